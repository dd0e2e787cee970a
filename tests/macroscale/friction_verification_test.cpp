// Friction with answers known in closed form: V5, V6, V15 of the solver's verification plan.
#include <catch2/catch.hpp>

#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "macroscale/ledger.h"
#include "macroscale/pull_out.h"
#include "macroscale/solve.h"
#include "tests/macroscale/capstan.h"
#include "tests/macroscale/sample_fabric.h"
#include "tests/macroscale/steps.h"

using namespace heddle::macroscale;
using Eigen::Vector3d;
using Eigen::VectorXd;
using heddle::test::Capstan;
using heddle::test::capstan_ratio;
using heddle::test::coulomb;
using heddle::test::make_fabric;
using heddle::test::run_steps;

TEST_CASE("V5: the friction test through the finite elements gives 2 mu N with Coulomb 0.3",
          "[macroscale][verification][friction]") {
  const double load = GENERATE(218.0, 343.0, 1000.0, 1500.0, 4000.0);
  CAPTURE(load);
  heddle::friction::Model model;
  model.law = heddle::friction::Coulomb{0.3};
  PullOutSpec spec;
  spec.contact_sites = GENERATE(ContactSites::nodes, ContactSites::gauss);
  spec.normal_force = load;
  const auto result = run_pull_out(spec, make_fabric({.contact_stiffness = 5e9}), model);
  REQUIRE(result.completed);
  CHECK(result.steady_force == Approx(2.0 * 0.3 * load).epsilon(1e-3));
  CHECK(result.pressure_spread < 0.01);  // V2: uniform pressure on a plate
}

TEST_CASE("V5: with a rate law the finite elements meet the law at the pressure and speed of the rig",
          "[macroscale][verification][friction]") {
  heddle::friction::Model model;
  model.law = heddle::friction::HerseyPower{0.6, 0.14};
  PullOutSpec spec;
  spec.contact_sites = GENERATE(ContactSites::nodes, ContactSites::gauss);
  spec.speed = GENERATE(1.66e-3, 41.67e-3);
  const auto result = run_pull_out(spec, make_fabric({}), model);
  REQUIRE(result.completed);
  heddle::friction::Context context;
  context.slip_speed = spec.speed;
  context.pressure = spec.normal_force / (spec.size[0] * spec.size[1]);
  context.fabric_temperature = spec.fabric_temperature;
  context.tool_temperature = spec.tool_temperature;
  const double mu = heddle::friction::evaluate(model, context, {}).mu;
  CHECK(result.steady_force == Approx(2.0 * mu * spec.normal_force).epsilon(1e-3));
}

