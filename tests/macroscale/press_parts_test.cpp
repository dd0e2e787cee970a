// Pieces of a press by themselves: drives, shapes, weight, what the numbers admit.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

#include "macroscale/closing.h"
#include "macroscale/ledger.h"
#include "macroscale/punch_profile.h"
#include "macroscale/stamping_scene.h"
#include "macroscale/tool_drive.h"
#include "tests/derivative_check.h"
#include "tests/macroscale/quasi_static.h"
#include "tests/macroscale/sample_fabric.h"

using namespace heddle::macroscale;
using Eigen::Vector3d;
using heddle::test::derivative_gap;
using heddle::test::make_fabric;

namespace {

Scene strip_of_fabric(const heddle::mesoscale::FabricProperties& fabric, std::array<double, 2> size,
                      double spacing) {
  Scene scene;
  scene.blank = make_blank(size, spacing * (1.0 + 1e-6));
  scene.fabric = &fabric;
  scene.shear_rate = false;
  scene.load = weight_of_fabric(scene);
  return scene;
}

double largest_of(const Eigen::VectorXd& x, int component) {
  double largest = -1e9;
  for (Eigen::Index k = component; k < x.size(); k += 3) largest = std::max(largest, x[k]);
  return largest;
}

struct Supports {
  double die = 0.0, binder = 0.0;  ///< vertical force of each on the fabric, away from the tool [N]
};

Supports supports(const System& system, const State& state) {
  Supports sum;
  StepData now;
  now.start = &state;
  now.dt = 1.0;
  for (std::size_t k = 0; k < system.scene().tools.size(); ++k)
    for (int i = 0; i < system.contacts(); ++i) {
      const auto [d, contact] = system.contact_at(state.node(i), static_cast<int>(k),
                                                  system.pose(state, static_cast<int>(k)));
      const double force = system.contact_area(now, i) * contact.pressure * d.normal.z();
      (system.scene().tools[k].role == Role::binder ? sum.binder : sum.die) += force;
    }
  return sum;
}

}  // namespace

TEST_CASE(
    "a sheet in free fall falls by g t^2 / 2 in the time step's order, whatever mass scaling says of its "
    "weight",
    "[macroscale][press][gravity]") {
  const auto fabric = make_fabric({});
  const double scaling = GENERATE(1.0, 10.0);
  const auto fall = [&](int steps) {
    Scene scene = strip_of_fabric(fabric, {0.1, 0.1}, 0.025);
    scene.mass_scaling = scaling;
    System system(scene);
    State state = initial_state(scene);
    const double dt = 0.1 / steps;
    double work = 0.0, residual = 0.0;
    heddle::test::run_steps(system, state, dt, steps, {},
                            [&](const StepData& step, const State& end) {
                              const StepLedger ledger = account(system, step, end).ledger;
                              work += ledger.work_dead;
                              residual += ledger.residual();
                            },
                            {.force_tolerance = 1e-12, .relative_tolerance = 0.0});
    const double g = standard_gravity / scaling;
    CHECK(-largest_of(state.x, 2) == Approx(0.5 * g * dt * dt * steps * (steps + 1)).epsilon(1e-9));
    const double weight = standard_gravity * 0.7 * 0.01;
    CHECK(work == Approx(-weight * largest_of(state.x, 2)).epsilon(1e-9));
    CHECK(std::abs(residual) < 1e-9 * work);
    return -largest_of(state.x, 2) - 0.5 * g * 0.01;
  };
  CHECK(heddle::test::observed_order(fall(10), fall(20)) == Approx(1.0).margin(0.01));
}

TEST_CASE("a strip pinned at both ends sags as far as its stretch lets it", "[macroscale][press][gravity]") {
  // A shallow parabola of span L and sag f: tension w L^2 / (8 f), elongation 8 f^2 / (3 L).
  const double length = 0.2, stiffness = 5.9e6;
  const auto fabric = make_fabric({.tow_stiffness = stiffness, .bending = 1e-9});
  Scene scene = strip_of_fabric(fabric, {length, 0.005}, 0.005);
  const Blank& blank = scene.blank;
  scene.held.assign(3 * blank.nodes(), 0);
  for (int i : {0, blank.nu})
    for (int j = 0; j <= blank.nv; ++j)
      for (int c = 0; c < 3; ++c) scene.held[3 * blank.node(i, j) + c] = 1;
  System system(scene);
  State state = initial_state(scene);
  heddle::test::run_at_rest(system, state, 10.0, 3, {}, {}, {},
                            {.force_tolerance = 1e-7, .relative_tolerance = 0.0});
  const double weight = standard_gravity * 0.7;
  const double sag = std::cbrt(3.0 * weight * std::pow(length, 4) / (64.0 * stiffness));
  CHECK(-state.node(blank.node(blank.nu / 2, 0)).z() == Approx(sag).epsilon(0.005));
}

