#include "core/triangle_walk.h"

#include <Eigen/Geometry>

namespace heddle {

using Eigen::Vector3d;

// Regions of a triangle: Ericson, Real-Time Collision Detection, 5.1.5.
double squared_distance(const Vector3d& a, const Vector3d& b, const Vector3d& c, const Vector3d& q) {
  const Vector3d ab = b - a, ac = c - a, ap = q - a;
  const double d1 = ab.dot(ap), d2 = ac.dot(ap);
  if (d1 <= 0.0 && d2 <= 0.0) return ap.squaredNorm();
  const Vector3d bp = q - b;
  const double d3 = ab.dot(bp), d4 = ac.dot(bp);
  if (d3 >= 0.0 && d4 <= d3) return bp.squaredNorm();
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0) return (ap - (d1 / (d1 - d3)) * ab).squaredNorm();
  const Vector3d cp = q - c;
  const double d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d6 >= 0.0 && d5 <= d6) return cp.squaredNorm();
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0) return (ap - (d2 / (d2 - d6)) * ac).squaredNorm();
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0)
    return (bp - ((d4 - d3) / ((d4 - d3) + (d5 - d6))) * (c - b)).squaredNorm();
  const double scale = 1.0 / (va + vb + vc);
  return (ap - (vb * scale) * ab - (vc * scale) * ac).squaredNorm();
}

TriangleWalk::TriangleWalk(const TriangleMesh& mesh)
    : mesh_(mesh), first_(mesh.vertices.size() + 1, 0), around_(3 * mesh.triangles.size()) {
  for (const auto& triangle : mesh.triangles)
    for (int v : triangle) ++first_[static_cast<std::size_t>(v) + 1];
  for (std::size_t v = 1; v < first_.size(); ++v) first_[v] += first_[v - 1];
  std::vector<int> next(first_.begin(), first_.end() - 1);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (int v : mesh.triangles[t])
      around_[static_cast<std::size_t>(next[static_cast<std::size_t>(v)]++)] = static_cast<int>(t);
}

TriangleWalk::Nearest TriangleWalk::at(int triangle, const Vector3d& place) const {
  const auto& t = mesh_.triangles[static_cast<std::size_t>(triangle)];
  const auto vertex = [&](int v) {
    return Vector3d::Map(mesh_.vertices[static_cast<std::size_t>(v)].data());
  };
  return {squared_distance(vertex(t[0]), vertex(t[1]), vertex(t[2]), place), triangle};
}

TriangleWalk::Nearest TriangleWalk::from(Nearest best, const Vector3d& place) const {
  for (;;) {
    const int here = best.triangle;
    for (int v : mesh_.triangles[static_cast<std::size_t>(here)])
      for (int n = first_[static_cast<std::size_t>(v)]; n < first_[static_cast<std::size_t>(v) + 1]; ++n) {
        const int neighbour = around_[static_cast<std::size_t>(n)];
        if (neighbour == here) continue;
        const Nearest there = at(neighbour, place);
        if (there.squared < best.squared) best = there;
      }
    if (best.triangle == here) return best;
  }
}

bool TriangleWalk::touch(int a, int b) const {
  for (int v : mesh_.triangles[static_cast<std::size_t>(a)])
    for (int w : mesh_.triangles[static_cast<std::size_t>(b)])
      if (v == w) return true;
  return false;
}

}  // namespace heddle
