#pragma once

#include <vector>

#include <Eigen/Core>

#include "core/triangle_mesh.h"

namespace heddle {

/// Square of the distance of a point to triangle (a, b, c) [m^2].
double squared_distance(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
                        const Eigen::Vector3d& place);

/// Finds the nearest triangle of a mesh from one that is near: goes to the nearest of all that share a vertex
/// with it until none is nearer. The end is the nearest triangle of all if the start lies on the same stretch
/// of surface, near enough that no dent stops the walk. Safe to read from any thread.
class TriangleWalk {
 public:
  /// @param mesh  must outlive the walk; every index names a vertex
  explicit TriangleWalk(const TriangleMesh& mesh);

  struct Nearest {
    double squared;  ///< square of the distance [m^2]
    int triangle;    ///< index in the mesh
  };
  Nearest at(int triangle, const Eigen::Vector3d& place) const;
  Nearest from(Nearest start, const Eigen::Vector3d& place) const;
  /// Whether two triangles share a vertex: a walk that ended at one has seen the other.
  bool touch(int a, int b) const;

 private:
  const TriangleMesh& mesh_;
  std::vector<int> first_, around_;  ///< triangles about each vertex: around_[first_[v] .. first_[v + 1])
};

}  // namespace heddle
