// Effects of fabric and process beside friction: laws of one corner, closed forms, whole stampings.
#include "macroscale/fabric_effects.h"

#include <catch2/catch.hpp>

#include <cmath>
#include <numbers>
#include <random>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include "macroscale/corner_element.h"
#include "macroscale/ledger.h"
#include "macroscale/stamping.h"
#include "macroscale/stamping_scene.h"
#include "tests/derivative_check.h"
#include "tests/macroscale/sample_fabric.h"
#include "tests/macroscale/sample_stamping.h"
#include "tests/macroscale/steps.h"

using namespace heddle::macroscale;
using Eigen::Vector3d;
using heddle::Curve;
using heddle::Surface;
using heddle::mesoscale::FabricProperties;
using heddle::test::coarse_stamping;
using heddle::test::coulomb;
using heddle::test::derivative_gap;
using heddle::test::make_fabric;
using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Vector6 = Eigen::Matrix<double, 6, 1>;

namespace {

constexpr double degree = std::numbers::pi / 180.0;

// Tows with a toe that draw on each other, as crimp makes them: w = E/2 sum (e^2 + 40 e^3) + C e1 e2.
Surface crimped_tension() {
  constexpr int n = 41;
  std::vector<double> w;
  const auto own = [](double e) { return 0.5 * 2e5 * e * e + 4e6 * e * e * e + 2e9 * e * e * e * e; };
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const double e1 = -0.02 + 0.001 * i, e2 = -0.02 + 0.001 * j;
      w.push_back(own(e1) + own(e2) + 6e4 * e1 * e2);
    }
  return {-0.02, 0.001, n, -0.02, 0.001, n, w};
}

FabricProperties crimped_fabric() {
  FabricProperties fabric = make_fabric({.rate_consistency = 5.0});
  fabric.tension_energy = crimped_tension();
  std::vector<double> s, y;
  for (int k = 0; k <= 40; ++k) {
    s.push_back(0.95 * k / 40.0);
    y.push_back(30.0 * std::tanh(6.0 * s.back()) + 200.0 * std::pow(s.back(), 5.0));
  }
  fabric.shear_stress = Curve(s, y);
  return fabric;
}

// Everything that a corner can have at once.
struct Everything {
  FabricProperties fabric = crimped_fabric();
  Surface coupling = coupling_of({0.8, 2000.0}, fabric.tension_energy);
  CornerLaw law;

  Everything() {
    law.fabric = &fabric;
    law.area = 20e-6;
    law.length_warp = 4e-3;
    law.length_weft = 5e-3;
    law.rate_consistency = 5.0;
    law.rate_index = 0.38;
    law.time_step = 4e-3;
    law.shear_factor = 0.7;
    law.locking = {300.0, 15.0 * degree, 2.5};
    law.coupling = &coupling;
    law.tow_viscosity = 50.0;
    law.strain_before = {0.001, -0.002};
  }
};

Vector6 pose(int kind) {
  Vector6 y;
  if (kind == 0) y << 4.01e-3, 0, 0, 1.2e-3, 4.88e-3, 0.1e-3;        // stretched, sheared, locking
  if (kind == 1) y << 3.97e-3, 0.2e-3, 0.3e-3, -2.5e-3, 4.36e-3, 0;  // slack warp, the other way
  if (kind == 2) y << 3.7e-3, 0, 0.3e-3, 3.6e-3, 3.4e-3, 0;          // near locking, slack: indefinite
  if (kind == 3) y << 4.03e-3, 0, 0, 1.5 * 4.03e-3 * 0.1, 5.02e-3, 0.05e-3;  // both tows pull, little shear
  return y;
}

double energy_of(const CornerLaw& law, const Vector6& y) {
  return corner_energy(law, y.head<3>(), y.tail<3>(), 0.1).total();
}

Vector6 gradient_of(const CornerLaw& law, const Vector6& y) {
  const CornerGradient g = corner_gradient(law, y.head<3>(), y.tail<3>(), 0.1);
  Vector6 v;
  v << g.a(), g.b();
  return v;
}

