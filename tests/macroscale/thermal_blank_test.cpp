// Temperatures of a blank while it is stamped: what moves them, what they move, and that nothing is lost.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "macroscale/checkpoint.h"
#include "macroscale/stamping.h"
#include "macroscale/stamping_scene.h"
#include "macroscale/system.h"
#include "tests/macroscale/kept_stamping.h"
#include "tests/macroscale/sample_fabric.h"

using namespace heddle::macroscale;
using heddle::test::bytes_of;
using heddle::test::from;
using heddle::test::make_fabric;

namespace {

StampingSpec small_case(int steps = 5) {
  StampingSpec spec;
  spec.blank.spacing = 32e-3;  // 11 x 11 nodes
  spec.process.stroke = 25e-3;
  spec.process.time = 0.15;
  spec.process.steps = steps;
  spec.thermal.emplace();
  return spec;
}

heddle::mesoscale::FabricProperties fabric() {
  return make_fabric({.rate_consistency = 5.0, .table_end = 8e-4});
}

heddle::friction::Model law_of_the_film() {
  heddle::friction::Model model;
  model.law = heddle::friction::HerseyPower{.scale = 0.2, .exponent = 0.136};
  return model;
}

StampingResult run(const StampingSpec& spec, const StampingControl& control = {}) {
  return run_stamping(spec, fabric(), law_of_the_film(), control);
}

}  // namespace

TEST_CASE("a blank among tools and air as warm as itself is stamped as with one temperature",
          "[macroscale][thermal]") {
  StampingSpec spec = small_case();
  spec.process.tool_temperature = spec.process.blank_temperature;
  spec.thermal->air.temperature = spec.process.blank_temperature;
  spec.thermal->crystallisation.rate = 0.0;
  spec.thermal->friction_heat = false;
  const StampingResult warm = run(spec);
  StampingSpec plain = spec;
  plain.thermal.reset();
  const StampingResult one = run(plain);
  REQUIRE(warm.summary.completed);
  REQUIRE(one.summary.completed);
  CHECK_FALSE(one.history.back().heat);
  CHECK(one.final_state.heat.top.empty());
  CHECK(warm.summary.peak_punch_force == Approx(one.summary.peak_punch_force).epsilon(1e-9));
  CHECK(warm.summary.draw_in_max == Approx(one.summary.draw_in_max).epsilon(1e-9));
  CHECK(warm.summary.heat->last.mean_temperature == Approx(453.15).epsilon(1e-12));
}

TEST_CASE("cold tools cool the faces they touch, stiffen the melt and raise the force",
          "[macroscale][thermal]") {
  StampingSpec spec = small_case();
  spec.contact_sites = GENERATE(ContactSites::nodes, ContactSites::gauss);
  const StampingResult cold = run(spec);
  REQUIRE(cold.summary.completed);
  const HeatRow& heat = cold.summary.heat->last;
  CHECK(heat.coldest_face > spec.process.tool_temperature);
  CHECK(heat.coldest_face < 440.0);
  CHECK(heat.mean_temperature < 453.15);
  CHECK(heat.through_bottom < 0.0);
  CHECK(heat.of_friction > 0.0);
  // The friction columns of the ledger and the heat that friction brings are the same work.
  const HistoryRow& last = cold.history.back();
  CHECK(heat.of_friction ==
        Approx(last.friction_punch + last.friction_die + last.friction_binder).epsilon(1e-9));

  StampingSpec plain = spec;
  plain.thermal.reset();
  const StampingResult one = run(plain);
  CHECK(cold.summary.peak_punch_force > 1.02 * one.summary.peak_punch_force);
  WARN("peak force with one temperature " << one.summary.peak_punch_force << " N, with temperatures "
                                          << cold.summary.peak_punch_force << " N; coldest face "
                                          << heat.coldest_face - 273.15 << " degC");
}

