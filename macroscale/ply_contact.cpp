#include "macroscale/ply_contact.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <tbb/parallel_for.h>
#include <Eigen/Geometry>
#include <Eigen/LU>

namespace heddle::macroscale {

namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr double beyond_edge = 0.5;  ///< how far off the edge a point still meets the ply [cells]
constexpr double margin = 0.5;       ///< that a pair may move before the pattern is made anew [cells]

Vector3d node_of(const VectorXd& x, int i) {
  return x.segment<3>(3 * i);
}

struct Bilinear {
  std::array<double, 4> value, along_u, along_v;
};
Bilinear bilinear(double u, double v) {
  return {{(1 - u) * (1 - v), u * (1 - v), u * v, (1 - u) * v}, {v - 1, 1 - v, v, -v}, {u - 1, -u, u, 1 - u}};
}

// Unit normals at the nodes: of the corners that meet there, by the share of their cells.
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

// Where a point lies over one quad along the normals interpolated between its corners: x = X(u, v) + h N(u,
// v). Interpolated normals leave no gaps and no double cover between quads, whichever way the sheet bends.
struct Projection {
  double u = 0.5, v = 0.5, h = 0.0;
  double outside = std::numeric_limits<double>::infinity();  ///< how far off the quad [cells]; inf: not found
};

Projection project(const std::array<Vector3d, 4>& corner, const std::array<Vector3d, 4>& normal,
                   const Vector3d& point) {
  constexpr int most = 12;
  constexpr double close = 1e-12, lost = 2.0;
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

// Quads of one ply by place, in boxes as large as the largest of them with what reaches it.
class QuadFinder {
 public:
  QuadFinder(const Blank& blank, const Ply& ply, const VectorXd& x, double reach) : first_(ply.first_quad) {
    const int count = ply.end_quad - ply.first_quad;
    centre_.resize(static_cast<std::size_t>(count));
    double radius = 0.0;
    low_ = Vector3d::Constant(std::numeric_limits<double>::infinity());
    Vector3d high = -low_;
    for (int q = 0; q < count; ++q) {
      const auto& quad = blank.quads[ply.first_quad + q];
      Vector3d& c = centre_[q];
      c = 0.25 * (node_of(x, quad[0]) + node_of(x, quad[1]) + node_of(x, quad[2]) + node_of(x, quad[3]));
      for (int node : quad) radius = std::max(radius, (node_of(x, node) - c).norm());
      low_ = low_.cwiseMin(c);
      high = high.cwiseMax(c);
    }
    // Half a cell beyond the edge is less than another radius.
    range_ = 2.0 * radius + reach;
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

  /// Calls visit(quad) for every quad whose middle is within range, in one order whatever the threads do.
  template <class Visit>
  void near(const Vector3d& x, const Visit& visit) const {
    std::array<int, 3> from{}, to{};
    for (int d = 0; d < 3; ++d) {
      const double at = std::clamp((x[d] - low_[d]) / range_, -2.0, boxes_[d] + 1.0);
      from[d] = std::max(static_cast<int>(std::floor(at)) - 1, 0);
      to[d] = std::min(static_cast<int>(std::floor(at)) + 1, boxes_[d] - 1);
    }
    for (int i = from[0]; i <= to[0]; ++i)
      for (int j = from[1]; j <= to[1]; ++j)
        for (int k = from[2]; k <= to[2]; ++k) {
          const std::size_t box = static_cast<std::size_t>(number({i, j, k}));
          for (int n = start_[box]; n < start_[box + 1]; ++n)
            if ((centre_[quads_[n]] - x).squaredNorm() <= range_ * range_) visit(first_ + quads_[n]);
        }
  }

 private:
  int number(const std::array<int, 3>& at) const { return (at[0] * boxes_[1] + at[1]) * boxes_[2] + at[2]; }
  int first_;
  double range_ = 0.0;
  Vector3d low_;
  std::array<int, 3> boxes_{};
  std::vector<Vector3d> centre_;
  std::vector<int> start_, quads_;
};

// What of a patch a place in it needs.
struct Patch {
  Vector3d place, normal, along_u, along_v;
  double rise = 0.0;  ///< of the smooth surface through the nodes above the patch, along their normals [m]
  Bilinear w;

  Patch(const std::array<int, 4>& quad, double u, double v, const VectorXd& x,
        const std::vector<Vector3d>& normals)
      : w(bilinear(u, v)) {
    place = normal = along_u = along_v = Vector3d::Zero();
    for (std::size_t i = 0; i < 4; ++i) {
      const Vector3d corner = node_of(x, quad[i]);
      place += w.value[i] * corner;
      normal += w.value[i] * normals[quad[i]];
      along_u += w.along_u[i] * corner;
      along_v += w.along_v[i] * corner;
    }
    normal.normalize();
    // Half of the way to the tangent planes of the corners: on a circle that is the arc over its chord, on a
    // line of nodes the cubic through four of them.
    for (std::size_t i = 0; i < 4; ++i)
      rise += 0.5 * w.value[i] * normals[quad[i]].dot(node_of(x, quad[i]) - place);
  }
};

PlyPair pair_at(const Blank& blank, const PlyPoint& point, int quad, const Projection& at, const VectorXd& x,
                const std::vector<Vector3d>& normals) {
  const Patch own(blank.quads[point.quad], 0.5, 0.5, x, normals),
      other(blank.quads[quad], at.u, at.v, x, normals);
  PlyPair pair;
  pair.quad = quad;
  pair.local = {at.u, at.v};
  pair.area = 2.0 * blank.share[point.quad] * blank.ply(blank.ply_of_quad(point.quad)).corner_area();
  for (std::size_t i = 0; i < 4; ++i) {
    pair.node[i] = blank.quads[point.quad][i];
    pair.weight[i] = own.w.value[i];
    pair.node[i + 4] = blank.quads[quad][i];
    pair.weight[i + 4] = -other.w.value[i];
  }
  pair.normal = point.side * other.normal;
  pair.offset = point.side * (other.rise - own.normal.dot(other.normal) * own.rise);
  // Slopes in the plane of the normal: then a rotation of both plies is no slip at all, however coarse the
  // grid.
  const Matrix3d plane = Matrix3d::Identity() - pair.normal * pair.normal.transpose();
  Eigen::Matrix<double, 3, 2> tangent;
  tangent << plane * own.along_u, plane * own.along_v;
  const Eigen::Matrix<double, 3, 2> dual = tangent * (tangent.transpose() * tangent).inverse();
  const double distance = pair.normal.dot(own.place - other.place);
  for (std::size_t i = 0; i < 4; ++i)
    pair.turn[i] = distance * (own.w.along_u[i] * dual.col(0) + own.w.along_v[i] * dual.col(1));
  return pair;
}

}  // namespace

std::vector<PlyPoint> ply_points(const Blank& blank) {
  std::vector<PlyPoint> points;
  for (int k = 0; k + 1 < blank.plies(); ++k) {
    for (int q = blank.ply(k).first_quad; q < blank.ply(k).end_quad; ++q) points.push_back({q, k + 1, -1});
    for (int q = blank.ply(k + 1).first_quad; q < blank.ply(k + 1).end_quad; ++q) points.push_back({q, k, 1});
  }
  return points;
}

std::vector<PlyPair> pair_plies(const Blank& blank, const std::vector<PlyPoint>& points, const VectorXd& x,
                                double reach) {
  std::vector<PlyPair> pairs(points.size());
  if (points.empty()) return pairs;
  const std::vector<Vector3d> normals = node_normals(blank, x);
  std::vector<QuadFinder> finders;
  for (int k = 0; k < blank.plies(); ++k) finders.emplace_back(blank, blank.ply(k), x, reach);
  tbb::parallel_for(std::size_t{0}, points.size(), [&](std::size_t k) {
    const PlyPoint& point = points[k];
    Vector3d here = Vector3d::Zero();
    for (const int node : blank.quads[point.quad]) here += 0.25 * node_of(x, node);
    Projection best;
    int found = -1;
    finders[static_cast<std::size_t>(point.against)].near(here, [&](int q) {
      std::array<Vector3d, 4> corner, normal;
      for (std::size_t i = 0; i < 4; ++i) {
        corner[i] = node_of(x, blank.quads[q][i]);
        normal[i] = normals[blank.quads[q][i]];
      }
      Projection at = project(corner, normal, here);
      if (at.outside > beyond_edge || std::abs(at.h) > reach) return;
      if (at.outside < 1e-9) at.outside = 0.0;
      const bool nearer = at.outside < best.outside ||
                          (at.outside == best.outside && std::abs(at.h) < std::abs(best.h) * (1.0 - 1e-9));
      if (!nearer) return;
      best = at;
      found = q;
    });
    if (found >= 0) pairs[k] = pair_at(blank, point, found, best, x, normals);
  });
  return pairs;
}

double gap(const PlyPair& pair, const VectorXd& x) {
  Vector3d apart = Vector3d::Zero();
  for (std::size_t i = 0; i < 8; ++i) apart += pair.weight[i] * node_of(x, pair.node[i]);
  return pair.normal.dot(apart) - pair.offset;
}

Vector3d slip(const PlyPair& pair, const VectorXd& field) {
  Vector3d apart = Vector3d::Zero(), turned = Vector3d::Zero();
  for (std::size_t i = 0; i < 8; ++i) apart += pair.weight[i] * node_of(field, pair.node[i]);
  for (std::size_t i = 0; i < 4; ++i) turned += pair.normal.dot(node_of(field, pair.node[i])) * pair.turn[i];
  return apart - pair.normal.dot(apart) * pair.normal + turned;
}

std::array<Matrix3d, 8> slip_factors(const PlyPair& pair) {
  const Matrix3d plane = Matrix3d::Identity() - pair.normal * pair.normal.transpose();
  std::array<Matrix3d, 8> factors;
  for (std::size_t i = 0; i < 8; ++i) factors[i] = pair.weight[i] * plane;
  for (std::size_t i = 0; i < 4; ++i) factors[i] += pair.turn[i] * pair.normal.transpose();
  return factors;
}

TowDirections tow_directions(const Blank& blank, const PlyPoint& point, const VectorXd& x) {
  const auto node = [&](std::size_t k) { return node_of(x, blank.quads[point.quad][k]); };
  return {0.5 * (node(1) + node(2) - node(0) - node(3)), 0.5 * (node(2) + node(3) - node(0) - node(1))};
}

NormalContact ply_contact(const Curve& compaction, double gap, double rest) {
  NormalContact contact;
  contact.approach = 0.5 * (rest - gap);
  if (contact.approach <= 0.0) return contact;
  const Curve::Value p = compaction.evaluate(contact.approach);
  contact.energy = 2.0 * compaction.integral(contact.approach);
  contact.pressure = p.y;
  contact.stiffness = 0.5 * p.slope;
  return contact;
}

PlyCoupling coupling_of(const std::vector<PlyPair>& pairs) {
  PlyCoupling coupling;
  for (const PlyPair& pair : pairs) {
    coupling.quad.push_back(pair.quad);
    coupling.local.push_back(pair.local);
  }
  return coupling;
}

std::vector<int> coupled_nodes(const Blank& blank, const PlyCoupling& coupling, std::size_t point) {
  std::vector<int> nodes;
  const int quad = coupling.quad[point];
  if (quad < 0) return nodes;
  const Ply& ply = blank.ply(blank.ply_of_quad(quad));
  const auto [i, j] = blank.grid[blank.quads[quad][0]];
  const auto [u, v] = coupling.local[point];
  const auto cells = [](int line, double local, double by) {
    return static_cast<int>(std::floor(line + std::clamp(local, 0.0, 1.0) + by));
  };
  for (int a = cells(i, u, -margin); a <= cells(i, u, margin); ++a)
    for (int b = cells(j, v, -margin); b <= cells(j, v, margin); ++b)
      if (const int near = ply.quad(a, b); near >= 0)
        nodes.insert(nodes.end(), blank.quads[near].begin(), blank.quads[near].end());
  nodes.insert(nodes.end(), blank.quads[quad].begin(), blank.quads[quad].end());
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return nodes;
}

bool covers(const Blank& blank, const PlyCoupling& coupling, const std::vector<PlyPair>& pairs) {
  if (coupling.quad.size() != pairs.size()) return false;
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    if (pairs[k].quad < 0 || pairs[k].quad == coupling.quad[k]) continue;
    const std::vector<int> nodes = coupled_nodes(blank, coupling, k);
    for (std::size_t i = 4; i < 8; ++i)
      if (!std::binary_search(nodes.begin(), nodes.end(), pairs[k].node[i])) return false;
  }
  return true;
}

}  // namespace heddle::macroscale