Matrix6 hessian_of(const CornerLaw& law, const Vector6& y, Filter filter) {
  const CornerHessian h = corner_hessian(law, y.head<3>(), y.tail<3>(), 0.1, filter);
  Matrix6 m;
  m << h.aa, h.ab, h.ab.transpose(), h.bb;
  return m;
}

Matrix6 nearest_positive(const Matrix6& m) {
  const Eigen::SelfAdjointEigenSolver<Matrix6> e(m);
  return e.eigenvectors() * e.eigenvalues().cwiseMax(0.0).asDiagonal() * e.eigenvectors().transpose();
}

StampingResult run(const StampingSpec& spec, const FabricProperties& fabric) {
  StampingResult result = run_stamping(spec, fabric, coulomb());
  CAPTURE(result.summary.failure);
  REQUIRE(result.summary.completed);
  return result;
}

StampingResult run(const StampingSpec& spec) {
  const FabricProperties fabric = make_fabric({.rate_consistency = 5.0});
  return run(spec, fabric);
}

void check_same_bits(const StampingResult& a, const StampingResult& b) {
  CHECK(a.final_state.position == b.final_state.position);
  CHECK(a.history.back().punch_force == b.history.back().punch_force);
}

}  // namespace

TEST_CASE("locking is nothing below its angle, A ten degrees beyond it, odd, and the slope of its energy",
          "[macroscale][effect][derivative]") {
  const ShearLocking law{300.0, 35.0 * degree, 2.5};
  CHECK(locking_law(law, std::sin(34.9 * degree)).energy == 0.0);
  CHECK(locking_law(law, std::sin(34.9 * degree)).first == 0.0);
  const double there = std::sin(45.0 * degree);
  CHECK(locking_law(law, there).first * std::cos(45.0 * degree) == Approx(300.0).epsilon(1e-12));
  for (const double s : {0.6, 0.75, -0.7, -0.9}) {
    CAPTURE(s);
    const CornerScalar at = locking_law(law, s);
    CHECK(locking_law(law, -s).first == -at.first);
    CHECK(locking_law(law, -s).energy == at.energy);
    const auto energy = [&](double x) { return locking_law(law, x).energy; };
    const auto stress = [&](double x) { return locking_law(law, x).first; };
    CHECK(derivative_gap(energy, s, 1e-2, at.first) < 1e-7);
    CHECK(derivative_gap(energy, s, 1e-2, 1.01 * at.first) > 1e-4);
    CHECK(derivative_gap(stress, s, 1e-2, at.second) < 1e-7);
    CHECK(derivative_gap(stress, s, 1e-2, 1.01 * at.second) > 1e-4);
  }
}

TEST_CASE("with locking, coupling and flowing tows corner forces are slopes of one energy, stiffness theirs",
          "[macroscale][effect][corner][derivative]") {
  const Everything all;
  const int kind = GENERATE(0, 1, 2, 3);
  CAPTURE(kind);
  const Vector6 y = pose(kind);
  const Vector6 g = gradient_of(all.law, y);
  const Matrix6 h = hessian_of(all.law, y, Filter::none);
  CHECK((h - h.transpose()).norm() < 1e-12 * h.norm());
  Vector6 d;
  d << 0.3, -0.7, 0.5, -0.2, 0.6, 0.4;
  const auto energy = [&](double t) { return energy_of(all.law, y + t * d); };
  const double slope = g.dot(d);
  CHECK(derivative_gap(energy, 0.0, 1e-3, slope) < 1e-6);
  CHECK(derivative_gap(energy, 0.0, 1e-3, 1.01 * slope) > 1e-4);
  for (int k = 0; k < 6; ++k) {
    const auto force = [&](double t) { return gradient_of(all.law, y + t * d)[k]; };
    const double tangent = h.row(k).dot(d);
    CHECK(derivative_gap(force, 0.0, 1e-3, tangent) < 1e-5);
    CHECK(derivative_gap(force, 0.0, 1e-3, 1.01 * tangent) > 1e-4);
  }
}

