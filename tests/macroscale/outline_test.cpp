#include <catch2/catch.hpp>
#include <chrono>
#include <numbers>
#include <numeric>
#include <random>
#include <stdexcept>

#include "macroscale/outline.h"
#include "tests/macroscale/sample_meshes.h"

using namespace heddle;
using namespace heddle::macroscale;
using namespace heddle::test;

namespace {

/// n x n cells over a square of the given size, turned by an angle.
std::vector<QuadCell> grid(int n, double size, double angle = 0.0) {
  const auto at = [&](int i, int j) {
    const double x = size * (static_cast<double>(i) / n - 0.5), y = size * (static_cast<double>(j) / n - 0.5);
    if (angle == 0.0) return Point2{x, y};
    return Point2{x * std::cos(angle) - y * std::sin(angle), x * std::sin(angle) + y * std::cos(angle)};
  };
  std::vector<QuadCell> cells;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) cells.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
  }
  return cells;
}

double sum(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

Ring star(int points, double outer, double inner) {
  Ring ring;
  for (int i = 0; i < 2 * points; ++i) {
    const double r = i % 2 ? inner : outer, angle = std::numbers::pi * i / points;
    ring.push_back({r * std::cos(angle), r * std::sin(angle)});
  }
  return ring;
}

Problems found(const Outline& outline) {
  return check(outline, "blank.outline");
}

}  // namespace

TEST_CASE("makers give outlines that pass, with the area they should have", "[macroscale][outline]") {
  CHECK(found(rectangle({0.3, 0.2})).empty());
  CHECK(area(rectangle({0.3, 0.2})) == Approx(0.06).epsilon(1e-15));
  const double radius = 0.16, error = 1e-5;
  const Outline round = circle(radius, error);
  CHECK(found(round).empty());
  const double missing = 1.0 - area(round) / (std::numbers::pi * radius * radius);
  CHECK(missing > 0.0);
  CHECK(missing < 2.0 * error / radius);
  for (std::size_t i = 0; i < round.outer.size(); ++i) {
    const auto &a = round.outer[i], &b = round.outer[(i + 1) % round.outer.size()];
    CHECK(std::hypot(a[0], a[1]) == Approx(radius).epsilon(1e-15));
    CHECK(radius - std::hypot(0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])) <= error);
    for (const Point2 mirrored : {Point2{-a[0], a[1]}, Point2{a[0], -a[1]}, Point2{a[1], a[0]}})
      CHECK(std::find(round.outer.begin(), round.outer.end(), mirrored) != round.outer.end());
  }
  const Outline clockwise =
      polygon({{0, 0}, {0, 1}, {1, 1}, {1, 0}, {0, 0}}, {{{0.2, 0.2}, {0.4, 0.2}, {0.4, 0.4}}});
  CHECK(clockwise.outer.size() == 4);
  CHECK(found(clockwise).empty());
  CHECK(area(clockwise) == Approx(0.98).epsilon(1e-14));
  CHECK_THROWS_AS(circle(-1.0), InputError);
  CHECK_THROWS_AS(circle(1.0, 1e-15), InputError);
}