TEST_CASE("before the punch moves the blank hangs into the opening, and die less binder carry its weight",
          "[macroscale][press][gravity]") {
  const auto fabric = make_fabric({});
  const heddle::friction::Model friction;
  StampingSpec spec;
  spec.blank.spacing = 20e-3;
  spec.process.press.gravity = true;
  Scene scene = stamping_scene(spec, fabric, friction);
  System system(scene);
  State state = initial_state(scene);
  StepData step;
  REQUIRE(close_binder(scene, system, {}, state, step).converged);
  const double flat = state.node(scene.blank.node(scene.blank.nu / 2, scene.blank.nv / 2)).z();
  REQUIRE(settle(scene, system, {}, state, step).converged);
  const double sag = flat - state.node(scene.blank.node(scene.blank.nu / 2, scene.blank.nv / 2)).z();
  CHECK(sag > 2e-4);
  CHECK(sag < 5e-3);
  const double weight = standard_gravity * 0.7 * 0.32 * 0.32;
  const Supports found = supports(system, state);
  const double pressed = spec.process.binder_force + standard_gravity * spec.binder.mass;
  CHECK(-found.binder == Approx(pressed).epsilon(1e-9));
  CHECK(found.die + found.binder == Approx(weight).epsilon(1e-6));
  CHECK(found.die == Approx(pressed + weight).epsilon(1e-9));
  CHECK(state.v.norm() == 0.0);
  CHECK(state.time == 0.0);
}

TEST_CASE("the force of a drive is the slope of its energy, and its stiffness the slope of the force",
          "[macroscale][press][derivative]") {
  Tool loaded{Role::binder, PlaneShape{}, Motion::loaded, 650.0, 20.0, 196.0, 3e5};
  Tool sprung{Role::punch, PlaneShape{}, Motion::sprung};
  sprung.stiffness = 1e6;
  Tool yielding = sprung;
  yielding.yield = 800.0;
  for (const Tool& tool : {loaded, sprung, yielding})
    for (const double u : {-1e-3, 3e-4, 2e-3}) {
      CAPTURE(u, tool.stiffness);
      const Drive at = drive_at(tool, u);
      const auto energy = [&](double t) { return drive_at(tool, t).energy; };
      const auto force = [&](double t) { return drive_at(tool, t).force; };
      CHECK(derivative_gap(energy, u, 1e-3, at.force) < 1e-8);
      CHECK(derivative_gap(energy, u, 1e-3, 1.01 * at.force) > 1e-3);
      if (at.stiffness > 0.0) {
        CHECK(derivative_gap(force, u, 1e-3, at.stiffness) < 1e-8);
        CHECK(derivative_gap(force, u, 1e-3, 1.01 * at.stiffness) > 1e-3);
      } else {
        CHECK(force(1.1 * u) == at.force);
      }
    }
  CHECK(drive_at(yielding, 1.0).force == 800.0);  // it yields to a push
  CHECK(drive_at(yielding, -1.0).force == -1e6);  // and not to a pull
  CHECK(drive_at(yielding, 8e-4).energy == Approx(drive_at(yielding, 8e-4 + 1e-12).energy).epsilon(1e-8));
}

