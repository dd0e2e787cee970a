#pragma once

#include <string>

#include "core/problem.h"
#include "core/triangle_mesh.h"

namespace heddle::macroscale {

enum class TopologyRule {
  closed,       ///< every edge has two triangles: inside and outside are defined everywhere
  open_allowed  ///< a sheet with a border will do; its front is where its normals point
};

/// Everything that keeps a triangulation from being a tool: no or bad numbers, degenerate and repeated
/// triangles, edges with one (unless open is allowed) or more than two triangles, vertices where sheets touch
/// in one point, triangles turned against their neighbours, parts inside out, triangles that cross.
///
/// Each problem says how many there are and where the first is [mm], and whether repaired() mends the mesh
/// (then the key KEY.repair does it) or what to do instead. Crossings are looked for only once edges and
/// vertices are sound, because before that no side of a triangle is inside; the same holds for inside out.
/// Predicates are exact (CGAL), so nothing here depends on a tolerance.
/// @param key   dotted path of the tool, for instance "tools.punch"
/// @param file  the tool's file as the user wrote it, put into each problem
Problems check(const TriangleMesh& mesh, const std::string& key, const std::string& file,
               TopologyRule rule = TopologyRule::closed);

}  // namespace heddle::macroscale
