// Stopping, keeping and going on: whatever interrupts a run, it ends with the same bits.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "macroscale/checkpoint.h"
#include "macroscale/stamping.h"
#include "tests/macroscale/kept_stamping.h"
#include "tests/macroscale/sample_fabric.h"
#include "tests/macroscale/sample_stamping.h"

using namespace heddle::macroscale;
using heddle::test::bytes_of;
using heddle::test::coarse_stamping;
using heddle::test::coulomb;
using heddle::test::from;
using heddle::test::Kept;
using heddle::test::make_fabric;
using heddle::test::run_and_keep;

namespace {

/// As stiff through the thickness as most tests have it, and so soft that the punch reaches its middle.
constexpr double firm = 5e8, soft = 2e7;  // [Pa/m]

Kept run(const StampingSpec& spec, StampingControl control = {}, double contact_stiffness = firm,
         const heddle::friction::Model& model = coulomb()) {
  return run_and_keep(
      spec, make_fabric({.rate_consistency = 5.0, .contact_stiffness = contact_stiffness, .table_end = 8e-4}),
      model, control);
}

/// Slip resistance that softens, and effects whose mu follows age and load times slip.
heddle::friction::Model with_slip_resistance() {
  heddle::friction::Model model;
  model.law = heddle::friction::SlipResistance{.length = 2e-3, .rate_exponent = 0.05};
  model.effects.dwell_ageing = heddle::friction::DwellAgeing{.amplitude = 0.1, .time = 0.02};
  model.effects.wear = heddle::friction::Wear{.amplitude = 0.2, .load_slip = 50.0};
  return model;
}

/// A film that follows the tool and is squeezed out, and a peak at the start of slip.
heddle::friction::Model with_film_memory() {
  heddle::friction::Model model;
  model.law = heddle::friction::HerseyPower{.scale = 0.325, .exponent = 0.136};
  model.effects.tool_temperature_film =
      heddle::friction::ToolTemperatureFilm{.weight = 0.8, .settling = 0.05};
  model.effects.static_peak = heddle::friction::StaticPeak{.amplitude = 0.3};
  model.effects.film_squeeze_out = heddle::friction::FilmSqueezeOut{.rate = 1e-4};
  return model;
}

/// Whether any contact of any tool has moved that number away from rest.
bool any_contact(const State& state, double heddle::friction::ContactState::*member) {
  return std::any_of(state.memory.begin(), state.memory.end(), [&](const auto& of_tool) {
    return std::any_of(of_tool.begin(), of_tool.end(), [&](const auto& m) { return m.*member != 0.0; });
  });
}

}  // namespace

TEST_CASE("a checkpoint keeps every bit of state, history, contact memory and picture",
          "[macroscale][checkpoint]") {
  StampingSpec spec = coarse_stamping(5);
  spec.process.steps = 3;
  const Kept kept = run(spec);
  REQUIRE(kept.checkpoints.size() == 5);  // binder closed, three steps, the end
  for (const std::string& bytes : kept.checkpoints) CHECK(bytes_of(from(bytes)) == bytes);
  const StampingCheckpoint last = from(kept.checkpoints.back());
  CHECK(last.step == 3);
  CHECK(last.blank.position == kept.result.final_state.position);
  CHECK(last.blank.pressure == kept.result.final_state.pressure);
  CHECK(last.history.back().work_punch == kept.result.history.back().work_punch);
  const auto& binder = last.state.memory[2];
  CHECK(
      std::any_of(binder.begin(), binder.end(), [](const auto& m) { return m.slip > 0.0 && m.dwell > 0.0; }));
}

TEST_CASE("a run that goes on from any of its checkpoints ends with the same bits",
          "[macroscale][checkpoint]") {
  const StampingSpec spec = coarse_stamping(5);
  static const Kept whole = run(spec);
  REQUIRE(whole.result.summary.completed);
  const std::size_t at = GENERATE(std::size_t{0}, 3, 5);  // 5: nothing left to do
  const StampingCheckpoint checkpoint = from(whole.checkpoints[at]);
  CHECK(checkpoint.step == static_cast<int>(at));
  std::vector<int> observed;
  StampingControl control;
  control.resume_from = &checkpoint;
  control.observe = [&](int step, int, const HistoryRow&, const BlankState&) { observed.push_back(step); };
  const Kept rest = run(spec, control);
  CHECK(rest.checkpoints.back() == whole.checkpoints.back());
  CHECK(rest.result.final_state.position == whole.result.final_state.position);
  CHECK(rest.result.summary.newton_iterations == whole.result.summary.newton_iterations);
  CHECK(rest.result.summary.energy_residual_max == whole.result.summary.energy_residual_max);
  CHECK(observed.size() == 5 - at);
}

