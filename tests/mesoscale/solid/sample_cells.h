#pragma once

#include <cstdint>
#include <random>
#include <vector>

#include "mesoscale/solid/homogenise.h"
#include "mesoscale/solid/micromechanics.h"

namespace heddle::test {

namespace solid = mesoscale::solid;

inline constexpr solid::IsotropicPhase glass{72.4e9, 0.22}, polypropylene{1.5e9, 0.40};

/// A tow of Table 1, consolidated.
inline solid::Matrix6 tow_stiffness() {
  return solid::stiffness(solid::chamis(glass, polypropylene, 0.6));
}

inline double gap(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  return (a - b).norm() / b.norm();
}

/// Voxels with what the solver only looks at.
struct SampleCell {
  std::array<int, 3> count;
  Eigen::Matrix3d edges;
  std::vector<std::uint16_t> material;
  std::vector<solid::Matrix6> stiffness;

  solid::ElasticCell view() const { return {count, edges, material, stiffness}; }
};

inline SampleCell uniform_cell(std::array<int, 3> count, const Eigen::Matrix3d& edges,
                               const solid::Matrix6& c) {
  const auto voxels = static_cast<std::size_t>(count[0]) * count[1] * count[2];
  return {count, edges, std::vector<std::uint16_t>(voxels, 0), {c}};
}

inline Eigen::Matrix3d box(double x, double y, double z) {
  return Eigen::Vector3d(x, y, z).asDiagonal();
}

/// material(i, j, k) of each voxel.
template <class Material>
SampleCell filled_cell(std::array<int, 3> count, const Eigen::Matrix3d& edges,
                       std::vector<solid::Matrix6> stiffness, const Material& material) {
  SampleCell cell{count, edges, {}, std::move(stiffness)};
  for (int k = 0; k < count[2]; ++k)
    for (int j = 0; j < count[1]; ++j)
      for (int i = 0; i < count[0]; ++i)
        cell.material.push_back(static_cast<std::uint16_t>(material(i, j, k)));
  return cell;
}

inline SampleCell random_cell(std::array<int, 3> count, std::vector<solid::Matrix6> stiffness,
                              unsigned seed) {
  std::mt19937 generator(seed);
  const auto materials = static_cast<unsigned>(stiffness.size());
  return filled_cell(count, box(2e-3, 3e-3, 1e-3), std::move(stiffness),
                     [&](int, int, int) { return generator() % materials; });
}

inline std::vector<solid::Matrix6> tow_and_resin() {
  return {solid::stiffness(polypropylene), tow_stiffness(),
          solid::rotated(tow_stiffness(), solid::turn_to({0.0, 1.0, 0.2}))};
}

}  // namespace heddle::test