TEST_CASE("each fault of an outline is named with its place", "[macroscale][outline]") {
  const Ring square{{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  const auto hole = [](double x, double y, double s) {
    return Ring{{x, y}, {x + s, y}, {x + s, y + s}, {x, y + s}};
  };
  CHECK(names(found({{{0, 0}, {1, 0}}, {}}), "blank.outline.points", {"the outer border has 2"}));
  CHECK(names(found({Ring(100001, {0, 0}), {}}), "blank.outline.size", {"at most 100000 points"}));
  CHECK(names(refusal([] { circle(0.0); }), "blank.outline.circle.range", {"positive radius"}));
  CHECK(names(found({{{0, 0}, {1, 0}, {std::nan(""), 1}}, {}}), "blank.outline.finite", {"point 3"}));
  CHECK(names(found({{{0, 0}, {1, 0}, {1, 0}, {0, 1}}, {}}), "blank.outline.repeated_point",
              {"point 2", "(1000, 0) mm"}));
  CHECK(names(found({{{0, 0}, {1, 1}, {1, 0}, {0, 1}}, {}}), "blank.outline.simple",
              {"(500, 500) mm", "edges 1 and 3"}));
  CHECK(names(found({{{0, 0}, {2, 0}, {1, 0}, {1, 1}}, {}}), "blank.outline.simple",
              {"the outer border"}));  // folds back
  CHECK(names(found({{{0, 0}, {2, 0}, {1, 0}}, {}}), "blank.outline.simple", {"the outer border"}));
  CHECK(names(found({{{0, 0}, {2, 0}, {2, 1}, {1, 0}, {0, 1}}, {}}), "blank.outline.simple",
              {"(1000, 0) mm"}));  // touches
  CHECK(names(found({{{0, 0}, {0, 1}, {1, 1}, {1, 0}}, {}}), "blank.outline.orientation",
              {"counter-clockwise"}));
  CHECK(names(found({square, {hole(0.9, 0.5, 0.2)}}), "blank.outline.apart",
              {"the outer border and hole 1 meet at (1000, "}));
  CHECK(names(found({square, {hole(0.8, 0.5, 0.2)}}), "blank.outline.apart", {"meet"}));  // only touches
  CHECK(names(found({square, {hole(2, 2, 0.1)}}), "blank.outline.hole_inside", {"hole 1 lies outside"}));
  CHECK(names(found({square, {hole(0.1, 0.1, 0.5), hole(0.2, 0.2, 0.1)}}), "blank.outline.hole_in_hole",
              {"hole 2 lies in hole 1"}));
  CHECK(names(found({square, {hole(0.1, 0.1, 0.3), hole(0.3, 0.3, 0.3)}}), "blank.outline.apart",
              {"hole 1 and hole 2"}));
  CHECK(found({square, {hole(0.1, 0.1, 0.2), hole(0.300000000000001, 0.1, 0.2)}})
            .empty());  // 1 fm apart is apart
}

TEST_CASE("points on borders are inside", "[macroscale][outline]") {
  const Outline outline =
      polygon({{0, 0}, {1, 0}, {1, 1}, {0, 1}}, {{{0.25, 0.25}, {0.75, 0.25}, {0.75, 0.75}, {0.25, 0.75}}});
  CHECK(contains(outline, 0.1, 0.1));
  CHECK(contains(outline, 1.0, 0.5));
  CHECK(contains(outline, 0.25, 0.5));
  CHECK_FALSE(contains(outline, 0.5, 0.5));
  CHECK_FALSE(contains(outline, std::nextafter(1.0, 2.0), 0.5));
}

TEST_CASE("cells along, across and away from a border", "[macroscale][outline]") {
  const std::vector<QuadCell> cells = grid(8, 0.32);  // 40 mm
  SECTION("a blank of the grid's own size: every cell whole, to the last bit") {
    const auto areas = clipped_areas(rectangle({0.32, 0.32}), cells);
    for (std::size_t i = 0; i < cells.size(); ++i) CHECK(areas[i] == area(cells[i]));
  }
  SECTION("a border on the lines of the grid") {
    const auto areas = clipped_areas(rectangle({0.16, 0.32}), cells);
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const bool inside = std::abs(cells[i][0][0] + cells[i][1][0]) < 0.16;
      CHECK(areas[i] == (inside ? area(cells[i]) : 0.0));
    }
  }
  SECTION("a border through the middle of cells") {
    const auto areas = clipped_areas(rectangle({0.28, 0.28}), cells);
    CHECK(areas[0] == Approx(0.02 * 0.02).epsilon(1e-14));
    CHECK(areas[1] == Approx(0.02 * 0.04).epsilon(1e-14));
    CHECK(areas[9] == area(cells[9]));
  }
  SECTION("a diagonal through corners") {
    const auto areas = clipped_areas(polygon({{-0.16, -0.16}, {0.16, -0.16}, {0.16, 0.16}}), cells);
    for (int i = 0; i < 8; ++i) {
      for (int j = 0; j < 8; ++j) {
        const double share = i > j ? 1.0 : i == j ? 0.5 : 0.0;
        CHECK(areas[8 * i + j] == Approx(share * area(cells[8 * i + j])).epsilon(1e-12).margin(1e-19));
      }
    }
  }
  SECTION("a hole within one cell and a slot that cuts a cell in two") {
    const Outline outline = polygon({{-0.2, -0.2},
                                     {0.2, -0.2},
                                     {0.2, 0.2},
                                     {0.2, 0.03},
                                     {-0.2, 0.03},
                                     {-0.2, 0.01},
                                     {0.2, 0.01},
                                     {0.2, 0.0},
                                     {0.3, 0.0},
                                     {0.3, 0.25},
                                     {-0.2, 0.25}},
                                    {{{0.05, -0.03}, {0.06, -0.03}, {0.06, -0.02}, {0.05, -0.02}}});
    // The slot makes the ring cross itself at the right end; only a sound one is clipped.
    CHECK_FALSE(found(outline).empty());
    const Outline comb = polygon({{-0.2, -0.2},
                                  {0.2, -0.2},
                                  {0.2, 0.01},
                                  {-0.15, 0.01},
                                  {-0.15, 0.03},
                                  {0.2, 0.03},
                                  {0.2, 0.2},
                                  {-0.2, 0.2}},
                                 {{{0.05, -0.03}, {0.06, -0.03}, {0.06, -0.02}, {0.05, -0.02}}});
    REQUIRE(found(comb).empty());
    const auto areas = clipped_areas(comb, cells);
    CHECK(areas[8 * 4 + 4] == Approx(0.04 * 0.02).epsilon(1e-13));         // 0 to 10 and 30 to 40 mm remain
    CHECK(areas[8 * 5 + 3] == Approx(0.04 * 0.04 - 1e-4).epsilon(1e-13));  // the hole
    CHECK(areas[8 * 0 + 4] == Approx(0.0016 - 0.03 * 0.02).epsilon(1e-13));
  }
  SECTION("cells that are no cells") {
    CHECK_THROWS_AS(clipped_areas(rectangle({1, 1}), {{{{0, 0}, {0, 1}, {1, 1}, {1, 0}}}}),
                    std::invalid_argument);
    CHECK_THROWS_AS(clipped_areas(rectangle({1, 1}), {{{{0, 0}, {1, 0}, {0.2, 0.2}, {0, 1}}}}),
                    std::invalid_argument);
  }
}

TEST_CASE("cells that cover an outline add up to its area", "[macroscale][outline]") {
  const std::vector<Outline> outlines{circle(0.16), polygon(star(7, 0.15, 0.06)),
                                      polygon(circle(0.15).outer, {star(5, 0.08, 0.03)})};
  for (const Outline& outline : outlines) {
    REQUIRE(found(outline).empty());
    for (double angle : {0.0, 0.3, std::numbers::pi / 4}) {
      // Wide enough to cover the outline whichever way the grid is turned.
      const auto areas = clipped_areas(outline, grid(40, 0.5, angle));
      CHECK(std::abs(sum(areas) / area(outline) - 1.0) < 1e-12);
    }
  }
}

TEST_CASE("a cell's share agrees with counting points", "[macroscale][outline]") {
  const Outline outline = polygon(circle(0.15).outer, {star(5, 0.08, 0.03)});
  const std::vector<QuadCell> cells = grid(6, 0.32, 0.2);
  const auto areas = clipped_areas(outline, cells);
  for (std::size_t i = 0; i < cells.size(); ++i) {
    constexpr int n = 40;
    int inside = 0;
    for (int a = 0; a < n; ++a) {
      for (int b = 0; b < n; ++b) {
        const double s = (a + 0.5) / n, t = (b + 0.5) / n;
        Point2 p{};
        for (int c = 0; c < 2; ++c)
          p[c] =
              cells[i][0][c] + s * (cells[i][1][c] - cells[i][0][c]) + t * (cells[i][3][c] - cells[i][0][c]);
        inside += contains(outline, p[0], p[1]);
      }
    }
    CHECK(areas[i] / area(cells[i]) == Approx(static_cast<double>(inside) / (n * n)).margin(0.02));
  }
}

TEST_CASE("ten thousand cells are clipped in under a second", "[macroscale][outline]") {
  const Outline outline = circle(0.16);
  const auto cells = grid(100, 0.36, 0.1);
  const auto start = std::chrono::steady_clock::now();
  const auto areas = clipped_areas(outline, cells);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  INFO(outline.outer.size() << " points, " << cells.size() << " cells: " << seconds << " s");
  CHECK(std::abs(sum(areas) / area(outline) - 1.0) < 1e-12);
  CHECK(seconds < 10.0);  // catches a border test of every cell; a busy machine is no fault
}
