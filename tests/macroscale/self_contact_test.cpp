// A sheet that meets itself: what it meets, slopes, invariants, and folds whose answers are known.
#include "macroscale/self_contact.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <random>

#include <Eigen/Geometry>

#include "macroscale/checkpoint.h"
#include "macroscale/folds.h"
#include "macroscale/ledger.h"
#include "macroscale/quality.h"
#include "macroscale/system.h"
#include "tests/macroscale/folded_strip.h"
#include "tests/macroscale/kept_stamping.h"
#include "tests/macroscale/quasi_static.h"
#include "tests/macroscale/sample_fabric.h"
#include "tests/macroscale/slope_checks.h"

using namespace heddle::macroscale;
using Eigen::Vector3d;
using Eigen::VectorXd;
using heddle::test::check_slopes_of_pairs;
using heddle::test::fold;
using heddle::test::folded_strip;
using heddle::test::FoldedStrip;
using heddle::test::make_fabric;
using heddle::test::run_at_rest;
using heddle::test::run_steps;
using heddle::test::shake;
using heddle::test::without_pairs;

namespace {

constexpr double pi = std::numbers::pi;
constexpr double thickness = 1.5e-3;  // of make_fabric [m]

VectorXd placed(const Blank& blank, const std::function<Vector3d(double x, double y)>& place) {
  VectorXd x(3 * blank.nodes());
  for (int n = 0; n < blank.nodes(); ++n)
    x.segment<3>(3 * n) = place(blank.reference[n].x(), blank.reference[n].y());
  return x;
}

std::vector<PlyPair> pairs_of(const Blank& blank, const VectorXd& x, double reach = 3.0 * thickness) {
  return pair_with_itself(blank, self_points(blank), x, reach, thickness);
}

// Part of a step that two parts of a sheet have in it: none of them in the copy.
}  // namespace

TEST_CASE("a flat sheet, a sheared one, a dome and a wave meet no part of themselves",
          "[macroscale][self_contact]") {
  const double gamma = 60.0 * pi / 180.0;
  for (const double h : {5e-3, 1e-3}) {  // coarser and finer than the fabric is thick
    const Blank blank = make_blank({24 * h, 24 * h}, h * (1.0 + 1e-9));
    const double size = 24 * h;
    for (const auto& place : std::vector<std::function<Vector3d(double, double)>>{
             [](double x, double y) { return Vector3d(x, y, 0.0); },
             [&](double x, double y) { return Vector3d(x + y * std::sin(gamma), y * std::cos(gamma), 0.0); },
             [&](double x, double y) {
               return Vector3d(x, y, std::sqrt(0.51 * size * size - x * x - y * y));
             },
             [&](double x, double y) { return Vector3d(x, y, 0.15 * size * std::sin(4.0 * pi * x / size)); }})
      CHECK(pairs_of(blank, placed(blank, place)).empty());
  }
}

TEST_CASE("a bend as tight as the fabric is thick touches itself nowhere, with legs to it these do",
          "[macroscale][self_contact]") {
  constexpr double h = 0.25e-3, r = 0.5 * thickness;
  const auto bent = [&](int cells, int round) {
    const Blank blank = make_blank({cells * h, 4 * h}, h * (1.0 + 1e-9));
    const double arc = round * h, legs = 0.5 * (cells * h - arc);
    return pairs_of(blank, placed(blank, [&](double x, double y) -> Vector3d {
                      const double s = x + 0.5 * cells * h - legs, angle = std::clamp(s, 0.0, arc) / r;
                      const double before = std::min(s, 0.0), after = std::max(s - arc, 0.0);
                      return {before + r * std::sin(angle) + after * std::cos(arc / r), y,
                              r * (1.0 - std::cos(angle)) + after * std::sin(arc / r)};
                    }));
  };
  CHECK(bent(11, 11).empty());
  CHECK_FALSE(bent(33, 9).empty());
}

