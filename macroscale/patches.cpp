#include "macroscale/patches.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>
#include <Eigen/LU>

namespace heddle::macroscale {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Eigen::VectorXd;

Bilinear bilinear(double u, double v) {
  return {{(1 - u) * (1 - v), u * (1 - v), u * v, (1 - u) * v}, {v - 1, 1 - v, v, -v}, {u - 1, -u, u, 1 - u}};
}

std::vector<Vector3d> node_normals(const Blank& blank, const VectorXd& x) {
  std::vector<Vector3d> normal(blank.reference.size(), Vector3d::Zero());
  for (std::size_t q = 0; q < blank.quads.size(); ++q)
    for (const Corner& c : corners_of(blank.quads[q])) {
      const Vector3d origin = node_of(x, c.node);
      normal[c.node] += blank.share[q] * c.sign *
                        (node_of(x, c.along_warp) - origin).cross(node_of(x, c.along_weft) - origin);
    }
  for (Vector3d& n : normal) n.normalize();
  return normal;
}

Vector3d middle_of(const std::array<int, 4>& quad, const VectorXd& x) {
  return 0.25 * (node_of(x, quad[0]) + node_of(x, quad[1]) + node_of(x, quad[2]) + node_of(x, quad[3]));
}

Projection project(const std::array<int, 4>& quad, const VectorXd& x, const std::vector<Vector3d>& normals,
                   const Vector3d& point) {
  constexpr int most = 12;
  constexpr double close = 1e-12, lost = 2.0;
  std::array<Vector3d, 4> corner, normal;
  for (std::size_t i = 0; i < 4; ++i) {
    corner[i] = node_of(x, quad[i]);
    normal[i] = normals[static_cast<std::size_t>(quad[i])];
  }
  Projection at;
  at.h = (point - 0.25 * (corner[0] + corner[1] + corner[2] + corner[3])).dot(normal[0]);
  for (int k = 0; k < most; ++k) {
    const Bilinear w = bilinear(at.u, at.v);
    Vector3d place = Vector3d::Zero(), n = Vector3d::Zero();
    Matrix3d slope = Matrix3d::Zero();
    for (std::size_t i = 0; i < 4; ++i) {
      const Vector3d lifted = corner[i] + at.h * normal[i];
      place += w.value[i] * lifted;
      n += w.value[i] * normal[i];
      slope.col(0) += w.along_u[i] * lifted;
      slope.col(1) += w.along_v[i] * lifted;
    }
    slope.col(2) = n;
    const Vector3d change = slope.inverse() * (point - place);
    if (!change.allFinite()) return {};
    at.u += change[0];
    at.v += change[1];
    at.h += change[2];
    // Newton's first step of a nearly plane patch is good to a fraction of a cell: what is far now stays far.
    if (std::abs(at.u - 0.5) > lost || std::abs(at.v - 0.5) > lost) return {};
    if (std::abs(change[0]) + std::abs(change[1]) < close) {
      at.outside = std::max({0.0, -at.u, at.u - 1.0, -at.v, at.v - 1.0});
      return at;
    }
  }
  return {};
}

QuadFinder::QuadFinder(const Blank& blank, const Ply& ply, const VectorXd& x, double reach, double radii)
    : first_(ply.first_quad) {
  const int count = ply.end_quad - ply.first_quad;
  centre_.resize(static_cast<std::size_t>(count));
  low_ = Vector3d::Constant(std::numeric_limits<double>::infinity());
  Vector3d high = -low_;
  for (int q = 0; q < count; ++q) {
    const auto& quad = blank.quads[ply.first_quad + q];
    Vector3d& c = centre_[q];
    c = middle_of(quad, x);
    for (int node : quad) radius_ = std::max(radius_, (node_of(x, node) - c).norm());
    low_ = low_.cwiseMin(c);
    high = high.cwiseMax(c);
  }
  range_ = radii * radius_ + reach;
  for (int d = 0; d < 3; ++d) boxes_[d] = 1 + static_cast<int>((high[d] - low_[d]) / range_);
  start_.assign(static_cast<std::size_t>(boxes_[0]) * boxes_[1] * boxes_[2] + 1, 0);
  std::vector<int> box(centre_.size());
  for (std::size_t q = 0; q < centre_.size(); ++q) {
    std::array<int, 3> at{};
    for (int d = 0; d < 3; ++d)
      at[d] = std::clamp(static_cast<int>((centre_[q][d] - low_[d]) / range_), 0, boxes_[d] - 1);
    box[q] = number(at);
    ++start_[static_cast<std::size_t>(box[q]) + 1];
  }
  for (std::size_t k = 1; k < start_.size(); ++k) start_[k] += start_[k - 1];
  std::vector<int> next(start_.begin(), start_.end() - 1);
  quads_.resize(centre_.size());
  for (std::size_t q = 0; q < centre_.size(); ++q) quads_[next[box[q]]++] = static_cast<int>(q);
}

void QuadFinder::boxes_about(double x, int direction, int& from, int& to) const {
  const double at = std::clamp((x - low_[direction]) / range_, -2.0, boxes_[direction] + 1.0);
  from = std::max(static_cast<int>(std::floor(at)) - 1, 0);
  to = std::min(static_cast<int>(std::floor(at)) + 1, boxes_[direction] - 1);
}

}  // namespace heddle::macroscale
