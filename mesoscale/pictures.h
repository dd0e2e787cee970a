#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/triangle_mesh.h"
#include "mesoscale/cell.h"
#include "mesoscale/nesting.h"

namespace heddle::mesoscale {

/// Surfaces of all tows of one repeat.
struct TowSurfaces {
  TriangleMesh mesh;
  std::vector<int> tow;  ///< of each triangle: 1 to `warps` the warps, then the wefts
};

/// Each tow is closed and lies in the sheared fabric plane: sections are swept along the path and flat at the
/// ends of the repeat.
/// @param along   stations per pitch
/// @param across  strips over the tow width
TowSurfaces tow_surfaces(const UnitCell& cell, int along = 24, int across = 16);

/// Which tow fills each voxel of one repeat, sampled at the voxel's middle: 0 = none (resin or air), 1 to
/// `warps` the warps, then the wefts. x fastest. Lengths in the parameter plane, which is the fabric's own
/// plane where it is not sheared.
struct VoxelLabels {
  std::array<int, 3> count{};       ///< voxels along x, y, z
  std::array<double, 3> origin{};   ///< lowest corner [m]
  std::array<double, 3> spacing{};  ///< [m]
  std::vector<std::uint16_t> labels;
};

/// @param per_pitch   voxels along one pitch
/// @param through     voxels over the thickness of the fabric
VoxelLabels tow_labels(const UnitCell& cell, int per_pitch, int through);

enum class TowDirection { warp, weft };

/// A closed outline in the plane of a cut: {distance along the cut, z} [m].
struct Outline {
  TowDirection tow;
  std::vector<std::array<double, 2>> points;
};

/// What a vertical cut along the middle of warp `warp` shows: the warp as a band, the wefts as their
/// sections. Distances are along xi, in which an oblique cut through a sheared fabric keeps the parameter
/// width.
std::vector<Outline> warp_cut(const UnitCell& cell, int warp = 0, int points_per_pitch = 48);

/// The same of a stack, along the middle of the lowest ply's first warp: what each ply shows there, which is
/// its own middle only where it is not shifted across.
std::vector<Outline> stack_cut(const PlyStack& stack, int points_per_pitch = 48);

}  // namespace heddle::mesoscale
