// Whole stampings on a press that gives way, stands askew, dwells and lets go.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "macroscale/checkpoint.h"
#include "macroscale/closing.h"
#include "macroscale/quality.h"
#include "macroscale/stamping.h"
#include "macroscale/stamping_scene.h"
#include "macroscale/system.h"
#include "tests/macroscale/kept_stamping.h"
#include "tests/macroscale/sample_fabric.h"
#include "tests/macroscale/sample_stamping.h"

using namespace heddle::macroscale;
using heddle::test::coarse_stamping;
using heddle::test::coulomb;
using heddle::test::make_fabric;

namespace {

StampingResult run(const StampingSpec& spec, double rate_consistency = 0.0, double mu = 0.3) {
  return run_stamping(spec, make_fabric({.rate_consistency = rate_consistency}), coulomb(mu));
}

void check_books(const StampingResult& result) {
  CAPTURE(result.summary.failure);
  REQUIRE(result.summary.completed);
  CHECK(result.summary.energy_residual_max < 0.01);
  CHECK(result.summary.force_balance_residual_max < 1e-3);
}

/// Punch force over its own way, between rows.
double force_at(const std::vector<HistoryRow>& history, double way) {
  double x0 = 0.0, f0 = 0.0;
  for (const HistoryRow& row : history) {
    const double x1 = row.punch_displacement - row.punch_deflection;
    if (x1 >= way) return f0 + (row.punch_force - f0) * (way - x0) / (x1 - x0);
    x0 = x1, f0 = row.punch_force;
  }
  return f0;
}

}  // namespace

TEST_CASE("with gravity on the weight's work is in the books, and off it is not there",
          "[macroscale][press][gravity]") {
  StampingSpec spec = coarse_stamping(10);
  const auto off = run(spec);
  spec.process.press.gravity = true;
  const auto on = run(spec);
  check_books(on);
  CHECK(on.history.back().work_gravity > 0.0);
  // The die carries both weights besides; what it feels points down.
  const double weight = standard_gravity * (20.0 + 0.7 * 0.32 * 0.32);
  CHECK(off.history.back().die_force - on.history.back().die_force > weight);
  CHECK(off.history.back().work_gravity == 0.0);
  auto forgotten = on.history;
  double largest = 0.0;
  for (HistoryRow& row : forgotten) {
    row.work_gravity = 0.0;
    largest = std::max(largest, std::abs(ledger_residual(row)) / on.history.back().work_punch);
  }
  CHECK(largest > 5.0 * on.summary.energy_residual_max);
}

TEST_CASE("a press that gives way stretches the rigid force over stroke by F / k",
          "[macroscale][press][compliance]") {
  StampingSpec spec = coarse_stamping(10);
  spec.process.steps = 25;
  const auto rigid = run(spec);
  spec.process.press.compliance = 2e-5;  // 1 mm at 50 N
  const auto soft = run(spec);
  check_books(soft);
  CHECK(soft.history.back().punch_deflection > 5e-4);
  for (const HistoryRow& row : soft.history) {
    CHECK(row.punch_deflection == Approx(2e-5 * row.punch_force).epsilon(1e-3).margin(1e-9));
    CHECK(row.energy_press ==
          Approx(0.5 * 2e-5 * row.punch_force * row.punch_force).epsilon(2e-3).margin(1e-9));
    if (row.punch_force < 2.0) continue;  // between two rows of the start the curve is no straight line
    CHECK(row.punch_force ==
          Approx(force_at(rigid.history, row.punch_displacement - row.punch_deflection)).epsilon(0.01));
  }
  CHECK(rigid.history.back().energy_press == 0.0);
}