TEST_CASE("legs of a hairpin meet each other, the faces that look at each other only",
          "[macroscale][self_contact]") {
  const FoldedStrip strip = folded_strip(12, 2, 4, 2.5e-3);
  VectorXd x = placed(strip.blank, [](double a, double b) { return Vector3d(a, b, 0.0); });
  const double apart = 1.4e-3;
  fold(strip, apart, x);
  const std::vector<PlyPoint> points = self_points(strip.blank);
  const std::vector<PlyPair> pairs = pairs_of(strip.blank, x);
  REQUIRE(pairs.size() == points.size());
  int met = 0;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const int i = strip.blank.grid[strip.blank.quads[points[k].quad][0]][0];
    if (points[k].side < 0) CHECK(pairs[k].quad < 0);  // nothing lies on the outside of the fold
    if (points[k].side < 0 || pairs[k].quad < 0) continue;
    ++met;
    const int j = strip.blank.grid[strip.blank.quads[pairs[k].quad][0]][0];
    CHECK(i + j == 2 * 12 + 1);  // straight across
    if (i < 10 || i > 15) CHECK(gap(pairs[k], x) == Approx(apart).epsilon(1e-9));
    // From the other leg to the point: down to the lower leg, up to the upper one.
    CHECK(pairs[k].normal.z() * (i < 12 ? -1.0 : 1.0) > 0.95);
  }
  CHECK(met == 2 * 12 * 4);
}

TEST_CASE("turns of a roll meet with unlike faces, and each meets the next turn, not the one after",
          "[macroscale][self_contact]") {
  constexpr double h = 2.5e-3, apart = 2e-3, inner = 8e-3;
  const Blank blank = make_blank({72 * h, 3 * h}, h * (1.0 + 1e-9));
  // r = inner + apart a / 2 pi, walked by arc length.
  double angle = 0.0, at = 0.0;
  std::vector<double> angle_at;
  for (int i = 0; i <= 72; ++i) {
    for (; at < i * h; at += 1e-6) angle += 1e-6 / (inner + apart * angle / (2.0 * pi));
    angle_at.push_back(angle);
  }
  VectorXd x(3 * blank.nodes());
  for (int n = 0; n < blank.nodes(); ++n) {
    const double a = angle_at[blank.grid[n][0]], r = inner + apart * a / (2.0 * pi);
    x.segment<3>(3 * n) = Vector3d(r * std::sin(a), blank.reference[n].y(), r * std::cos(a));
  }
  const std::vector<PlyPoint> points = self_points(blank);
  const std::vector<PlyPair> pairs = pairs_of(blank, x);
  REQUIRE_FALSE(pairs.empty());
  int inwards = 0, outwards = 0;
  for (std::size_t k = 0; k < points.size(); ++k) {
    if (pairs[k].quad < 0) continue;
    const int i = blank.grid[blank.quads[points[k].quad][0]][0],
              j = blank.grid[blank.quads[pairs[k].quad][0]][0];
    const double between = angle_at[j] - angle_at[i];
    CHECK(std::abs(std::abs(between) - 2.0 * pi) < 0.4);  // a whole turn
    // At the ends of the strip normals are those of one cell, half a cell's turn off.
    if (std::min(i, j) > 0 && std::max(i, j) < 71) CHECK(gap(pairs[k], x) == Approx(apart).epsilon(0.02));
    // The sheet's normal looks inwards or outwards all along: one face meets later turns, the other earlier.
    (points[k].side > 0 ? outwards : inwards) += between > 0.0 ? 1 : -1;
  }
  CHECK(std::abs(inwards) > 60);
  CHECK(inwards * outwards < 0);
}

namespace {

struct Bench {
  heddle::mesoscale::FabricProperties fabric = make_fabric({.tow_stiffness = 1e3, .rate_consistency = 5.0});
  heddle::friction::Model friction;
  FoldedStrip strip = folded_strip(6, 2, 4, 5e-3);
  Scene scene;
  State state;
  StepData step;
  std::unique_ptr<System> system;
};

// A crumpled fold, pressed, with load and friction wherever it meets itself.
std::unique_ptr<Bench> bench() {
  auto b = std::make_unique<Bench>();
  b->friction.law = heddle::friction::Coulomb{0.3};
  b->scene.blank = b->strip.blank;
  b->scene.fabric = &b->fabric;
  b->scene.friction = &b->friction;
  b->scene.slip_smoothing = 1e-3;
  b->scene.self_contact = true;
  b->state = initial_state(b->scene);
  fold(b->strip, 0.9 * thickness, b->state.x);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-1.5e-4, 1.5e-4);
  for (double& value : b->state.x) value += uniform(random);
  b->step.dt = 5e-3;
  b->step.start = &b->state;
  b->step.target = b->state.x;
  b->system = std::make_unique<System>(b->scene);
  b->system->pair(b->step);
  REQUIRE(b->step.pairs.size() == 2 * b->scene.blank.quads.size());
  b->step.friction.assign(1, std::vector<FrictionPoint>(b->step.pairs.size()));
  for (std::size_t k = 0; k < b->step.pairs.size(); ++k) {
    FrictionPoint& point = b->step.friction[0][k];
    if (b->step.pairs[k].quad < 0) continue;
    point.load = 0.5;
    point.normal = b->step.pairs[k].normal;
    point.context.pressure = 1e4;
  }
  return b;
}

}  // namespace

