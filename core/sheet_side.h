#pragma once

#include <vector>

#include <Eigen/Core>

#include "core/triangle_mesh.h"

namespace heddle {

/// Which side of an oriented surface a place is on, by the normals of its faces, edges and corners: at an
/// edge the sum of both faces, at a corner the sum weighted by angle. Source: Baerentzen & Aanaes 2005.
class SheetSide {
 public:
  /// @param mesh  must outlive this; every index names a vertex
  explicit SheetSide(const TriangleMesh& mesh);

  /// Whether the place lies against the normals of the feature of `triangle` that is nearest to it.
  /// @param triangle  the mesh's nearest to the place
  bool behind(const Eigen::Vector3d& place, int triangle) const;

 private:
  Eigen::Vector3d vertex(int index) const;

  const TriangleMesh& mesh_;
  std::vector<Eigen::Vector3d> face_, edge_, corner_;  ///< normals; edge 3 t + k runs from corner k of t
};

}  // namespace heddle