TEST_CASE("a corner whose tension stiffens shear is filtered to the nearest positive matrix",
          "[macroscale][effect][corner]") {
  const Everything all;
  std::mt19937 random(7);
  std::uniform_real_distribution<double> off(-0.6, 0.6);
  int indefinite = 0;
  double worst = 0.0;
  for (int k = 0; k < 1000; ++k) {
    Vector6 y;
    y << 4e-3 * (1.0 + 0.02 * off(random)), 4e-3 * off(random), 4e-3 * off(random), 5e-3 * off(random),
        5e-3 * (1.0 + 0.3 * off(random)), 5e-3 * off(random);
    const Matrix6 exact = hessian_of(all.law, y, Filter::none);
    indefinite += Eigen::SelfAdjointEigenSolver<Matrix6>(exact).eigenvalues()[0] < 0.0;
    worst = std::max(
        worst, (hessian_of(all.law, y, Filter::positive) - nearest_positive(exact)).norm() / exact.norm());
  }
  CHECK(indefinite > 100);
  CHECK(worst < 1e-12);
}

TEST_CASE("a turned corner has the same energy and turned forces with every effect on",
          "[macroscale][effect][corner][invariant]") {
  const Everything all;
  const Vector6 y = pose(GENERATE(0, 1, 3));
  const Eigen::Matrix3d r = Eigen::AngleAxisd(1.1, Vector3d(1, 2, -1).normalized()).toRotationMatrix();
  Vector6 z;
  z << r * y.head<3>(), r * y.tail<3>();
  CHECK(energy_of(all.law, z) == Approx(energy_of(all.law, y)).epsilon(1e-11));
  const Vector6 g = gradient_of(all.law, y), turned = gradient_of(all.law, z);
  CHECK((turned.head<3>() - r * g.head<3>()).norm() < 1e-10 * g.norm());
  CHECK((turned.tail<3>() - r * g.tail<3>()).norm() < 1e-10 * g.norm());
}

TEST_CASE("where both tows carry the reference tension shear resists (1 + c) times as much, slack tows none",
          "[macroscale][effect]") {
  // n = E e, so the reference is carried at e = n_ref / E; there the table has a point.
  FabricProperties fabric = make_fabric({});
  const double reference = 0.005 * 5.9e6, c = 0.6;
  const Surface coupling = coupling_of({c, reference}, fabric.tension_energy);
  CornerLaw law;
  law.fabric = &fabric;
  law.area = law.length_warp = law.length_weft = 1.0;
  const auto shear_force = [&](const CornerLaw& of, double strain) {
    const double s = 0.3;
    const Vector3d a(1.0 + strain, 0.0, 0.0),
        b((1.0 + strain) * s, (1.0 + strain) * std::sqrt(1.0 - s * s), 0.0);
    return corner_gradient(of, a, b, 0.0).shear_a.y();
  };
  CornerLaw with = law;
  with.coupling = &coupling;
  CHECK(shear_force(with, 0.005) == Approx((1.0 + c) * shear_force(law, 0.005)).epsilon(1e-9));
  CHECK(shear_force(with, -0.005) == Approx(shear_force(law, -0.005)).epsilon(1e-3));
  // Four times the tension in both: psi = 16/5 n_ref each.
  CHECK(shear_force(with, 0.02) == Approx((1.0 + 6.4 * c) * shear_force(law, 0.02)).epsilon(1e-9));
}

TEST_CASE("crimp that is pulled out later stretches the toe and keeps the stiffness of straight tows",
          "[macroscale][effect]") {
  FabricProperties fabric = crimped_fabric();
  FabricEffects effects;
  effects.crimp_stretch = 0.25;
  const FabricProperties later = with_effects(fabric, effects);
  for (const double e1 : {-0.01, 0.003, 0.012})
    for (const double e2 : {-0.004, 0.0, 0.015}) {
      const Surface::Value was = fabric.tension_energy.evaluate(e1, e2),
                           is = later.tension_energy.evaluate(1.25 * e1, 1.25 * e2);
      CHECK(is.fx == Approx(1.25 * was.fx).epsilon(1e-12));
      CHECK(is.fxx == Approx(was.fxx).epsilon(1e-12));
      CHECK(is.fxy == Approx(was.fxy).epsilon(1e-12));
    }
  CHECK(heddle::mesoscale::check(later).empty());
  CHECK(with_effects(fabric, {}).tension_energy.values() == fabric.tension_energy.values());
}