TEST_CASE(
    "where a sheet meets itself the residual is the slope of the potential, the matrix that of the residual",
    "[macroscale][self_contact][derivative]") {
  const auto b = bench();
  System& system = *b->system;
  const auto met = std::count_if(b->step.pairs.begin(), b->step.pairs.end(),
                                 [](const PlyPair& pair) { return pair.quad >= 0; });
  CHECK(met >= 2 * 5 * 4);
  VectorXd x = b->state.x, d = VectorXd::Zero(x.size());
  shake(x, 5e-5, 7);
  shake(d, 1.0, 11);
  check_slopes_of_pairs(system, b->step, x, d);
}

TEST_CASE("what parts of a sheet do to each other adds up to no force and turns nothing",
          "[macroscale][self_contact][invariant]") {
  const auto b = bench();
  const System& system = *b->system;
  const StepData apart = without_pairs(b->step);
  VectorXd x = b->state.x;
  shake(x, 1e-5, 9);  // so that it rubs
  const VectorXd force = system.gradient(b->step, x) - system.gradient(apart, x);
  Vector3d sum = Vector3d::Zero(), moment = Vector3d::Zero();
  double size = 0.0;
  for (int i = 0; i < b->scene.blank.nodes(); ++i) {
    const Vector3d f = force.segment<3>(3 * i);
    sum += f;
    size += f.norm();
    moment += b->state.node(i).cross(f);  // where the parts met
  }
  REQUIRE(size > 1.0);
  CHECK(sum.norm() < 1e-12 * size);
  CHECK(moment.norm() < 1e-12 * size * 0.05);
}

namespace {

// A folded strip between two plates, its lower leg held in the plane and its upper one led there.
struct Pressed {
  double thickness = 0.0;                     ///< between the plates [m]
  double carried = 0.0;                       ///< by contact of the strip with itself [N]
  double pull_upper = 0.0, pull_lower = 0.0;  ///< of supports along x [N]
  double rubbed = 0.0;                        ///< in the last step, between the legs [J]
  double residual = 0.0, work = 0.0;          ///< of the ledger, all steps [J]
  int crossings = 0;
};

constexpr int leg = 20, across = 4;
constexpr double spacing = 5e-3, mu = 0.3, speed = 0.02, dt = 0.005;
constexpr double leg_area = leg * across * spacing * spacing;  // [m^2]

Pressed press(double force, bool pull) {
  const auto fabric = make_fabric({.tow_stiffness = 1.0, .shear_stiffness = 1e-3, .bending = 1e-9});
  heddle::friction::Model friction;
  friction.law = heddle::friction::Coulomb{mu};
  const FoldedStrip strip = folded_strip(leg, 2, across, spacing);
  const double approach = approach_at(fabric.compaction.curves().front(), force / leg_area);
  const double apart = thickness - 2.0 * approach;
  Scene scene;
  scene.blank = strip.blank;
  scene.fabric = &fabric;
  scene.friction = pull ? &friction : nullptr;
  scene.self_contact = true;
  scene.slip_smoothing = 4e-6;
  scene.shear_rate = 0.0;
  const double below = -0.5 * thickness + approach, above = apart + 0.5 * thickness - approach;
  scene.tools = {{Role::die, PlaneShape{{0, 0, below}, {0, 0, 1}}, Motion::fixed, 0.0, 0.0},
                 {Role::binder, PlaneShape{{0, 0, above}, {0, 0, -1}}, Motion::loaded, force, 0.5}};
  scene.held.assign(static_cast<std::size_t>(scene.unknowns()), 0);
  for (int n = 0; n < scene.blank.nodes(); ++n) {
    scene.held[3 * n] = scene.held[3 * n + 1] = 1;
    // The tip is no part of what is pressed.
    if (!strip.lower(n) && !strip.upper(n)) scene.held[3 * n + 2] = 1;
  }
  System system(scene);
  State state = initial_state(scene);
  fold(strip, apart, state.x);
  const VectorXd laid = state.x;
  bool drawn = false;
  const auto lead = [&](double time, VectorXd& x) {
    for (int n = 0; n < scene.blank.nodes(); ++n) {
      const double share = strip.upper(n) ? 1.0 : strip.lower(n) ? 0.0 : 0.5;
      x[3 * n] = laid[3 * n] - (drawn ? share * speed * time : 0.0);
      x[3 * n + 1] = laid[3 * n + 1];
      if (share == 0.5) x[3 * n + 2] = laid[3 * n + 2];
    }
  };
  SolveOptions options;
  options.force_tolerance = 1e-8 * force;
  options.relative_tolerance = 0.0;
  options.lag_tolerance = 1e-4;
  Pressed result;
  const auto look = [&](const StepData& step, const State& end) {
    const StepLedger books = account(system, step, end).ledger;
    result.residual += books.residual();
    result.work += std::abs(books.work());
    result.carried = result.pull_upper = result.pull_lower = 0.0;
    result.rubbed = books.friction.back();
    // Half of it from each side.
    for (const PlyPair& pair : step.pairs)
      result.carried += pair.quad < 0 ? 0.0 : pair.area * system.contact_of_plies(pair, end.x).pressure;
    const VectorXd support = system.full_gradient(step, end.x);
    for (int n = 0; n < scene.blank.nodes(); ++n)
      if (strip.upper(n) || strip.lower(n))
        (strip.upper(n) ? result.pull_upper : result.pull_lower) += support[3 * n];
  };
  run_at_rest(system, state, 0.05, 20, {}, lead, look, options);
  if (pull) {
    drawn = true;
    state.time = 0.0;
    result.residual = result.work = 0.0;
    run_steps(system, state, dt, 10, lead, look, options);
  }
  result.thickness = above - below + state.tool_z[1];
  result.crossings = count_crossings(scene.blank, state.x);
  return result;
}

}  // namespace

