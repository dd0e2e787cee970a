// Stampings of several plies.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <tbb/global_control.h>

#include "macroscale/checkpoint.h"
#include "macroscale/ply_state.h"
#include "macroscale/stamping.h"
#include "macroscale/stamping_scene.h"
#include "tests/macroscale/kept_stamping.h"
#include "tests/macroscale/random_stampings.h"
#include "tests/macroscale/sample_fabric.h"
#include "tests/macroscale/sample_stamping.h"

using namespace heddle::macroscale;
using heddle::test::bytes_of;
using heddle::test::coulomb;
using heddle::test::Kept;
using heddle::test::make_fabric;
using heddle::test::run_and_keep;

namespace {

constexpr double degree = std::numbers::pi / 180.0;

StampingSpec small_case(const std::vector<double>& layup_in_degrees) {
  StampingSpec spec = heddle::test::coarse_stamping(5);
  spec.blank.plies = static_cast<int>(layup_in_degrees.size());
  for (const double angle : layup_in_degrees) spec.blank.layup.push_back(angle * degree);
  return spec;
}

Kept run(const StampingSpec& spec, StampingControl control = {}) {
  return run_and_keep(spec, make_fabric({.rate_consistency = 5.0, .table_end = 8e-4}), coulomb(), control);
}

}  // namespace

TEST_CASE(
    "a stamping of two plies closes its ledger and its force balance, and goes on from a checkpoint or "
    "on one thread to the same bits",
    "[macroscale][plies][stamping][checkpoint]") {
  const StampingSpec spec = small_case({0.0, 45.0});
  const Kept whole = run(spec);
  const StampingSummary& s = whole.result.summary;
  REQUIRE(s.completed);
  CHECK(s.energy_residual_max < 0.01);
  CHECK(s.force_balance_residual_max < 1e-3);
  REQUIRE(s.stack);
  CHECK(s.stack->interfaces.size() == 1);
  for (const InterfaceSummary& between : s.stack->interfaces) {
    CHECK(between.slip_max > between.slip_mean);
    CHECK(between.slip_mean > 0.0);
  }
  CHECK(whole.result.history.back().friction_plies > 0.0);
  // The check can fail: without the heat of the plies the ledger is open.
  CHECK(whole.result.history.back().friction_plies > 0.01 * whole.result.history.back().work_punch);

  const StampingCheckpoint checkpoint = heddle::test::from(whole.checkpoints[2]);
  CHECK((bytes_of(checkpoint) == whole.checkpoints[2]));
  StampingControl control;
  control.resume_from = &checkpoint;
  CHECK((run(spec, control).checkpoints.back() == whole.checkpoints.back()));

  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  CHECK((run(spec).checkpoints.back() == whole.checkpoints.back()));
}

TEST_CASE("a binder at a gap stands that far off the die, however the plies between face each other",
          "[macroscale][plies][stamping]") {
  StampingSpec spec = small_case({0.0, 0.0});
  spec.binder.control = BinderControl::gap;
  auto fabric = make_fabric({});
  const heddle::friction::Model law;
  const auto softer = make_fabric({.contact_stiffness = 2.5e8});
  for (const bool facing : {false, true}) {
    if (facing) fabric.facing = {0.8 * fabric.thickness, softer.compaction.curves().front()};
    const double stack = fabric.thickness + ply_rest(fabric, 0.0);
    // Pressed, just touched, wider than the stack, and nearer than its tables reach.
    for (const double gap : {0.9 * stack, stack, 1.3 * stack, 0.1 * stack}) {
      CAPTURE(facing, gap / stack);
      spec.binder.gap = gap;
      const Scene scene = stamping_scene(spec, fabric, law);
      const auto level = [&](Role role) {
        const auto tool = std::find_if(scene.tools.begin(), scene.tools.end(),
                                       [&](const Tool& t) { return t.role == role; });
        return std::get<RingShape>(tool->shape).level;
      };
      CHECK(level(Role::binder) - level(Role::die) == Approx(gap).epsilon(1e-9));
    }
  }
}