namespace {

const char* name(ContactSites sites) {
  return sites == ContactSites::nodes ? "nodes" : "Gauss points";
}

// Friction loads followed to 0.1 %: the answers below are exact to that.
SolveOptions tight_lag() {
  SolveOptions options;
  options.lag_tolerance = 1e-3;
  return options;
}

// A strip held between plate and binder, drawn over the die's shoulder and straight down its wall: tension
// [N]. The ring is so large (5 m) that its edge is a straight shoulder to a 5 mm strip.
double draw_in_tension(double mu, double binder_force, bool shoulder, double spacing = 2.5e-3,
                       ContactSites sites = ContactSites::nodes) {
  const auto fabric = make_fabric({.bending = 1e-5, .contact_stiffness = 5e9});
  heddle::friction::Model friction;
  friction.law = heddle::friction::Coulomb{mu};
  const double opening = 5.0, fillet = 0.02, half = 0.5 * fabric.thickness, flat = 0.1, drop = 0.02;
  const double arc = (fillet + half) * 0.5 * std::numbers::pi;
  const double length = shoulder ? flat + arc + drop : flat + 0.02;
  Scene scene;
  scene.contact_sites = sites;
  scene.blank = make_blank({length, 0.005}, spacing);
  scene.fabric = &fabric;
  scene.friction = &friction;
  scene.tools = {{Role::die, RingShape{-half, opening, fillet, true}, Motion::fixed, 0.0, 0.0},
                 {Role::binder, RingShape{half, opening + fillet - 2e-3, 2e-3, false}, Motion::loaded,
                  binder_force, 0.5}};
  scene.slip_smoothing = 4e-6;
  scene.shear_rate = false;
  Blank& blank = scene.blank;
  // s = distance from the far end along the strip; the shoulder starts where `flat` is used up.
  const double edge = opening + fillet;
  const auto place = [&](double s) -> Vector3d {
    if (s <= flat) return {edge + flat - s, 0.0, 0.0};
    if (!shoulder) return {edge + flat - s, 0.0, 0.0};
    const double angle = std::min((s - flat) / (fillet + half), 0.5 * std::numbers::pi),
                 rest = s - flat - angle * (fillet + half);
    return {edge - (fillet + half) * std::sin(angle), 0.0,
            -half - fillet + (fillet + half) * std::cos(angle) - rest};
  };
  const Vector3d pull = shoulder ? Vector3d(0, 0, -1) : Vector3d(-1, 0, 0);
  System system(scene);
  State state = initial_state(scene);
  for (int i = 0; i < blank.nodes(); ++i) {
    const Vector3d r = blank.reference[i];
    state.x.segment<3>(3 * i) = place(r.x() + 0.5 * length) + Vector3d(0, r.y(), 0);
  }
  // Where the binder will come to rest: its force over the strip it covers.
  const double approach = approach_at(system.compaction(), binder_force / (flat * 0.005));
  for (int i = 0; i < blank.nodes(); ++i)
    if (blank.reference[i].x() + 0.5 * length < flat) state.x[3 * i + 2] -= approach;
  state.x[3 * blank.nodes()] = -2.0 * approach;
  scene.held.assign(3 * blank.nodes(), 0);
  for (int j = 0; j <= blank.nv; ++j)
    for (int c = 0; c < 3; ++c) scene.held[3 * blank.node(blank.nu, j) + c] = 1;
  const VectorXd laid = state.x;
  const double speed = 0.02;
  const auto draw = [&](double time, VectorXd& x) {
    for (int j = 0; j <= blank.nv; ++j) {
      const int n = blank.node(blank.nu, j);
      x.segment<3>(3 * n) = laid.segment<3>(3 * n) + speed * time * pull;
    }
  };
  double tension = 0.0;
  run_steps(
      system, state, 0.005, 60, draw,
      [&](const StepData& step, const State& end) {
        tension = account(system, step, end).forces.by_supports.dot(pull);
      },
      tight_lag());
  return tension;
}

}  // namespace

TEST_CASE("V6: tension over a cylinder grows by exp(mu theta)", "[macroscale][verification][friction]") {
  const double wrap = 0.5 * std::numbers::pi;
  const double exact = std::exp(0.3 * wrap);
  const auto sites = GENERATE(ContactSites::nodes, ContactSites::gauss);
  const auto model = coulomb(0.3);
  std::vector<double> gaps;
  for (const int per_radius : {5, 10, 20})
    gaps.push_back(capstan_ratio(model, wrap, per_radius, sites) / exact - 1.0);
  WARN("V6, contact at " << name(sites) << ", spacing R / 5, R / 10, R / 20: T2/T1 off by " << gaps[0] << ", "
                         << gaps[1] << ", " << gaps[2] << "; order "
                         << std::log2(std::abs(gaps[0] / gaps[2])) / 2.0);
  CHECK(std::abs(gaps[2]) < 0.005);
  CHECK(capstan_ratio(coulomb(0.0), wrap, 20, sites) == Approx(1.0).epsilon(0.002));
}

