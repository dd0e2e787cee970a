// Tools with a coefficient of their own.
#include <catch2/catch.hpp>

#include <random>

#include "macroscale/quality.h"
#include "macroscale/stamping.h"
#include "macroscale/system.h"
#include "tests/macroscale/sample_fabric.h"
#include "tests/macroscale/sample_stamping.h"
#include "tests/macroscale/slope_checks.h"

using namespace heddle::macroscale;
using Eigen::VectorXd;
using heddle::test::check_slopes;
using heddle::test::coarse_stamping;
using heddle::test::coulomb;
using heddle::test::make_fabric;

namespace {

StampingResult run(const StampingSpec& spec, double mu) {
  return run_stamping(spec, make_fabric({}), coulomb(mu));
}

void check_books(const StampingResult& result) {
  CAPTURE(result.summary.failure);
  REQUIRE(result.summary.completed);
  CHECK(result.summary.energy_residual_max < 0.01);
  CHECK(result.summary.force_balance_residual_max < 1e-3);
}

}  // namespace

TEST_CASE("three tools that each say 0.3 are a law that says 0.3, to the bit",
          "[macroscale][tool friction]") {
  StampingSpec spec = coarse_stamping(6);
  const StampingResult by_law = run(spec, 0.3);
  spec.punch.friction_coefficient = spec.die.friction_coefficient = spec.binder.friction_coefficient = 0.3;
  const StampingResult by_tool = run(spec, 0.1);
  check_books(by_tool);
  REQUIRE(by_tool.history.size() == by_law.history.size());
  for (std::size_t k = 0; k < by_law.history.size(); ++k) {
    CHECK(by_tool.history[k].punch_force == by_law.history[k].punch_force);
    CHECK(by_tool.history[k].friction_die == by_law.history[k].friction_die);
  }
  CHECK(by_tool.final_state.friction_coefficient == by_law.final_state.friction_coefficient);
}

TEST_CASE("a frictionless binder does no friction work, and the other tools rub by the law",
          "[macroscale][tool friction]") {
  StampingSpec spec = coarse_stamping(8);
  const StampingResult all = run(spec, 0.3);
  spec.binder.friction_coefficient = 0.0;
  const StampingResult without = run(spec, 0.3);
  check_books(without);
  CHECK(all.history.back().friction_binder > 0.0);
  CHECK(without.history.back().friction_binder == 0.0);
  CHECK(without.history.back().friction_die > 0.0);
  CHECK(without.summary.peak_punch_force < all.summary.peak_punch_force);
}

TEST_CASE("the field of the coefficient shows each tool's own", "[macroscale][tool friction]") {
  StampingSpec spec = coarse_stamping(8);
  spec.punch.friction_coefficient = 0.5;
  spec.die.friction_coefficient = 0.25;
  spec.binder.friction_coefficient = 0.25;
  const BlankState blank = run(spec, 0.1).final_state;
  int at_punch = 0, at_die = 0;
  for (std::size_t n = 0; n < blank.friction_coefficient.size(); ++n) {
    if (blank.pressure[n] == 0.0) continue;
    // The apex is the punch's, the corners lie between die and binder.
    const double r = std::hypot(blank.reference[n][0], blank.reference[n][1]);
    if (r < 0.02) at_punch += blank.friction_coefficient[n] == 0.5;
    if (r > 0.15) at_die += blank.friction_coefficient[n] == 0.25;
    CHECK(blank.friction_coefficient[n] != 0.1);
  }
  CHECK(at_punch > 0);
  CHECK(at_die > 0);
}

TEST_CASE("the force between three tools of unlike coefficients is the slope of their potential",
          "[macroscale][tool friction][derivative]") {
  const auto fabric = make_fabric({});
  const heddle::friction::Model law = coulomb(0.3);
  Scene scene;
  scene.blank = make_blank({0.04, 0.03}, 0.01);
  scene.fabric = &fabric;
  scene.friction = &law;
  scene.tools = {{Role::punch, HemisphereShape{{0, 0, 0.75e-3}, 0.05}, Motion::driven, 0.0, 0.0},
                 {Role::die, PlaneShape{{0, 0, -0.75e-3}, {0, 0, 1}}, Motion::fixed, 0.0, 0.0},
                 {Role::binder, PlaneShape{{0, 0, 0.75e-3}, {0, 0, -1}}, Motion::loaded, 40.0, 0.5}};
  scene.tools[1].friction = coulomb(0.8);
  scene.tools[2].friction = coulomb(0.0);
  scene.slip_smoothing = 1e-3;
  const State state = initial_state(scene);
  StepData step;
  step.dt = 5e-3;
  step.start = &state;
  step.target = state.x;
  step.tool_z = {-1e-4, 0.0, 0.0};
  FrictionPoint pressed;
  pressed.load = 0.5;
  pressed.context.pressure = 1e4;
  step.friction.assign(3, std::vector<FrictionPoint>(static_cast<std::size_t>(scene.blank.nodes()), pressed));
  System system(scene);

  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  VectorXd d(state.x.size()), x = state.x;
  for (double& value : d) value = uniform(random);
  for (double& value : x) value += 2e-4 * uniform(random);
  check_slopes(system, step, x, d);
}
