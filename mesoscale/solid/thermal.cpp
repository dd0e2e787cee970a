#include "mesoscale/solid/thermal.h"

#include <Eigen/LU>
#include <array>

#include "core/problem.h"

namespace heddle::mesoscale::solid {

namespace {

Vector6 voigt_strain(const FreeStrain& strain) {
  Vector6 e = Vector6::Zero();
  e.head<3>() << strain.axial, strain.transverse, strain.transverse;
  return e;
}

// Mean over a voxel of the strains of each load case, from the displacements of its nodes 4 c + 2 b + a.
using Strains = Eigen::Matrix<double, 6, loads>;
Strains mean_strain(const std::array<const double*, 8>& node, int cases,
                    const Eigen::Matrix3d& to_reference) {
  Strains strain = Strains::Zero();
  for (int l = 0; l < cases; ++l) {
    Eigen::Matrix3d pulled = Eigen::Matrix3d::Zero();  // du_i / dxi_M
    for (int n = 0; n < 8; ++n)
      for (int i = 0; i < 3; ++i)
        for (int m = 0; m < 3; ++m)
          pulled(i, m) +=
              ((n >> m & 1) != 0 ? 0.125 : -0.125) * node[static_cast<std::size_t>(n)][cases * i + l];
    const Eigen::Matrix3d gradient = pulled * to_reference;
    for (int v = 0; v < 6; ++v) {
      const auto [i, j] = voigt_axes[static_cast<std::size_t>(v)];
      strain(v, l) = i == j ? gradient(i, i) : gradient(i, j) + gradient(j, i);
    }
  }
  return strain;
}

}  // namespace

FreeStrain schapery(const IsotropicPhase& fibre, double fibre_strain, const IsotropicPhase& matrix,
                    double matrix_strain, double fibre_fraction) {
  const double f = fibre_fraction, m = 1.0 - fibre_fraction;
  const double stiff = fibre.modulus * f + matrix.modulus * m;
  const double axial = (fibre.modulus * fibre_strain * f + matrix.modulus * matrix_strain * m) / stiff;
  const double poisson = fibre.poisson * f + matrix.poisson * m;
  return {axial, (1.0 + fibre.poisson) * fibre_strain * f + (1.0 + matrix.poisson) * matrix_strain * m -
                     axial * poisson};
}

HeldStress content_held_stress(const VoxelCell& cell, std::span<const Matrix6> phases,
                               std::span<const FreeStrain> strain) {
  HeldStress result;
  for (const VoxelContent& content : cell.contents) {
    std::vector<double> share;
    std::vector<Matrix6> stiffness;
    std::vector<Vector6> held;
    for (const Portion& portion : content.portions) {
      const Eigen::Matrix3d turn = turn_to(cell.directions[portion.direction]);
      share.push_back(portion.share);
      stiffness.push_back(rotated(phases[portion.phase], turn));
      held.push_back(stiffness.back() * (strain_turn(turn) * voigt_strain(strain[portion.phase])));
    }
    const std::vector<Matrix6> layer = layer_strains(share, stiffness, content.normal);
    Vector6 sum = Vector6::Zero();
    for (std::size_t n = 0; n < layer.size(); ++n) sum += share[n] * layer[n].transpose() * held[n];
    result.push_back(sum);
  }
  return result;
}

Vector6 held_work(const ElasticCell& cell, const MacroLoad& load, const Field& u, const CellSolver& solver,
                  int first, const HeldStress& held) {
  const int cases = solver.cases();
  const VoxelEdges edges = cell.voxel_edges();
  const Eigen::Matrix3d to_reference = (0.5 * edges).inverse();
  const auto [nx, ny, nz] = cell.count;
  const std::size_t node = 3 * static_cast<std::size_t>(cases), plane = solver.plane();
  std::vector<Vector6> of_layer(static_cast<std::size_t>(nz));
  tbb::parallel_for(0, nz, [&](int k) {
    Strains macro = Strains::Zero();
    for (int l = 0; l < cases; ++l)
      macro.col(l) = load.stretch[static_cast<std::size_t>(first + l)] +
                     layer_height(cell, k) * load.curvature[static_cast<std::size_t>(first + l)];
    Vector6 sum = Vector6::Zero();
    std::array<const double*, 8> nodes{};
    for (int j = 0; j < ny; ++j)
      for (int i = 0; i < nx; ++i) {
        for (int n = 0; n < 8; ++n) {
          const int x = (i + (n & 1)) % nx, y = (j + (n >> 1 & 1)) % ny, z = (k + (n >> 2)) % solver.planes();
          nodes[static_cast<std::size_t>(n)] =
              u.data() + plane * static_cast<std::size_t>(z) + node * (static_cast<std::size_t>(y) * nx + x);
        }
        const std::uint16_t m = cell.material[(static_cast<std::size_t>(k) * ny + j) * nx + i];
        sum += (macro + mean_strain(nodes, cases, to_reference)).transpose() * held[m];
      }
    of_layer[static_cast<std::size_t>(k)] = sum;
  });
  Vector6 total = Vector6::Zero();  // in the order of the layers: the same bits on any number of threads
  for (const Vector6& sum : of_layer) total += sum;
  return total * edges.determinant();
}

}  // namespace heddle::mesoscale::solid
