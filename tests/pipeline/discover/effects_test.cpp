// Every effect of the library as discovery sees it: off is the baseline bit for bit, and small is linear.
#include <catch2/catch.hpp>
#include <cmath>
#include <set>

#include "core/text_file.h"
#include "pipeline/discover/coupon_forward.h"
#include "pipeline/discover/map_fit.h"
#include "shipped_question.h"

using namespace heddle;
using namespace heddle::discover;

namespace {

std::vector<CouponCell> pulled_cells() {
  std::vector<CouponCell> cells = test::crossed_cells();
  for (CouponCell& cell : cells)
    for (int k = 0; k < 4; ++k)
      cell.points.push_back({.stretch = k,
                             .steady = false,
                             .slip = 5e-4 * std::pow(4.0, k),
                             .normal_force = cell.pull.normal_force,
                             .log_force = 0.0});
  return cells;
}

}  // namespace

TEST_CASE("the library holds every id of the house that acts now, each from its own file",
          "[discover][effects]") {
  std::set<std::string> ids;
  for (const EffectFile& effect : built_in_effects()) ids.insert(effect.id);
  CHECK(ids.size() == 36);  // F1 to F15, R1 to R6, M1 to M5, M7, M8, P1 to P7, discretisation
  for (const char* id : {"tool_temperature_film", "boundary_lubrication", "mislabelled_condition",
                         "shear_rate", "inertia", "discretisation"})
    CHECK(ids.contains(id));
  CHECK(built_in_effects().front().id == "tool_temperature_film");  // in library order
}

TEST_CASE("an effect at its off value predicts the baseline bit for bit, and grows linearly from there",
          "[discover][effects][invariant]") {
  const CouponQuestion question = test::shipped_question();
  const std::vector<CouponCell> cells = pulled_cells();
  const std::vector<EffectFile> usable = usable_effects(question.base, question.effects);
  const ForwardModel forward =
      coupon_forward(question.base, question.rig, cells, question.baseline, usable, 4);
  CHECK(usable.size() == 20);  // all of friction, and of the rig all but the choice of a label
  const auto free_baseline = std::ssize(free_numbers(forward, {}));
  const Eigen::VectorXd base = forward.predict(trial_at(forward, {}, Eigen::VectorXd::Zero(free_baseline)));
  REQUIRE(base.allFinite());
  for (std::size_t e = 0; e < usable.size(); ++e) {
    CAPTURE(usable[e].id);
    Eigen::VectorXd z = Eigen::VectorXd::Zero(std::ssize(free_numbers(forward, {e})));
    const auto at = [&](double amplitude) {
      z[free_baseline] = amplitude;
      return forward.predict(trial_at(forward, {e}, z));
    };
    CHECK(at(0.0) == base);
    const Eigen::VectorXd small = at(1e-6) - base, twice = at(2e-6) - base;
    CHECK(small.norm() > 0.0);
    // The pressure contrast acts by its square: both halves of a plate cancel to first order.
    const double order = usable[e].id == "nonuniform_pressure" ? 4.0 : 2.0;
    if (order == 2.0) CHECK((twice - order * small).norm() < 0.01 * twice.norm());
  }
}

TEST_CASE("an effect file says what is wrong with it, all at once", "[discover][effects][bad]") {
  const auto rules = [](const std::string& text) {
    std::set<std::string> ids;
    try {
      read_effect(text, "own.yaml");
    } catch (const InputError& error) {
      for (const Problem& problem : error.problems()) ids.insert(problem.id);
    }
    return ids;
  };
  CHECK(rules("id: x\n") == std::set<std::string>{"discover.effect.missing"});
  const std::string head = "id: x\nstage: film\nform: f\nsource: s\n";
  CHECK(rules(head + "parameters:\n  a: {unit: \"\", prior: \"half-normal, scale 1\", off: 0}\n").empty());
  CHECK(rules(head + "parameters:\n  a: {unit: \"\", prior: \"half-normal, scale 1\"}\n") ==
        std::set<std::string>{"discover.effect.off"});
  CHECK(rules(head + "parameters:\n  a: {unit: \"\", prior: \"normal, mean 1, sd 1\", off: 0}\n") ==
        std::set<std::string>{"discover.effect.centre"});
  CHECK(rules(head + "colour: red\nparameters:\n  a: {unit: \"\", prior: \"flat\", off: 0}\n") ==
        std::set<std::string>{"discover.effect.unknown", "discover.effect.prior"});
  CHECK(rules("id: x\nstage: moon\nform: f\nsource: s\nparameters:\n  a: {unit: \"\", prior: \"half-normal, "
              "scale "
              "1\", off: 0}\n") == std::set<std::string>{"discover.effect.stage"});
}

TEST_CASE("a prediction is the friction test's own force", "[discover][effects]") {
  CouponQuestion question = test::shipped_question();
  question.base.effects.static_peak = friction::StaticPeak{.amplitude = 0.3, .length = 2e-3};
  const std::vector<CouponCell> cells = pulled_cells();
  const ForwardModel forward = coupon_forward(question.base, question.rig, cells, {}, {}, 4);
  const Eigen::VectorXd predicted = forward.predict({.baseline = Eigen::VectorXd(), .effects = {}});
  Eigen::Index row = 0;
  for (const CouponCell& cell : cells)
    for (const CouponPoint& point : cell.points) {
      friction::FrictionRig rig = question.rig.rig;
      rig.pull_length = point.slip;
      rig.dwell_before = cell.dwell;
      CHECK(std::exp(predicted[row++]) ==
            Approx(friction::run_friction_test(question.base, cell.pull, rig).pull_force).epsilon(1e-12));
    }
}
