#include "core/triangle_mesh.h"

namespace heddle {

namespace {

double tetrahedron(const std::array<double, 3>& a, const std::array<double, 3>& b,
                   const std::array<double, 3>& c) {
  return (a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
          a[2] * (b[0] * c[1] - b[1] * c[0])) /
         6.0;
}

}  // namespace

double volume(const TriangleMesh& mesh) {
  double sum = 0.0;
  for (const std::array<int, 3>& t : mesh.triangles)
    sum += tetrahedron(mesh.vertices[static_cast<std::size_t>(t[0])],
                       mesh.vertices[static_cast<std::size_t>(t[1])],
                       mesh.vertices[static_cast<std::size_t>(t[2])]);
  return sum;
}

}  // namespace heddle
