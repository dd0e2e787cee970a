#pragma once

#include <cstddef>
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

/// A mesh after the repairs that cannot change its shape by more than `tolerance`, and how many of each.
struct Repair {
  TriangleMesh mesh;
  double tolerance = 0.0;              ///< vertices nearer than this were merged [m]
  std::size_t merged_vertices = 0;     ///< ... into another one
  std::size_t dropped_degenerate = 0;  ///< triangles without area: two corners at one place
  std::size_t flipped_caps = 0;        ///< triangles without area: three corners on a line
  std::size_t dropped_repeated = 0;    ///< triangles that are there already
  std::size_t turned = 0;              ///< triangles whose normal was reversed

  bool changed() const {
    return merged_vertices + dropped_degenerate + flipped_caps + dropped_repeated + turned > 0;
  }
};

/// Merges vertices nearer than 1e-6 of the bounding box's diagonal, drops degenerate and repeated triangles,
/// turns triangles to agree with their neighbours and closed parts inside in. A pure function: same mesh,
/// same result. It never fills a hole and never moves a surface: what remains, check() names.
Repair repaired(const TriangleMesh& mesh);

/// "merges 12 vertices, turns 3 triangles"; "changes nothing".
std::string summary(const Repair& repair);

}  // namespace heddle::macroscale
