// Friction between tows as a share of the shear resistance: the law of one corner, and of whole sheets.
#include "macroscale/shear_friction.h"

#include <catch2/catch.hpp>

#include <cmath>
#include <numbers>
#include <random>

#include "macroscale/checkpoint.h"
#include "macroscale/ledger.h"
#include "macroscale/stamping.h"
#include "tests/derivative_check.h"
#include "tests/macroscale/diagonal_net.h"
#include "tests/macroscale/kept_stamping.h"
#include "tests/macroscale/quasi_static.h"
#include "tests/macroscale/sample_fabric.h"

using namespace heddle::macroscale;
using Eigen::VectorXd;
using heddle::Curve;
using heddle::test::derivative_gap;
using heddle::test::in_frame;
using heddle::test::make_fabric;
using heddle::test::observed_order;
using heddle::test::run_steps;

namespace {

// Soft, then locking, with a toe: its slope falls before it rises.
Curve locking_curve() {
  std::vector<double> s, y;
  for (int k = 0; k <= 60; ++k) {
    s.push_back(0.95 * k / 60.0);
    y.push_back(30.0 * std::tanh(8.0 * s.back()) + 400.0 * std::pow(s.back(), 6.0));
  }
  return {s, y};
}

const ShearFriction third{1.0 / 3.0, 2.0};

struct Walk {
  ShearMemory memory;
  double work = 0.0, dissipated = 0.0;
};

void go(const ShearFriction& law, const Curve& curve, Walk& walk, double s) {
  const ShearMemory reached = sheared_to(law, curve, walk.memory, s);
  walk.work += tow_friction(law, curve, walk.memory, s).energy;
  walk.dissipated += dissipated_by_tows(law, curve, walk.memory, reached);
  walk.memory = reached;
}

void go_in(int steps, const ShearFriction& law, const Curve& curve, Walk& walk, double s) {
  const double from = walk.memory.sine;
  for (int k = 1; k <= steps; ++k) go(law, curve, walk, k == steps ? s : from + (s - from) * k / steps);
}

}  // namespace

TEST_CASE("stress of tow friction is the slope of its work, its tangent the slope of the stress",
          "[macroscale][hysteresis][derivative]") {
  const Curve curve = locking_curve();
  Walk walk;
  go(third, curve, walk, 0.7);
  go(third, curve, walk, 0.68);
  // Springing back, at the limit, and beyond all shear so far on both sides.
  for (const double s : {0.675, 0.2, -0.4, 0.8, -0.85}) {
    CAPTURE(s);
    const CornerScalar at = tow_friction(third, curve, walk.memory, s);
    const auto energy = [&](double x) { return tow_friction(third, curve, walk.memory, x).energy; };
    const auto stress = [&](double x) { return tow_friction(third, curve, walk.memory, x).first; };
    CHECK(derivative_gap(energy, s, 1e-3, at.first) < 1e-7);
    CHECK(derivative_gap(energy, s, 1e-3, 1.01 * at.first) > 1e-4);
    CHECK(derivative_gap(stress, s, 1e-3, at.second) < 1e-6);
    if (at.second != 0.0) CHECK(derivative_gap(stress, s, 1e-3, 1.01 * at.second) > 1e-4);
  }
  CHECK(tow_friction(third, curve, walk.memory, 0.675).second > 0.0);
  CHECK(tow_friction(third, curve, walk.memory, 0.2).second == 0.0);
}

TEST_CASE("stress of tow friction is continuous where reversal, limit and first loading meet",
          "[macroscale][hysteresis]") {
  const Curve curve = locking_curve();
  std::mt19937 random(3);
  std::uniform_real_distribution<double> place(-0.9, 0.9);
  Walk walk;
  for (int k = 0; k < 200; ++k) {
    go(third, curve, walk, place(random) * std::min(1.0, 0.05 * (k + 1)));
    for (const double edge : {walk.memory.widest, -walk.memory.widest, walk.memory.sine}) {
      const double below = tow_friction(third, curve, walk.memory, edge - 1e-11).first,
                   above = tow_friction(third, curve, walk.memory, edge + 1e-11).first;
      CHECK(std::abs(above - below) < 1e-6);
    }
  }
}

