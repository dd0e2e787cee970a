#include <catch2/catch.hpp>

#include <limits>
#include <set>

#include "macroscale/advice.h"
#include "tests/macroscale/sample_fabric.h"

using namespace heddle::macroscale;
using heddle::test::make_fabric;

namespace {

StampingSpec small_case() {
  StampingSpec spec;
  spec.blank.spacing = 20e-3;  // 17 x 17 nodes
  spec.process.stroke = 40e-3;
  spec.process.time = 0.25;
  spec.process.steps = 20;
  return spec;
}

StampingResult run(const StampingSpec& spec, double coefficient, double contact_stiffness, double table_end) {
  heddle::friction::Model model;
  model.law = heddle::friction::Coulomb{coefficient};
  return run_stamping(spec, make_fabric({.contact_stiffness = contact_stiffness, .table_end = table_end}),
                      model);
}

std::string advice(const StampingSpec& spec, const StampingResult& result) {
  return advice_for(*result.failure, spec, result.summary);
}

}  // namespace

TEST_CASE(
    "a punch that reaches the fabric's middle is told of room between the tools, and of the stroke before",
    "[macroscale][advice]") {
  const StampingSpec spec = small_case();
  const StampingResult result = run(spec, 0.3, 2e7, 8e-4);
  REQUIRE(result.failure);
  CHECK(result.failure->kind == FailureKind::pressed_through);
  CHECK_THAT(advice(spec, result), Catch::Contains("no room") && Catch::Contains("process.punch.stroke='") &&
                                       Catch::Contains("process.binder_force='195 N'"));
}

TEST_CASE("a binder that presses through its blank is told of its force before anything else",
          "[macroscale][advice]") {
  StampingSpec spec = small_case();
  spec.process.binder_force = 3e5;  // 4 MPa, and the table ends at 0.25 MPa
  const StampingResult result = run(spec, 0.3, 5e8, 5e-4);
  REQUIRE(result.failure);
  CHECK(result.failure->step == 0);
  CHECK_THAT(advice(spec, result),
             Catch::Contains("before the punch moves") && Catch::Contains("process.binder_force='9e+04 N'"));
}

TEST_CASE("friction that is no number ends the run, keeps what was reached and points at laws and tables",
          "[macroscale][advice]") {
  const StampingSpec spec = small_case();
  const StampingResult result = run(spec, std::numeric_limits<double>::quiet_NaN(), 5e8, 5e-4);
  CHECK_FALSE(result.summary.completed);
  REQUIRE(result.failure);
  CHECK(result.failure->kind == FailureKind::not_finite);
  CHECK(result.final_state.position.size() == 17 * 17);
  CHECK_THAT(advice(spec, result), Catch::Contains("tables read from files"));
}

TEST_CASE("every way to fail has an advice of its own, another one while the binder closes",
          "[macroscale][advice]") {
  const StampingSpec spec = small_case();
  std::set<std::string> advices;
  StampingFailure failure;
  StampingSummary summary;
  for (const int step : {0, 7})
    for (const auto kind :
         {FailureKind::search, FailureKind::indefinite, FailureKind::friction_loads, FailureKind::folded,
          FailureKind::pressed_through, FailureKind::lost_tool, FailureKind::not_finite}) {
      failure.step = step;
      failure.kind = kind;
      advices.insert(advice_for(failure, spec, summary));
    }
  CHECK(advices.size() == 7 + 4);  // four kinds share one before the punch moves
  failure.kind = FailureKind::search;
  summary.falling_branch = true;
  CHECK_THAT(advice_for(failure, spec, summary), Catch::Contains("falls with speed"));
}