TEST_CASE("a flattened fold carries a plate's force through itself and is as thick as two layers",
          "[macroscale][self_contact][patch]") {
  const double force = 30.0;
  const auto fabric = make_fabric({});
  const Pressed fold = press(force, false);
  const double approach = approach_at(fabric.compaction.curves().front(), force / leg_area);
  WARN("carried " << fold.carried / force << " of the force; closed by "
                  << (2.0 * thickness - fold.thickness) / (4.0 * approach)
                  << " of what the law says; crossings " << fold.crossings);
  CHECK(fold.carried == Approx(force).epsilon(1e-3));
  CHECK(2.0 * thickness - fold.thickness == Approx(4.0 * approach).epsilon(0.05));
  CHECK(fold.crossings == 0);
}

TEST_CASE("drawing one layer of a fold over the other takes mu N, and what it rubs is in the ledger",
          "[macroscale][self_contact][friction]") {
  const double force = 30.0;
  const Pressed fold = press(force, true);
  WARN("upper leg " << fold.pull_upper / (mu * force) << ", lower leg " << fold.pull_lower / (mu * force)
                    << " mu N; rubbed " << fold.rubbed / (mu * force * speed * dt)
                    << " of mu N times the way; ledger " << fold.residual / fold.work);
  // Drawn along -x: the layer below drags by mu N and so does the plate above.
  CHECK(fold.pull_upper == Approx(-2.0 * mu * force).epsilon(0.01));
  CHECK(fold.pull_lower == Approx(mu * force).epsilon(0.01));
  CHECK(fold.rubbed == Approx(mu * force * speed * dt).epsilon(0.01));
  CHECK(std::abs(fold.residual) < 1e-3 * fold.work);
}