TEST_CASE(
    "V6: with a law of speed and pressure tension over a cylinder follows dT/dtheta = mu(T / (R b), U) T",
    "[macroscale][verification][friction]") {
  const double wrap = 0.5 * std::numbers::pi;
  const auto sites = GENERATE(ContactSites::nodes, ContactSites::gauss);
  heddle::friction::Model model;
  model.law = heddle::friction::HerseyPower{0.6, 0.14};
  const Capstan capstan;
  const Scene scene;
  heddle::friction::Context context;
  context.slip_speed = capstan.speed;
  context.fabric_temperature = scene.blank_temperature_at(0.0);
  context.tool_temperature = scene.tool_temperature;
  const double mid = capstan.radius + 0.5 * make_fabric({}).thickness;
  const auto mu = [&](double tension) {
    context.pressure = tension / (mid * capstan.width);
    return heddle::friction::evaluate(model, context, {}).mu;
  };
  // Runge and Kutta's fourth order over 200 steps.
  double tension = capstan.tension;
  const double h = wrap / 200;
  for (int k = 0; k < 200; ++k) {
    const auto slope = [&](double t) { return mu(t) * t; };
    const double a = slope(tension), b = slope(tension + 0.5 * h * a), c = slope(tension + 0.5 * h * b),
                 d = slope(tension + h * c);
    tension += h / 6.0 * (a + 2.0 * b + 2.0 * c + d);
  }
  const double exact = tension / capstan.tension, ratio = capstan_ratio(model, wrap, 20, sites);
  WARN("V6, law of speed and pressure, contact at " << name(sites) << ": T2/T1 " << ratio << ", integrated "
                                                    << exact << "; mu from " << mu(capstan.tension) << " to "
                                                    << mu(tension));
  CHECK(ratio == Approx(exact).epsilon(0.005));
  // One mu for the whole arc is another answer: the check sees that pressure grows along it.
  CHECK(std::abs(std::exp(mu(capstan.tension) * wrap) / exact - 1.0) > 0.01);
}

TEST_CASE("V15: a strip drawn from under the binder carries twice mu times the binder force",
          "[macroscale][verification][friction]") {
  const double mu = 0.3;
  const double t1 = draw_in_tension(mu, 50.0, false), t2 = draw_in_tension(mu, 200.0, false);
  const double slope = (t2 - t1) / 150.0, intercept = t1 - 50.0 * slope;
  WARN("V15, flat: " << t1 << " and " << t2 << " N for 50 and 200 N of binder force; slope " << slope
                     << ", intercept " << intercept << " N");
  CHECK(slope == Approx(2.0 * mu).epsilon(0.005));
  CHECK(std::abs(intercept) < 0.01 * t1);
}

TEST_CASE("V15: over the die's shoulder that tension grows by exp(mu pi / 2)",
          "[macroscale][verification][friction][long]") {
  const double mu = 0.3;
  const auto sites = GENERATE(ContactSites::nodes, ContactSites::gauss);
  // An eighth of the shoulder's radius.
  const double t1 = draw_in_tension(mu, 50.0, true, 2.5e-3, sites),
               t2 = draw_in_tension(mu, 200.0, true, 2.5e-3, sites);
  const double slope = (t2 - t1) / 150.0;
  CAPTURE(t1, t2);
  CHECK(slope == Approx(2.0 * mu * std::exp(mu * 0.5 * std::numbers::pi)).epsilon(0.005));
}

TEST_CASE("V15: the shipped shoulder of 20 mm at the spacings of the mesh study against exp(mu pi / 2)",
          "[macroscale][verification][friction][slow]") {
  const double mu = 0.3, exact = std::exp(mu * 0.5 * std::numbers::pi);
  for (const auto sites : {ContactSites::nodes, ContactSites::gauss})
    for (const double spacing : {6e-3, 4.444e-3, 3e-3, 2.5e-3}) {
      const double t1 = draw_in_tension(mu, 50.0, true, spacing, sites),
                   t2 = draw_in_tension(mu, 200.0, true, spacing, sites);
      const double ratio = (t2 - t1) / 150.0 / (2.0 * mu);
      fmt::print("{:<6} spacing {:>5.2f} mm, r/h {:>4.1f}: T2/T1 {:.4f}, exp(mu theta) {:.4f}, {:+.2f} %\n",
                 sites == ContactSites::nodes ? "nodes" : "gauss", 1e3 * spacing, 0.02 / spacing, ratio,
                 exact, 100.0 * (ratio / exact - 1.0));
      CHECK(ratio == Approx(exact).epsilon(0.005));
    }
}