TEST_CASE("compliance, offset and tilt are off to the bit and linear when tiny",
          "[macroscale][press][effect]") {
  StampingSpec spec = coarse_stamping(10);
  spec.process.steps = 5;
  const auto base = run(spec, 5.0);
  struct Response {
    const char* name;
    std::function<void(PressSpec&, double)> set;
    std::function<double(const StampingResult&)> read;
    double tiny;
  };
  // What a mirror turns round is told by the difference of two sides; the force is even in it.
  const auto force = [](const StampingResult& r) { return r.history.back().punch_force; };
  const auto along_x = [](const StampingResult& r) {
    return r.summary.draw_in_rays[0] - r.summary.draw_in_rays[4];
  };
  const auto along_y = [](const StampingResult& r) {
    return r.summary.draw_in_rays[2] - r.summary.draw_in_rays[6];
  };
  const std::vector<Response> responses{
      {"compliance", [](PressSpec& p, double a) { p.compliance = a; }, force, 1e-9},
      {"offset",
       [](PressSpec& p, double a) {
         p.punch_offset = {a, 0.0};
       },
       along_x, 1e-6},
      {"tilt", [](PressSpec& p, double a) { p.binder_tilt = a; }, along_y, 1e-6}};
  for (const Response& response : responses) {
    CAPTURE(response.name);
    const auto with = [&](double amplitude) {
      StampingSpec other = spec;
      response.set(other.process.press, amplitude);
      return run(other, 5.0);
    };
    CHECK(with(0.0).final_state.position == base.final_state.position);
    const double once = response.read(with(response.tiny)) - response.read(base),
                 twice = response.read(with(2.0 * response.tiny)) - response.read(base);
    CAPTURE(once, twice);
    CHECK(once != 0.0);
    CHECK(twice == Approx(2.0 * once).epsilon(0.01));
  }
}

TEST_CASE("a punch off its axis the other way, and a binder tilted the other way, mirror the draw-in",
          "[macroscale][press][effect]") {
  const auto rays = [](double offset, double tilt) {
    StampingSpec spec = coarse_stamping(10);
    spec.process.press.punch_offset = {offset, 0.0};
    spec.process.press.binder_tilt = tilt;
    const auto result = run(spec);
    check_books(result);
    CHECK((result.summary.symmetry_gap_shear < 0.0) == (offset != 0.0 || tilt != 0.0));
    return result.summary.draw_in_rays;
  };
  const auto right = rays(1e-3, 0.0), left = rays(-1e-3, 0.0);
  CHECK(std::abs(right[0] - right[4]) > 1e-5);
  for (std::size_t k = 0; k < 8; ++k) CHECK(right[k] == Approx(left[(12 - k) % 8]).margin(1e-6));
  const auto up = rays(0.0, 1e-4), down = rays(0.0, -1e-4);
  CHECK(std::abs(up[2] - up[6]) > 1e-5);
  for (std::size_t k = 0; k < 8; ++k) CHECK(up[k] == Approx(down[(8 - k) % 8]).margin(1e-6));
}

TEST_CASE("springs behind the binder add their stiffness times its way to its force",
          "[macroscale][press][binder]") {
  StampingSpec spec = coarse_stamping(10);
  spec.binder.stiffness = 1e7;
  std::vector<BlankState> states;
  const auto result = run_stamping(spec, make_fabric({}), coulomb(),
                                   [&](int step, int, const HistoryRow&, const BlankState& blank) {
                                     if (step > 0) states.push_back(blank);
                                   });
  check_books(result);
  REQUIRE(states.size() == result.history.size());
  for (std::size_t k = 2; k < states.size(); ++k)
    CHECK(result.history[k].binder_force == Approx(650.0 + 1e7 * states[k].binder_position).epsilon(2e-3));
  CHECK(std::abs(states.back().binder_position) > 1e-6);
  CHECK(result.history.back().energy_press > 0.0);
}

