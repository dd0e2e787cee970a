// Contact between plies: slopes, invariants, and stacks whose answers are known in closed form.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

#include <Eigen/Geometry>

#include "macroscale/ledger.h"
#include "macroscale/system.h"
#include "tests/macroscale/quasi_static.h"
#include "tests/macroscale/sample_fabric.h"
#include "tests/macroscale/slope_checks.h"

using namespace heddle::macroscale;
using Eigen::Vector3d;
using Eigen::VectorXd;
using heddle::test::check_slopes;
using heddle::test::check_slopes_of_pairs;
using heddle::test::make_fabric;
using heddle::test::run_at_rest;
using heddle::test::run_steps;
using heddle::test::shake;
using heddle::test::without_pairs;

namespace {

constexpr double degree = std::numbers::pi / 180.0;

Blank stack_of(std::array<double, 2> size, double spacing, const std::vector<double>& layup, double apart) {
  const double x = 0.5 * size[0], y = 0.5 * size[1];
  const Outline outline{.outer = {{-x, -y}, {x, -y}, {x, y}, {-x, y}}, .holes = {}};
  std::vector<Blank> plies;
  for (std::size_t k = 0; k < layup.size(); ++k)
    plies.push_back(
        make_blank(outline, spacing, layup[k],
                   (static_cast<double>(k) - 0.5 * static_cast<double>(layup.size() - 1)) * apart));
  return stacked(std::move(plies));
}

struct Bench {
  // Soft along its tows: beside stiff ones what plies do would be lost in rounding.
  heddle::mesoscale::FabricProperties fabric = make_fabric({.tow_stiffness = 1e3, .rate_consistency = 5.0});
  heddle::friction::Model friction;
  Scene scene;
  State state;
  StepData step;
};

// Three plies, turned, pressed into each other and crumpled, with load and friction at every contact.
std::unique_ptr<Bench> bench() {
  auto b = std::make_unique<Bench>();
  b->friction.law = heddle::friction::Coulomb{0.3};
  b->scene.blank =
      stack_of({0.05, 0.04}, 0.01, {0.0, 30.0 * degree, -45.0 * degree}, 0.9 * b->fabric.thickness);
  b->scene.fabric = &b->fabric;
  b->scene.friction = &b->friction;
  b->scene.slip_smoothing = 1e-3;
  b->state = initial_state(b->scene);
  b->step.dt = 5e-3;
  b->step.start = &b->state;
  b->step.target = b->state.x;
  return b;
}

void load_all(Bench& b, const System& system) {
  b.step.friction.assign(1, std::vector<FrictionPoint>(b.step.pairs.size()));
  for (std::size_t k = 0; k < b.step.pairs.size(); ++k) {
    FrictionPoint& point = b.step.friction[0][k];
    if (b.step.pairs[k].quad < 0) continue;
    point.load = 0.5;
    point.normal = b.step.pairs[k].normal;
    point.context.pressure = 1e4;
  }
  REQUIRE(system.friction_rows(b.step) == 1);
}

}  // namespace

TEST_CASE("with plies in contact the residual is the slope of the potential, the matrix that of the residual",
          "[macroscale][plies][derivative]") {
  const auto b = bench();
  shake(b->state.x, 1.5e-4, 3);
  b->step.target = b->state.x;
  System system(b->scene);
  system.pair(b->step);
  load_all(*b, system);
  const auto met = std::count_if(b->step.pairs.begin(), b->step.pairs.end(),
                                 [](const PlyPair& pair) { return pair.quad >= 0; });
  CHECK(static_cast<double>(met) > 0.9 * static_cast<double>(b->step.pairs.size()));
  VectorXd x = b->state.x, d = VectorXd::Zero(x.size());
  shake(x, 5e-5, 7);
  shake(d, 1.0, 11);
  check_slopes(system, b->step, x,
               0.1 * d);  // not far: friction that has just begun to slip bends within nanometres
  check_slopes_of_pairs(system, b->step, x, d);
}