TEST_CASE("sectors, bowls and turned tools have the normal and curvature of their distance",
          "[macroscale][press][derivative]") {
  struct Probe {
    Tool tool;
    Vector3d x;
  };
  const SectorShape sector{0.7e-3, 0.092, 0.004, -std::numbers::pi / 4, std::numbers::pi / 4};
  RingShape bowl{-0.7e-3, 0.072, 0.02, true, 0.1};
  Tool tilted{Role::binder, RingShape{0.7e-3, 0.092, 0.002, false}};
  tilted.turn = Turn{Eigen::AngleAxisd(0.05, Vector3d(0.6, 0.8, 0.0)).toRotationMatrix(), {0, 0, 0.7e-3}};
  const auto as_tool = [](const Shape& shape) { return Tool{Role::binder, shape}; };
  const std::vector<Probe> probes{
      {as_tool(sector), {0.12, 0.02, -0.001}}, {as_tool(sector), {0.094, 0.01, -0.0005}},
      {as_tool(sector), {0.09, 0.0885, 0.0}},  {as_tool(sector), {0.068, 0.0665, -0.0008}},
      {as_tool(sector), {0.09, 0.02, 0.008}},  {as_tool(bowl), {0.03, -0.02, -0.09}},
      {as_tool(bowl), {0.05, 0.04, -0.025}},   {tilted, {0.12, 0.03, -0.006}},
      {tilted, {-0.075, -0.053, -0.001}}};
  for (std::size_t index = 0; index < probes.size(); ++index) {
    const Probe& probe = probes[index];
    CAPTURE(index);
    const Distance at = distance(probe.tool, probe.x);
    for (int c = 0; c < 3; ++c) {
      const auto moved = [&](double t) {
        Vector3d y = probe.x;
        y[c] = t;
        return distance(probe.tool, y);
      };
      const auto value = [&](double t) { return moved(t).distance; };
      if (std::abs(at.normal[c]) > 1e-3) {
        CHECK(derivative_gap(value, probe.x[c], 0.01, at.normal[c]) < 1e-6);
        CHECK(derivative_gap(value, probe.x[c], 0.01, 1.01 * at.normal[c]) > 1e-4);
      }
      for (int r = 0; r < 3; ++r) {
        if (std::abs(at.curvature(r, c)) < 1e-2) continue;
        const auto normal = [&](double t) { return moved(t).normal[r]; };
        CHECK(derivative_gap(normal, probe.x[c], 0.01, at.curvature(r, c)) < 1e-6);
        CHECK(derivative_gap(normal, probe.x[c], 0.01, 1.01 * at.curvature(r, c)) > 1e-4);
      }
    }
  }
}

TEST_CASE(
    "a sector is the ring away from its sides, and a tilted plate stands off by the height of its slope",
    "[macroscale][press]") {
  const SectorShape sector{0.7e-3, 0.092, 0.002, -1.0, 1.0};
  const RingShape ring{0.7e-3, 0.092, 0.002, false};
  for (const Vector3d& x :
       {Vector3d(0.12, 0.02, -0.001), Vector3d(0.0925, 0.01, 0.0005), Vector3d(0.08, 0.0, 0.0)}) {
    CHECK(distance(Shape(sector), x).distance == Approx(distance(Shape(ring), x).distance).margin(1e-12));
    CHECK((distance(Shape(sector), x).normal - distance(Shape(ring), x).normal).norm() < 1e-12);
  }
  CHECK(distance(Shape(sector), {-0.12, 0.02, -0.001}).distance > 0.1);
  Tool tilted{Role::binder, ring};
  tilted.turn = Turn{Eigen::AngleAxisd(0.01, Vector3d::UnitX()).toRotationMatrix(), {0, 0, 0.7e-3}};
  const double before = distance(Shape(ring), {0.0, 0.12, -0.001}).distance;
  CHECK(distance(tilted, {0.0, 0.12, -0.001}).distance - before ==
        Approx(0.12 * std::sin(0.01)).epsilon(1e-3));
  CHECK(distance(tilted, {0.0, -0.12, -0.001}).distance - before ==
        Approx(-0.12 * std::sin(0.01)).epsilon(1e-3));
}

TEST_CASE("steps of a dwell begin where the stroke ends, grow, and add up to it", "[macroscale][press]") {
  ProcessSpec process;
  process.press.dwell = GENERATE(0.01, 0.5, 60.0);
  CHECK(all_steps(process) == process.steps + dwell_rows);
  CHECK(time_at_step(process, process.steps, 1.0) == stroke_time(process));
  double before = stroke_time(process), length = 0.0;
  for (int step = process.steps + 1; step <= all_steps(process); ++step) {
    const double now = time_at_step(process, step, 1.0);
    CHECK(now - before >= length * (1.0 - 1e-9));
    CHECK(stroke_at_time(process, now) == Approx(process.stroke));
    length = now - before;
    before = now;
  }
  CHECK(before == Approx(stroke_time(process) + process.press.dwell).epsilon(1e-12));
  const double first = time_at_step(process, process.steps + 1, 1.0) - stroke_time(process);
  CHECK(first <= stroke_time(process) / process.steps * (1.0 + 1e-6));
}

TEST_CASE("a press that cannot work is refused with every reason at once",
          "[macroscale][press][wrong input]") {
  StampingSpec spec;
  spec.process.press.punch_offset = {2e-3, 1e-3};
  spec.die.bottom = DieBottom::bowl;
  spec.die.depth = 0.06;
  const auto problems = check(spec);
  for (const char* id :
       {"effects.punch_misalignment.offset.clearance", "tools.die.depth.bowl", "tools.die.depth.stroke"})
    CHECK(std::any_of(problems.begin(), problems.end(), [&](const auto& p) { return p.id == id; }));
  spec.process.press.punch_offset = {1e-3, 1e-3};
  spec.die.depth = 0.1;
  CHECK(check(spec).empty());
}
