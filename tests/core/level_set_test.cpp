#include "core/level_set.h"

#include <tbb/global_control.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>

using namespace heddle;

namespace {

constexpr double radius = 3e-3;
constexpr double ball_volume = 4.0 / 3.0 * std::numbers::pi * radius * radius * radius;

LevelSet ball(double x, double voxel, double half_width = 3.0) {
  const auto distance = [x](double px, double py, double pz) {
    return std::sqrt((px - x) * (px - x) + py * py + pz * pz) - radius;
  };
  return level_set_from_distance(distance, {{x - radius, -radius, -radius}, {x + radius, radius, radius}},
                                 voxel, half_width);
}

std::vector<float> all_values(const LevelSet& set) {
  std::vector<float> values;
  for (const auto& block : set.blocks()) {
    values.resize(values.size() + 512);
    set.read(block, 8, values.data() + values.size() - 512);
  }
  return values;
}

}  // namespace

TEST_CASE("a ball sampled from its distance has its volume", "[core][level_set]") {
  // Measured through a surface smeared over 1.5 voxels.
  CHECK(volume(ball(1e-4, 0.1e-3)) == Approx(ball_volume).epsilon(1e-3));
  CHECK(volume(ball(1e-4, 0.05e-3)) == Approx(ball_volume).epsilon(3e-4));
}

TEST_CASE("a level set holds the distance in its band and one sign beyond", "[core][level_set]") {
  const LevelSet set = ball(0.0, 0.1e-3);
  const auto at = [&](int i, int j, int k) {
    float value;
    set.read({i, j, k}, 1, &value);
    return static_cast<double>(value);
  };
  CHECK(at(31, 0, 0) == Approx(0.1e-3));
  CHECK(at(0, -28, 0) == Approx(-0.2e-3));
  CHECK(at(0, 0, 0) == Approx(-0.3e-3));
  CHECK(at(60, 0, 0) == Approx(0.3e-3));
  CHECK(at(-100, 500, 0) == Approx(0.3e-3));
  std::vector<float> cube(12 * 12 * 12);
  set.read({25, -3, -5}, 12, cube.data());
  CHECK(static_cast<double>(cube[(2 * 12 + 3) * 12 + 5]) == Approx(27 * 0.1e-3 - radius));
  CHECK(static_cast<double>(cube[(5 * 12 + 11) * 12 + 1]) ==
        Approx(0.1e-3 * std::sqrt(30.0 * 30 + 8 * 8 + 4 * 4) - radius).epsilon(1e-5));
}

TEST_CASE("a level set does not depend on the number of threads", "[core][level_set]") {
  const TriangleMesh mesh = surface(ball(0.0, 0.3e-3));
  const auto both = [&] {
    auto values = all_values(ball(0.0, 0.1e-3));
    const auto of_mesh = all_values(level_set_from_mesh(mesh, 0.1e-3, 4.0));
    values.insert(values.end(), of_mesh.begin(), of_mesh.end());
    return values;
  };
  const auto many = both();
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  CHECK(both() == many);
}

TEST_CASE("the overlap of two balls is the lens between them, and nothing when they touch",
          "[core][level_set]") {
  const double apart = GENERATE(3e-3, 5e-3, 6e-3, 6.4e-3);
  CAPTURE(apart);
  const Overlap found = overlap(ball(0.0, 0.05e-3), ball(apart, 0.05e-3));
  const double depth = 2.0 * radius - apart;
  const double lens = depth <= 0.0 ? 0.0
                                   : std::numbers::pi * depth * depth *
                                         (apart * apart + 4.0 * apart * radius) / (12.0 * apart);
  CHECK(found.volume == Approx(lens).epsilon(0.01));
  if (apart == 6e-3) CHECK(found.depth == Approx(0.0).margin(1e-9));
  if (depth > 0.0) CHECK(found.depth > 0.0);
  if (depth < 0.0) CHECK(found.depth < 0.0);  // the bands do not even meet
}

TEST_CASE("the surface of a level set is closed, outward and in place", "[core][level_set]") {
  const TriangleMesh mesh = surface(ball(0.0, 0.1e-3));
  CHECK(volume(mesh) == Approx(ball_volume).epsilon(2e-3));
  std::map<std::array<int, 2>, int> edges;
  for (const auto& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) ++edges[{t[k], t[(k + 1) % 3]}];
  for (const auto& [edge, count] : edges) {
    REQUIRE(count == 1);
    REQUIRE(edges.count({edge[1], edge[0]}) == 1);
  }
  for (const auto& v : mesh.vertices)
    REQUIRE(std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]) == Approx(radius).margin(0.02e-3));
}

TEST_CASE("a level set made from a mesh has the distance to the mesh", "[core][level_set]") {
  const TriangleMesh mesh = surface(ball(0.0, 0.1e-3));
  const LevelSet set = level_set_from_mesh(mesh, 0.15e-3, 4.0);
  CHECK(volume(set) == Approx(volume(mesh)).epsilon(2e-3));
  float value;
  set.read({0, 0, 22}, 1, &value);
  CHECK(static_cast<double>(value) == Approx(0.3e-3).margin(0.01e-3));
  set.read({0, 0, 0}, 1, &value);
  CHECK(value < 0.0f);
}

TEST_CASE("a sheet's inner side is where its normals do not point", "[core][level_set]") {
  // A roof: two slopes that meet in a ridge along y, normals up, edges far away.
  const double l = 5e-3, h = 2.5e-3;
  const TriangleMesh roof{{{-l, -l, -h}, {-l, l, -h}, {0, l, 0}, {0, -l, 0}, {l, l, -h}, {l, -l, -h}},
                          {{0, 3, 2}, {0, 2, 1}, {3, 5, 4}, {3, 4, 2}}};
  const LevelSet set = level_set_from_mesh(roof, 0.1e-3, 5.0, Sides::open);
  const auto at = [&](int i, int j, int k) {
    float value;
    set.read({i, j, k}, 1, &value);
    return static_cast<double>(value);
  };
  CHECK(at(0, 0, 3) == Approx(0.3e-3).epsilon(1e-5));  // above the ridge: nearest to an edge
  CHECK(at(1, 3, 3) > 0.0);
  CHECK(at(0, 0, -3) == Approx(-0.3e-3 * 2.0 / std::sqrt(5.0)).epsilon(1e-5));
  CHECK(at(24, 7, -12 + 2) == Approx(0.2e-3 * 2.0 / std::sqrt(5.0)).epsilon(1e-5));
  CHECK(at(0, 0, -15) <= -0.5e-3);  // beyond the band on either side
  CHECK(at(-20, 0, 0) >= 0.5e-3);
  CHECK(at(40, 0, -10) >= 0.5e-3);
}

TEST_CASE("a body that reaches out of its box is refused, not cut", "[core][level_set]") {
  const auto distance = [](double x, double y, double z) {
    return std::sqrt(x * x + y * y + z * z) - radius;
  };
  const double cut = 0.5 * radius;
  CHECK_THROWS_AS(level_set_from_distance(distance, {{-cut, -cut, -cut}, {cut, cut, cut}}, 0.1e-3, 3.0),
                  std::invalid_argument);
  CHECK_THROWS_AS(level_set_from_distance(distance, {}, 0.0, 3.0), std::invalid_argument);
  CHECK_THROWS_AS(level_set_from_mesh({{{0, 0, 0}}, {{0, 0, 1}}}, 1e-3, 3.0), std::invalid_argument);
}
