#pragma once

#include "mesoscale/cell.h"
#include "mesoscale/nesting.h"
#include "mesoscale/pictures.h"
#include "mesoscale/solid/voxel_cell.h"

namespace heddle::mesoscale::solid {

/// What a voxel that two materials share is made of.
enum class Mixing {
  laminate,  ///< layers across the normal of the interface
  dominant   ///< the larger of them: the staircase of a plain voxel mesh, kept for comparison
};

struct SamplerOptions {
  int per_pitch = 32;  ///< voxels along one pitch, each way
  int layers = 32;     ///< voxels over the thickness
  Mixing mixing = Mixing::laminate;
};

/// Phases of a sampled cell: stiffness is asked for in this order.
inline constexpr std::uint16_t resin_phase = 0, warp_phase = 1, weft_phase = 2;

/// One repeat of a weave as voxels, on the sheared lattice where the cell is sheared. Volume shares come from
/// 4 x 4 columns a voxel, each cut exactly along z (and are then rounded to 1/32); directions from the slope
/// of the tow's centreline over the voxel, in steps of 0.5 degrees; normals from the gradient of the share.
///
/// @param thickness  of the fabric: crown to crown [m]
/// @throws NumericalError  if the grid asks for more than 65535 different voxels
VoxelCell sample(const UnitCell& cell, double thickness, const SamplerOptions& options);

/// The same of plies on one another, `layers` voxels over each ply's share of the thickness. In a voxel that
/// holds warps (wefts) of two plies, all have the direction of those that fill more of it.
VoxelCell sample(const PlyStack& stack, const SamplerOptions& options);

/// One repeat of a weave for people and other codes to look at: whose tow, how much of it, and where it runs.
struct CellVoxels {
  VoxelLabels grid;             ///< tow at the middle of each voxel
  std::vector<float> fraction;  ///< of the voxel's volume that is tow [-], by columns as in `sample`
  std::vector<float>
      direction;  ///< three a voxel: unit vector along the tow that fills more; 0 where none does
};

/// @param cell       unsheared
/// @param per_pitch  voxels along one pitch, each way
/// @param through    voxels from crown to crown
CellVoxels cell_voxels(const UnitCell& cell, int per_pitch, int through);

}  // namespace heddle::mesoscale::solid
