#include "macroscale/ply_contact.h"

#include <algorithm>
#include <cmath>

#include <tbb/parallel_for.h>
#include <Eigen/Geometry>
#include <Eigen/LU>

#include "macroscale/patches.h"

namespace heddle::macroscale {

namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr double beyond_edge = 0.5;  ///< how far off the edge a point still meets the ply [cells]
constexpr double edge_on = 0.5;      ///< cosine below which faces are no faces to each other
constexpr double margin = 0.5;       ///< that a pair may move before the pattern is made anew [cells]

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

}  // namespace

std::vector<PlyPoint> ply_points(const Blank& blank) {
  std::vector<PlyPoint> points;
  for (int k = 0; k + 1 < blank.plies(); ++k) {
    for (int q = blank.ply(k).first_quad; q < blank.ply(k).end_quad; ++q) points.push_back({q, k + 1, -1});
    for (int q = blank.ply(k + 1).first_quad; q < blank.ply(k + 1).end_quad; ++q) points.push_back({q, k, 1});
  }
  return points;
}

PlyPair pair_at(const Blank& blank, const PlyPoint& point, const PlyPlace& place, const VectorXd& x,
                const std::vector<Vector3d>& normals) {
  const Patch own(blank.quads[point.quad], 0.5, 0.5, x, normals),
      other(blank.quads[place.quad], place.u, place.v, x, normals);
  PlyPair pair;
  pair.quad = place.quad;
  pair.local = {place.u, place.v};
  pair.rest = place.rest;
  pair.area = 2.0 * blank.share[point.quad] * blank.ply(blank.ply_of_quad(point.quad)).corner_area();
  for (std::size_t i = 0; i < 4; ++i) {
    pair.node[i] = blank.quads[point.quad][i];
    pair.weight[i] = own.w.value[i];
    pair.node[i + 4] = blank.quads[place.quad][i];
    pair.weight[i + 4] = -other.w.value[i];
  }
  pair.normal = place.side * other.normal;
  const double facing = own.normal.dot(other.normal);
  const auto rise = [&](const Patch& patch) {
    return std::clamp(patch.rise, -place.most_rise, place.most_rise);
  };
  pair.offset = place.side * (rise(other) - facing * rise(own));
  pair.turn.fill(Vector3d::Zero());
  if (std::abs(facing) < edge_on) return pair;
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

std::vector<PlyPair> pair_plies(const Blank& blank, std::span<const PlyPoint> points, const VectorXd& x,
                                double reach, double rest) {
  std::vector<PlyPair> pairs(points.size());
  if (points.empty()) return pairs;
  const std::vector<Vector3d> normals = node_normals(blank, x);
  std::vector<QuadFinder> finders;
  for (int k = 0; k < blank.plies(); ++k) finders.emplace_back(blank, blank.ply(k), x, reach);
  tbb::parallel_for(std::size_t{0}, points.size(), [&](std::size_t k) {
    const PlyPoint& point = points[k];
    const Vector3d here = middle_of(blank.quads[point.quad], x);
    Projection best;
    int found = -1;
    finders[static_cast<std::size_t>(point.against)].near(here, [&](int q, const Vector3d&) {
      Projection at = project(blank.quads[q], x, normals, here);
      if (at.outside > beyond_edge || std::abs(at.h) > reach) return;
      if (at.outside < 1e-9) at.outside = 0.0;
      const bool nearer = at.outside < best.outside ||
                          (at.outside == best.outside && std::abs(at.h) < std::abs(best.h) * (1.0 - 1e-9));
      if (!nearer) return;
      best = at;
      found = q;
    });
    if (found >= 0)
      pairs[k] =
          pair_at(blank, point, {.quad = found, .u = best.u, .v = best.v, .side = point.side, .rest = rest},
                  x, normals);
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
