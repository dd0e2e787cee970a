#include <catch2/catch.hpp>

#include <cmath>

#include "core/surface.h"
#include "tests/derivative_check.h"

using heddle::Surface;
using heddle::test::derivative_gap;

namespace {
template <class F>
Surface sampled(const F& f, int n) {
  std::vector<double> v;
  const double d = 1.0 / (n - 1);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) v.push_back(f(i * d, j * d));
  return Surface(0.0, d, n, 0.0, d, n, v);
}
double bump(double x, double y) {
  return std::exp(x) * std::cos(2.0 * y) + x * y;
}
}  // namespace

TEST_CASE("a surface meets parabolas exactly, inside and beyond the grid", "[core][surface]") {
  const auto f = [](double x, double y) { return 1.0 + 2.0 * x - y + 3.0 * x * x + x * y - 2.0 * y * y; };
  const Surface s = sampled(f, 7);
  const double x = GENERATE(-0.3, 0.0, 0.41, 1.0, 1.7), y = GENERATE(-0.2, 0.33, 1.4);
  const auto v = s.evaluate(x, y);
  CHECK(v.f == Approx(f(x, y)).epsilon(1e-12));
  CHECK(v.fx == Approx(2.0 + 6.0 * x + y).margin(1e-11));
  CHECK(v.fy == Approx(-1.0 + x - 4.0 * y).margin(1e-11));
  CHECK(v.fxx == Approx(6.0).margin(1e-9));
  CHECK(v.fxy == Approx(1.0).margin(1e-9));
  CHECK(v.fyy == Approx(-4.0).margin(1e-9));
}

TEST_CASE("surface slopes agree with central differences", "[core][surface][derivative]") {
  const Surface s = sampled(bump, 9);
  const double x = GENERATE(-0.1, 0.22, 0.77, 1.2), y = GENERATE(-0.1, 0.3, 0.9);
  const auto v = s.evaluate(x, y);
  const auto along_x = [&](double t) { return s.evaluate(t, y).f; };
  const auto slope_y = [&](double t) { return s.evaluate(x, t).fy; };
  const auto slope_x_along_y = [&](double t) { return s.evaluate(x, t).fx; };
  CHECK(derivative_gap(along_x, x, 0.1, v.fx) < 1e-7);
  CHECK(derivative_gap(along_x, x, 0.1, 1.01 * v.fx + 1e-3) > 1e-4);
  CHECK(derivative_gap(slope_y, y, 0.1, v.fyy) < 1e-6);
  CHECK(derivative_gap(slope_x_along_y, y, 0.1, v.fxy) < 1e-6);
}

TEST_CASE("surface error falls with the fourth power of the step", "[core][surface][convergence]") {
  const auto error = [](int n) {
    const Surface s = sampled(bump, n);
    double worst = 0.0;
    for (double x = 0.3; x < 0.7; x += 0.013)
      for (double y = 0.3; y < 0.7; y += 0.017)
        worst = std::max(worst, std::abs(s.evaluate(x, y).f - bump(x, y)));
    return worst;
  };
  const double order = std::log2(error(17) / error(33));
  CHECK(order > 3.5);
  CHECK(order < 4.6);
}

// A search for the least energy compares values that are almost equal.
TEST_CASE("a surface far beyond its grid is smooth down to rounding", "[core][surface]") {
  const Surface s = sampled(bump, 301);
  const double y = GENERATE(-2.0, 0.37, 3.0);  // 600 steps outside, inside, 600 beyond
  constexpr double step = 1e-8;
  for (int k = 0; k < 50; ++k) {
    const double x = -6.0 + 1e-3 * k;  // 1800 steps outside
    const auto v = s.evaluate(x, y);
    const double change = s.evaluate(x + step, y).f - v.f;
    CHECK(std::abs(change - step * (v.fx + 0.5 * step * v.fxx)) < 1e-14 * std::abs(v.f));
  }
}
