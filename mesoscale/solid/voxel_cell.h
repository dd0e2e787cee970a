#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "mesoscale/solid/cell_solver.h"

namespace heddle::mesoscale::solid {

/// One material's part of a voxel.
struct Portion {
  std::uint16_t phase = 0;      ///< into the stiffness of the phases
  std::uint16_t direction = 0;  ///< into VoxelCell::directions: where the phase's axis 1 points
  double share = 1.0;           ///< of the voxel's volume [-]

  bool operator==(const Portion&) const = default;
};

/// What fills a voxel: one phase, or layers of several across one normal.
struct VoxelContent {
  std::vector<Portion> portions;                      ///< shares add up to 1
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< of the layers; no matter for one portion
};

/// A cell as equal voxels, x fastest. Voxels that hold the same share one content: the stiffness of tens of
/// thousands of contents is a table, of millions of voxels it would be the memory.
struct VoxelCell {
  std::array<int, 3> count{};          ///< voxels along x, y, z
  Eigen::Matrix3d edges;               ///< of the cell [m], columns; the third along z
  std::vector<std::uint16_t> content;  ///< of each voxel, into contents
  std::vector<VoxelContent> contents;
  std::vector<Eigen::Vector3d> directions{Eigen::Vector3d::UnitX()};  ///< the first: no turn
};

/// Volume share of each phase, `phases` of them [-].
std::vector<double> phase_shares(const VoxelCell& cell, std::size_t phases);

/// Layers of several materials across a normal, exactly: strains along the layers and stresses across them
/// are common. A void in the voxel takes its whole share away instead (mean of the stiffnesses): as a layer
/// it would cut the voxel through.
/// @param share      of each layer, adding up to 1
/// @param stiffness  of each layer [Pa]
Matrix6 laminate(std::span<const double> share, std::span<const Matrix6> stiffness,
                 const Eigen::Vector3d& normal);

/// How each layer strains when the laminate as a whole does: e_n = A_n e, Voigt. Layers beside a void strain
/// as the whole.
std::vector<Matrix6> layer_strains(std::span<const double> share, std::span<const Matrix6> stiffness,
                                   const Eigen::Vector3d& normal);

/// Stiffness of each content [Pa].
/// @param phases  of each phase, its axis 1 along the direction [Pa]
std::vector<Matrix6> content_stiffness(const VoxelCell& cell, std::span<const Matrix6> phases);

/// The cell as the solver takes it; both arguments must outlive it.
ElasticCell elastic_cell(const VoxelCell& cell, std::span<const Matrix6> content_stiffness);

}  // namespace heddle::mesoscale::solid
