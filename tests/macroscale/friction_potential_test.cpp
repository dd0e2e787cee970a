#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "macroscale/contact.h"
#include "macroscale/scene.h"

using namespace heddle::macroscale;
using namespace heddle;
using Eigen::Vector3d;

namespace {

/// Every effect that stands beside the power law, and a law of its own memory.
friction::Model with_effects() {
  friction::Model model;
  model.law = friction::HerseyPower{0.325, 0.136};
  friction::Effects& e = model.effects;
  e.tool_temperature_film = friction::ToolTemperatureFilm{.weight = 0.5, .settling = 0.05};
  e.tool_temperature_shift = friction::ToolTemperatureShift{.slope = -9e-4};
  e.static_peak = friction::StaticPeak{.amplitude = 0.4};
  e.sliding_evolution = friction::SlidingEvolution{.amplitude = -0.2};
  e.stick_slip = friction::StickSlip{.amplitude = 0.2};
  e.pressure_dependent_area = friction::PressureDependentArea{.exponent = 0.3};
  e.orientation = friction::Orientation{.amplitude = 0.15};
  e.adhesion = friction::Adhesion{.stress = 1e3};
  e.film_squeeze_out = friction::FilmSqueezeOut{.rate = 1e-5};
  e.dwell_ageing = friction::DwellAgeing{.amplitude = 0.1};
  e.solidification = friction::Solidification{.amplitude = 0.5};
  e.shear_heating = friction::ShearHeating{.amplitude = 1.0};
  e.wear = friction::Wear{.amplitude = 0.2};
  e.viscosity_plateau = friction::ViscosityPlateau{.fluidity = 1e-4};
  e.boundary_lubrication = friction::BoundaryLubrication{.amplitude = 0.1};
  return model;
}

friction::Model slip_resistance(friction::SlipResistance::Evolution evolution) {
  friction::Model model;
  model.law = friction::SlipResistance{.rate_exponent = 0.05, .evolution = evolution};
  return model;
}

enum class Live { nothing, orientation, history };

/// |closed integral of F dv| over the integral of |F| |dv|, around a circle of velocities off the origin; the
/// trapezoid rule on a period is exact to rounding. `live` moves what the step should hold along with v.
double loop_share(const friction::Model& model, Live live) {
  FrictionPoint point;
  point.load = 2.0;
  point.normal = Vector3d(0.0, 0.0, 1.0);
  point.context.pressure = 2e4;
  point.context.time_step = 2e-3;
  point.context.slip_angle = 0.3;
  point.memory = {.slip = 1e-3, .dwell = 0.05, .slip_resistance = -0.01, .age = 0.2, .load_slip = 500.0};
  const FrictionSettings settings{&model, 1e-5};
  constexpr int count = 2000;
  constexpr double turn = 2.0 * std::numbers::pi / count;
  double around = 0.0, size = 0.0;
  for (int i = 0; i < count; ++i) {
    const double a = i * turn;
    const Vector3d v(0.02 + 8e-3 * std::cos(a), 0.01 + 8e-3 * std::sin(a), 0.0);
    const Vector3d dv = 8e-3 * turn * Vector3d(-std::sin(a), std::cos(a), 0.0);
    FrictionPoint seen = point;
    if (live == Live::orientation) seen.context.slip_angle = std::atan2(v.y(), v.x());
    if (live == Live::history) {
      seen.memory.slip += 2e-3 * a / (2.0 * std::numbers::pi);
      seen.memory.slip_resistance -= 0.02 * a / (2.0 * std::numbers::pi);
    }
    const Vector3d force = friction_force(settings, seen, v);
    around += force.dot(dv);
    size += force.norm() * dv.norm();
  }
  return std::abs(around) / size;
}

}  // namespace

TEST_CASE("with its lag frozen friction does no work around a closed loop of slip velocities",
          "[macroscale][contact][friction][invariant]") {
  using Evolution = friction::SlipResistance::Evolution;
  CHECK(loop_share(with_effects(), Live::nothing) < 1e-10);
  CHECK(loop_share(slip_resistance(Evolution::frozen), Live::nothing) < 1e-10);
  CHECK(loop_share(slip_resistance(Evolution::inside), Live::nothing) < 1e-10);
}

TEST_CASE("orientation or history left live inside the potential does work around the loop",
          "[macroscale][contact][friction][invariant]") {
  using Evolution = friction::SlipResistance::Evolution;
  CHECK(loop_share(with_effects(), Live::orientation) > 1e-4);
  CHECK(loop_share(with_effects(), Live::history) > 1e-4);
  CHECK(loop_share(slip_resistance(Evolution::frozen), Live::history) > 1e-4);
}

TEST_CASE("a sticking contact creeps less than 0.05 mm over a stroke",
          "[macroscale][contact][friction][bound]") {
  const friction::Model paper = [] {
    friction::Model model;
    model.law = friction::HerseyPower{0.325, 0.136};
    return model;
  }();
  const friction::Model all = with_effects();
  for (const friction::Model* model : {&paper, &all})
    for (const double share : {0.5, 0.9, 0.999}) {
      FrictionPoint point;
      point.load = 2.0;
      point.context.pressure = 2e4;
      const FrictionSettings settings{model, 2e-4 * 70e-3 / 0.43};  // as a stamping of this stroke sets it
      // The speed at which friction holds that share of what it can at rest.
      const double held = share * law_at(settings, point, 0.0).mu * point.load;
      double low = 0.0, high = settings.smoothing;
      for (int i = 0; i < 200; ++i) {
        const double middle = 0.5 * (low + high);
        (friction_force(settings, point, {middle, 0.0, 0.0}).norm() < held ? low : high) = middle;
      }
      CAPTURE(share, low);
      CHECK(low < settings.smoothing);  // it sticks: the ramp holds
      CHECK(low * 0.43 < 0.05e-3);
    }
}