TEST_CASE("beside temperatures solidification takes those of the faces: none solid, all solid, and between",
          "[macroscale][thermal][friction]") {
  const StampingSpec spec = small_case();
  const auto peak = [&](double onset, double tool_weight, double scale = 0.2) {
    auto law = law_of_the_film();
    std::get<heddle::friction::HerseyPower>(law.law).scale = scale;
    if (onset > 0.0)
      law.effects.solidification = heddle::friction::Solidification{
          .amplitude = 0.5, .onset = onset, .width = 1.0, .time = 1e-9, .tool_weight = tool_weight};
    const StampingResult result = run_stamping(spec, fabric(), law);
    REQUIRE(result.summary.completed);
    return result.summary.peak_punch_force;
  };
  const double without = peak(0.0, 0.9);
  // Colder than any tool, warmer than any melt: the law by itself, and half as much again (but for the first
  // step of a contact, which has no dwell yet).
  CHECK(peak(300.0, 0.9) == Approx(without).epsilon(1e-9));
  const double all = peak(600.0, 0.9);
  CHECK(all == Approx(peak(0.0, 0.9, 0.3)).epsilon(0.02));
  // Between the temperatures of tool and melt some faces are solid; what is weighed for half-spaces does not
  // count.
  const double some = peak(420.0, 0.9);
  WARN("solidification beside temperatures: none " << without << " N, some " << some << " N, all " << all
                                                   << " N");
  CHECK(some > 1.01 * without);
  CHECK(some < 0.99 * all);
  CHECK(peak(420.0, 0.2) == some);
}

TEST_CASE("over a stamping, heat content changes by what went through the faces and by friction",
          "[macroscale][thermal][balance]") {
  StampingSpec spec = small_case(10);
  spec.thermal->crystallisation.rate = 20.0;  // much faster and hotter than any melt, so that it happens here
  spec.thermal->crystallisation.peak_temperature = 430.0;
  const StampingResult result = run(spec);
  REQUIRE(result.summary.completed);
  CHECK(result.summary.heat->last.crystallised > 0.5);
  WARN("heat balance off by " << result.summary.heat->residual_share);
  CHECK(result.summary.heat->residual_share < 1e-10);
}

TEST_CASE("each tool has its own temperature and its own side of the blank", "[macroscale][thermal]") {
  StampingSpec spec = small_case();
  spec.thermal->crystallisation.rate = 0.0;
  spec.thermal->friction_heat = false;
  spec.thermal->die_temperature = spec.process.blank_temperature;
  spec.thermal->air = {spec.process.blank_temperature, 0.0, 0.0};
  const StampingResult result = run(spec);
  REQUIRE(result.summary.completed);
  CHECK(result.summary.heat->last.through_top < -10.0);
  CHECK(std::abs(result.summary.heat->last.through_bottom) <
        0.01 * std::abs(result.summary.heat->last.through_top));
}

TEST_CASE("temperatures keep the symmetries of the square", "[macroscale][thermal]") {
  const StampingResult result = run(small_case());
  const BlankState& blank = result.final_state;
  const int n = blank.nu;
  const auto at = [&](int i, int j) { return static_cast<std::size_t>(i * (n + 1) + j); };
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j <= n; ++j)
      for (const std::size_t image : {at(n - i, j), at(i, n - j), at(j, i)}) {
        CHECK(blank.heat.top[image] == Approx(blank.heat.top[at(i, j)]).epsilon(1e-6));
        CHECK(blank.heat.bottom[image] == Approx(blank.heat.bottom[at(i, j)]).epsilon(1e-6));
      }
}

TEST_CASE("shear resistance takes the mean of its consistency, and of its softening, through the ply",
          "[macroscale][thermal]") {
  StampingSpec spec = small_case();
  spec.effects.softening = {0.01, 453.15};
  const auto properties = fabric();
  const auto law = law_of_the_film();
  const Scene scene = stamping_scene(spec, properties, law);
  const System system(scene);
  State start = initial_state(scene);
  for (const double factor : start.heat.rate_factor) CHECK(factor == Approx(1.0).epsilon(1e-12));
  for (const double factor : start.heat.shear_factor) CHECK(factor == Approx(1.0).epsilon(1e-12));
  // Cooled through and through by holding for long on tools at one temperature: the Arrhenius ratio of the
  // two.
  State held = start;
  for (int i = 0; i < scene.blank.nodes(); ++i) held.x[3 * i + 2] = 0.0;
  hold_heat(system, 60.0, held);
  const double here = held.heat.field.temperature_of(0)[10];
  const double expected =
      properties.shear_rate.consistency_at(here) / properties.shear_rate.consistency_at(453.15);
  CHECK(held.heat.rate_factor[0] == Approx(expected).epsilon(1e-3));
  // The rate-free resistance that softens with temperature is taken the same way.
  CHECK(held.heat.shear_factor[0] == Approx(std::exp(-0.01 * (here - 453.15))).epsilon(1e-3));
  CHECK(expected > 2.0);
}

