#include <catch2/catch.hpp>

#include <cmath>
#include <filesystem>

#include "macroscale/punch_profile.h"
#include "macroscale/punch_table.h"
#include "macroscale/quality.h"
#include "macroscale/stamping.h"
#include "tests/macroscale/sample_fabric.h"
#include "tests/source_dir.h"

using namespace heddle::macroscale;
using heddle::test::make_fabric;
using heddle::test::SampleFabric;

namespace {

StampingSpec small_case() {
  StampingSpec spec;
  spec.blank.spacing = 16e-3;  // 21 x 21 nodes
  spec.process.stroke = 40e-3;
  spec.process.time = 0.25;
  spec.process.steps = 20;
  return spec;
}

heddle::friction::Model coulomb() {
  heddle::friction::Model model;
  model.law = heddle::friction::Coulomb{0.3};
  return model;
}

StampingResult run(const StampingSpec& spec, double rate_consistency = 0.0) {
  return run_stamping(spec, make_fabric({.rate_consistency = rate_consistency}), coulomb());
}

// So soft that the punch reaches its middle, but not the binder.
constexpr SampleFabric pressed_through{.contact_stiffness = 2e7, .table_end = 8e-4};

}  // namespace

TEST_CASE(
    "a small stamping closes its energy ledger and its force balance, and keeps the symmetries of the square",
    "[macroscale][stamping]") {
  const auto result = run(small_case(), 5.0);
  const StampingSummary& s = result.summary;
  REQUIRE(s.completed);
  CHECK(s.rejected_steps <= 2);
  CHECK(s.peak_punch_force > 10.0);
  CHECK(s.energy_residual_max < 0.01);
  CHECK(s.force_balance_residual_max < 1e-3);
  CHECK(s.symmetry_gap_shear < 1e-3);
  CHECK(s.symmetry_gap_draw_in < 1e-3);
  CHECK(s.twist_share < 0.005);

  // The check can fail: without one of its columns the ledger is open.
  for (double HistoryRow::*column :
       {&HistoryRow::energy_tow, &HistoryRow::friction_binder, &HistoryRow::energy_shear}) {
    auto history = result.history;
    for (HistoryRow& row : history) row.*column = 0.0;
    CHECK(energy_residual_max(history) > 0.01);
  }
}

TEST_CASE("before the punch moves the blank lies flat, slack and where it was", "[macroscale][stamping]") {
  StampingSpec spec = small_case();
  spec.process.steps = 1;
  spec.process.stroke = 1e-4;
  HistoryRow first;
  BlankState blank;
  run_stamping(spec, make_fabric({}), coulomb(),
               [&](int step, int, const HistoryRow& row, const BlankState& state) {
                 if (step == 0) first = row, blank = state;
               });
  CHECK(std::abs(first.draw_in_max) < 1e-7);
  CHECK(first.tow_strain_max < 1e-6);
  for (const auto& x : blank.position) CHECK(std::abs(x[2]) < 5e-5);  // only the rings' edges bend it
}

TEST_CASE("with stabilisation on, its force and its work are in the books", "[macroscale][stamping]") {
  StampingSpec spec = small_case();
  spec.artefact.stabilisation = 2000.0;
  const auto result = run(spec);
  REQUIRE(result.summary.completed);
  CHECK(result.history.back().dissipation_artefact > 0.01 * result.history.back().work_punch);
  CHECK(result.summary.energy_residual_max < 0.01);
  CHECK(result.summary.force_balance_residual_max < 1e-3);
}

TEST_CASE("a stamping that cannot go on keeps its history and says where it stopped",
          "[macroscale][stamping]") {
  const auto result = run_stamping(small_case(), make_fabric(pressed_through), coulomb());
  const StampingSummary& s = result.summary;
  CHECK_FALSE(s.completed);
  CHECK_THAT(s.failure,
             Catch::Contains("through the middle of the fabric") && Catch::Contains("fell below 1e-7 s"));
  CHECK(s.rejected_steps > 0);
  REQUIRE_FALSE(result.history.empty());
  CHECK(result.history.back().punch_displacement == Approx(result.final_state.punch_displacement));
}

TEST_CASE("work of the punch is the area under its force against stroke", "[macroscale][stamping]") {
  StampingSpec spec = small_case();
  spec.process.steps = 40;
  const auto result = run(spec);
  double area = 0.0, force = 0.0, stroke = 0.0;
  for (const HistoryRow& row : result.history) {
    area += 0.5 * (force + row.punch_force) * (row.punch_displacement - stroke);
    force = row.punch_force;
    stroke = row.punch_displacement;
  }
  // End-of-step forces overestimate a rising force by half a step's rise.
  CHECK(result.history.back().work_punch == Approx(area).epsilon(0.05));
  CHECK(result.history.back().work_punch > area);
}