TEST_CASE("plies that turn together do not slip past each other, and moving them together stores nothing",
          "[macroscale][plies][invariant]") {
  const auto b = bench();
  shake(b->state.x, 1.5e-4, 5);
  System system(b->scene);
  system.pair(b->step);
  const Vector3d spin(0.3, -0.7, 0.2), speed(1.0, 2.0, -0.5);
  VectorXd rigid = b->state.x;
  for (int i = 0; i < b->scene.blank.nodes(); ++i)
    rigid.segment<3>(3 * i) = speed + spin.cross(Vector3d(b->state.x.segment<3>(3 * i)));
  double largest = 0.0;
  for (const PlyPair& pair : b->step.pairs) {
    if (pair.quad < 0) continue;
    CHECK(slip(pair, rigid).norm() < 1e-12);
    PlyPair plain = pair;  // middle surfaces alone move past each other by the thickness times the spin
    for (Vector3d& turn : plain.turn) turn.setZero();
    largest = std::max(largest, slip(plain, rigid).norm());
  }
  CHECK(largest > 0.5e-3);
  // What is stored follows from where the plies meet, wherever the stack stands.
  const Eigen::Matrix3d r = Eigen::AngleAxisd(0.8, Vector3d(1, -2, 0.5).normalized()).toRotationMatrix();
  VectorXd moved = b->state.x;
  for (int i = 0; i < b->scene.blank.nodes(); ++i)
    moved.segment<3>(3 * i) = r * b->state.x.segment<3>(3 * i) + Vector3d(0.1, 0.2, 0.3);
  const auto stored = [&](const VectorXd& x) {
    double sum = 0.0;
    for (const PlyPair& pair : system.pairs_at(x)) sum += pair.area * system.contact_of_plies(pair, x).energy;
    return sum;
  };
  REQUIRE(stored(b->state.x) > 0.0);
  CHECK(stored(moved) == Approx(stored(b->state.x)).epsilon(1e-9));
}

TEST_CASE("what plies do to each other adds up to no force and turns no stack",
          "[macroscale][plies][invariant]") {
  const auto b = bench();
  shake(b->state.x, 1.5e-4, 5);
  System system(b->scene);
  system.pair(b->step);
  load_all(*b, system);
  VectorXd x = b->state.x;
  shake(x, 1e-5, 9);
  StepData apart = without_pairs(b->step);
  b->step.target = apart.target = x;
  const VectorXd force = system.gradient(b->step, x) - system.gradient(apart, x);
  Vector3d sum = Vector3d::Zero();
  double size = 0.0;
  for (int i = 0; i < b->scene.blank.nodes(); ++i) {
    sum += force.segment<3>(3 * i);
    size += force.segment<3>(3 * i).norm();
  }
  REQUIRE(size > 1.0);
  CHECK(sum.norm() < 1e-12 * size);
  // Moments about the positions at which the plies met.
  Vector3d moment = Vector3d::Zero();
  const VectorXd at_start = system.gradient(b->step, b->state.x) - system.gradient(apart, b->state.x);
  for (int i = 0; i < b->scene.blank.nodes(); ++i)
    moment += Vector3d(b->state.x.segment<3>(3 * i)).cross(Vector3d(at_start.segment<3>(3 * i)));
  CHECK(moment.norm() < 1e-12 * size * 0.05);
}

TEST_CASE("V12: two plies that fly into each other keep their momentum", "[macroscale][plies][invariant]") {
  const auto fabric = make_fabric({});
  heddle::friction::Model friction;
  friction.law = heddle::friction::Coulomb{0.3};
  Scene scene;
  scene.blank = stack_of({0.05, 0.04}, 0.01, {0.0, 30.0 * degree}, fabric.thickness);
  scene.fabric = &fabric;
  scene.friction = &friction;
  scene.slip_smoothing = 1e-4;
  System system(scene);
  State state = initial_state(scene);
  for (int i = 0; i < scene.blank.nodes(); ++i)
    state.v.segment<3>(3 * i) =
        scene.blank.ply_of_node(i) == 0 ? Vector3d(0.02, 0, 0.05) : Vector3d(0, 0.01, -0.05);
  const auto momentum = [&](const State& s) {
    Vector3d sum = Vector3d::Zero();
    for (int i = 0; i < scene.blank.nodes(); ++i) sum += system.mass(3 * i) * s.v.segment<3>(3 * i);
    return sum;
  };
  const Vector3d before = momentum(state);
  double stored = 0.0, rubbed = 0.0;
  SolveOptions options;
  options.force_tolerance = 1e-11;
  options.relative_tolerance = 0.0;
  run_steps(
      system, state, 1e-4, 10, {},
      [&](const StepData& step, const State& end) {
        const StepLedger books = account(system, step, end).ledger;
        stored = std::max(stored, books.compaction_plies);
        rubbed += books.friction.back();
      },
      options);
  CHECK(stored > 0.0);
  CHECK(rubbed > 0.0);
  CHECK((momentum(state) - before).norm() < 1e-12);
}