TEST_CASE(
    "with temperatures a run goes on from any of its checkpoints to the same bits, through its hold as well",
    "[macroscale][thermal][checkpoint]") {
  StampingSpec spec = small_case();
  spec.process.hold = 2.0;
  spec.effects.softening = {0.01, 453.15};
  std::vector<std::string> kept;
  StampingControl control;
  control.keep = [&](const StampingCheckpoint& c, bool) { kept.push_back(bytes_of(c)); };
  const StampingResult whole = run(spec, control);
  REQUIRE(whole.summary.completed);
  REQUIRE(kept.size() == 7);  // binder closed, five steps, the end of the hold
  CHECK(whole.summary.heat->held == Approx(2.0));
  for (const std::size_t at : {std::size_t{0}, std::size_t{3}, std::size_t{5}, std::size_t{6}}) {
    const StampingCheckpoint checkpoint = from(kept[at]);
    CHECK(bytes_of(checkpoint) == kept[at]);
    std::vector<std::string> again;
    StampingControl on;
    on.resume_from = &checkpoint;
    on.keep = [&](const StampingCheckpoint& c, bool) { again.push_back(bytes_of(c)); };
    const StampingResult rest = run(spec, on);
    CHECK(again.back() == kept.back());
    CHECK(rest.final_state.heat.mean == whole.final_state.heat.mean);
    CHECK(rest.summary.heat->last.residual == whole.summary.heat->last.residual);
  }
  // The check can fail: without its temperatures it is another run, and one that is refused.
  StampingCheckpoint cold = from(kept[3]);
  cold.state.heat = {};
  StampingControl on;
  on.resume_from = &cold;
  CHECK_THROWS_AS(run(spec, on), std::invalid_argument);
  cold = from(kept[3]);
  for (double& t : cold.state.heat.field.temperature) t -= 1.0;
  std::vector<std::string> other;
  on.keep = [&](const StampingCheckpoint& c, bool) { other.push_back(bytes_of(c)); };
  run(spec, on);
  CHECK(other.back() != kept.back());
}

TEST_CASE("a blank held on its tools freezes from the faces inwards, and the hold ends when no melt is left",
          "[macroscale][thermal]") {
  StampingSpec spec = small_case();
  spec.process.hold = 1000.0;
  spec.thermal->air.convection = 200.0;  // blown at, so that what no tool touches freezes as well
  const StampingResult result = run(spec);
  REQUIRE(result.summary.completed);
  const HeatSummary& heat = *result.summary.heat;
  REQUIRE(heat.first_face);
  REQUIRE(heat.solid);
  CHECK(*heat.first_face < *heat.solid);
  CHECK(heat.last.time == Approx(*heat.solid));
  CHECK(heat.held < spec.process.hold);
  CHECK(heat.last.frozen_through == Approx(1.0));
  CHECK(heat.residual_share < 1e-10);
  for (std::size_t k = 1; k < result.hold.size(); ++k) {
    CHECK(result.hold[k].frozen_through >= result.hold[k - 1].frozen_through);
    CHECK(result.hold[k].crystallised >= result.hold[k - 1].crystallised);
  }
  CHECK(*std::max_element(result.final_state.heat.mean.begin(), result.final_state.heat.mean.end()) <
        spec.thermal->freezing_temperature);
}

TEST_CASE("coupling the heat after each step costs an error of first order in the step",
          "[macroscale][thermal][convergence]") {
  // What temperatures add to the force, so that the mechanics' own error in the step does not count.
  std::vector<double> lost, added;
  for (const int steps : {20, 40, 80}) {
    StampingSpec spec = small_case(steps);
    const StampingResult result = run(spec);
    REQUIRE(result.summary.completed);
    spec.thermal.reset();
    const StampingResult plain = run(spec);
    REQUIRE(plain.summary.completed);
    lost.push_back(result.summary.heat->last.through_top + result.summary.heat->last.through_bottom);
    added.push_back(result.history.back().punch_force - plain.history.back().punch_force);
  }
  const double order = std::log2(std::abs((added[0] - added[1]) / (added[1] - added[2])));
  WARN("observed order in the step of what temperatures add to the punch force: "
       << order << " (" << added[0] << ", " << added[1] << ", " << added[2] << " N); heat lost " << lost[0]
       << ", " << lost[1] << ", " << lost[2] << " J");
  CHECK(order == Approx(1.0).margin(0.3));
  CHECK(std::abs(lost[1] - lost[2]) < 1e-3 * std::abs(lost[2]));
}