TEST_CASE("tows stretched at a constant rate pull by eta times it, and the ledger holds eta rate^2 area time",
          "[macroscale][effect][ledger]") {
  const FabricProperties fabric = make_fabric({});
  const heddle::friction::Model friction = coulomb();
  Scene scene;
  scene.blank = make_blank({0.04, 0.03}, 0.01);
  scene.fabric = &fabric;
  scene.shear_rate = 0.0;
  scene.effects.tow_viscosity = 300.0;
  scene.held.assign(3 * scene.blank.nodes(), 1);
  System system(scene);
  State state = initial_state(scene);
  constexpr double rate = 0.05, dt = 0.01;  // [1/s], [s]; warp alone
  constexpr int steps = 4;
  const Eigen::VectorXd start = state.x;
  double time = 0.0, dissipated = 0.0, residual = 0.0, work = 0.0, end_force = 0.0;
  heddle::test::run_steps(
      system, state, dt, steps,
      [&](double, Eigen::VectorXd& x) {
        time += dt;
        for (int i = 0; i < scene.blank.nodes(); ++i) x[3 * i] = (1.0 + rate * time) * start[3 * i];
      },
      [&](const StepData& step, const State& end) {
        const StepAccount books = account(system, step, end);
        dissipated += books.ledger.tow_rate;
        work += books.ledger.work();
        residual += std::abs(books.ledger.residual());
        end_force = 0.0;
        const Eigen::VectorXd g = system.full_gradient(step, end.x);
        for (int i = 0; i < scene.blank.nodes(); ++i)
          if (start[3 * i] > 0.0199) end_force += g[3 * i];
      });
  CHECK(dissipated == Approx(300.0 * rate * rate * 0.04 * 0.03 * dt * steps).epsilon(1e-9));
  CHECK(residual < 1e-9 * work);
  const double elastic = 5.9e6 * rate * dt * steps * 0.03;
  // Inertia of the last column at its constant speed is nothing but in the first step.
  CHECK(end_force == Approx(elastic + 300.0 * rate * 0.03).epsilon(1e-6));
}

TEST_CASE("a factor on bending, on mass, and an error of the binder force are those numbers, to the bit",
          "[macroscale][effect]") {
  const StampingSpec base = coarse_stamping(5);
  StampingSpec one = base, other = base;
  one.effects.bending = 2.0;
  check_same_bits(run(one), run(base, make_fabric({.rate_consistency = 5.0, .bending = 2e-3})));
  one = base;
  one.effects.inertia = 4.0;
  other.artefact.mass_scaling = 4.0;
  check_same_bits(run(one), run(other));
  one = other = base;
  one.process.press.binder_force_error = 0.25;
  other.process.binder_force *= 1.25;
  check_same_bits(run(one), run(other));
  const StampingResult pressed = run(one);
  CHECK(pressed.history.back().binder_force > 1.2 * base.process.binder_force);
}

TEST_CASE("a heavier blank weighs more, scaled mass does not", "[macroscale][effect]") {
  StampingSpec spec = coarse_stamping(2);
  spec.process.press.gravity = true;
  const auto weight = [](const StampingSpec& of) {
    const StampingResult result = run(of);
    return result.history.back().work_gravity;
  };
  const double usual = weight(spec);
  StampingSpec heavy = spec, scaled = spec;
  heavy.effects.inertia = 3.0;
  scaled.artefact.mass_scaling = 3.0;
  CHECK(weight(heavy) > usual + 1e-3);
  CHECK(weight(scaled) == Approx(usual).epsilon(0.05));
}

