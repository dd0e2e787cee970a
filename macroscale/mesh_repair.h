#pragma once

#include <cstddef>
#include <string>

#include "core/triangle_mesh.h"

namespace heddle::macroscale {

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
