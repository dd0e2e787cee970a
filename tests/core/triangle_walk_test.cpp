#include "core/triangle_walk.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "core/level_set.h"

using namespace heddle;
using Eigen::Vector3d;

namespace {

// Nearest of many points of a triangle, refined about the best: slow and without a single case distinction.
double searched_distance(const Vector3d& a, const Vector3d& b, const Vector3d& c, const Vector3d& q) {
  double best = std::numeric_limits<double>::infinity(), s0 = 0.5, t0 = 0.5, reach = 0.5;
  for (int level = 0; level < 60; ++level, reach *= 0.7) {
    double s_best = s0, t_best = t0;
    for (int i = -4; i <= 4; ++i)
      for (int j = -4; j <= 4; ++j) {
        const double s = std::clamp(s0 + reach * i / 4.0, 0.0, 1.0);
        const double t = std::clamp(t0 + reach * j / 4.0, 0.0, 1.0 - s);
        const double d = (a + s * (b - a) + t * (c - a) - q).norm();
        if (d < best) {
          best = d;
          s_best = s;
          t_best = t;
        }
      }
    s0 = s_best;
    t0 = t_best;
  }
  return best;
}

Vector3d vertex(const TriangleMesh& mesh, int v) {
  return Vector3d::Map(mesh.vertices[static_cast<std::size_t>(v)].data());
}

double nearest_of_all(const TriangleMesh& mesh, const Vector3d& q) {
  double best = std::numeric_limits<double>::infinity();
  for (const auto& t : mesh.triangles)
    best = std::min(best, squared_distance(vertex(mesh, t[0]), vertex(mesh, t[1]), vertex(mesh, t[2]), q));
  return std::sqrt(best);
}

// An egg, so that no two places are alike.
TriangleMesh egg() {
  const auto distance = [](double x, double y, double z) {
    return std::sqrt(x * x + 1.3 * y * y + 0.8 * z * z) - 3e-3;  // not a true distance: only its zero is used
  };
  return surface(level_set_from_distance(distance, {{-4e-3, -4e-3, -4e-3}, {4e-3, 4e-3, 4e-3}}, 0.2e-3, 5.0));
}

}  // namespace

TEST_CASE("the distance to a triangle is that to the nearest of its points", "[core][triangle_walk]") {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const auto point = [&] { return Vector3d(uniform(random), uniform(random), uniform(random)); };
  for (int n = 0; n < 200; ++n) {
    const Vector3d a = point(), b = point(), c = point(), q = 1.5 * point();
    CHECK(std::sqrt(squared_distance(a, b, c, q)) == Approx(searched_distance(a, b, c, q)).epsilon(1e-5));
  }
}

TEST_CASE("a walk over neighbours of a convex mesh ends at the nearest triangle of all",
          "[core][triangle_walk]") {
  TriangleMesh ball;  // by latitude and longitude: every face is in the hull
  const int rows = 20, columns = 40;
  for (int i = 0; i <= rows; ++i)
    for (int j = 0; j < columns; ++j) {
      const double a = std::numbers::pi * (i + 0.01) / (rows + 0.02),
                   b = 2.0 * std::numbers::pi * j / columns;
      ball.vertices.push_back({std::sin(a) * std::cos(b), std::sin(a) * std::sin(b), std::cos(a)});
    }
  for (int i = 0; i < rows; ++i)
    for (int j = 0; j < columns; ++j) {
      const int a = i * columns + j, b = i * columns + (j + 1) % columns;
      ball.triangles.push_back({a, a + columns, b});
      ball.triangles.push_back({b, a + columns, b + columns});
    }
  const TriangleWalk walk(ball);
  std::mt19937 random(4);
  std::uniform_real_distribution<double> uniform(-2.0, 2.0);
  int outside = 0;
  for (int n = 0; n < 200; ++n) {
    const Vector3d q(uniform(random), uniform(random), uniform(random));
    if (std::hypot(q.x(), q.y()) < 1.01) continue;  // the poles are left open
    ++outside;
    const int start = static_cast<int>(static_cast<std::size_t>(n) * 7919 % ball.triangles.size());
    CHECK(std::sqrt(walk.from(walk.at(start, q), q).squared) ==
          Approx(nearest_of_all(ball, q)).epsilon(1e-12));
  }
  CHECK(outside > 100);
}