TEST_CASE("softened shear is that of a fabric with so much less, and at its reference temperature the same",
          "[macroscale][effect]") {
  StampingSpec spec = coarse_stamping(5);
  spec.effects.softening = {0.01, spec.process.blank_temperature - 40.0};
  const double factor = std::exp(-0.4);
  const auto soft = run(spec);
  const auto weak =
      run(coarse_stamping(5), make_fabric({.shear_stiffness = 60.0 * factor, .rate_consistency = 5.0}));
  CHECK(soft.history.back().punch_force == Approx(weak.history.back().punch_force).epsilon(1e-6));
  CHECK(soft.history.back().energy_shear == Approx(weak.history.back().energy_shear).epsilon(1e-6));
  spec.effects.softening.reference = spec.process.blank_temperature;
  check_same_bits(run(spec), run(coarse_stamping(5)));
}

TEST_CASE("a blank that cools at once is stamped as one as cold as its tools", "[macroscale][effect]") {
  StampingSpec cooling = coarse_stamping(5), cold = coarse_stamping(5);
  cooling.process.cooling_rate = 1e4;
  cold.process.blank_temperature = cold.process.tool_temperature;
  const auto fabric = make_fabric({.rate_consistency = 5.0});
  heddle::friction::Model law;
  law.law = heddle::friction::HerseyPower{.scale = 0.2, .exponent = 0.136};
  const auto force = [&](const StampingSpec& spec) {
    return run_stamping(spec, fabric, law).history.back().punch_force;
  };
  // The first of five steps began warm.
  CHECK(force(cooling) == Approx(force(cold)).epsilon(2e-3));
  CHECK(force(cold) > 1.05 * force(coarse_stamping(5)));
  Scene scene;
  scene.cooling_rate = 0.5;
  CHECK(scene.blank_temperature_at(2.0) ==
        Approx(scene.tool_temperature + (scene.blank_temperature - scene.tool_temperature) * std::exp(-1.0)));
}

TEST_CASE("a blank laid down turned under round tools is the same part, turned", "[macroscale][effect]") {
  StampingSpec spec = coarse_stamping(5);
  const auto straight = run(spec);
  spec.blank.turned = 20.0 * degree;
  const auto turned = run(spec);
  CHECK(turned.history.back().punch_force == Approx(straight.history.back().punch_force).epsilon(1e-5));
  CHECK(turned.summary.draw_in_max == Approx(straight.summary.draw_in_max).epsilon(1e-5));
  const double c = std::cos(spec.blank.turned), s = std::sin(spec.blank.turned);
  double worst = 0.0;
  for (std::size_t i = 0; i < turned.final_state.position.size(); ++i) {
    const auto& p = straight.final_state.position[i];
    const auto& q = turned.final_state.position[i];
    worst = std::max({worst, std::abs(q[0] - (c * p[0] - s * p[1])), std::abs(q[1] - (s * p[0] + c * p[1])),
                      std::abs(q[2] - p[2])});
  }
  CHECK(worst < 1e-6);
  CHECK(turned.final_state.edge.front().reference[1] ==
        Approx(s * straight.final_state.edge.front().reference[0] +
               c * straight.final_state.edge.front().reference[1]));
}

TEST_CASE("with every effect of forming at once the ledger closes and forces balance, one ply and two",
          "[macroscale][effect][ledger]") {
  StampingSpec spec = coarse_stamping(10);
  spec.blank.plies = GENERATE(1, 2);
  spec.effects.bending = 3.0;
  spec.effects.inertia = 2.0;
  spec.effects.crimp_stretch = 0.2;
  spec.effects.tow_viscosity = 500.0;
  spec.effects.shear_locking = {200.0, 8.0 * degree, 2.0};
  spec.effects.tension_coupling = {0.5, 500.0};
  spec.effects.softening = {0.005, 400.0};
  spec.process.cooling_rate = 2.0;
  spec.process.press.binder_force_error = -0.1;
  spec.blank.turned = 5.0 * degree;
  const auto result = run(spec, crimped_fabric());
  CHECK(result.summary.energy_residual_max < 0.01);
  CHECK(result.summary.force_balance_residual_max < 1e-3);
  CHECK(result.history.back().dissipation_tow_rate > 0.0);
}