TEST_CASE("first loading follows the fabric's own curve whatever share of it is friction, in any steps",
          "[macroscale][hysteresis]") {
  const auto fabric = make_fabric({});
  auto locking = fabric;
  locking.shear_stress = locking_curve();
  for (const double share : {0.1, 0.5, 0.99})
    for (const int steps : {1, 7, 100})
      for (const double side : {1.0, -1.0}) {
        const ShearFriction law{share, 1.0};
        Walk walk;
        for (int k = 1; k <= steps; ++k) {
          const double s = side * 0.9 * k / steps;
          const double friction = tow_friction(law, locking.shear_stress, walk.memory, s).first;
          const double whole = (1.0 - share) * side * locking.shear_stress(std::abs(s)) + friction;
          CHECK(whole == Approx(side * locking.shear_stress(std::abs(s))).epsilon(1e-12));
          go(law, locking.shear_stress, walk, s);
        }
        CHECK(walk.work == Approx(share * locking.shear_stress.integral(0.9)).epsilon(1e-12));
      }
}

TEST_CASE("a cycle dissipates 4 q (A - q / K) per area, in any number of steps, and every one the same",
          "[macroscale][hysteresis]") {
  const Curve curve = locking_curve();
  constexpr double amplitude = 0.6;
  for (const int steps : {1, 3, 50}) {
    Walk walk;
    go_in(steps, third, curve, walk, amplitude);
    const double q = third.share * curve(amplitude);
    CHECK(walk.memory.stress == Approx(q).epsilon(1e-12));
    const double loop = 4.0 * q * (amplitude - q / walk.memory.stiffness);
    for (int cycle = 0; cycle < 20; ++cycle) {
      const Walk before = walk;
      go_in(steps, third, curve, walk, -amplitude);
      go_in(steps, third, curve, walk, amplitude);
      CHECK(walk.dissipated - before.dissipated == Approx(loop).epsilon(1e-10));
      CHECK(walk.work - before.work == Approx(loop).epsilon(1e-10));
      CHECK(walk.memory.stress == Approx(q).epsilon(1e-12));
      CHECK(walk.memory.stiffness == before.memory.stiffness);
    }
  }
}

TEST_CASE("cycles between any two shears come back to the same stress: nothing ratchets",
          "[macroscale][hysteresis]") {
  const Curve curve = locking_curve();
  Walk walk;
  go(third, curve, walk, 0.8);
  for (const double low : {0.79, 0.6, -0.3}) {
    go(third, curve, walk, low);
    const double at_low = walk.memory.stress;
    for (int cycle = 0; cycle < 100; ++cycle) {
      go_in(3, third, curve, walk, 0.7);
      go_in(2, third, curve, walk, low);
    }
    CHECK(walk.memory.stress == Approx(at_low).epsilon(1e-10));
    go(third, curve, walk, 0.8);
  }
}

TEST_CASE("on random ways tows never give energy, work is what is stored and what is lost, and mirrors agree",
          "[macroscale][hysteresis]") {
  const Curve curve = locking_curve();
  std::mt19937 random(5);
  std::uniform_real_distribution<double> place(-0.93, 0.93), part(0.02, 0.95), stiff(1.0, 20.0);
  double most = 0.0;
  for (int run = 0; run < 200; ++run) {
    const ShearFriction law{part(random), stiff(random)};
    Walk walk, mirrored;
    double reach = 0.05;
    for (int k = 0; k < 60; ++k) {
      reach = std::min(1.0, reach * 1.1);
      const double s = reach * place(random);
      const Walk before = walk;
      go(law, curve, walk, s);
      go(law, curve, mirrored, -s);
      const double stored = stored_in_crossovers(walk.memory) - stored_in_crossovers(before.memory);
      const double work = walk.work - before.work, lost = walk.dissipated - before.dissipated;
      REQUIRE(lost >= -1e-12);
      REQUIRE(std::abs(work - stored - lost) <= 1e-11);
      REQUIRE(std::abs(walk.memory.stress) <= law.share * curve(walk.memory.widest) * (1.0 + 1e-12));
      REQUIRE(mirrored.memory.stress == -walk.memory.stress);
      most = std::max(most, lost);
    }
  }
  CHECK(most > 1.0);  // else the check had nothing to look at
}

