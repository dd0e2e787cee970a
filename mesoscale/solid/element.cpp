#include "mesoscale/solid/element.h"

#include <Eigen/LU>
#include <cmath>

namespace heddle::mesoscale::solid {

namespace {

using Matrix9 = Eigen::Matrix<double, 9, 9>;

// Coefficients are sums over eight nodes, so both factors of the energy carry 1/8.
constexpr double of_sums = 1.0 / 64.0;

Eigen::Matrix3d block(const Matrix9& t, int m, int n) {
  return t.block<3, 3>(3 * m, 3 * n);
}

// What couples the coefficients of xi eta, xi zeta, eta zeta: d/dxi of the first varies with eta, d/deta of
// it with xi, and so on; equal modes of strain and stress meet with weight 1/3.
Matrix9 bilinear_form(const Matrix9& t) {
  Matrix9 b;
  b << block(t, 0, 0) + block(t, 1, 1), block(t, 1, 2), block(t, 0, 2),  //
      block(t, 2, 1), block(t, 0, 0) + block(t, 2, 2), block(t, 0, 1),   //
      block(t, 2, 0), block(t, 1, 0), block(t, 1, 1) + block(t, 2, 2);
  return b / 3.0;
}

template <class Form, std::size_t size>
void store(const Form& form, std::array<double, size>& out) {
  for (Eigen::Index i = 0; i < form.rows(); ++i)
    for (Eigen::Index j = 0; j < form.cols(); ++j)
      out[static_cast<std::size_t>(i * form.cols() + j)] = of_sums * form(i, j);
}

}  // namespace

Matrix9 pulled_back(const Matrix6& stiffness, const VoxelEdges& edges) {
  const Eigen::Matrix3d half = 0.5 * edges, inverse = half.inverse();  // inverse(M, j) = dxi_M / dx_j
  const double volume = edges.determinant();
  Matrix9 t = Matrix9::Zero();
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k) {
      Eigen::Matrix3d c;  // C_ijkl over (j, l)
      for (int j = 0; j < 3; ++j)
        for (int l = 0; l < 3; ++l) c(j, l) = component(stiffness, i, j, k, l);
      const Eigen::Matrix3d pulled = volume * inverse * c * inverse.transpose();
      for (int m = 0; m < 3; ++m)
        for (int n = 0; n < 3; ++n) t(3 * m + i, 3 * n + k) = pulled(m, n);
    }
  return t;
}

ElementTable element_table(const Matrix6& stiffness, const VoxelEdges& edges) {
  const Matrix9 t = pulled_back(stiffness, edges);
  ElementTable table;
  store(t, table.linear);
  store(bilinear_form(t), table.bilinear);
  store(Eigen::Matrix3d((block(t, 0, 0) + block(t, 1, 1) + block(t, 2, 2)) / 9.0), table.trilinear);
  return table;
}

std::vector<ElementTable> element_tables(std::span<const Matrix6> stiffness, const VoxelEdges& edges) {
  std::vector<ElementTable> tables;
  tables.reserve(stiffness.size());
  for (const Matrix6& c : stiffness) tables.push_back(element_table(c, edges));
  return tables;
}

Eigen::Matrix<double, 24, 24> element_matrix(const Matrix6& stiffness, const VoxelEdges& edges) {
  const Eigen::Matrix3d to_space = (0.5 * edges).inverse();
  const double point = 1.0 / std::sqrt(3.0), weight = edges.determinant() / 8.0;
  Eigen::Matrix<double, 24, 24> k = Eigen::Matrix<double, 24, 24>::Zero();
  for (int gauss = 0; gauss < 8; ++gauss) {
    const auto sign = [](int bits, int axis) { return (bits >> axis) & 1 ? 1.0 : -1.0; };
    Eigen::Matrix<double, 6, 24> strain = Eigen::Matrix<double, 6, 24>::Zero();
    for (int node = 0; node < 8; ++node) {
      Eigen::RowVector3d slope;
      for (int m = 0; m < 3; ++m) {
        slope[m] = sign(node, m) / 8.0;
        for (int n = 0; n < 3; ++n)
          if (n != m) slope[m] *= 1.0 + sign(node, n) * sign(gauss, n) * point;
      }
      const Eigen::RowVector3d gradient = slope * to_space;
      for (int row = 0; row < 6; ++row) {
        const auto [a, b] = voigt_axes[row];
        strain(row, 3 * node + a) += a == b ? gradient[a] : gradient[b];
        if (a != b) strain(row, 3 * node + b) += gradient[a];
      }
    }
    k += weight * strain.transpose() * stiffness * strain;
  }
  return k;
}

}  // namespace heddle::mesoscale::solid
