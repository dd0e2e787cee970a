// Where contact is asked for: nodes and Gauss points, and fabric that is pressed sheared.
#include <catch2/catch.hpp>

#include <cmath>
#include <numeric>

#include "macroscale/checkpoint.h"
#include "macroscale/friction_lag.h"
#include "macroscale/stamping.h"
#include "tests/derivative_check.h"
#include "tests/macroscale/quasi_static.h"
#include "tests/macroscale/sample_fabric.h"

using namespace heddle::macroscale;
using Eigen::Vector3d;
using Eigen::VectorXd;
using heddle::test::derivative_gap;
using heddle::test::make_fabric;

namespace {

const auto both_sites = {ContactSites::nodes, ContactSites::gauss};

/// Tows so soft that what rounding leaves of their forces does not hide the sum of pressures.
constexpr heddle::test::SampleFabric soft{.tow_stiffness = 1e3};

/// A round blank at 30 degrees to its tows, its cells distorted in the plane, between a plate and a loaded
/// one.
struct Press {
  heddle::mesoscale::FabricProperties fabric;
  Scene scene;
  double force = 60.0;  ///< [N]

  explicit Press(ContactSites sites, heddle::mesoscale::FabricProperties pressed = make_fabric(soft))
      : fabric(std::move(pressed)) {
    scene.contact_sites = sites;
    scene.blank = make_blank(circle(0.05, 1e-6), 8e-3, 0.5);
    scene.fabric = &fabric;
    scene.tools = {{Role::die, PlaneShape{{0, 0, -0.75e-3}, {0, 0, 1}}, Motion::fixed, 0.0, 0.0},
                   {Role::binder, PlaneShape{{0, 0, 0.75e-3}, {0, 0, -1}}, Motion::loaded, force, 0.5}};
  }
};

/// Pressures of both plates at the nodes and the sum of contact forces once the plates have come to rest.
struct Rest {
  std::vector<double> pressure;
  double force = 0.0, area = 0.0, approach = 0.0;
};

Rest at_rest(Press& press, const Eigen::Matrix2d& deformation = Eigen::Matrix2d::Identity(),
             bool distorted = true) {
  Scene& scene = press.scene;
  heddle::friction::Model friction;
  scene.friction = &friction;
  System system(scene);
  State state = initial_state(scene);
  scene.held.assign(3 * scene.blank.nodes(), 0);
  for (int i = 0; i < scene.blank.nodes(); ++i) {
    const Vector3d r = scene.blank.reference[i];
    Eigen::Vector2d x = deformation * r.head<2>();
    if (distorted) x += 0.25e-3 * Eigen::Vector2d(std::sin(900.0 * r.y()), std::sin(700.0 * r.x()));
    state.x.segment<2>(3 * i) = x;
    scene.held[3 * i] = scene.held[3 * i + 1] = 1;
  }
  state.corner_angle = corner_angles(scene.blank, state);
  const VectorXd laid = state.x;
  SolveOptions options;
  options.force_tolerance = 1e-10;
  options.relative_tolerance = 0.0;
  options.frictionless = true;
  heddle::test::run_at_rest(
      system, state, 1.0, 6, {},
      [&](double, VectorXd& x) {
        for (int i = 0; i < scene.blank.nodes(); ++i) x.segment<2>(3 * i) = laid.segment<2>(3 * i);
      },
      {}, options);
  StepData step;
  step.dt = 1.0;
  step.start = &state;
  step.tool_z = state.tool_z;
  const auto shear = contact_shear_angle(scene.blank, scene.contact_sites, state.corner_angle);
  if (scene.compaction_follows_shear) step.contact_shear = shear;
  step.friction = freeze(system, step, state.x, shear);
  Rest rest{nodal_pressure(system, step, 0)};
  const auto upper = nodal_pressure(system, step, 1);
  rest.pressure.insert(rest.pressure.end(), upper.begin(), upper.end());
  for (int i = 0; i < system.contacts(); ++i) {
    rest.force += step.friction[0][i].load;
    rest.area += system.contact_area(step, i);
    rest.approach += system.tool_contact(step, state.x, 0, i).normal.approach / system.contacts();
  }
  return rest;
}

heddle::mesoscale::FabricProperties stiffer_when_sheared(const heddle::test::SampleFabric& flat) {
  auto fabric = make_fabric(flat);
  const auto stiff = make_fabric({.contact_stiffness = 2e9});
  fabric.compaction = heddle::CurveFamily(
      {0.0, 0.6}, {fabric.compaction.curves().front(), stiff.compaction.curves().front()});
  return fabric;
}

}  // namespace

