#include <catch2/catch.hpp>

#include <cmath>

#include "core/curve.h"
#include "tests/derivative_check.h"

using heddle::Curve;
using heddle::CurveFamily;
using heddle::test::derivative_gap;

namespace {
Curve hardening() {
  return Curve({0.0, 0.1, 0.3, 0.35, 0.6, 1.0}, {0.0, 1.0, 1.2, 5.0, 7.5, 10.5});
}
}  // namespace

TEST_CASE("curve goes through its points and stays monotone between them", "[core][curve]") {
  const Curve curve = hardening();
  for (std::size_t i = 0; i < curve.x().size(); ++i)
    CHECK(curve(curve.x()[i]) == Approx(curve.y()[i]).margin(1e-14));
  for (double x = 0.0; x < 1.0; x += 1e-3) CHECK(curve(x + 1e-3) >= curve(x));
}

TEST_CASE("curve slope agrees with central differences, and its integral's slope is the curve",
          "[core][curve][derivative]") {
  const Curve curve = hardening();
  const double x = GENERATE(-0.5, 0.03, 0.2, 0.32, 0.7, 1.4);
  CAPTURE(x);
  const double slope = curve.evaluate(x).slope;
  CHECK(derivative_gap(curve, x, 0.05, slope) < 1e-7);
  CHECK(derivative_gap(curve, x, 0.05, 1.01 * slope) > 1e-4);
  const auto integral = [&](double t) { return curve.integral(t); };
  CHECK(derivative_gap(integral, x, 0.05, curve(x)) < 1e-7);
  CHECK(derivative_gap(integral, x, 0.05, 1.01 * curve(x)) > 1e-4);
}

TEST_CASE("an even grid and the same points found by search give the same curve", "[core][curve]") {
  std::vector<double> x, y;
  for (int i = 0; i <= 10; ++i) x.push_back(0.1 * i), y.push_back(std::tanh(0.1 * i));
  const Curve even(x, y);
  x[5] += 1e-7;  // breaks evenness, moves the curve by about as much
  const Curve uneven(x, y);
  for (double t = -0.2; t < 1.2; t += 0.037) CHECK(even(t) == Approx(uneven(t)).margin(1e-6));
}

TEST_CASE("a curve that is not a function or not finite is refused with the point named", "[core][curve]") {
  CHECK_THROWS_WITH(Curve({0.0, 0.0}, {1.0, 2.0}), Catch::Contains("point 1"));
  CHECK_THROWS_WITH(Curve({0.0, 1.0}, {1.0, std::nan("")}), Catch::Contains("not finite"));
  CHECK(heddle::fault_of_monotone_table({0, 1, 2}, {0, 2, 1}, "pressure") ==
        "pressure: y must not fall, but point 2 has 1 after 2");
  CHECK(heddle::fault_of_monotone_table({0, 1, 2}, {0, 1, 2}, "pressure").empty());
}

TEST_CASE("a curve family blends between its curves and holds beyond them", "[core][curve]") {
  const CurveFamily family({0.0, 1.0}, {Curve({0, 1}, {0, 1}), Curve({0, 1}, {0, 3})});
  CHECK(family.evaluate(0.5, 0.5).y == Approx(1.0));
  CHECK(family.evaluate(0.5, 0.5).slope == Approx(2.0));
  CHECK(family.evaluate(0.5, -1.0).y == Approx(0.5));
  CHECK(family.evaluate(0.5, 2.0).y == Approx(1.5));
  CHECK(family.integral(1.0, 0.5) == Approx(1.0));
}
