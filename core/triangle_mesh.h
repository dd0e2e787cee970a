#pragma once

#include <array>
#include <vector>

namespace heddle {

/// Triangles with shared vertices, outward normals (counter-clockwise seen from outside). [m]
struct TriangleMesh {
  std::vector<std::array<double, 3>> vertices;
  std::vector<std::array<int, 3>> triangles;
};

/// Signed volume by the divergence theorem; that of the bodies where the surfaces are closed [m^3].
double volume(const TriangleMesh& mesh);

}  // namespace heddle
