#pragma once

#include <array>
#include <deque>
#include <functional>
#include <vector>

#include "core/sheet_side.h"
#include "core/triangle_mesh.h"

namespace heddle {

/// 8^3 voxels of a band about a surface, the last index running fastest.
struct BandBlock {
  static constexpr int row = 8, size = row * row * row;
  std::array<int, 3> origin{};  ///< first voxel; multiples of 8
  std::array<float, size>
      distance{};  ///< to the nearest triangle [m], negative (or -0) inside; infinite out of reach
  std::array<int, size> triangle{};  ///< ... which is this one; -1 out of reach
};

/// What is known of one block before the band grows: a triangle near each voxel that is near the surface (-1:
/// unknown) and on which side of the surface it lies.
struct BandSeed {
  std::array<int, BandBlock::size> triangle{};
  std::array<bool, BandBlock::size> inside{};
};

/// Distance to the nearest triangle on all blocks that come within `reach` of the surface.
///
/// The nearest triangle of a voxel is looked for from the nearest ones of its neighbours, and handed on until
/// no neighbour knows a nearer one, so that sheets that face each other meet in the middle, whichever was
/// first. A voxel's side is that of its neighbour: no surface runs between two places that are nearer to each
/// other than to it. Same result for any number of threads.
/// @param voxel  [m]; voxel (i, j, k) stands at voxel * (i, j, k)
/// @param reach  [m]
/// @param first  origins of the blocks that hold places nearer than a voxel to the surface
/// @param seed   what is known of each of them: at the least, all voxels nearer than a voxel to the surface
/// @param wanted whether the block at an origin is asked for
/// @param sheet  tells sides where the mesh is open; null for a closed one
std::deque<BandBlock> grow_band(const TriangleMesh& mesh, double voxel, double reach,
                                const std::vector<std::array<int, 3>>& first,
                                const std::function<BandSeed(const std::array<int, 3>&)>& seed,
                                const std::function<bool(const std::array<int, 3>&)>& wanted,
                                const SheetSide* sheet);

}  // namespace heddle
