#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "core/level_set.h"
#include "core/problem.h"
#include "macroscale/tools.h"

namespace heddle::macroscale {

/// How a tool's mesh becomes a band.
struct ToolBandSpec {
  double voxel = 0.5e-3;     ///< [m]; a twentieth of the smallest radius that matters keeps the error small
  double half_width = 3e-3;  ///< distances are right up to here on both sides [m]; see required_half_width
  Sides sides = Sides::closed;  ///< whether the mesh bounds a body or is a sheet
  Box region = everywhere;      ///< distances are known in here only; see reach_of_fabric
  double memory_limit = 400e6;  ///< [byte], of the whole build
};

/// Half width that a band needs so that no node leaves it unnoticed between two positions the solver accepts:
///     tool step + thickness + largest increment.
/// A node that was accepted lies no deeper than half the fabric's thickness; within one step the tool comes
/// nearer by its step, and a trial of Newton's method moves the node by one increment at most. The other half
/// of the thickness is what contact needs on the outer side, and reserve on the inner one.
/// @param tool_step          largest motion of the tool in a time step [m]
/// @param thickness          of the stress-free fabric [m]
/// @param largest_increment  of a node in one Newton iteration [m]
double required_half_width(double tool_step, double thickness, double largest_increment);

/// Signed distance to a tool's surface, twice piecewise differentiable, near the surface only.
///
/// The samples of a level set are turned into the coefficients of a tensor-product quadratic B-spline by
/// c = f - (second differences of f) / 8, so that the spline takes up quadratics exactly (no bias by
/// curvature). Its gradient is continuous everywhere in the band and its Hessian constant in no voxel but
/// bounded; both are exact derivatives of the value. The gradient is NOT made unit: a contact force p(d) grad
/// d is then the exact gradient of the contact energy. | |grad d| - 1 | is of the order of the distance's own
/// error over a voxel.
///
/// Coefficients stand in bricks of 8^3 voxels with a rim of one, so that the 27 of a point lie in one brick.
/// Nothing changes after construction: safe to read from any thread.
class ToolBand {
 public:
  /// @param half_width  [m], at most that of the level set less `rim` voxels
  /// @param region      where distances are asked for; the level set's own must be larger by a block
  /// @throws std::invalid_argument  if the level set is too narrow
  ToolBand(const LevelSet& level_set, double half_width, Sides sides = Sides::closed,
           const Box& region = everywhere);

  /// Voxels of a level set beyond half_width that the splines there still read.
  static constexpr double rim = 3.5;

  double voxel() const { return voxel_; }
  double half_width() const { return half_width_; }
  std::size_t bricks() const { return brick_.size() / brick_size; }
  std::size_t memory() const;  ///< [byte]
  /// Largest depth inside the tool that the band holds [m]; less than half_width if the tool is thinner.
  double depth() const { return depth_; }

  Distance evaluate(const Eigen::Vector3d& x) const;
  /// The same distance in the region; elsewhere -infinity for certain inside the tool, infinity for outside
  /// it or too near to its surface to tell. For tools against tools, which meet outside the fabric's region
  /// too.
  double rough_distance(const Eigen::Vector3d& x) const;

 private:
  static constexpr int brick_row = LevelSet::block + 2;
  static constexpr std::size_t brick_size = brick_row * brick_row * brick_row;
  static constexpr std::int32_t outside = -1, inside = -2, unknown = -3;

  bool in_region(const Eigen::Vector3d& x) const;
  std::int32_t brick_at(const std::array<int, 3>& voxel) const;
  Distance beyond(const Eigen::Vector3d& x, bool within) const;

  double voxel_, inverse_voxel_, half_width_, depth_ = 0.0;
  Sides sides_;
  Box region_;
  std::array<int, 3> first_{}, blocks_{};  ///< table of blocks: first index and number each way, in blocks
  std::vector<std::int32_t> table_;        ///< brick of each block, or on which side of the band it lies
  std::vector<float> brick_;
};

/// Distance (positive outside), its gradient and Hessian; x in the tool's own frame [m].
///
/// Outside, beyond the band: a lower bound of the distance, at least half_width; normal unit, curvature zero.
/// No contact can arise there as long as half_width is more than half the fabric's thickness. Inside, beyond
/// the band, and anywhere outside the band's region: the distance is -infinity, so that an energy built on it
/// is infinite and a line search takes a shorter step. Never "no contact".
Distance evaluate(const ToolBand& band, const Eigen::Vector3d& x);

/// Faults of a mesh and a specification that would keep a band from being built or trusted, without building
/// it.
/// @param key  dotted path of the tool in the configuration, for instance "tools.punch"
Problems check(const TriangleMesh& mesh, const ToolBandSpec& spec, const std::string& key);

/// Estimated peak memory of building the band [byte]: from the mesh's area, the voxel and the half width.
double estimated_memory(const TriangleMesh& mesh, const ToolBandSpec& spec);

/// @throws InputError  for every problem of check(), and for a tool that is thinner than the band is deep
///                     (a node could pass through it and come out as "no contact")
ToolBand tool_band(const TriangleMesh& mesh, const ToolBandSpec& spec, const std::string& key);

}  // namespace heddle::macroscale