TEST_CASE("each ply of a state stands for itself", "[macroscale][plies][stamping]") {
  StampingSpec spec = small_case({0.0, 30.0});
  spec.process.steps = 1;
  spec.process.stroke = 1e-3;
  const BlankState state = run(spec).result.final_state;
  REQUIRE(ply_count(state) == 2);
  std::size_t nodes = 0, quads = 0, edges = 0;
  for (int k = 0; k < 2; ++k) {
    const BlankState ply = ply_of(state, k);
    CHECK(ply.grid.size() == ply.position.size());
    for (const auto& quad : ply.quads)
      for (const int node : quad) CHECK((node >= 0 && node < static_cast<int>(ply.position.size())));
    for (std::size_t n = 0; n < ply.position.size(); ++n) CHECK(ply.position[n] == state.position[nodes + n]);
    nodes += ply.position.size();
    quads += ply.quads.size();
    edges += ply.edge.size();
  }
  CHECK(nodes == state.position.size());
  CHECK(quads == state.quads.size());
  CHECK(edges == state.edge.size());
}

TEST_CASE("a stack and its mirror image need the same force", "[macroscale][plies][stamping][invariant]") {
  const auto force = [](const std::vector<double>& layup) {
    StampingSpec spec = small_case(layup);
    spec.process.stroke = 15e-3;
    spec.process.time = 0.09;
    spec.process.steps = 3;
    const StampingResult result = run(spec).result;
    REQUIRE(result.summary.completed);
    return result.summary.peak_punch_force;
  };
  const double one = force({30.0, -30.0}), mirrored = force({-30.0, 30.0});
  CHECK(mirrored == Approx(one).epsilon(1e-4));
  CHECK(std::abs(force({30.0, 0.0}) / one - 1.0) > 1e-3);  // another stack needs another force
}

TEST_CASE("two plies that slip freely take twice the force of one", "[macroscale][plies][stamping][long]") {
  const auto force = [](int plies) {
    StampingSpec spec = small_case(std::vector<double>(static_cast<std::size_t>(plies), 0.0));
    spec.blank.spacing = 25e-3;
    spec.process.stroke = 24e-3;
    spec.process.steps = 4;
    const StampingResult result = run_stamping(spec, make_fabric({}), coulomb(1e-6));
    REQUIRE(result.summary.completed);
    return result.summary.peak_punch_force;
  };
  const double one = force(1), two = force(2);
  WARN("two plies without friction: " << two / one << " times the force of one");
  CHECK(two / one == Approx(2.0).epsilon(0.1));
}

// Drawn as the random stampings of one ply are, with two to four plies of a few hundred nodes in all.
TEST_CASE("random stampings of two to four plies of any lay-up come to their end",
          "[macroscale][plies][robustness][slow]") {
  const heddle::mesoscale::FabricProperties fabric =
      heddle::mesoscale::analyse(heddle::mesoscale::CellSpec{}).fabric;
  const int number = GENERATE(0, 1, 2, 3, 4, 5, 6, 7, 8, 9);
  heddle::test::RandomStamping stamping = heddle::test::random_stamping(number, fabric);
  heddle::test::Draw draw(0x9119u + static_cast<std::uint64_t>(number));
  BlankSpec& blank = stamping.spec.blank;
  blank.plies = 2 + number % 3;
  for (int k = 0; k < blank.plies; ++k) blank.layup.push_back(draw.even(-0.5, 0.5) * std::numbers::pi);
  const double extent = blank.shape == BlankShape::circle ? 2.0 * blank.radius : blank.size[0];
  blank.spacing = extent / 17.0;
  const double room = stack_thickness(blank, fabric.thickness) + 0.5e-3;
  stamping.spec.die.opening_radius = stamping.spec.punch.radius + room;
  stamping.spec.binder.inner_radius = stamping.spec.die.opening_radius + stamping.spec.die.fillet;
  const heddle::test::RobustnessVerdict verdict = heddle::test::run(stamping);
  INFO("case " << number << ": " << verdict.failure);
  CHECK(verdict.finished);
  CHECK(verdict.energy_residual < 0.01);
  CHECK(verdict.force_balance < 1e-3);
  const StampingSummary& s = verdict.summary;
  WARN("case " << number << ": " << blank.plies << " plies, " << s.nodes << " nodes, " << s.newton_iterations
               << " Newton iterations, " << s.rejected_steps << " steps tried again, ledger "
               << verdict.energy_residual << ", balance " << verdict.force_balance);
}
