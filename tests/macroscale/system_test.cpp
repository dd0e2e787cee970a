#include <catch2/catch.hpp>

#include <random>

#include <Eigen/Geometry>

#include "macroscale/ledger.h"
#include "macroscale/system.h"
#include "tests/macroscale/matrix_product.h"
#include "tests/macroscale/sample_fabric.h"
#include "tests/macroscale/slope_checks.h"

using namespace heddle::macroscale;
using Eigen::Vector3d;
using Eigen::VectorXd;
using heddle::test::check_slopes;
using heddle::test::make_fabric;
using heddle::test::multiply;

namespace {

struct Bench {
  heddle::mesoscale::FabricProperties fabric = make_fabric({.rate_consistency = 5.0});
  heddle::friction::Model friction;
  Scene scene;
  State state;
  StepData step;
};

// A crumpled little blank between a punch, a die plate and a loaded binder, with every term of the potential
// alive.
std::unique_ptr<Bench> bench(ContactSites sites = ContactSites::nodes) {
  auto b = std::make_unique<Bench>();
  b->scene.contact_sites = sites;
  b->friction.law = heddle::friction::Coulomb{0.3};
  b->scene.blank = make_blank({0.04, 0.03}, 0.01);
  b->scene.fabric = &b->fabric;
  b->scene.friction = &b->friction;
  b->scene.tools = {{Role::punch, HemisphereShape{{0, 0, 0.75e-3}, 0.05}, Motion::driven, 0.0, 0.0},
                    {Role::die, PlaneShape{{0, 0, -0.75e-3}, {0, 0, 1}}, Motion::fixed, 0.0, 0.0},
                    {Role::binder, PlaneShape{{0, 0, 0.75e-3}, {0, 0, -1}}, Motion::loaded, 40.0, 0.5}};
  b->scene.slip_smoothing = 1e-3;
  b->scene.stabilisation = 100.0;
  b->state = initial_state(b->scene);
  b->step.dt = 5e-3;
  b->step.start = &b->state;
  b->step.target = b->state.x;
  b->step.tool_z = {-1e-4, 0.0, 0.0};
  b->step.friction.assign(3, std::vector<FrictionPoint>(contact_count(b->scene.blank, sites)));
  for (auto& tool : b->step.friction)
    for (auto& point : tool) {
      point.load = 0.5;
      point.context.pressure = 1e4;
    }
  return b;
}

heddle::Curve stiffer_compaction() {
  return make_fabric({.contact_stiffness = 2e9}).compaction.curves().front();
}

VectorXd shaken(const Bench& b, double size) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(-size, size);
  VectorXd x = b.state.x;
  for (double& value : x) value += uniform(random);
  return x;
}

}  // namespace

TEST_CASE("the residual is the slope of the incremental potential, the matrix the slope of the residual",
          "[macroscale][system][derivative]") {
  const auto b = bench(GENERATE(ContactSites::nodes, ContactSites::gauss));
  if (GENERATE(false, true)) {  // a binder with a rounded edge that tilts on springs
    Tool& binder = b->scene.tools[2];
    binder.shape = RingShape{0.6e-3, 0.004, 0.008, false};
    binder.stiffness = 1e4;
    binder.tilt = Tilt{{0.001, -0.002, 0.6e-3}, 0.02};
    b->state = initial_state(b->scene);
    b->step.target = b->state.x;
  }
  if (GENERATE(false, true)) {  // effects of the fabric
    b->scene.effects.shear_locking = {50.0, 0.01, 2.5};
    b->scene.effects.softening = {0.01, 400.0};
    b->scene.effects.tow_viscosity = 100.0;
    b->scene.coupling = coupling_of({0.5, 1000.0}, b->fabric.tension_energy);
    b->state.x *= 1.001;
  }
  System system(b->scene);
  if (GENERATE(false, true)) {  // compaction of the sheared fabric, another one at each point
    b->fabric.compaction =
        heddle::CurveFamily({0.0, 0.8}, {b->fabric.compaction.curves().front(), stiffer_compaction()});
    for (int i = 0; i < system.contacts(); ++i) b->step.contact_shear.push_back(0.1 * (i % 9) - 0.4);
  }
  const VectorXd x = shaken(*b, 2e-4), d = shaken(*b, 1.0) - b->state.x;
  check_slopes(system, b->step, x, d);
  // Rows of the binder by themselves: the whole could hide their faults behind stiff tows.
  const int first = system.unknown_of(2), own = unknowns_of(b->scene.tools[2]);
  const VectorXd row = heddle::test::tangent_of(system, b->step, x, d).segment(first, own);
  const auto residual = [&](double t) -> VectorXd {
    return system.gradient(b->step, VectorXd(x + t * d)).segment(first, own);
  };
  CHECK(heddle::test::tangent_gap(residual, row) < 1e-6);
  CHECK(heddle::test::tangent_gap(residual, 1.01 * row) > 1e-3);
}