TEST_CASE("a binder held at a gap stays there, and presses the flat fabric as its compaction says",
          "[macroscale][press][binder]") {
  StampingSpec spec = coarse_stamping(10);
  spec.binder.control = BinderControl::gap;
  const auto fabric = make_fabric({});
  const double approach = 3e-5;
  spec.binder.gap = fabric.thickness - 2.0 * approach;
  const auto result = run_stamping(spec, fabric, coulomb());
  check_books(result);
  CHECK(result.final_state.binder_position == 0.0);
  CHECK(result.history.back().work_binder == 0.0);
  const heddle::friction::Model friction = coulomb();
  Scene scene = stamping_scene(spec, fabric, friction);
  System system(scene);
  State state = initial_state(scene);
  StepData step;
  REQUIRE(close_binder(scene, system, {}, state, step).converged);
  const double pressure = fabric.compaction.curves().front()(approach);
  for (int i = 0; i < scene.blank.nodes(); ++i)
    if (scene.blank.reference[i].head<2>().norm() > 0.13)  // clear of the edge, where the fabric bends
      CHECK(system.contact_at(state.node(i), 2, {}).normal.pressure == Approx(pressure).epsilon(0.01));
}

TEST_CASE("each sector of a split binder carries its own share", "[macroscale][press][binder]") {
  StampingSpec spec = coarse_stamping(10);
  spec.blank.spacing = 16e-3;
  spec.binder.sectors = GENERATE(2, 4, 6);
  const auto fabric = make_fabric({});
  const heddle::friction::Model friction = coulomb();
  Scene scene = stamping_scene(spec, fabric, friction);
  REQUIRE(scene.unknowns_of_tools() == spec.binder.sectors);
  System system(scene);
  State state = initial_state(scene);
  StepData step;
  REQUIRE(close_binder(scene, system, {}, state, step).converged);
  for (int k = 2; k < 2 + spec.binder.sectors; ++k) {
    double force = 0.0;
    for (int i = 0; i < scene.blank.nodes(); ++i) {
      const auto [d, contact] = system.contact_at(state.node(i), k, {state.tool_z[k]});
      force -= scene.blank.node_area[i] * contact.pressure * d.normal.z();
    }
    CHECK(force == Approx(650.0 / spec.binder.sectors).epsilon(2e-3));  // what inertia is left of the closing
  }
}

TEST_CASE("a stamping with a split binder closes its books, and four sectors keep the square's halves alike",
          "[macroscale][press][binder]") {
  StampingSpec spec = coarse_stamping(10);
  spec.binder.sectors = 4;
  const auto result = run(spec);
  check_books(result);
  CHECK(result.history.back().binder_force == Approx(650.0).epsilon(1e-2));
  const auto& rays = result.summary.draw_in_rays;
  CHECK(rays[0] == Approx(rays[4]).epsilon(1e-3));
  CHECK(rays[2] == Approx(rays[6]).epsilon(1e-3));
}

TEST_CASE("a punch that bottoms out yields at its force, and the die's floor takes it",
          "[macroscale][press][bottoming]") {
  StampingSpec spec = coarse_stamping(10);
  spec.die.depth = 20e-3;
  spec.die.bottom = DieBottom::flat;
  spec.process.press.force_limit = 300.0;
  const auto result = run(spec);
  check_books(result);
  const HistoryRow& last = result.history.back();
  CHECK(last.punch_force == Approx(300.0).epsilon(2e-3));
  CHECK(last.punch_displacement == Approx(25e-3));
  CHECK(last.punch_deflection > 3e-3);
  CHECK(last.punch_displacement - last.punch_deflection > 19.5e-3);
  for (const HistoryRow& row : result.history) CHECK(row.punch_force < 300.0 * 1.002);
}

