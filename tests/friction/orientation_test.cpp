// Effect F7 in its three forms: what turns with the fabric.
#include <catch2/catch.hpp>

#include <cmath>
#include <numbers>

#include "friction/model.h"

using namespace heddle::friction;

namespace {

constexpr double pi = std::numbers::pi;

struct Drag {
  double cosine = 0.0, sine = 0.0;
};

/// mu over that without the effect.
double factor(Orientation::Form form, double amplitude, double theta, double gamma, Drag drag = {}) {
  Model model;
  model.law = HerseyPower{0.6, 0.14};
  Context context;
  context.slip_speed = 0.02;
  context.pressure = 1e5;
  context.slip_angle = theta;
  context.shear_angle = gamma;
  context.drag_cosine = drag.cosine;
  context.drag_sine = drag.sine;
  const double without = evaluate(model, context, {}).mu;
  model.effects.orientation = Orientation{.amplitude = amplitude, .form = form};
  return evaluate(model, context, {}).mu / without;
}

double trellis(double theta, double gamma) {
  return factor(Orientation::Form::trellis, 0.4, theta, gamma);
}

}  // namespace

TEST_CASE("along the trellis friction is largest on the long diagonal and smallest across it",
          "[friction][effects][analytic]") {
  const double gamma = GENERATE(-0.9, -0.3, 0.2, 0.6, 1.2);
  const double diagonal = (gamma < 0.0 ? -0.5 : 0.5) * (0.5 * pi - std::abs(gamma));
  const double share = 0.4 * std::sin(gamma) * std::sin(gamma);
  CHECK(trellis(diagonal, gamma) == Approx(1.0 + share).epsilon(1e-12));
  CHECK(trellis(diagonal + 0.5 * pi, gamma) == Approx(1.0 - share).epsilon(1e-12));
  CHECK(trellis(diagonal + 0.25 * pi, gamma) == Approx(1.0).epsilon(1e-12));
  // The mean over all directions is the law's own.
  double mean = 0.0;
  for (int k = 0; k < 8; ++k) mean += trellis(0.1 + 0.25 * pi * k, gamma) / 8.0;
  CHECK(mean == Approx(1.0).epsilon(1e-12));
}

TEST_CASE("without shear the trellis has no direction, and it comes in smoothly on either side",
          "[friction][effects][invariant]") {
  const double theta = GENERATE(0.0, 0.4, 1.0, 2.0);
  CHECK(trellis(theta, 0.0) == 1.0);
  for (double gamma : {1e-3, -1e-3}) CHECK(std::abs(trellis(theta, gamma) - 1.0) <= 0.4 * 1e-6);
}

TEST_CASE(
    "exchange of warp and weft, and the mirror of the fabric, leave friction along the trellis as it is",
    "[friction][effects][invariant]") {
  const double gamma = GENERATE(-0.7, 0.25, 0.8), theta = GENERATE(-1.1, 0.0, 0.3, 0.9, 2.5);
  // Against the weft, counted towards the warp, the same slip lies at (90 deg - gamma) - theta.
  CHECK(trellis(0.5 * pi - gamma - theta, gamma) == Approx(trellis(theta, gamma)).epsilon(1e-12));
  CHECK(trellis(-theta, -gamma) == Approx(trellis(theta, gamma)).epsilon(1e-12));
  CHECK(trellis(theta + pi, gamma) == Approx(trellis(theta, gamma)).epsilon(1e-12));
  // The form that reads no shear keeps the first symmetry only where there is none.
  const auto tows = [&](double angle) { return factor(Orientation::Form::tows, 0.4, angle, gamma); };
  CHECK(std::abs(tows(0.5 * pi - gamma - 0.9) - tows(0.9)) > 1e-3);
}

TEST_CASE("with the film's drag friction turns by its two shares, and by nothing where there is no table",
          "[friction][effects][analytic]") {
  const double theta = GENERATE(-1.1, 0.0, 0.3, 0.9, 2.5), gamma = GENERATE(-0.7, 0.25);
  const auto film = [&](double amplitude, Drag drag) {
    return factor(Orientation::Form::film, amplitude, theta, gamma, drag);
  };
  CHECK(film(1.0, {0.1, -0.2}) ==
        Approx(1.0 + 0.1 * std::cos(2.0 * theta) - 0.2 * std::sin(2.0 * theta)).epsilon(1e-12));
  CHECK(film(0.5, {0.1, -0.2}) - 1.0 == Approx(0.5 * (film(1.0, {0.1, -0.2}) - 1.0)).margin(1e-15));
  CHECK(film(1.0, {}) == 1.0);
  CHECK(film(0.0, {0.1, -0.2}) == 1.0);
  // D (sin, cos) of the shear is the form trellis with A sin^2(gamma) = D.
  const double share = 0.4 * std::sin(gamma) * std::sin(gamma), side = gamma < 0.0 ? -1.0 : 1.0;
  CHECK(film(1.0, {share * std::abs(std::sin(gamma)), side * share * std::cos(gamma)}) ==
        Approx(trellis(theta, gamma)).epsilon(1e-12));
}
