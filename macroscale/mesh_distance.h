#pragma once

#include <memory>

#include <Eigen/Core>

#include "core/triangle_mesh.h"

namespace heddle::macroscale {

/// Signed distance to a closed triangulation, exact to rounding: nearest triangle by an axis-aligned box
/// tree, sign by counting crossings with exact predicates (CGAL). About twenty times slower than a band on a
/// grid, so it is the oracle of the band, not its replacement. Queries may run from several threads at once.
class MeshDistance {
 public:
  /// @throws InputError when check() finds a problem: a sign needs a sound, closed surface
  explicit MeshDistance(const TriangleMesh& mesh);
  ~MeshDistance();
  MeshDistance(MeshDistance&&) noexcept;
  MeshDistance& operator=(MeshDistance&&) noexcept;

  /// Distance to the surface, negative inside the solid [m].
  double signed_distance(const Eigen::Vector3d& x) const;
  /// Nearest point of the surface [m].
  Eigen::Vector3d closest_point(const Eigen::Vector3d& x) const;

 private:
  struct Trees;
  std::unique_ptr<Trees> trees_;
};

}  // namespace heddle::macroscale