namespace {

// A stack between two plates under a force, at rest.
struct Pressed {
  double thickness = 0.0;     ///< between the plates [m]
  std::vector<double> force;  ///< of each interface [N]
  double spread = 0.0;        ///< of the pressures between plies, about the mean [-]
};

Pressed press(const std::vector<double>& layup, double force,
              const heddle::mesoscale::FabricProperties& fabric = make_fabric({})) {
  const std::array<double, 2> size{0.06, 0.05};
  Scene scene;
  scene.fabric = &fabric;
  scene.blank = stack_of(size, 0.01, layup, scene.ply_rest());
  const double half = 0.5 * (fabric.thickness + scene.ply_rest() * (static_cast<double>(layup.size()) - 1.0));
  scene.tools = {{Role::die, PlaneShape{{0, 0, -half}, {0, 0, 1}}, Motion::fixed, 0.0, 0.0},
                 {Role::binder, PlaneShape{{0, 0, half}, {0, 0, -1}}, Motion::loaded, force, 0.5}};
  scene.held.assign(static_cast<std::size_t>(scene.unknowns()), 0);
  for (int i = 0; i < scene.blank.nodes(); ++i) scene.held[3 * i] = scene.held[3 * i + 1] = 1;
  System system(scene);
  State state = initial_state(scene);
  SolveOptions options;
  options.force_tolerance = 1e-9 * force;
  options.relative_tolerance = 0.0;
  run_at_rest(system, state, 0.05, 30, {}, {}, {}, options);
  Pressed result;
  result.thickness = 2.0 * half + state.tool_z[1];
  const auto pairs = system.pairs_at(state.x);
  result.force.assign(layup.size() - 1, 0.0);
  const double mean = force / (size[0] * size[1]);
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const PlyPoint& point = system.ply_points()[k];
    const double pressure = system.contact_of_plies(pairs[k], state.x).pressure;
    result.force[static_cast<std::size_t>(interface_of(point))] += pairs[k].area * pressure;
    if (pairs[k].quad >= 0) result.spread = std::max(result.spread, std::abs(pressure / mean - 1.0));
  }
  return result;
}

}  // namespace

TEST_CASE("a stack between plates carries the force evenly through every ply, and is as thick as its plies",
          "[macroscale][plies][patch]") {
  const double force = 150.0;
  const auto fabric = make_fabric({});
  const double alone =
      fabric.thickness - 2.0 * approach_at(fabric.compaction.curves().front(), force / (0.06 * 0.05));
  for (const std::size_t plies : {std::size_t{2}, std::size_t{4}}) {
    const Pressed stack = press(std::vector<double>(plies, 0.0), force);
    CHECK(stack.thickness == Approx(static_cast<double>(plies) * alone).epsilon(1e-6));
    for (const double carried : stack.force) CHECK(carried == Approx(force).epsilon(1e-6));
    CHECK(stack.spread < 1e-5);
  }
  // Turned plies have grids that do not match: each interface carries the force, not quite evenly.
  const Pressed turned = press({0.0, 45.0 * degree, 90.0 * degree}, force);
  for (const double carried : turned.force) CHECK(carried == Approx(force).epsilon(1e-6));
  WARN("pressures between turned plies: " << 100.0 * turned.spread << " % about the mean; thickness "
                                          << 100.0 * (turned.thickness / (3.0 * alone) - 1.0) << " %");
  CHECK(turned.thickness == Approx(3.0 * alone).epsilon(0.01));
}

