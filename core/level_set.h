#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <limits>
#include <memory>
#include <vector>

#include "core/triangle_mesh.h"

namespace heddle {

struct Box {
  std::array<double, 3> low{}, high{};  ///< corners [m]
};

/// Signed distance to a surface (negative inside the body) on the voxels of a narrow band, one sign beyond
/// it. Voxel (i, j, k) stands at voxel() * (i, j, k). A handle to something that never changes: cheap to
/// copy, safe to read from any thread. The storage is OpenVDB's; no header but this one knows.
class LevelSet {
 public:
  struct Grid;
  explicit LevelSet(std::shared_ptr<const Grid> grid) : grid_(std::move(grid)) {}

  double voxel() const;       ///< [m]
  double half_width() const;  ///< distances are true up to here on both sides [m]
  std::size_t active_voxels() const;
  std::size_t memory() const;  ///< [byte]

  /// Blocks of 8 x 8 x 8 voxels (first indices multiples of 8) that hold some of the band, in a fixed order.
  static constexpr int block = 8;
  std::vector<std::array<int, 3>> blocks() const;
  /// Values [m] of count^3 voxels from `first` on, the last index running fastest; beyond the band
  /// half_width() or a little more, with the sign of the side.
  void read(std::array<int, 3> first, int count, float* values) const;

  const Grid& grid() const { return *grid_; }

 private:
  std::shared_ptr<const Grid> grid_;
};

/// Samples a TRUE signed distance (slope 1; an implicit function such as f/t - 1 is none) straight into the
/// blocks of the band, in parallel, with the same result for any number of threads. The distance must be
/// right within half_width_voxels + 14 voxels of the surface and not too small beyond.
/// @param body   box that holds the body; the band beyond it is added here, so that it is never cut
/// @param voxel  [m]
/// @throws std::invalid_argument  if voxel or width are not positive, or if the body reaches out of its box
LevelSet level_set_from_distance(const std::function<double(double, double, double)>& distance,
                                 const Box& body, double voxel, double half_width_voxels);

/// What lies inside a mesh.
enum class Sides {
  closed,  ///< the mesh bounds a body, whatever its orientation
  /// A sheet with an edge: the tool is on the side its normals point away from. Beyond its edge a sheet has
  /// no side to speak of: it must reach past whatever it is to meet.
  open
};

/// All of space.
constexpr Box everywhere{{-std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity(),
                          -std::numeric_limits<double>::infinity()},
                         {std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity(),
                          std::numeric_limits<double>::infinity()}};

/// Distance to a mesh: to its nearest triangle, up to the rounding of a float.
/// @param region  only blocks that meet it get the band; elsewhere a level set tells sides and no distances
/// @throws std::invalid_argument  if voxel or width are not positive, or an index does not exist
LevelSet level_set_from_mesh(const TriangleMesh& mesh, double voxel, double half_width_voxels,
                             Sides sides = Sides::closed, const Box& region = everywhere);

/// Enclosed volume [m^3].
double volume(const LevelSet& body);

/// What two bodies share. Voxels are counted whole when their centre lies inside both: two bodies that only
/// touch share none, however long they run beside each other. A volume with weights at the surface (or the
/// level set of the intersection) is smeared over a voxel and finds 3.6 % of a tow there.
struct Overlap {
  double volume = 0.0;  ///< voxels inside both, times their size [m^3]
  double depth = 0.0;   ///< max of -max(d_a, d_b) over the voxels: > 0 inside both, < 0 apart [m]
  std::size_t voxels = 0;
};
/// @throws std::invalid_argument  if the voxel sizes differ
Overlap overlap(const LevelSet& a, const LevelSet& b);

/// Triangles of the surface, normals outward.
TriangleMesh surface(const LevelSet& body);

}  // namespace heddle
