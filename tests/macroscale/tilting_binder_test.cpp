// A binder that tilts as the fabric below it asks.
#include <catch2/catch.hpp>

#include <cmath>
#include <numbers>
#include <utility>

#include <Eigen/Dense>

#include "macroscale/checkpoint.h"
#include "macroscale/closing.h"
#include "macroscale/stamping.h"
#include "macroscale/stamping_scene.h"
#include "macroscale/system.h"
#include "macroscale/tool_pose.h"
#include "tests/derivative_check.h"
#include "tests/macroscale/kept_stamping.h"
#include "tests/macroscale/sample_fabric.h"
#include "tests/macroscale/sample_stamping.h"

using namespace heddle::macroscale;
using Eigen::Vector3d;
using heddle::test::coarse_stamping;
using heddle::test::coulomb;
using heddle::test::derivative_gap;
using heddle::test::make_fabric;

namespace {

Tool tilting_ring() {
  Tool tool{Role::binder, RingShape{0.7e-3, 0.092, 0.01, false}, Motion::loaded, 650.0, 20.0};
  tool.tilt = Tilt{{0.002, -0.001, 0.7e-3}, 0.12};
  return tool;
}

/// Both the slope and that one a percent off is seen.
template <class Function>
void check_slope(const Function& value, double at, double scale, double slope, double least) {
  if (std::abs(slope) < least) return;
  CHECK(derivative_gap(value, at, scale, slope) < 1e-6);
  CHECK(derivative_gap(value, at, scale, 1.01 * slope) > 1e-4);
}

StampingSpec tilting_stamping() {
  StampingSpec spec = coarse_stamping(10);
  spec.binder.free_tilt = true;
  return spec;
}

Outline shifted_square(double aside) {
  Outline outline;
  for (const auto& [x, y] : {std::pair{-1, -1}, std::pair{1, -1}, std::pair{1, 1}, std::pair{-1, 1}})
    outline.outer.push_back({aside + 0.15 * x, 0.15 * y});
  return outline;
}

void check_books(const StampingResult& result) {
  CAPTURE(result.summary.failure);
  REQUIRE(result.summary.completed);
  CHECK(result.summary.energy_residual_max < 1e-6);
  CHECK(result.summary.force_balance_residual_max < 1e-3);
}

/// Force of the fabric on the binder and its moment about the punch's axis, level components.
struct Load {
  double force = 0.0;                                ///< upwards [N]
  Eigen::Vector2d moment = Eigen::Vector2d::Zero();  ///< [N m]
  double size = 0.0;                                 ///< sum of sizes of what adds up to the moment [N m]
};

Load load_of_binder(const System& system, const State& state, int binder) {
  Load load;
  const Pose pose = system.pose(state, binder);
  for (int i = 0; i < system.contacts(); ++i) {
    const auto [d, contact] = system.contact_at(state.node(i), binder, pose);
    const Vector3d force = system.scene().blank.node_area[i] * contact.pressure * -d.normal;
    const Vector3d moment = (state.node(i) - system.scene().tools[binder].tilt->pivot).cross(force);
    load.force += force.z();
    load.moment += moment.head<2>();
    load.size += moment.head<2>().norm();
  }
  return load;
}

}  // namespace

TEST_CASE("normal, curvature and slopes of a tilting tool are those of its distance",
          "[macroscale][press][tilt][derivative]") {
  const Tool tool = tilting_ring();
  const Tilt& tilt = *tool.tilt;
  const Pose pose{1e-4, {2e-3, -3e-3}};
  for (const Vector3d& x :
       {Vector3d(0.13, 0.02, -0.001), Vector3d(0.07, 0.065, 0.002), Vector3d(-0.02, 0.094, 0.004)}) {
    const Distance at = distance(tool, pose, x);
    const Vector3d slopes = slopes_at(tilt, pose, x, at.normal);
    const TiltCurvature bent = curvature_at(tilt, pose, x, at);
    for (int c = 0; c < 3; ++c) {
      const auto beside = [&](double t) {
        Vector3d y = x;
        y[c] = t;
        return distance(tool, pose, y);
      };
      check_slope([&](double t) { return beside(t).distance; }, x[c], 0.01, at.normal[c], 1e-3);
      const auto moved = [&](double t) {
        Pose other = pose;
        (c == 0 ? other.z : other.lift[static_cast<std::size_t>(c - 1)]) = t;
        return other;
      };
      const double unknown = c == 0 ? pose.z : pose.lift[static_cast<std::size_t>(c - 1)];
      check_slope([&](double t) { return distance(tool, moved(t), x).distance; }, unknown, 0.01, slopes[c],
                  1e-3);
      for (int r = 0; r < 3; ++r) {
        check_slope([&](double t) { return beside(t).normal[r]; }, x[c], 0.01, at.curvature(r, c), 1e-2);
        check_slope([&](double t) { return distance(tool, moved(t), x).normal[r]; }, unknown, 0.01,
                    bent.with_point(r, c), 1e-2);
        check_slope(
            [&](double t) { return slopes_at(tilt, moved(t), x, distance(tool, moved(t), x).normal)[r]; },
            unknown, 0.01, bent.own(r, c), 1e-2);
      }
    }
    const Pose further{3e-4, {5e-3, 1e-3}};
    Vector3d ways = Vector3d::Zero();
    const Vector3d by(2e-4, 3e-3, 4e-3);
    for (int c = 0; c < 3; ++c) ways += by[c] * ways_at(tilt, x)[static_cast<std::size_t>(c)];
    CHECK((carried(tool, pose, further, x) - ways).norm() < 1e-15);
  }
}

