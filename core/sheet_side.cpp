#include "core/sheet_side.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

#include <Eigen/Geometry>

namespace heddle {

using Eigen::Vector3d;

SheetSide::SheetSide(const TriangleMesh& mesh)
    : mesh_(mesh), corner_(mesh.vertices.size(), Vector3d::Zero()) {
  struct Side {
    std::array<int, 2> edge;
    std::size_t place;  // 3 * triangle + side
  };
  std::vector<Side> sides;
  face_.reserve(mesh.triangles.size());
  sides.reserve(3 * mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& v = mesh.triangles[t];
    const Vector3d normal = (vertex(v[1]) - vertex(v[0])).cross(vertex(v[2]) - vertex(v[0])).normalized();
    face_.push_back(normal);
    for (std::size_t k = 0; k < 3; ++k) {
      const int a = v[k], b = v[(k + 1) % 3], c = v[(k + 2) % 3];
      sides.push_back({{std::min(a, b), std::max(a, b)}, 3 * t + k});
      const Vector3d e = vertex(b) - vertex(a), f = vertex(c) - vertex(a);
      corner_[static_cast<std::size_t>(a)] += normal * std::atan2(e.cross(f).norm(), e.dot(f));
    }
  }
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
    return std::tie(a.edge, a.place) < std::tie(b.edge, b.place);
  });
  edge_.assign(3 * mesh.triangles.size(), Vector3d::Zero());
  for (std::size_t first = 0, end = 0; first < sides.size(); first = end) {
    Vector3d sum = Vector3d::Zero();
    for (end = first; end < sides.size() && sides[end].edge == sides[first].edge; ++end)
      sum += face_[sides[end].place / 3];
    for (std::size_t n = first; n < end; ++n) edge_[sides[n].place] = sum;
  }
}

Vector3d SheetSide::vertex(int index) const {
  return Vector3d::Map(mesh_.vertices[static_cast<std::size_t>(index)].data());
}

bool SheetSide::behind(const Vector3d& q, int triangle) const {
  // Regions of a triangle: Ericson, Real-Time Collision Detection, 5.1.5.
  const auto t = static_cast<std::size_t>(triangle);
  const auto& v = mesh_.triangles[t];
  const Vector3d a = vertex(v[0]), b = vertex(v[1]), c = vertex(v[2]), ab = b - a, ac = c - a;
  const auto side = [&](const Vector3d& foot, const Vector3d& normal) {
    return (q - foot).dot(normal) < 0.0;
  };
  const auto corner = [&](std::size_t k, const Vector3d& foot) {
    return side(foot, corner_[static_cast<std::size_t>(v[k])]);
  };
  const double d1 = ab.dot(q - a), d2 = ac.dot(q - a);
  if (d1 <= 0.0 && d2 <= 0.0) return corner(0, a);
  const double d3 = ab.dot(q - b), d4 = ac.dot(q - b);
  if (d3 >= 0.0 && d4 <= d3) return corner(1, b);
  if (d1 * d4 - d3 * d2 <= 0.0 && d1 >= 0.0 && d3 <= 0.0) return side(a, edge_[3 * t]);
  const double d5 = ab.dot(q - c), d6 = ac.dot(q - c);
  if (d6 >= 0.0 && d5 <= d6) return corner(2, c);
  if (d5 * d2 - d1 * d6 <= 0.0 && d2 >= 0.0 && d6 <= 0.0) return side(a, edge_[3 * t + 2]);
  if (d3 * d6 - d5 * d4 <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0) return side(b, edge_[3 * t + 1]);
  return side(a, face_[t]);
}

}  // namespace heddle