TEST_CASE("contact points share the blank's area and follow rigid motion and stretch exactly",
          "[macroscale][contact]") {
  const Blank blank = make_blank(circle(0.05, 1e-6), 8e-3, 0.5);
  for (const auto sites : both_sites) {
    const auto points = contact_points(blank, sites);
    REQUIRE(static_cast<int>(points.size()) == contact_count(blank, sites));
    std::vector<double> at_node(blank.nodes(), 0.0);
    VectorXd x(3 * blank.nodes());
    for (int i = 0; i < blank.nodes(); ++i) x.segment<3>(3 * i) = blank.reference[i];
    Vector3d moment = Vector3d::Zero(), of_nodes = Vector3d::Zero();
    for (const ContactPoint& point : points) {
      double sum = 0.0;
      for (int a = 0; a < point.nodes; ++a) {
        at_node[point.node[a]] += point.weight[a] * point.area;
        sum += point.weight[a];
      }
      CHECK(sum == Approx(1.0).epsilon(1e-15));
      moment += point.area * at_point(point, x);
    }
    for (int i = 0; i < blank.nodes(); ++i) {
      CHECK(at_node[i] == Approx(blank.node_area[i]).epsilon(1e-12));
      of_nodes += blank.node_area[i] * blank.reference[i];
    }
    CHECK((moment - of_nodes).norm() < 1e-15);
  }
}

TEST_CASE("V2: a plate presses trimmed and distorted cells evenly, and the pressures sum to its force",
          "[macroscale][contact][verification][patch]") {
  for (const auto sites : both_sites) {
    Press press(sites);
    const Rest rest = at_rest(press);
    CHECK(rest.force == Approx(press.force).epsilon(1e-10));
    const double mean = press.force / rest.area;
    for (const double p : rest.pressure) CHECK(p == Approx(mean).epsilon(0.01));
  }
}

TEST_CASE("a sheared sheet between plates carries its force by the pressure of its angle on its own area",
          "[macroscale][contact][verification]") {
  const double gamma = 0.3, s = std::sin(gamma), c = std::cos(gamma);
  // Warp stays, weft turns by gamma, in the axes of the tows.
  Eigen::Matrix2d tows, shear;
  tows << std::cos(0.5), -std::sin(0.5), std::sin(0.5), std::cos(0.5);
  shear << 1.0, s, 0.0, c;
  for (const auto sites : both_sites) {
    Press press(sites, stiffer_when_sheared(soft));
    press.scene.compaction_follows_shear = true;
    const Rest rest = at_rest(press, tows * shear * tows.transpose(), false);
    const double flat =
        std::accumulate(press.scene.blank.node_area.begin(), press.scene.blank.node_area.end(), 0.0);
    CHECK(rest.area == Approx(c * flat).epsilon(1e-9));
    CHECK(rest.force == Approx(press.force).epsilon(1e-10));
    CHECK(press.fabric.compaction.evaluate(rest.approach, gamma).y ==
          Approx(press.force / (c * flat)).epsilon(1e-4));
    // As flat fabric the same sheet gives way more.
    press.scene.compaction_follows_shear = false;
    CHECK(at_rest(press, tows * shear * tows.transpose(), false).approach > 1.3 * rest.approach);
  }
}

