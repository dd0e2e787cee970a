#include "mesoscale/solid/macro_load.h"

#include <Eigen/LU>

#include "mesoscale/solid/pack.h"

namespace heddle::mesoscale::solid {

namespace {

using Vector9 = Eigen::Matrix<double, 9, 1>;

// Gradient of a strain in the voxel's own coordinates, (3 M + i); `half` holds half the edges.
Vector9 pulled_gradient(const Vector6& strain, const Eigen::Matrix3d& half) {
  Eigen::Matrix3d gradient;
  for (int v = 0; v < 6; ++v) {
    const auto [i, j] = voigt_axes[v];
    gradient(i, j) = gradient(j, i) = i == j ? strain[v] : 0.5 * strain[v];
  }
  const Eigen::Matrix3d pulled = gradient * half;
  return Eigen::Map<const Vector9>(pulled.data());
}

// What one voxel pulls with, by the coefficients of its displacement (xi, eta, zeta; xi zeta, eta zeta).
struct ModalForce {
  double steady[9][loads];       // of the stretch
  double with_height[9][loads];  // of the curvature, times the height of the voxel's middle
  double bilinear[6][loads];     // of the curvature within the voxel
};

ModalForce modal_force(const Matrix6& stiffness, const VoxelEdges& edges, const MacroLoad& load) {
  const Eigen::Matrix<double, 9, 9> pulled = pulled_back(stiffness, edges);
  const Eigen::Matrix3d half = 0.5 * edges;
  ModalForce force;
  for (int l = 0; l < loads; ++l) {
    const Vector9 stretch = pulled * pulled_gradient(load.stretch[l], half);
    const Vector9 curvature = pulled * pulled_gradient(load.curvature[l], half);
    for (int m = 0; m < 9; ++m) {
      force.steady[m][l] = stretch[m];
      force.with_height[m][l] = curvature[m];
    }
    // d/dxi and d/deta of these coefficients vary with zeta, as the strain does: weight 1/3.
    for (int m = 0; m < 6; ++m) force.bilinear[m][l] = half(2, 2) * curvature[m] / 3.0;
  }
  return force;
}

// Minus one eighth of the coefficients' forces on each node of a voxel, node 4 c + 2 b + a at (a, b, c).
// `first` load case of the field.
template <int cases>
HEDDLE_INLINE void scatter(const ModalForce& force, int first, double height,
                           const std::array<double*, 8>& nodes) {
  for (int i = 0; i < 3; ++i) {
    const auto coefficient = [&](Pack<cases>& sum, int m) {
      Pack<cases> with_height;
      load(sum, force.steady[m] + first);
      load(with_height, force.with_height[m] + first);
      add_product(sum, height, with_height);
    };
    Pack<cases> x, y, z, xz, yz;
    coefficient(x, i);
    coefficient(y, 3 + i);
    coefficient(z, 6 + i);
    load(xz, force.bilinear[i] + first);
    load(yz, force.bilinear[3 + i] + first);
#pragma GCC unroll 8
    for (int n = 0; n < 8; ++n) {
      const double a = n & 1 ? -0.125 : 0.125, b = n & 2 ? -0.125 : 0.125, c = n & 4 ? -0.125 : 0.125;
      double* at = nodes[static_cast<std::size_t>(n)] + cases * i;
      Pack<cases> sum;
      load(sum, at);
      add_product(sum, a, x);
      add_product(sum, b, y);
      add_product(sum, c, z);
      add_product(sum, n & 4 ? a : -a, xz);
      add_product(sum, n & 4 ? b : -b, yz);
      store(at, sum);
    }
  }
}

// One row of voxels; rows[2 c + b] are its rows of nodes.
struct RowTask {
  const ModalForce* forces;
  const std::uint16_t* material;
  int nx;
  int first;  // load case
  double height;
  std::array<double*, 4> rows;
};

template <int cases>
HEDDLE_INLINE void scatter_row(const RowTask& t) {
  constexpr std::ptrdiff_t node = 3 * cases;
  for (int i = 0; i < t.nx; ++i) {
    const std::ptrdiff_t l = node * i, r = node * ((i + 1) % t.nx);
    const auto& n = t.rows;
    scatter<cases>(t.forces[t.material[i]], t.first, t.height,
                   {n[0] + l, n[0] + r, n[1] + l, n[1] + r, n[2] + l, n[2] + r, n[3] + l, n[3] + r});
  }
}
template <int cases>
__attribute__((target("avx2,fma"))) void scatter_row_avx2(const RowTask& t) {
  scatter_row<cases>(t);
}
template <int cases>
void add_row(const RowTask& t) {
  if (best_instructions() == Instructions::plain)
    scatter_row<cases>(t);
  else
    scatter_row_avx2<cases>(t);
}

}  // namespace

MacroLoad unit_strains() {
  MacroLoad load;
  for (int l = 0; l < loads; ++l) {
    load.stretch[l] = Vector6::Unit(l);
    load.curvature[l] = Vector6::Zero();
  }
  return load;
}

MacroLoad unit_plate_loads() {
  MacroLoad load;
  constexpr int in_plane[3] = {0, 1, 5};
  for (int l = 0; l < 3; ++l) {
    load.stretch[l] = load.curvature[l + 3] = Vector6::Unit(in_plane[l]);
    load.stretch[l + 3] = load.curvature[l] = Vector6::Zero();
  }
  return load;
}

double layer_height(const ElasticCell& cell, int layer) {
  return (layer + 0.5 - 0.5 * cell.count[2]) * cell.edges(2, 2) / cell.count[2];
}

void add_forces(const ElasticCell& cell, const MacroLoad& load, const CellSolver& solver, Field& force,
                int first) {
  const VoxelEdges edges = cell.voxel_edges();
  std::vector<ModalForce> of_material;
  for (const Matrix6& c : cell.stiffness) of_material.push_back(modal_force(c, edges, load));
  const auto [nx, ny, nz] = cell.count;
  const std::size_t row = static_cast<std::size_t>(3 * solver.cases()) * nx;
  solver.for_layers([](int) {},
                    [&](int k) {
                      double* low = force.data() + solver.plane() * static_cast<std::size_t>(k);
                      double* high =
                          force.data() + solver.plane() * static_cast<std::size_t>((k + 1) % solver.planes());
                      for (int j = 0; j < ny; ++j) {
                        const std::size_t here = row * static_cast<std::size_t>(j),
                                          next = row * static_cast<std::size_t>((j + 1) % ny);
                        const RowTask task{of_material.data(),
                                           cell.material.data() + (static_cast<std::size_t>(k) * ny + j) * nx,
                                           nx,
                                           first,
                                           layer_height(cell, k),
                                           {low + here, low + next, high + here, high + next}};
                        (solver.cases() == loads ? add_row<loads> : add_row<pair_of_loads>)(task);
                      }
                    });
}

Matrix6 macro_energy(const ElasticCell& cell, const MacroLoad& load) {
  Matrix6 stretch, curvature;
  for (int l = 0; l < loads; ++l) {
    stretch.col(l) = load.stretch[l];
    curvature.col(l) = load.curvature[l];
  }
  const std::size_t layer = static_cast<std::size_t>(cell.count[0]) * cell.count[1];
  const double thickness = cell.edges(2, 2) / cell.count[2];
  Matrix6 sum = Matrix6::Zero();
  for (int k = 0; k < cell.count[2]; ++k) {
    std::vector<std::size_t> number(cell.stiffness.size(), 0);
    for (std::size_t v = layer * k; v < layer * (k + 1); ++v) ++number[cell.material[v]];
    Matrix6 c = Matrix6::Zero();
    for (std::size_t m = 0; m < number.size(); ++m) c += static_cast<double>(number[m]) * cell.stiffness[m];
    const Matrix6 strain = stretch + layer_height(cell, k) * curvature;
    sum += strain.transpose() * c * strain +
           thickness * thickness / 12.0 * curvature.transpose() * c * curvature;
  }
  return sum * cell.voxel_edges().determinant();
}

}  // namespace heddle::mesoscale::solid
