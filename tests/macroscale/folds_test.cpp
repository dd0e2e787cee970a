#include "macroscale/folds.h"

#include <catch2/catch.hpp>

#include <cmath>
#include <functional>
#include <numbers>
#include <random>

#include <Eigen/Geometry>

#include "macroscale/stamping.h"

using namespace heddle::macroscale;
using Eigen::Vector3d;

namespace {

constexpr double pi = std::numbers::pi;
constexpr double thickness = 1.5e-3;  // [m]

// A grid of nu x nv cells of side h whose nodes stand where `place` puts them.
BlankState sheet(int nu, int nv, double h, const std::function<Vector3d(double x, double y)>& place) {
  BlankState blank;
  blank.nu = nu;
  blank.nv = nv;
  const auto node = [&](int i, int j) { return i * (nv + 1) + j; };
  for (int i = 0; i <= nu; ++i)
    for (int j = 0; j <= nv; ++j) {
      const Vector3d x = place(h * i, h * j);
      blank.grid.push_back({i, j});
      blank.reference.push_back({h * i, h * j});
      blank.position.push_back({x.x(), x.y(), x.z()});
      if (i < nu && j < nv)
        blank.quads.push_back({node(i, j), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1)});
    }
  return blank;
}

// A strip bent once round about y: flat up to `start`, half a turn of radius r, flat again above itself; the
// upper leg leans down by `lean`.
std::function<Vector3d(double, double)> hairpin(double start, double r, double lean = 0.0) {
  return [=](double x, double y) -> Vector3d {
    if (x <= start) return {x, y, 0.0};
    const double angle = (x - start) / r;
    if (angle <= pi) return {start + r * std::sin(angle), y, r * (1.0 - std::cos(angle))};
    const double along = x - start - pi * r;
    return {start - along * std::cos(lean), y, 2.0 * r - along * std::sin(lean)};
  };
}

// Every node against every cell of the flat sheet's far parts, without any grid of boxes.
double nearest_of_all(const BlankState& blank, int n, double neighbour, double h, double reach);

}  // namespace

TEST_CASE("a flat sheet, a sheared one, a dome and a shallow wave neither fold nor come near themselves",
          "[macroscale][folds]") {
  constexpr double h = 5e-3;
  const double gamma = 60.0 * pi / 180.0;
  const auto places = std::vector<std::function<Vector3d(double, double)>>{
      [](double x, double y) { return Vector3d(x, y, 0.0); },
      [&](double x, double y) { return Vector3d(x + y * std::sin(gamma), y * std::cos(gamma), 0.0); },
      [](double x, double y) {  // nearly a half sphere
        const double u = x - 0.05, v = y - 0.05;
        return Vector3d(u, v, std::sqrt(0.075 * 0.075 - u * u - v * v));
      },
      [](double x, double y) { return Vector3d(x, y, 4e-3 * std::sin(2.0 * pi * x / 0.04)); }};
  for (const auto& place : places) {
    const Folds folds = find_folds(sheet(20, 20, h, place), thickness);
    CHECK_FALSE(folds.any());
    CHECK(folds.place.empty());
    CHECK(folds.distance == std::vector<double>(folds.distance.size(), thickness));
  }
}

TEST_CASE("the turn of a cylinder is four spacings over its radius", "[macroscale][folds]") {
  constexpr double h = 5e-3, r = 30e-3;
  const Folds folds = find_folds(sheet(12, 8, h,
                                       [&](double x, double y) {
                                         return Vector3d(r * std::sin(x / r), y, r * (1.0 - std::cos(x / r)));
                                       }),
                                 thickness);
  CHECK(folds.turn[6 * 9 + 4] == Approx(4.0 * h / r).epsilon(1e-6));
}

TEST_CASE("a hairpin folds; its legs are near where they are closer than a thickness, and there only",
          "[macroscale][folds]") {
  constexpr double h = 2.5e-3;
  const Folds wide = find_folds(sheet(40, 6, h, hairpin(0.05, 3e-3)), thickness);
  CHECK(wide.folded > 0);
  CHECK(wide.near == 0);
  CHECK(wide.crossings == 0);
  REQUIRE(wide.place.size() == 1);
  CHECK(wide.place[0].at[0] == Approx(0.05).margin(5e-3));
  CHECK(wide.place[0].turn > fold_turn);

  const Folds tight = find_folds(sheet(40, 6, h, hairpin(0.05, 0.6e-3)), thickness);
  CHECK(tight.crossings == 0);
  CHECK(tight.near > 100);
  // On the legs the distance is theirs: 2 r.
  CHECK(tight.distance[static_cast<std::size_t>(10 * 7 + 3)] == Approx(1.2e-3).epsilon(1e-9));
  CHECK(tight.distance[static_cast<std::size_t>(10 * 7 + 3)] < tight.reach);
}