TEST_CASE("a tool that stands level is where it stood without a tilt", "[macroscale][press][tilt]") {
  Tool tool = tilting_ring();
  const Vector3d x(0.097, 0.01, 0.001);
  const Distance free = distance(tool, Pose{1e-4}, x);
  tool.tilt.reset();
  const Distance held = distance(tool, Pose{1e-4}, x);
  CHECK(free.distance == held.distance);
  CHECK(free.normal == held.normal);
  CHECK(free.curvature == held.curvature);
  // Turned by 0.01 rad about x it stands off by the height of its slope.
  tool.tilt = Tilt{{0.0, 0.0, 0.7e-3}, 0.1};
  const auto gap = [&](double y, double angle) {
    return distance(tool, Pose{0.0, {0.1 * angle, 0.0}}, {0.0, y, -0.001}).distance;
  };
  CHECK(gap(0.12, 0.01) - gap(0.12, 0.0) == Approx(0.12 * std::sin(0.01)).epsilon(1e-3));
  CHECK(gap(-0.12, 0.01) - gap(-0.12, 0.0) == Approx(-0.12 * std::sin(0.01)).epsilon(1e-3));
}

TEST_CASE("the tilt's arm is the radius of gyration of what the binder presses",
          "[macroscale][press][tilt]") {
  StampingSpec spec;
  spec.blank.spacing = 2e-3;
  spec.binder.free_tilt = true;
  const double side = spec.blank.size[0], hole = spec.binder.inner_radius + spec.binder.edge_fillet;
  const double area = side * side - std::numbers::pi * hole * hole;
  const double polar = std::pow(side, 4) / 6.0 - std::numbers::pi * std::pow(hole, 4) / 2.0;
  const heddle::friction::Model friction = coulomb();
  const auto fabric = make_fabric({});
  const Scene scene = stamping_scene(spec, fabric, friction);
  CHECK(scene.tools[2].tilt->arm == Approx(std::sqrt(polar / (2.0 * area))).epsilon(1e-3));
}

TEST_CASE("on a blank that lies to one side the closed binder tilts until pressure balances about its axis",
          "[macroscale][press][tilt]") {
  // A rigid plate on a bed of springs: at each node half of what the gap lacks of the thickness is pressed
  // into either face.
  StampingSpec spec = tilting_stamping();
  spec.blank.shape = BlankShape::polygon;
  spec.blank.polygon = shifted_square(0.02);
  const auto fabric = make_fabric({.toe = 1e-12});
  const heddle::friction::Model friction = coulomb();
  Scene scene = stamping_scene(spec, fabric, friction);
  constexpr int binder = 2;
  REQUIRE(scene.tools[binder].tilt);
  System system(scene);
  State state = initial_state(scene);
  StepData step;
  REQUIRE(close_binder(scene, system, {}, state, step).converged);
  const Load load = load_of_binder(system, state, binder);
  CHECK(load.force == Approx(650.0).epsilon(2e-3));
  CHECK(load.moment.norm() < 2e-3 * load.size);

  // The bed's own equilibrium: this fabric's pressure is linear in the approach.
  const heddle::Curve& table = fabric.compaction.curves().front();
  const double stiffness = table(2e-5) / 2e-5;
  REQUIRE(table(1e-5) == Approx(1e-5 * stiffness));
  Eigen::Matrix3d bed = Eigen::Matrix3d::Zero();
  Vector3d rest = Vector3d::Zero();
  const double closed = distance(scene.tools[1], Vector3d(0.15, 0.0, 0.0)).distance;
  for (int i = 0; i < scene.blank.nodes(); ++i) {
    const Vector3d& x = scene.blank.reference[i];
    if (x.head<2>().norm() < spec.binder.inner_radius + spec.binder.edge_fillet) continue;
    const Vector3d ways(1.0, x.y(), -x.x());  // of a plate lifted, turned about x, turned about y
    bed += 0.5 * stiffness * scene.blank.node_area[i] * ways * ways.transpose();
    rest += stiffness * scene.blank.node_area[i] * (0.5 * fabric.thickness - closed) * ways;
  }
  const Vector3d answer = bed.ldlt().solve(rest - Vector3d(650.0, 0.0, 0.0));
  const Pose pose = system.pose(state, binder);
  const double arm = scene.tools[binder].tilt->arm;
  CHECK(std::abs(answer[2]) > 1e-5);
  CHECK(pose.lift[0] / arm == Approx(answer[1]).margin(0.005 * std::abs(answer[2])));
  CHECK(pose.lift[1] / arm == Approx(answer[2]).epsilon(0.005));
}