TEST_CASE(
    "energy, pressure and stiffness of a sheared fabric's compaction are each the slope of the one before",
    "[macroscale][contact][derivative]") {
  const auto family = stiffer_when_sheared({}).compaction;
  const double gap = GENERATE(0.7e-3, 0.5e-3, 0.2e-3), angle = GENERATE(-0.2, 0.45, 0.9), half = 0.75e-3;
  const auto at = normal_contact(family, angle, gap, half);
  const auto energy = [&](double d) { return normal_contact(family, angle, d, half).energy; };
  const auto pressure = [&](double d) { return normal_contact(family, angle, d, half).pressure; };
  CHECK(derivative_gap(energy, gap, 1e-4, -at.pressure) < 1e-7);
  CHECK(derivative_gap(pressure, gap, 1e-4, -at.stiffness) < 1e-7);
  CHECK(derivative_gap(pressure, gap, 1e-4, -1.01 * at.stiffness) > 1e-4);
  CHECK(normal_contact(family, 0.0, gap, half).pressure ==
        normal_contact(family.curves().front(), gap, half).pressure);
}

namespace {

StampingSpec small_stamping() {
  StampingSpec spec;
  spec.blank.spacing = 32e-3;
  spec.process.stroke = 25e-3;
  spec.process.time = 0.15;
  spec.process.steps = 5;
  return spec;
}

heddle::friction::Model evolving() {
  heddle::friction::Model model;
  model.law = heddle::friction::Coulomb{0.3};
  model.effects.sliding_evolution = heddle::friction::SlidingEvolution{.amplitude = -0.3, .length = 5e-3};
  return model;
}

}  // namespace

TEST_CASE("a stamping with Gauss points closes its ledger and goes on from a checkpoint to the same bits",
          "[macroscale][contact][checkpoint]") {
  StampingSpec spec = small_stamping();
  spec.contact_sites = ContactSites::gauss;
  const auto fabric = make_fabric({.rate_consistency = 5.0});
  const auto law = evolving();
  StampingCheckpoint half;
  StampingControl control;
  control.keep = [&](const StampingCheckpoint& at, bool) {
    if (at.step == 3) half = at;
  };
  const StampingResult whole = run_stamping(spec, fabric, law, control);
  REQUIRE(whole.summary.completed);
  CHECK(whole.summary.energy_residual_max < 0.01);
  CHECK(whole.summary.force_balance_residual_max < 1e-3);
  CHECK(whole.summary.symmetry_gap_shear < 1e-5);
  double largest = 0.0;
  for (double p : whole.final_state.pressure) largest = std::max(largest, p);
  CHECK(largest > 1e3);

  StampingControl rest;
  rest.resume_from = &half;
  const StampingResult resumed = run_stamping(spec, fabric, law, rest);
  CHECK(resumed.summary.peak_punch_force == whole.summary.peak_punch_force);
  CHECK(resumed.final_state.position == whole.final_state.position);
  spec.contact_sites = ContactSites::nodes;  // another number of contacts
  CHECK_THROWS_AS(run_stamping(spec, fabric, law, rest), std::invalid_argument);
}

TEST_CASE(
    "a stamping whose compaction follows shear closes its ledger, and on a fabric that knows no shear only "
    "areas differ",
    "[macroscale][contact]") {
  StampingSpec spec = small_stamping();
  spec.contact_sites = GENERATE(ContactSites::nodes, ContactSites::gauss);
  const auto law = evolving();
  const auto plain = make_fabric({.rate_consistency = 5.0});
  auto stiff = stiffer_when_sheared({});
  stiff.shear_rate = plain.shear_rate;
  const double without = run_stamping(spec, plain, law).summary.peak_punch_force;
  spec.compaction_follows_shear = true;
  const StampingResult same = run_stamping(spec, plain, law), other = run_stamping(spec, stiff, law);
  REQUIRE(other.summary.completed);
  CHECK(other.summary.energy_residual_max < 0.01);
  // What holding the angle over a step leaves out, beside the dissipation of five large steps.
  CAPTURE(same.summary.numerical_dissipation_share, other.summary.numerical_dissipation_share);
  CHECK(std::abs(other.summary.numerical_dissipation_share - same.summary.numerical_dissipation_share) <
        0.02);
  CHECK(same.summary.peak_punch_force == Approx(without).epsilon(0.02));
  CHECK(other.summary.peak_punch_force != same.summary.peak_punch_force);
}