TEST_CASE("a held unknown has no residual and an identity row", "[macroscale][system]") {
  const auto b = bench();
  b->scene.held.assign(3 * b->scene.blank.nodes(), 0);
  b->scene.held[7] = 1;
  System system(b->scene);
  const VectorXd x = shaken(*b, 2e-4);
  CHECK(system.gradient(b->step, x)[7] == 0.0);
  CHECK(system.full_gradient(b->step, x)[7] != 0.0);
  system.assemble(b->step, x, Filter::none);
  VectorXd e = VectorXd::Zero(x.size());
  e[7] = 1.0;
  CHECK((multiply(system.solver().pattern(), system.solver().values(), e) - e).norm() == 0.0);
}

TEST_CASE("V1: rigid motion costs nothing, and a turned blank has turned forces",
          "[macroscale][system][invariant]") {
  const auto b = bench();
  b->scene.tools.clear();
  b->scene.stabilisation = 0.0;
  b->scene.shear_rate = false;
  b->state = initial_state(b->scene);
  b->step.start = &b->state;
  System system(b->scene);
  const Eigen::Matrix3d r = Eigen::AngleAxisd(0.8, Vector3d(1, -2, 0.5).normalized()).toRotationMatrix();
  const auto moved = [&](const VectorXd& x) {
    VectorXd y = x;
    for (int i = 0; i < b->scene.blank.nodes(); ++i)
      y.segment<3>(3 * i) = r * x.segment<3>(3 * i) + Vector3d(0.1, 0.2, 0.3);
    return y;
  };
  const auto internal = [&](const VectorXd& x) {
    b->step.target = x;  // no inertia force
    return system.gradient(b->step, x);
  };
  const double scale = 5.9e6 * 0.01;  // EA times the spacing [N]
  CHECK(internal(moved(b->state.x)).cwiseAbs().maxCoeff() < 1e-12 * scale);

  const VectorXd x = shaken(*b, 2e-4);
  const VectorXd g = internal(x), turned = internal(moved(x));
  for (int i = 0; i < b->scene.blank.nodes(); ++i)
    CHECK((turned.segment<3>(3 * i) - r * g.segment<3>(3 * i)).norm() < 1e-12 * scale);
  const auto stored = [&](const VectorXd& y) {
    b->step.target = y;
    return system.potential(b->step, y).total();
  };
  CHECK(stored(moved(x)) == Approx(stored(x)).epsilon(1e-12));
}

TEST_CASE("V2: uniform stretch and shear leave no residual inside the blank", "[macroscale][system][patch]") {
  const auto b = bench();
  b->scene.tools.clear();
  b->scene.stabilisation = 0.0;
  b->state = initial_state(b->scene);
  b->step.start = &b->state;
  System system(b->scene);
  Eigen::Matrix3d f;
  f << 1.004, 0.35, 0, 0.02, 0.93, 0, 0.1, -0.05, 1;
  VectorXd x = b->state.x;
  for (int i = 0; i < b->scene.blank.nodes(); ++i) x.segment<3>(3 * i) = f * b->state.x.segment<3>(3 * i);
  b->step.target = x;
  const VectorXd g = system.gradient(b->step, x);
  const double scale = g.cwiseAbs().maxCoeff();
  REQUIRE(scale > 1.0);  // the outline carries the stress
  // Two rows in: bending reaches the second neighbour.
  const int i = 2;
  for (int j = 1; j < b->scene.blank.nv; ++j)
    CHECK(g.segment<3>(3 * b->scene.blank.node(i, j)).norm() < 1e-10 * scale);
}