TEST_CASE("under a symmetric part a binder free to tilt stays level, and the part is that of a level one",
          "[macroscale][press][tilt]") {
  StampingSpec spec = tilting_stamping();
  const auto fabric = make_fabric({.rate_consistency = 5.0});
  const auto free = run_stamping(spec, fabric, coulomb());
  check_books(free);
  spec.binder.free_tilt = false;
  const auto held = run_stamping(spec, fabric, coulomb());
  CHECK(free.history.back().binder_tilt < 1e-7);
  CHECK(held.history.back().binder_tilt == 0.0);
  CHECK(free.summary.peak_punch_force == Approx(held.summary.peak_punch_force).epsilon(1e-4));
  CHECK(free.summary.draw_in_max == Approx(held.summary.draw_in_max).epsilon(1e-3));
}

TEST_CASE(
    "under a blank that lies to one side the binder tilts, mirrored where the blank is, and less on springs",
    "[macroscale][press][tilt]") {
  double lift = 0.0;  // of the turn about y
  const auto with = [&](double aside, double springs) {
    StampingSpec spec = tilting_stamping();
    spec.blank.shape = BlankShape::polygon;
    spec.blank.polygon = shifted_square(aside);
    spec.binder.stiffness = springs;
    StampingControl control;
    control.keep = [&](const StampingCheckpoint& c, bool) { lift = c.state.x[c.state.x.size() - 1]; };
    const auto result = run_stamping(spec, make_fabric({}), coulomb(), control);
    check_books(result);
    return result;
  };
  const auto right = with(0.02, 0.0);
  const double lift_right = lift;
  const auto left = with(-0.02, 0.0);
  const double lift_left = lift;
  const auto sprung = with(0.02, 1e8);
  CAPTURE(lift_right, lift_left, right.history.back().binder_tilt, sprung.history.back().binder_tilt);
  // The binder is supported more to the right, so its left sinks: a turn about y is positive where x falls.
  CHECK(lift_right < -1e-6);
  CHECK(lift_left == Approx(-lift_right).epsilon(1e-3));
  CHECK(sprung.history.back().binder_tilt < 0.7 * right.history.back().binder_tilt);
  for (std::size_t k = 0; k < 8; ++k)
    CHECK(right.summary.draw_in_rays[k] == Approx(left.summary.draw_in_rays[(12 - k) % 8]).margin(2e-6));
}

TEST_CASE("a stamping with a tilting binder goes on from a checkpoint to the same bits, and lets go",
          "[macroscale][press][tilt]") {
  StampingSpec spec = tilting_stamping();
  spec.process.steps = 4;
  spec.process.press.punch_offset = {1e-3, 5e-4};
  spec.process.press.release = true;
  spec.binder.stiffness = 1e6;
  spec.contact_sites = GENERATE(ContactSites::nodes, ContactSites::gauss);
  const auto fabric = make_fabric({});
  const auto [kept, whole] = heddle::test::run_and_keep(spec, fabric, coulomb());
  check_books(whole);
  REQUIRE(whole.summary.release);
  CHECK(std::abs(whole.summary.release->row.ledger_residual) < 1e-3 * whole.history.back().work_punch);
  const auto again = heddle::test::go_on(kept[2], spec, fabric, coulomb());
  CHECK(again.final_state.position == whole.final_state.position);
  CHECK(whole.history.back().binder_tilt > 1e-8);
  CHECK(again.history.back().binder_tilt == whole.history.back().binder_tilt);
}