TEST_CASE("friction with a memory goes on from a checkpoint to the same bits, and not without its memory",
          "[macroscale][checkpoint][friction]") {
  using heddle::friction::ContactState;
  const bool resistance = GENERATE(true, false);
  const heddle::friction::Model model = resistance ? with_slip_resistance() : with_film_memory();
  const StampingSpec spec = coarse_stamping(5);
  const Kept whole = run(spec, {}, firm, model);
  REQUIRE(whole.result.summary.completed);
  StampingCheckpoint checkpoint = from(whole.checkpoints[3]);
  for (const auto member : {&ContactState::slip, &ContactState::dwell, &ContactState::work_per_area})
    CHECK(any_contact(checkpoint.state, member));
  CHECK(any_contact(checkpoint.state, &ContactState::slip_resistance) == resistance);
  CHECK(any_contact(checkpoint.state, &ContactState::age) == resistance);
  CHECK(any_contact(checkpoint.state, &ContactState::load_slip) == resistance);
  CHECK(any_contact(checkpoint.state, &ContactState::film_temperature) != resistance);
  StampingControl control;
  control.resume_from = &checkpoint;
  CHECK(run(spec, control, firm, model).checkpoints.back() == whole.checkpoints.back());

  // The check can fail: forgotten memory is another run.
  const auto forgotten =
      resistance ? std::vector{&ContactState::slip_resistance, &ContactState::age, &ContactState::load_slip}
                 : std::vector{&ContactState::slip, &ContactState::dwell};
  for (const auto member : forgotten) {
    StampingCheckpoint poor = from(whole.checkpoints[3]);
    for (auto& of_tool : poor.state.memory)
      for (ContactState& m : of_tool) m.*member = 0.0;
    StampingControl from_poor;
    from_poor.resume_from = &poor;
    const Kept other = run(spec, from_poor, firm, model);
    CHECK(other.result.history.back().punch_force != whole.result.history.back().punch_force);
  }
}

TEST_CASE("a run stopped between Newton iterations keeps its last whole step, and goes on to the same bits",
          "[macroscale][checkpoint]") {
  const StampingSpec spec = coarse_stamping(5);
  int asked = 0;
  StampingControl counted;
  counted.stop = [&] { return ++asked, false; };
  const Kept whole = run(spec, counted);
  REQUIRE(asked > 30);
  for (const double share : {0.3, 0.9}) {
    int questions = 0;
    StampingControl control;
    control.stop = [&] { return ++questions >= share * asked; };
    const Kept stopped = run(spec, control);
    CHECK(stopped.result.summary.stopped);
    CHECK_FALSE(stopped.result.summary.completed);
    CHECK_FALSE(stopped.result.failure);
    const StampingCheckpoint checkpoint = from(stopped.checkpoints.back());
    CHECK(checkpoint.step < spec.process.steps);
    CHECK(stopped.result.history.size() == static_cast<std::size_t>(checkpoint.step));
    StampingControl resumed;
    resumed.resume_from = &checkpoint;
    CHECK(run(spec, resumed).checkpoints.back() == whole.checkpoints.back());
  }
  // Before the binder has closed there is nothing to keep.
  StampingControl at_once;
  at_once.stop = [] { return true; };
  const Kept nothing = run(spec, at_once);
  CHECK(nothing.result.summary.stopped);
  CHECK(nothing.checkpoints.empty());
}

TEST_CASE("a stamping that fails says where its last attempt stood, and what stood out of balance",
          "[macroscale][checkpoint]") {
  const StampingSpec spec = coarse_stamping(5);
  const Kept kept = run(spec, {}, soft);
  REQUIRE(kept.result.failure);
  REQUIRE_FALSE(kept.checkpoints.empty());
  const StampingFailure& failure = *kept.result.failure;
  CHECK(failure.reason == kept.result.summary.failure);
  CHECK(failure.step == from(kept.checkpoints.back()).step + 1);
  CHECK(failure.time_step > 0.0);
  const std::size_t nodes = kept.result.final_state.position.size();
  REQUIRE(failure.blank.position.size() == nodes);
  REQUIRE(failure.residual.size() == nodes);
  CHECK(failure.blank.position != kept.result.final_state.position);
  REQUIRE(failure.worst.size() == 10);
  CHECK(std::is_sorted(failure.worst.begin(), failure.worst.end(),
                       [](const auto& a, const auto& b) { return a.residual > b.residual; }));
  CHECK(failure.energies.size() == 10);
  CHECK(failure.not_finite.empty());
  // The same failure again, from the checkpoint it left.
  const StampingCheckpoint checkpoint = from(kept.checkpoints.back());
  StampingControl control;
  control.resume_from = &checkpoint;
  const Kept again = run(spec, control, soft);
  CHECK(again.result.summary.failure == kept.result.summary.failure);
  CHECK(again.result.final_state.position == kept.result.final_state.position);
  CHECK(again.result.summary.newton_iterations == kept.result.summary.newton_iterations);
}

TEST_CASE("a Newton search that runs out of iterations leaves its worst nodes behind",
          "[macroscale][checkpoint]") {
  // A blank that cannot close: the binder pushes it through its own middle at once.
  StampingSpec spec = coarse_stamping(5);
  spec.process.binder_force = 3e5;
  const Kept kept = run(spec, {}, soft);
  REQUIRE(kept.result.failure);
  CHECK(kept.result.failure->step == 0);
  CHECK(kept.checkpoints.empty());
  CHECK_THAT(kept.result.summary.failure, Catch::Contains("closing the binder"));
  CHECK(kept.result.failure->residual.size() == kept.result.final_state.position.size());
}

TEST_CASE("a checkpoint of another blank or another number of steps is refused",
          "[macroscale][checkpoint][wrong input]") {
  StampingSpec spec = coarse_stamping(5);
  spec.process.steps = 2;
  const Kept kept = run(spec);
  const StampingCheckpoint checkpoint = from(kept.checkpoints.back());
  StampingControl control;
  control.resume_from = &checkpoint;
  StampingSpec finer = spec;
  finer.blank.spacing = 25e-3;
  CHECK_THROWS_WITH(run(finer, control), Catch::Contains("another blank"));
  StampingSpec shorter = spec;
  shorter.process.steps = 1;
  CHECK_THROWS_WITH(run(shorter, control), Catch::Contains("step 2"));
}