TEST_CASE("a rate-free fabric with constant mu does not feel the punch speed; scaled mass and resin do",
          "[macroscale][stamping]") {
  const auto peak = [](double speed, double mass, double rate) {
    StampingSpec spec = small_case();
    spec.process.speed_scale = speed;
    spec.artefact.mass_scaling = mass;
    spec.shear_rate = rate > 0.0;
    const auto result = run(spec, rate);
    REQUIRE(result.summary.completed);
    return result.summary.peak_punch_force;
  };
  const double slow = peak(0.5, 1.0, 0.0), base = peak(1.0, 1.0, 0.0), fast = peak(2.0, 1.0, 0.0);
  CHECK(slow == Approx(base).epsilon(0.002));
  CHECK(fast == Approx(base).epsilon(0.002));
  CHECK(std::abs(peak(2.0, 1000.0, 0.0) / base - 1.0) > 0.1);

  const double slow_resin = peak(0.5, 1.0, 20.0), resin = peak(1.0, 1.0, 20.0),
               fast_resin = peak(2.0, 1.0, 20.0);
  const double signature = (fast_resin - resin) / (resin - slow_resin);
  CAPTURE(slow_resin, resin, fast_resin);
  CHECK(resin > base);
  CHECK(signature > 1.0);  // 2^n = 1.30 for the resin term alone
  CHECK(signature < 2.5);
}

TEST_CASE("the same stamping twice gives the same bytes", "[macroscale][stamping]") {
  StampingSpec spec = small_case();
  spec.process.steps = 5;
  const auto a = run(spec, 5.0), b = run(spec, 5.0);
  REQUIRE(a.history.size() == b.history.size());
  for (std::size_t k = 0; k < a.history.size(); ++k)
    CHECK(a.history[k].punch_force == b.history[k].punch_force);
  CHECK(a.final_state.position == b.final_state.position);
}

TEST_CASE("punch travel and time are inverse to each other and end at the stroke", "[macroscale][stamping]") {
  ProcessSpec process;
  process.speed_scale = GENERATE(0.5, 1.0, 2.0);
  CHECK(stroke_at_time(process, stroke_time(process)) == Approx(process.stroke));
  CHECK(mean_speed(process) == Approx(process.speed_scale * 0.07 / 0.43));
  for (double share : {0.0, 0.3, 0.98, 0.995, 1.0})
    CHECK(stroke_at_time(process, time_at_stroke(process, share * process.stroke)) ==
          Approx(share * process.stroke).margin(1e-12));
}

TEST_CASE("a table of the punch's motion is followed row by row and turned round to the last bit",
          "[macroscale][stamping]") {
  ProcessSpec process;  // the paper's profile from its formula, and from its table
  process.slow_down = 0.01;
  ProcessSpec table = process;
  table.profile =
      read_punch_table(std::filesystem::path(heddle::test::source_dir) / "configs/data/punch_motion.csv");
  table.speed_scale = process.speed_scale = GENERATE(1.0, 2.0);
  CHECK(table.profile->x().back() == process.time);
  CHECK(table.profile->y().back() == Approx(process.stroke).epsilon(1e-14));
  for (double t = 0.0; t <= 0.43; t += 0.0043) {
    INFO("t = " << t << " s");
    CHECK(stroke_at_time(table, t) == Approx(stroke_at_time(process, t)).margin(2e-6));
  }
  for (double share : {0.0, 1e-6, 0.3, 0.98, 0.995, 1.0}) {
    const double travel = share * process.stroke;
    CHECK(std::abs(stroke_at_time(table, time_at_stroke(table, travel)) - travel) <= 4e-17);
  }
}

TEST_CASE("a stamping that cannot work is refused with every reason at once", "[macroscale][stamping]") {
  StampingSpec spec;
  spec.blank.size = {0.15, 0.15};
  spec.process.steps = 0;
  spec.die.opening_radius = 0.06;
  spec.blank.orientation = 0.5;
  spec.blank.spacing = 1e-5;
  spec.process.stroke = 0.9;
  const auto problems = check(spec);
  REQUIRE(problems.size() >= 3);
  for (const char* id : {"blank.size.reach", "process.steps.range", "tools.die.opening_radius.clearance",
                         "blank.spacing.nodes", "process.punch.stroke.reach"})
    CHECK(std::any_of(problems.begin(), problems.end(), [&](const auto& p) { return p.id == id; }));
  CHECK(check(StampingSpec{}).empty());
  CHECK_THROWS_AS(run_stamping(spec, make_fabric({}), coulomb()), heddle::InputError);
}