TEST_CASE(
    "while the tools stand still the resin's share of the punch force fades, and a resumed dwell has the "
    "same bits",
    "[macroscale][press][dwell]") {
  StampingSpec spec = coarse_stamping(10);
  spec.process.press.dwell = 2.0;
  std::vector<StampingCheckpoint> kept;
  StampingControl control;
  control.keep = [&](const StampingCheckpoint& c, bool) { kept.push_back(c); };
  const auto fabric = make_fabric({.rate_consistency = 50.0});
  const auto result = run_stamping(spec, fabric, coulomb(), control);
  check_books(result);
  REQUIRE(result.history.size() == static_cast<std::size_t>(spec.process.steps + dwell_rows));
  const auto at = [&](int row) { return result.history[static_cast<std::size_t>(row - 1)]; };
  const int stroke = spec.process.steps, all = stroke + dwell_rows;
  CHECK(at(all).time == Approx(spec.process.time + 2.0));
  CHECK(at(all).punch_displacement == at(stroke).punch_displacement);
  CHECK(at(all).work_punch == at(stroke).work_punch);
  CHECK(at(all).punch_force < 0.95 * at(stroke).punch_force);
  for (int row = stroke + 1; row < all; ++row) CHECK(at(row + 1).punch_force < 1.002 * at(row).punch_force);

  StampingControl resumed;
  resumed.resume_from = &kept[static_cast<std::size_t>(stroke + 7)];
  REQUIRE(resumed.resume_from->step == stroke + 7);
  const auto again = run_stamping(spec, fabric, coulomb(), resumed);
  CHECK(again.final_state.position == result.final_state.position);
  CHECK(again.history.back().punch_force == result.history.back().punch_force);
}

TEST_CASE("a released blank springs back flat, for its shear gives back all that it stored",
          "[macroscale][press][release]") {
  StampingSpec spec = coarse_stamping(10);
  spec.process.press.release = true;
  const auto slippery = run(spec, 0.0, 0.0), rough = run(spec);
  for (const auto* result : {&slippery, &rough}) {
    check_books(*result);
    REQUIRE(result->summary.release);
    const HistoryRow& last = result->history.back();
    const HistoryRow& after = result->summary.release->row;
    CHECK(std::abs(after.ledger_residual) < 0.01 * last.work_punch);
    CHECK(after.energy_shear < last.energy_shear);
    CHECK(after.shear_angle_max < 0.02 * last.shear_angle_max);
    CHECK(after.punch_force == 0.0);
    CHECK(result->summary.release->moved > 1e-3);
  }
}

TEST_CASE("a run that was kept before its release goes on to the same released blank",
          "[macroscale][press][release]") {
  StampingSpec spec = coarse_stamping(10);
  spec.process.steps = 4;
  spec.process.press.release = true;
  const auto fabric = make_fabric({});
  const auto [kept, whole] = heddle::test::run_and_keep(spec, fabric, coulomb());
  REQUIRE(kept.size() == 6);
  for (const std::size_t from : {4u, 5u}) {
    CHECK(heddle::test::from(kept[from]).release.has_value() == (from == 5));
    const auto again = heddle::test::go_on(kept[from], spec, fabric, coulomb());
    CHECK(again.final_state.position == whole.final_state.position);
    CHECK(again.summary.release->row.energy_shear == whole.summary.release->row.energy_shear);
  }
}

TEST_CASE("with everything that a press does at once the ledger closes and forces balance",
          "[macroscale][press]") {
  StampingSpec spec = coarse_stamping(10);
  spec.blank.plies = GENERATE(1, 2);  // with friction between tows and, where there are two, between plies
  spec.shear_friction.share = 0.3;
  spec.die.bottom = DieBottom::flat;
  spec.die.depth = 20e-3;
  spec.binder.sectors = 4;
  spec.binder.stiffness = 1e6;
  PressSpec& press = spec.process.press;
  press.gravity = true;
  press.compliance = 1e-6;
  press.force_limit = 250.0;
  press.punch_offset = {5e-4, 3e-4};
  press.binder_tilt = 1e-4;
  press.dwell = 0.5;
  press.release = true;
  spec.process.hold = 0.0;
  const auto result = run(spec, 5.0);
  check_books(result);
  REQUIRE(result.summary.release);
  CHECK(std::abs(result.summary.release->row.ledger_residual) < 0.01 * result.history.back().work_punch);
}