TEST_CASE("what turns back inside a step is missed in second order of the step", "[macroscale][hysteresis]") {
  const Curve curve = locking_curve();
  const auto lost = [&](int steps) {
    Walk walk;
    for (int k = 1; k <= steps; ++k)  // two and a half periods; turning points fall between the steps
      go(third, curve, walk, 0.7 * std::sin(5.0 * std::numbers::pi * k / steps + 0.3) - 0.7 * std::sin(0.3));
    return walk.dissipated;
  };
  const double fine = lost(400000);
  double order = 0.0;  // turning points fall on steps by chance: the mean over many
  constexpr int many = 12;
  double coarse = 0.0, halved = 0.0;
  for (int k = 0; k < many; ++k) {
    coarse += std::abs(lost(97 + 2 * k) - fine);
    halved += std::abs(lost(2 * (97 + 2 * k) + 1) - fine);
  }
  order = observed_order(coarse, halved);
  CHECK(order > 1.7);
  CHECK(order < 2.4);
}

TEST_CASE("a picture frame to and fro loses the closed-form area of the loop, and its ledger says so",
          "[macroscale][hysteresis]") {
  constexpr double side = 0.1, angle = 0.6;
  auto fabric = make_fabric({.bending = 1e-9});
  fabric.shear_stress = locking_curve();
  Scene scene;
  scene.blank = make_blank({side, side}, 0.02);
  scene.fabric = &fabric;
  scene.shear_rate = 0.0;
  scene.shear_friction = third;
  scene.held.assign(3 * scene.blank.nodes(), 1);
  System system(scene);
  State state = initial_state(scene);
  StepLedger sum;
  const auto drive_to = [&](double from, double to, int steps) {
    const double begin = state.time;
    run_steps(
        system, state, 1.0, steps,
        [&](double time, VectorXd& x) {
          const double at = from + (to - from) * (time - begin) / steps;
          for (int i = 0; i < scene.blank.nodes(); ++i)
            x.segment<3>(3 * i) = in_frame(scene.blank.reference[i], at);
        },
        [&](const StepData& step, const State& end) {
          const StepLedger l = account(system, step, end).ledger;
          sum.shear += l.shear;
          sum.shear_hysteresis += l.shear_hysteresis;
          sum.numerical += l.numerical;
          sum.work_held += l.work_held;
          CHECK(l.shear_hysteresis >= -1e-15);
        });
    state.v.setZero();
  };
  drive_to(0.0, angle, 10);
  const double stored = (1.0 - third.share) * fabric.shear_stress.integral(std::sin(angle)) * side * side +
                        stored_in_crossovers(state.shear_memory.front()) * side * side;
  CHECK(sum.shear == Approx(stored).epsilon(1e-9));
  const double q = third.share * fabric.shear_stress(std::sin(angle)),
               k = state.shear_memory.front().stiffness;
  sum = {};
  drive_to(angle, -angle, 25);
  drive_to(-angle, angle, 25);
  CHECK(sum.shear_hysteresis == Approx(4.0 * q * (std::sin(angle) - q / k) * side * side).epsilon(1e-9));
  CHECK(std::abs(sum.shear) < 1e-9 * sum.shear_hysteresis);
  // Supports do what is lost, and what backward Euler loses beside it.
  CHECK(sum.work_held == Approx(sum.shear_hysteresis + sum.numerical).epsilon(1e-6));
}

TEST_CASE("let go, a sheared sheet springs back to where its spring and its friction balance",
          "[macroscale][hysteresis]") {
  constexpr double angle = 0.6;
  auto fabric = make_fabric({.bending = 1e-9});
  fabric.shear_stress = locking_curve();
  double before = -1e-3;
  for (const double share : {0.0, 0.1, 0.3, 0.45, 0.7}) {
    CAPTURE(share);
    Scene scene;
    scene.blank = make_blank({0.06, 0.06}, 0.02);
    scene.fabric = &fabric;
    scene.shear_rate = 0.0;
    scene.shear_friction = {share, 2.0};
    scene.held.assign(3 * scene.blank.nodes(), 1);
    System system(scene);
    State state = initial_state(scene);
    heddle::test::run_at_rest(system, state, 1.0, 5, {}, [&](double time, VectorXd& x) {
      for (int i = 0; i < scene.blank.nodes(); ++i)
        x.segment<3>(3 * i) = in_frame(scene.blank.reference[i], angle * std::min(time, 5.0) / 5.0);
    });
    // Balance: (1 - f) Psi'(s) + q(s) = 0 on the way back from sin(angle).
    const auto left_over = [&](double s) {
      const double friction =
          share > 0.0
              ? tow_friction(scene.shear_friction, fabric.shear_stress, state.shear_memory.front(), s).first
              : 0.0;
      return (1.0 - share) * fabric.shear_stress(s) + friction;
    };
    double low = 0.0, high = std::sin(angle);
    for (int k = 0; k < 60; ++k) (left_over(0.5 * (low + high)) > 0.0 ? high : low) = 0.5 * (low + high);
    // Now held in its plane only where it would move or turn as a whole.
    for (int i = 0; i < scene.blank.nodes(); ++i) scene.held[3 * i] = scene.held[3 * i + 1] = i == 0;
    scene.held[3 * scene.blank.node(3, 0) + 1] = 1;
    SolveOptions exact;
    exact.force_tolerance = 1e-9;
    heddle::test::run_at_rest(system, state, 0.02, 80, {}, {}, {}, exact);
    for (const double left : state.corner_angle)
      CHECK(std::abs(left) == Approx(std::asin(high)).margin(2e-4));
    CHECK(std::asin(high) > before + 1e-3);  // more friction, more of the angle stays
    before = std::asin(high);
  }
}