namespace {

// Steps of a length until a time; one that fails is tried again with half of it. Returns how many were.
int run_until(System& system, State& state, double last, double longest,
              const std::function<void(double, VectorXd&)>& prescribe, const SolveOptions& options,
              const std::function<void(const StepData&, State&)>& look) {
  int rejected = 0;
  for (double length = longest; state.time < last * (1.0 - 1e-12);) {
    State end;
    StepData step;
    const StepSummary summary = advance(system, state, length, state.tool_z, prescribe, options, end, step);
    if (!summary.converged) {
      ++rejected;
      length *= 0.5;
      INFO(summary.reason << " at " << state.time);
      REQUIRE(length > 1e-4 * longest);
      continue;
    }
    look(step, end);
    state = std::move(end);
    length = std::min(longest, last - state.time);
  }
  return rejected;
}

struct Flight {
  int crossings = 0;
  double momentum = 0.0;  ///< change over all [N s]
  double residual = 0.0;  ///< of the ledger [J]
  double kinetic = 0.0;   ///< at the start [J]
  int rejected = 0;
  VectorXd x;
};

// What a checkpoint keeps of a state of a sheet that has met itself.
State through_checkpoint(const Scene& scene, const System& system, const State& state) {
  StampingCheckpoint checkpoint;
  checkpoint.state = state;
  checkpoint.blank = blank_state(system, state, nullptr);
  const StampingCheckpoint read = heddle::test::from(heddle::test::bytes_of(checkpoint));
  StateSizes sizes;
  sizes.tools = 1;
  CHECK_FALSE(fault_of(read, scene.blank, scene.contact_sites, 0, sizes).empty());  // it has no room for it
  sizes.self_contact = true;
  CHECK(fault_of(read, scene.blank, scene.contact_sites, 0, sizes).empty());
  return read.state;
}

// A hairpin whose upper leg flies down on the lower one, which flies up. With `kept` it is put away half-way
// and goes on in a system of its own.
Flight fly(bool touches, double speed_of_leg, double longest, bool kept = false) {
  const auto fabric = make_fabric({.bending = 1e-5});
  heddle::friction::Model friction;
  friction.law = heddle::friction::Coulomb{mu};
  const FoldedStrip strip = folded_strip(14, 4, 3, 5e-3);
  Scene scene;
  scene.blank = strip.blank;
  scene.fabric = &fabric;
  scene.friction = &friction;
  scene.self_contact = touches;
  scene.shear_rate = 0.0;
  // Far below: a stamping has a tool.
  scene.tools = {{Role::die, PlaneShape{{0, 0, -1.0}, {0, 0, 1}}, Motion::fixed, 0.0, 0.0}};
  System system(scene);
  State state = initial_state(scene);
  fold(strip, 12e-3, state.x);
  for (int n = 0; n < scene.blank.nodes(); ++n) {
    const double free_end = strip.upper(n)   ? (scene.blank.grid[n][0] - strip.leg - strip.tip) / 14.0
                            : strip.lower(n) ? (strip.leg - scene.blank.grid[n][0]) / -14.0
                                             : 0.0;
    state.v[3 * n + 2] = -speed_of_leg * free_end;
  }
  const auto momentum = [&](const State& s) {
    Vector3d sum = Vector3d::Zero();
    for (int i = 0; i < scene.blank.nodes(); ++i) sum += system.mass(3 * i) * s.v.segment<3>(3 * i);
    return sum;
  };
  Flight flight;
  for (Eigen::Index k = 0; k < state.v.size(); ++k)
    flight.kinetic += 0.5 * system.mass(static_cast<int>(k)) * state.v[k] * state.v[k];
  const Vector3d before = momentum(state);
  SolveOptions options;
  options.force_tolerance = 1e-9;
  options.relative_tolerance = 0.0;
  const double last = 0.06;
  const auto look = [&](const StepData& step, const State& end) {
    flight.residual += account(system, step, end).ledger.residual();
    flight.crossings = std::max(flight.crossings, count_crossings(scene.blank, end.x));
  };
  flight.rejected = run_until(system, state, 0.5 * last, longest, {}, options, look);
  System after(scene);
  if (kept) state = through_checkpoint(scene, system, state);
  flight.rejected += run_until(kept ? after : system, state, last, longest, {}, options, look);
  flight.momentum = (momentum(state) - before).norm();
  flight.x = state.x;
  return flight;
}

}  // namespace

TEST_CASE("legs of a hairpin that fly into each other cross without contact, and do not with it",
          "[macroscale][self_contact]") {
  const Flight through = fly(false, 0.4, 1e-3), held = fly(true, 0.4, 1e-3);
  WARN("without: " << through.crossings << " crossings; with: " << held.crossings << ", " << held.rejected
                   << " steps tried again; ledger " << held.residual / held.kinetic << ", momentum "
                   << held.momentum);
  CHECK(through.crossings > 0);
  CHECK(held.crossings == 0);
  CHECK(held.momentum < 1e-9);
  CHECK(std::abs(held.residual) < 1e-3 * held.kinetic);
  // The same again, bit for bit, and the same from a checkpoint.
  CHECK(fly(true, 0.4, 1e-3).x == held.x);
  CHECK(fly(true, 0.4, 1e-3, true).x == held.x);
}