TEST_CASE(
    "the band of a mesh holds the distance to its nearest triangle, voxels larger than triangles or not",
    "[core][triangle_walk][level_set]") {
  const TriangleMesh mesh = egg();
  const double voxel = GENERATE(0.1e-3, 0.4e-3);
  const LevelSet set = level_set_from_mesh(mesh, voxel, 4.0);
  std::vector<float> values(512);
  const int stride = voxel < 0.2e-3 ? 353 : 31;
  int count = 0;
  for (const auto& block : set.blocks()) {
    set.read(block, 8, values.data());
    for (int n = count % 7; n < 512; n += stride) {
      const double value = values[static_cast<std::size_t>(n)];
      if (std::abs(value) > set.half_width()) continue;
      const Vector3d q = voxel * Vector3d(block[0] + n / 64, block[1] + n / 8 % 8, block[2] + n % 8);
      ++count;
      REQUIRE(std::abs(value) == Approx(nearest_of_all(mesh, q)).margin(1e-9));
    }
  }
  CHECK(count > 100);
}

namespace {

// A block with a slot that is narrower than the band is wide: two sheets face each other.
TriangleMesh slotted_block(double voxel) {
  const auto beyond = [](double x, double half) { return std::abs(x) - half; };
  const auto distance = [&](double x, double y, double z) {
    const double block = std::max({beyond(x, 4.1e-3), beyond(y, 3.1e-3), beyond(z, 3.1e-3)});
    const double slot = std::max(beyond(x - 0.7e-3, 0.8e-3), -z - 1.9e-3);
    return std::max(block, -slot);
  };
  return surface(
      level_set_from_distance(distance, {{-4.1e-3, -3.1e-3, -3.1e-3}, {4.1e-3, 3.1e-3, 3.1e-3}}, voxel, 5.0));
}

std::vector<float> values_of(const LevelSet& set, const std::array<int, 3>& block) {
  std::vector<float> values(512);
  set.read(block, 8, values.data());
  return values;
}

}  // namespace

TEST_CASE("two sheets that face each other share the band between them by distance",
          "[core][triangle_walk][level_set][long]") {
  const TriangleMesh mesh = slotted_block(GENERATE(0.5e-3, 0.2e-3));
  const double voxel = 0.25e-3;
  const LevelSet set = level_set_from_mesh(mesh, voxel, 8.0);
  int count = 0, in_slot = 0;
  for (const auto& block : set.blocks()) {
    const std::vector<float> values = values_of(set, block);
    for (int n = count % 11; n < 512; n += 37) {
      const double value = values[static_cast<std::size_t>(n)];
      if (std::abs(value) > set.half_width()) continue;
      const Vector3d q = voxel * Vector3d(block[0] + n / 64, block[1] + n / 8 % 8, block[2] + n % 8);
      ++count;
      in_slot +=
          std::abs(q.x() - 0.7e-3) < 0.8e-3 && std::abs(q.y()) < 3e-3 && q.z() > -1.5e-3 && q.z() < 3e-3;
      REQUIRE(std::abs(value) == Approx(nearest_of_all(mesh, q)).margin(1e-9));
    }
  }
  CHECK(count > 500);
  CHECK(in_slot > 20);
}

TEST_CASE("outside its region a level set still tells inside from outside", "[core][level_set]") {
  const TriangleMesh mesh = slotted_block(0.5e-3);
  const double voxel = 0.25e-3;
  Box region = everywhere;
  region.low[2] = 0.5e-3;
  const LevelSet whole = level_set_from_mesh(mesh, voxel, 8.0),
                 part = level_set_from_mesh(mesh, voxel, 8.0, Sides::closed, region);
  CHECK(5 * part.active_voxels() < 4 * whole.active_voxels());
  for (const auto& block : whole.blocks()) {
    const std::vector<float> expected = values_of(whole, block), found = values_of(part, block);
    if (voxel * (block[2] + 7) >= region.low[2]) {
      REQUIRE(found == expected);
      continue;
    }
    for (std::size_t n = 0; n < found.size(); ++n)
      REQUIRE(std::signbit(found[n]) == std::signbit(expected[n]));
  }
}