TEST_CASE("plies whose tows face each other by a table of their own rest nearer and give way by that table",
          "[macroscale][plies][patch]") {
  const double force = 150.0, pressure = force / (0.06 * 0.05);
  auto fabric = make_fabric({});
  const auto softer = make_fabric({.contact_stiffness = 2.5e8});
  fabric.facing = {0.8 * fabric.thickness, softer.compaction.curves().front()};
  const double at_plate = approach_at(fabric.compaction.curves().front(), pressure),
               between = approach_at(fabric.facing.compaction, pressure);
  CHECK(between > 1.7 * at_plate);
  for (const std::size_t plies : {std::size_t{2}, std::size_t{3}}) {
    const Pressed stack = press(std::vector<double>(plies, 0.0), force, fabric);
    const double apart = fabric.facing.rest - 2.0 * between;
    CHECK(stack.thickness ==
          Approx(fabric.thickness - 2.0 * at_plate + static_cast<double>(plies - 1) * apart).epsilon(1e-6));
    for (const double carried : stack.force) CHECK(carried == Approx(force).epsilon(1e-6));
  }
}

namespace {

constexpr double mu = 0.3;

// Steady force that draws one ply out of a stack whose other plies are held at their far edge [N].
double drawn_force(int plies, int drawn, bool plate_above, double force) {
  const auto fabric = make_fabric({});
  heddle::friction::Model friction;
  friction.law = heddle::friction::Coulomb{mu};
  Scene scene;
  const std::array<double, 2> size{0.1, 0.02};
  const double pressure = force / (size[0] * size[1]);
  const double approach = approach_at(fabric.compaction.curves().front(), pressure);
  const double apart = fabric.thickness - 2.0 * approach, half = 0.5 * apart * plies;
  scene.blank = stack_of(size, 0.01, std::vector<double>(static_cast<std::size_t>(plies), 0.0), apart);
  scene.fabric = &fabric;
  scene.friction = &friction;
  scene.slip_smoothing = 4e-6;
  scene.shear_rate = 0.0;
  scene.tools = {{Role::die, PlaneShape{{0, 0, -half}, {0, 0, 1}}, Motion::fixed, 0.0, 0.0}};
  if (plate_above)
    scene.tools.push_back({Role::binder, PlaneShape{{0, 0, half}, {0, 0, -1}}, Motion::loaded, force, 0.5});
  const Blank& blank = scene.blank;
  scene.held.assign(static_cast<std::size_t>(scene.unknowns()), 0);
  scene.load.assign(static_cast<std::size_t>(scene.unknowns()), 0.0);
  for (int k = 0; k < plies; ++k) {
    const Ply& ply = blank.ply(k);
    for (int j = 0; j <= ply.nv; ++j)
      for (int c = 0; c < 2; ++c) scene.held[3 * ply.node(k == drawn ? ply.nu : 0, j) + c] = 1;
  }
  if (!plate_above)
    for (int n = blank.ply(plies - 1).first_node; n < blank.nodes(); ++n)
      scene.load[3 * n + 2] = -pressure * blank.node_area[n];
  System system(scene);
  State state = initial_state(scene);
  const VectorXd laid = state.x;
  const double speed = 0.02;
  const Ply& ply = blank.ply(drawn);
  const auto draw = [&](double time, VectorXd& x) {
    for (int j = 0; j <= ply.nv; ++j) {
      const int n = ply.node(ply.nu, j);
      x[3 * n] = laid[3 * n] + speed * time;
      x[3 * n + 1] = laid[3 * n + 1];
    }
  };
  double result = 0.0;
  SolveOptions options;
  options.lag_tolerance = 1e-3;
  run_steps(
      system, state, 0.005, 15, draw,
      [&](const StepData& step, const State& end) {
        const VectorXd support = system.full_gradient(step, end.x);
        result = 0.0;
        for (int j = 0; j <= ply.nv; ++j) result += support[3 * ply.node(ply.nu, j)];
      },
      options);
  return result;
}

}  // namespace

TEST_CASE(
    "a strip drawn off another under a weight resists by mu N, one drawn from between two by twice that",
    "[macroscale][plies][verification][friction]") {
  const double force = 50.0;
  // As it is drawn out by 1.5 mm of its 100, a part of the weight comes to lie beside the strip below.
  const double off = drawn_force(2, 1, false, force), middle = drawn_force(3, 1, true, force);
  WARN("drawn off: " << off / (mu * force) << " mu N; from the middle: " << middle / (mu * force) << " mu N");
  CHECK(off == Approx(mu * force).epsilon(0.005));
  CHECK(middle == Approx(2.0 * mu * force).epsilon(0.005));
}