TEST_CASE("a step in which legs would pass right through each other is tried again with half of it",
          "[macroscale][self_contact]") {
  // 10 mm a step and leg, where the fabric is 1.5 mm thick.
  const Flight through = fly(false, 2.0, 5e-3), held = fly(true, 2.0, 5e-3);
  WARN("without: " << through.crossings << "; with: " << held.crossings << ", " << held.rejected
                   << " steps tried again");
  CHECK(through.crossings > 0);
  CHECK(held.crossings == 0);
  CHECK(held.rejected > 0);
}

namespace {

struct Loop {
  int crossings = 0;
  double first = 0.0;    ///< share of the free length taken away when the first segment crossed [-]
  double nearest = 1.0;  ///< smallest gap of what meets [m]
  double push = 0.0;     ///< of the walls at the end [N]
  int rejected = 0;
};

// A strip clamped level between two walls that close until a fifteenth of its length is left: it bows into a
// loop whose neck closes.
Loop close_walls(bool touches) {
  constexpr int free_cells = 36, wide = 2;
  constexpr double h = 2.5e-3, length = free_cells * h;
  const auto fabric = make_fabric({.tow_stiffness = 1e5, .bending = 1e-3});
  Scene scene;
  scene.blank = make_blank({(free_cells + 2) * h, wide * h}, h * (1.0 + 1e-9));
  scene.fabric = &fabric;
  scene.self_contact = touches;
  scene.shear_rate = 0.0;
  const Blank& blank = scene.blank;
  scene.held.assign(static_cast<std::size_t>(scene.unknowns()), 0);
  const auto wall = [&](int n) {
    return blank.grid[n][0] < 2 ? -1 : blank.grid[n][0] > blank.nu - 2 ? 1 : 0;
  };
  for (int n = 0; n < blank.nodes(); ++n) {
    scene.held[3 * n + 1] = 1;  // it bends as a cylinder
    if (wall(n) != 0) scene.held[3 * n] = scene.held[3 * n + 2] = 1;
  }
  System system(scene);
  State state = initial_state(scene);
  const VectorXd flat = state.x;
  for (int n = 0; n < blank.nodes(); ++n)  // which way it bows
    if (wall(n) == 0)
      state.x[3 * n + 2] = 1e-3 * std::pow(std::cos(pi * blank.reference[n].x() / (length + h)), 2);
  constexpr double closed = 14.0 / 15.0 * length, last = 1e5;
  Loop loop;
  SolveOptions options;
  options.force_tolerance = 1e-7;
  options.relative_tolerance = 0.0;
  const auto close = [&](double time, VectorXd& x) {
    for (int n = 0; n < blank.nodes(); ++n)
      if (wall(n) != 0)
        x.segment<3>(3 * n) = flat.segment<3>(3 * n) - Vector3d(0.5 * wall(n) * closed * time / last, 0, 0);
  };
  loop.rejected =
      run_until(system, state, last, last / 90.0, close, options, [&](const StepData& step, State& end) {
        end.v.setZero();
        const int crossings = count_crossings(blank, end.x);
        if (loop.crossings == 0 && crossings > 0) loop.first = closed / length * end.time / last;
        loop.crossings = std::max(loop.crossings, crossings);
        for (const PlyPair& pair : step.pairs)
          if (pair.quad >= 0) loop.nearest = std::min(loop.nearest, gap(pair, end.x));
        const VectorXd support = system.full_gradient(step, end.x);
        loop.push = 0.0;
        for (int n = 0; n < blank.nodes(); ++n)
          if (wall(n) > 0) loop.push -= support[3 * n];
      });
  return loop;
}

}  // namespace

TEST_CASE(
    "a strip between closing walls loops through itself without contact, and its neck stays shut with it",
    "[macroscale][self_contact]") {
  const Loop through = close_walls(false), held = close_walls(true);
  WARN("without: " << through.crossings << " crossings from " << through.first << " of the length on; with: "
                   << held.crossings << ", nearest " << 1e3 * held.nearest << " mm, " << held.rejected
                   << " steps tried again; walls push " << through.push << " and " << held.push << " N");
  CHECK(through.crossings > 0);
  CHECK(held.crossings == 0);
  CHECK(held.nearest < thickness);
  CHECK(held.nearest > 0.5 * thickness);
}