TEST_CASE("a sheet that has passed through itself is told by every tow that crosses, and by none before",
          "[macroscale][folds]") {
  constexpr double h = 2.5e-3, r = 6e-3;
  constexpr int across = 6;
  // The upper leg leans down and reaches the lower one 12 mm / sin(lean) away from the bend.
  const double lean = 0.5, reach = 2.0 * r / std::sin(lean);
  const double bend = 0.05, arc = pi * r;
  const auto cells = [&](double leg) { return static_cast<int>((bend + arc + leg) / h); };
  const Folds before = find_folds(sheet(cells(0.9 * reach), across, h, hairpin(bend, r, lean)), thickness);
  CHECK(before.crossings == 0);
  const Folds after = find_folds(sheet(cells(1.3 * reach), across, h, hairpin(bend, r, lean)), thickness);
  // One segment of each tow along x, at the crossing line.
  CHECK(after.crossings >= across);
  CHECK(after.crossings <= 4 * (across + 1));
  CHECK(after.near > 0);
  const auto crossing = std::array{bend - reach * std::cos(lean), 0.5 * across * h, 0.0};
  bool found = false;
  for (const FoldPlace& place : after.place)
    found |= std::hypot(place.at[0] - crossing[0], place.at[2] - crossing[2]) < 8e-3;
  CHECK(found);
}

TEST_CASE("distances found by boxes are those found by looking everywhere", "[macroscale][folds]") {
  constexpr double h = 5e-3, reach = 12e-3;
  constexpr int cells = 14;
  std::mt19937 random(11);
  std::uniform_real_distribution<double> jolt(-2e-3, 2e-3);
  // Rolled up and crumpled, so that many parts come near many others.
  const BlankState crumpled = sheet(cells, cells, h, [&](double x, double y) {
    const double r = 8e-3, a = x / r;
    return Vector3d(r * std::sin(a) + jolt(random), 0.4 * y + jolt(random),
                    r * std::cos(a) + 0.1 * x + jolt(random));
  });
  const Folds folds = find_folds(crumpled, reach);
  int near = 0;
  for (int n = 0; n < static_cast<int>(crumpled.grid.size()); ++n) {
    const double all = nearest_of_all(crumpled, n, std::max(4.0 * h, 4.0 * reach), h, reach);
    REQUIRE(folds.distance[static_cast<std::size_t>(n)] == Approx(all).margin(2e-5));
    near += all < reach;
  }
  CHECK(near > 20);
  CHECK(near == folds.near);
}

TEST_CASE("a sheet moved and turned folds as before", "[macroscale][folds][invariant]") {
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.8, Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  const auto place = hairpin(0.05, 0.6e-3);
  const Folds here = find_folds(sheet(40, 6, 2.5e-3, place), thickness);
  const Folds there =
      find_folds(sheet(40, 6, 2.5e-3,
                       [&](double x, double y) { return Vector3d(turn * place(x, y) + Vector3d(1, -2, 3)); }),
                 thickness);
  CHECK(there.folded == here.folded);
  CHECK(there.near == here.near);
  CHECK(there.crossings == here.crossings);
}

namespace {

// Distance to a triangle by sampling its plane's coordinates closely: slow, and of another kind.
double sampled_distance(const Vector3d& p, const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  double best = 1.0;
  double u0 = 0.0, v0 = 0.0, width = 1.0;
  for (int level = 0; level < 6; ++level, width *= 0.25) {
    double bu = u0, bv = v0;
    for (int i = -8; i <= 8; ++i)
      for (int j = -8; j <= 8; ++j) {
        const double u = std::clamp(u0 + width * i / 8.0, 0.0, 1.0),
                     v = std::clamp(v0 + width * j / 8.0, 0.0, 1.0 - u);
        const double d = (a + u * (b - a) + v * (c - a) - p).norm();
        if (d < best) best = d, bu = u, bv = v;
      }
    u0 = bu;
    v0 = bv;
  }
  return best;
}

double nearest_of_all(const BlankState& blank, int n, double neighbour, double h, double reach) {
  const auto at = [&](int k) { return Vector3d(blank.position[static_cast<std::size_t>(k)].data()); };
  const auto [i, j] = blank.grid[static_cast<std::size_t>(n)];
  double best = reach;
  for (const auto& q : blank.quads) {
    const auto [ci, cj] = blank.grid[static_cast<std::size_t>(q[0])];
    const double di = std::max({ci - i, i - ci - 1, 0}), dj = std::max({cj - j, j - cj - 1, 0});
    if (h * std::hypot(di, dj) < neighbour) continue;
    for (const auto& [a, b, c] : {std::array{q[0], q[1], q[2]}, std::array{q[0], q[2], q[3]}}) {
      if ((at(a) - at(n)).norm() > reach + 6.0 * h) continue;
      best = std::min(best, sampled_distance(at(n), at(a), at(b), at(c)));
    }
  }
  return best;
}

}  // namespace