namespace {

constexpr double bending = 2e-3;  // [N m]

// Sag of the tip of a strip of several plies, clamped, pressed together by dead loads, under a load on its
// upper ply's tip [m].
double tip_sag(int plies, double load, double friction_coefficient) {
  const auto fabric = make_fabric({.tow_stiffness = 1e5, .bending = bending, .contact_stiffness = 5e9});
  heddle::friction::Model friction;
  friction.law = heddle::friction::Coulomb{std::max(friction_coefficient, 1e-12)};
  const double length = 0.1, h = length / 9.5, pressure = 1.0;  // enough to stick
  Scene scene;
  const double approach = plies > 1 ? approach_at(fabric.compaction.curves().front(), pressure) : 0.0;
  scene.blank =
      stack_of({10 * h, h}, h * (1.0 + 1e-6), std::vector<double>(static_cast<std::size_t>(plies), 0.0),
               fabric.thickness - 2.0 * approach);
  scene.fabric = &fabric;
  scene.friction = friction_coefficient > 0.0 ? &friction : nullptr;
  scene.slip_smoothing = 1e-10;
  scene.shear_rate = 0.0;
  const Blank& blank = scene.blank;
  scene.held.assign(static_cast<std::size_t>(scene.unknowns()), 0);
  scene.load.assign(static_cast<std::size_t>(scene.unknowns()), 0.0);
  for (int k = 0; k < plies; ++k)
    for (int i = 0; i < 2; ++i)
      for (int j = 0; j <= blank.ply(k).nv; ++j)
        for (int c = 0; c < 3; ++c) scene.held[3 * blank.ply(k).node(i, j) + c] = 1;
  const Ply& top = blank.ply(plies - 1);
  System system(scene);
  State state = initial_state(scene);
  SolveOptions options;
  options.force_tolerance = 1e-5 * load;
  options.relative_tolerance = 0.0;
  options.newton_limit = 400;
  run_at_rest(
      system, state, 1.0, 4,
      [&](double share) {
        for (int n = 0; n < blank.nodes(); ++n) {
          const int ply = blank.ply_of_node(n);
          const double side = (ply == 0 ? 1.0 : 0.0) - (ply == plies - 1 ? 1.0 : 0.0);
          scene.load[3 * n + 2] = side * pressure * blank.node_area[n];
        }
        for (int j = 0; j <= top.nv; ++j)
          scene.load[3 * top.node(top.nu, j) + 2] -= share * load / (top.nv + 1);
      },
      {}, {}, options);
  return -(state.node(top.node(top.nu, 0)).z() - blank.reference[top.node(top.nu, 0)].z());
}

}  // namespace

TEST_CASE(
    "plies that slip freely bend as stiffly as each by itself together, plies that stick as a glued beam",
    "[macroscale][plies][verification]") {
  const double load = 2e-6, length = 0.1, width = 0.1 / 9.5;
  const double alone = tip_sag(1, load, 0.0);
  CHECK(alone == Approx(load * std::pow(length, 3) / (3.0 * bending * width)).epsilon(0.02));
  for (const int plies : {2, 3}) {
    const double free = tip_sag(plies, load, 0.0), stuck = tip_sag(plies, load, 2.0);
    // Glued, with straight normals: N B + E A H^2 (N^3 - N) / 12. Tows bend from halfway between the two held
    // columns on, but stretch only from the second on.
    const double thickness = 1.5e-3, n = plies, cells = 9.5;
    const double membrane = 1e5 * thickness * thickness * (n * n * n - n) / 12.0 / bending;
    const double glued = n + membrane * std::pow(cells / (cells - 0.5), 3);
    WARN(plies << " plies: free " << alone / free << ", stuck " << alone / stuck
               << " times as stiff as one; glued, with straight normals: " << glued);
    CHECK(alone / free == Approx(n).epsilon(0.005));
    CHECK(alone / stuck == Approx(glued).epsilon(0.01));
  }
}
