#include <catch2/catch.hpp>

#include <cmath>

#include "macroscale/grid_error.h"
#include "tests/macroscale/sample_fabric.h"

using namespace heddle::macroscale;
using heddle::test::make_fabric;

namespace {

// A run whose force is off by c h^order, as if computed on a grid of spacing h.
StampingResult made_up(double spacing, double order, double crossing = 0.0) {
  StampingResult result;
  result.summary.completed = true;
  result.summary.spacing = {spacing, spacing};
  for (int k = 1; k <= 10; ++k) {
    HistoryRow row;
    // `crossing` moves the force in mid-stroke and leaves the peak alone.
    row.punch_force = 50.0 * k + 1e3 * std::pow(spacing, order) * k / 10.0 + crossing * k * (10 - k);
    result.history.push_back(row);
  }
  result.summary.peak_punch_force = result.history.back().punch_force;
  result.summary.shear_angle_max = 0.7 + spacing;
  result.summary.draw_in_max = 0.03 - spacing;
  return result;
}

}  // namespace

TEST_CASE("grid error: first-order errors are found exactly, second-order ones three times too large",
          "[macroscale][grid_error]") {
  const auto first = compare_grids(made_up(0.004, 1.0), made_up(0.008, 1.0));
  REQUIRE(first.known);
  CHECK(first.force == Approx(1e3 * 0.004));
  CHECK(first.extrapolated_force == Approx(500.0));
  CHECK(first.force_share == Approx(4.0 / 504.0));
  CHECK(first.shear_angle == Approx(0.004));
  CHECK(first.draw_in == Approx(0.004));
  // A ratio that is not two: 5 cells against 3.
  CHECK(compare_grids(made_up(0.003, 1.0), made_up(0.005, 1.0)).force == Approx(1e3 * 0.003));
  CHECK(compare_grids(made_up(0.004, 2.0), made_up(0.008, 2.0)).force == Approx(3.0 * 1e3 * 0.004 * 0.004));
}

TEST_CASE("grid error: curves that agree at the peak alone do not hide what parts them before",
          "[macroscale][grid_error]") {
  const auto error = compare_grids(made_up(0.004, 1.0), made_up(0.008, 1.0, 1.0));
  REQUIRE(error.known);
  CHECK(error.force > 5.0 * 1e3 * 0.004);
}

TEST_CASE("grid error: what cannot be known is said, not made up", "[macroscale][grid_error]") {
  auto stopped = made_up(0.008, 1.0);
  stopped.summary.completed = false;
  stopped.summary.failure = "step 3 of 10: stagnated";
  CHECK_THAT(compare_grids(made_up(0.004, 1.0), stopped).reason,
             Catch::Contains("companion") && Catch::Contains("stagnated"));
  CHECK_THAT(compare_grids(stopped, made_up(0.016, 1.0)).reason, Catch::Contains("the run itself"));
  CHECK_FALSE(compare_grids(made_up(0.004, 1.0), made_up(0.004, 1.0)).known);
  auto shorter = made_up(0.008, 1.0);
  shorter.history.pop_back();
  CHECK_FALSE(compare_grids(made_up(0.004, 1.0), shorter).known);

  StampingSpec coarse;
  coarse.blank.spacing = 30e-3;  // twice that is beyond an eighth of the blank
  const auto error = grid_error(coarse, make_fabric({}), {}, made_up(0.03, 1.0));
  CHECK_FALSE(error.known);
  CHECK_THAT(error.reason, Catch::Contains("blank.spacing"));
}

TEST_CASE("grid error: the companion has half the cells, rounded up, and is otherwise the same case",
          "[macroscale][grid_error]") {
  StampingSpec spec;  // 72 x 72
  CHECK(coarse_companion(spec).blank.spacing == Approx(0.32 / 36));
  spec.blank.size = {0.32, 0.28};  // 72 x 63 -> 36 x 32
  spec.blank.spacing = 0.32 / 72;
  CHECK(coarse_companion(spec).blank.spacing == Approx(0.32 / 36));
  CHECK(coarse_companion(spec).process.steps == spec.process.steps);
  CHECK(coarse_companion(spec).blank.size == spec.blank.size);
}

namespace {

StampingSpec small_case() {
  StampingSpec spec;
  spec.blank.spacing = 16e-3;
  spec.process.stroke = 40e-3;
  spec.process.time = 0.25;
  spec.process.steps = 10;
  return spec;
}

heddle::friction::Model coulomb() {
  heddle::friction::Model model;
  model.law = heddle::friction::Coulomb{0.3};
  return model;
}

}  // namespace

TEST_CASE("grid error: the companion of a small stamping is run and compared", "[macroscale][grid_error]") {
  const StampingSpec spec = small_case();
  const auto fabric = make_fabric({});
  const auto run = run_stamping(spec, fabric, coulomb());
  const GridError error = grid_error(spec, fabric, coulomb(), run);
  REQUIRE(error.known);
  CHECK(error.nodes == 11 * 11);
  CHECK(error.spacing[0] == Approx(0.032));
  CHECK(error.force >= std::abs(run.summary.peak_punch_force - error.companion_force));
  CHECK(error.force_share > 0.001);
  CHECK(error.force_share < 0.2);
}

TEST_CASE("grid error: of a small stamping, it covers what a grid twice as fine changes",
          "[macroscale][grid_error][slow]") {
  StampingSpec spec = small_case();
  const auto fabric = make_fabric({});
  const auto run = run_stamping(spec, fabric, coulomb());
  const GridError error = grid_error(spec, fabric, coulomb(), run);
  REQUIRE(error.known);
  spec.blank.spacing = 8e-3;
  const double fine = run_stamping(spec, fabric, coulomb()).summary.peak_punch_force;
  const double change = std::abs(fine - run.summary.peak_punch_force);
  WARN("32, 16, 8 mm: " << error.companion_force << ", " << run.summary.peak_punch_force << ", " << fine
                        << " N; grid error at 16 mm " << error.force << " N");
  CHECK(change > 1e-3 * fine);  // the grids do differ
  CHECK(change < error.force);
}
