#include "macroscale/self_contact.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <Eigen/Geometry>

#include "macroscale/folds.h"
#include "macroscale/patches.h"
#include "macroscale/system.h"

namespace heddle::macroscale {

namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr double beyond_edge = 0.5;    ///< how far off the ply's edge a quad is still met [cells]
constexpr double neighbourhood = 2.0;  ///< of a cell along the flat sheet [thicknesses]
constexpr double most_rise = 0.25;     ///< of a smooth surface over its patch [thicknesses]

bool are_neighbours(const Blank& blank, const Ply& ply, int a, int b, double near) {
  const auto [ai, aj] = blank.grid[blank.quads[a][0]];
  const auto [bi, bj] = blank.grid[blank.quads[b][0]];
  const int di = std::abs(ai - bi), dj = std::abs(aj - bj);
  if (di <= 1 && dj <= 1) return true;
  const double u = std::max(di - 0.5, 0.0) * ply.spacing[0], v = std::max(dj - 0.5, 0.0) * ply.spacing[1];
  return u * u + v * v < near * near;
}

// Whether a place belongs to the quad: in it, or off it where the ply ends. What lies off it elsewhere is the
// next quad's.
bool belongs(const Blank& blank, const Ply& ply, int quad, const Projection& at) {
  constexpr double rounding = 1e-9;
  if (at.outside > beyond_edge) return false;
  const auto [i, j] = blank.grid[blank.quads[quad][0]];
  const auto ends = [&](double local, int u, int v) {
    return (local >= -rounding || ply.quad(i - u, j - v) < 0) &&
           (local <= 1.0 + rounding || ply.quad(i + u, j + v) < 0);
  };
  return ends(at.u, 1, 0) && ends(at.v, 0, 1);
}

// Upwards, as its corners go round; of no length where it is crushed to a line.
Vector3d normal_of(const std::array<int, 4>& quad, const VectorXd& x) {
  const auto node = [&](std::size_t k) -> Vector3d { return x.segment<3>(3 * quad[k]); };
  return (node(2) - node(0)).cross(node(3) - node(1)).normalized();
}

struct Meeting {
  int quad = -1;
  Projection at;
  double cost = std::numeric_limits<double>::infinity();  ///< distance, and how far it lies off the quad [m]
};

// Nearest meeting of a cell's lower and upper face.
std::array<Meeting, 2> meetings_of(const Blank& blank, const Ply& ply, const QuadFinder& finder,
                                   const std::vector<Vector3d>& normals, const std::vector<Vector3d>& upwards,
                                   const VectorXd& x, int quad, double reach, double thickness) {
  std::array<Meeting, 2> found;
  const Vector3d here = middle_of(blank.quads[quad], x);
  const double radius = finder.largest_radius(), near = neighbourhood * thickness;
  finder.near(here, [&](int other, const Vector3d& middle) {
    // Most of what is near lies beside the cell in a smooth sheet, and is told by its plane.
    const Vector3d apart = here - middle;
    const double high = apart.dot(upwards[other]);
    const double aside2 = apart.squaredNorm() - high * high, most = 1.2 * radius + std::abs(high);
    if (aside2 > most * most) return;
    if (are_neighbours(blank, ply, quad, other, near)) return;
    const Projection at = project(blank.quads[other], x, normals, here);
    if (std::abs(at.h) > reach || !belongs(blank, ply, other, at)) return;
    // The upper face looks at it if it lies on the side of the cell's normal.
    const Bilinear w = bilinear(at.u, at.v);
    Vector3d normal = Vector3d::Zero();
    for (std::size_t i = 0; i < 4; ++i) normal += w.value[i] * normals[blank.quads[other][i]];
    const bool upper = -at.h * normal.dot(upwards[quad]) > 0.0;
    Meeting& best = found[upper ? 1 : 0];
    const double cost = std::abs(at.h) + at.outside * radius;
    if (cost < best.cost * (1.0 - 1e-9)) best = {other, at, cost};
  });
  return found;
}

}  // namespace

std::vector<PlyPoint> self_points(const Blank& blank) {
  std::vector<PlyPoint> points;
  for (int k = 0; k < blank.plies(); ++k)
    for (int q = blank.ply(k).first_quad; q < blank.ply(k).end_quad; ++q)
      for (const int side : {-1, 1}) points.push_back({q, k, side});
  return points;
}

std::vector<PlyPair> pair_with_itself(const Blank& blank, std::span<const PlyPoint> points, const VectorXd& x,
                                      double reach, double thickness) {
  const std::vector<Vector3d> normals = node_normals(blank, x);
  std::vector<Vector3d> upwards(blank.quads.size());
  for (std::size_t q = 0; q < upwards.size(); ++q) upwards[q] = normal_of(blank.quads[q], x);
  std::vector<std::array<Meeting, 2>> met(blank.quads.size());
  bool any = false;
  for (int k = 0; k < blank.plies(); ++k) {
    const Ply& ply = blank.ply(k);
    const QuadFinder finder(blank, ply, x, reach, 1.0);
    tbb::parallel_for(tbb::blocked_range<int>(ply.first_quad, ply.end_quad, 64),
                      [&](const tbb::blocked_range<int>& range) {
                        for (int q = range.begin(); q != range.end(); ++q)
                          met[q] = meetings_of(blank, ply, finder, normals, upwards, x, q, reach, thickness);
                      });
  }
  for (const auto& faces : met) any |= faces[0].quad >= 0 || faces[1].quad >= 0;
  if (!any) return {};
  std::vector<PlyPair> pairs(points.size());
  for (std::size_t k = 0; k < points.size(); ++k) {
    const Meeting& meeting = met[points[k].quad][points[k].side > 0 ? 1 : 0];
    if (meeting.quad < 0) continue;
    pairs[k] = pair_at(blank, points[k],
                       {.quad = meeting.quad,
                        .u = meeting.at.u,
                        .v = meeting.at.v,
                        .side = meeting.at.h < 0.0 ? -1 : 1,
                        .rest = thickness,
                        .most_rise = most_rise * thickness},
                       x, normals);
    pairs[k].own = true;
  }
  return pairs;
}

std::string passage_of(const System& system, const StepData& step, const State& end) {
  const Scene& scene = system.scene();
  if (!scene.self_contact) return "";
  const State& start = *step.start;
  double way = 0.0;
  for (int i = 0; i < scene.blank.nodes(); ++i) way = std::max(way, (end.node(i) - start.node(i)).norm());
  // Two parts that come from beyond reach and touch in the end have gone more than the rest of it.
  const std::span<const PlyPoint> points = system.self_points();
  const double thickness = scene.fabric->thickness, needed = thickness + 2.0 * way;
  const std::size_t between = system.ply_points().size() - points.size();
  const bool paired = step.pairs.size() > between;
  if (needed > system.self_reach()) {
    const std::vector<PlyPair> all = pair_with_itself(scene.blank, points, start.x, needed, thickness);
    for (std::size_t k = 0; k < all.size(); ++k) {
      const bool seen = paired && step.pairs[between + k].quad >= 0;
      if (all[k].quad >= 0 && !seen && gap(all[k], end.x) < all[k].rest)
        return fmt::format("cell {} came to another part of the sheet from further than a step can see",
                           points[k].quad);
    }
  }
  if (!paired) return "";
  const int crossings = count_crossings(scene.blank, end.x);
  if (crossings > count_crossings(scene.blank, start.x))
    return fmt::format("{} tow segments passed through another part of the sheet", crossings);
  return "";
}

}  // namespace heddle::macroscale