namespace {

StampingSpec small_case(double share) {
  StampingSpec spec;
  spec.blank.spacing = 16e-3;  // 21 x 21 nodes
  spec.process.stroke = 40e-3;
  spec.process.time = 0.25;
  spec.process.steps = 12;
  spec.shear_friction.share = share;
  return spec;
}

heddle::friction::Model coulomb() {
  heddle::friction::Model model;
  model.law = heddle::friction::Coulomb{0.3};
  return model;
}

heddle::mesoscale::FabricProperties locking_fabric() {
  auto fabric = make_fabric({.rate_consistency = 5.0});
  fabric.shear_stress = locking_curve();
  return fabric;
}

struct Formed {
  StampingResult result;
  StampingCheckpoint last;
};

Formed form(const StampingSpec& spec, const heddle::mesoscale::FabricProperties& fabric) {
  Formed formed;
  StampingControl control;
  control.keep = [&](const StampingCheckpoint& c, bool last) {
    if (last) formed.last = c;
  };
  formed.result = run_stamping(spec, fabric, coulomb(), control);
  return formed;
}

}  // namespace

TEST_CASE(
    "friction between tows takes its share of the work of a stamping and leaves its force where little turns "
    "back",
    "[macroscale][hysteresis][stamping][long]") {
  const auto fabric = locking_fabric();
  double force = 0.0;
  for (const double share : {0.0, 0.45}) {
    CAPTURE(share);
    const StampingSpec spec = small_case(share);
    const Formed formed = form(spec, fabric);
    REQUIRE(formed.result.summary.completed);
    CHECK(formed.result.summary.energy_residual_max < 0.01);
    const HistoryRow& last = formed.result.history.back();
    CHECK((share > 0.0) == (last.dissipation_shear_hysteresis > 0.0));
    WARN("share " << share << ": " << last.punch_force << " N, " << last.dissipation_shear_hysteresis
                  << " J, shear " << last.energy_shear << " J");
    if (share > 0.0) {
      CHECK(last.punch_force == Approx(force).epsilon(0.02));
    } else {
      force = last.punch_force;
    }
  }
}

TEST_CASE("a stamping whose tows rub goes on from a checkpoint to the same bits",
          "[macroscale][hysteresis][checkpoint]") {
  const auto fabric = locking_fabric();
  const StampingSpec spec = small_case(0.3);
  StampingCheckpoint middle;
  StampingControl control;
  control.keep = [&](const StampingCheckpoint& c, bool last) {
    if (!last && c.step == 9) middle = c;
  };
  const StampingResult whole = run_stamping(spec, fabric, coulomb(), control);
  REQUIRE(middle.step == 9);
  REQUIRE(middle.state.shear_memory.size() == middle.state.corner_angle.size());
  middle = heddle::test::from(heddle::test::bytes_of(middle));
  StampingControl again;
  again.resume_from = &middle;
  const StampingResult resumed = run_stamping(spec, fabric, coulomb(), again);
  CHECK(resumed.final_state.position == whole.final_state.position);
  CHECK(resumed.history.back().dissipation_shear_hysteresis ==
        whole.history.back().dissipation_shear_hysteresis);
  middle.state.shear_memory.clear();
  CHECK_THROWS_WITH(run_stamping(spec, fabric, coulomb(), again), Catch::Contains("friction between tows"));
}
