#include <catch2/catch.hpp>

#include <cmath>

#include <Eigen/Geometry>

#include "macroscale/contact.h"
#include "tests/derivative_check.h"

using namespace heddle::macroscale;
using Eigen::Matrix3d;
using Eigen::Vector3d;
using heddle::test::derivative_gap;

namespace {

heddle::friction::Model rising() {
  heddle::friction::Model model;
  model.law = heddle::friction::HerseyPower{0.6, 0.14};
  return model;
}

FrictionPoint loaded_point() {
  FrictionPoint point;
  point.load = 2.5;
  point.normal = Vector3d(0.1, -0.3, 0.9).normalized();
  point.context.pressure = 1e4;
  return point;
}

// N Int g dU between two slip speeds.
double power_difference(const FrictionSettings& settings, const FrictionPoint& point, double from,
                        double to) {
  const Vector3d along = point.normal.unitOrthogonal();
  return friction_power_difference(settings, point, friction_response(settings, point, from * along),
                                   friction_response(settings, point, to * along));
}

}  // namespace

TEST_CASE("contact energy, pressure and stiffness are each the slope of the one before",
          "[macroscale][contact][derivative]") {
  const heddle::Curve compaction({0.0, 1e-4, 3e-4, 5e-4}, {0.0, 1e3, 2e4, 2e5});
  const double gap = GENERATE(0.7e-3, 0.5e-3, 0.2e-3, -0.1e-3);
  const double half = 0.75e-3;
  const auto at = normal_contact(compaction, gap, half);
  const auto energy = [&](double d) { return normal_contact(compaction, d, half).energy; };
  const auto pressure = [&](double d) { return normal_contact(compaction, d, half).pressure; };
  CHECK(derivative_gap(energy, gap, 1e-4, -at.pressure) < 1e-7);
  CHECK(derivative_gap(pressure, gap, 1e-4, -at.stiffness) < 1e-7);
  CHECK(derivative_gap(pressure, gap, 1e-4, -1.01 * at.stiffness) > 1e-4);
  CHECK(normal_contact(compaction, 0.8e-3, half).pressure == 0.0);
}

TEST_CASE("friction force is the slope of its potential and its tangent the slope of the force",
          "[macroscale][contact][derivative]") {
  const auto model = rising();
  const FrictionSettings settings{&model, 1e-3};
  const FrictionPoint point = loaded_point();
  const double size = GENERATE(0.2e-3, 0.9e-3, 5e-3, 0.1);  // sticking, ramp, sliding
  const Vector3d v = size * Vector3d(0.8, 0.5, 0.1), d(0.2, 0.3, -0.6);
  const double base = slip_velocity(point, v).norm();
  const auto potential = [&](double t) {
    return power_difference(settings, point, base, slip_velocity(point, v + t * d).norm());
  };
  const double slope = friction_force(settings, point, v).dot(d);
  CHECK(derivative_gap(potential, 0.0, size, slope) < 1e-6);
  CHECK(derivative_gap(potential, 0.0, size, 1.01 * slope) > 1e-4);
  const Matrix3d tangent = friction_tangent(settings, point, v, FrictionTangent::exact);
  for (int k = 0; k < 3; ++k) {
    const auto force = [&](double t) { return friction_force(settings, point, v + t * d)[k]; };
    CHECK(derivative_gap(force, 0.0, size, tangent.row(k).dot(d)) < 1e-6);
    CHECK(derivative_gap(force, 0.0, size, 1.01 * tangent.row(k).dot(d)) > 1e-4);
  }
}

TEST_CASE("friction acts in the tangent plane only, against slip, with mu N when sliding",
          "[macroscale][contact]") {
  heddle::friction::Model model;
  model.law = heddle::friction::Coulomb{0.3};
  const FrictionSettings settings{&model, 1e-4};
  const FrictionPoint point = loaded_point();
  const Vector3d v(0.05, 0.02, 0.01), force = friction_force(settings, point, v);
  CHECK(force.dot(point.normal) == Approx(0.0).margin(1e-15));
  CHECK(force.norm() == Approx(0.3 * point.load).epsilon(1e-12));
  CHECK(force.normalized().dot(slip_velocity(point, v).normalized()) == Approx(1.0));
  CHECK(friction_force(settings, point, Vector3d::Zero()).norm() == 0.0);
  CHECK(friction_tangent(settings, point, Vector3d::Zero(), FrictionTangent::convex).allFinite());
}

TEST_CASE("the friction potential does not depend on the path: power around a closed loop is zero",
          "[macroscale][contact][invariant]") {
  const auto model = rising();
  const FrictionSettings settings{&model, 1e-3};
  const FrictionPoint point = loaded_point();
  const double there = power_difference(settings, point, 2e-4, 3e-3),
               back = power_difference(settings, point, 3e-3, 2e-4);
  CHECK(there + back == Approx(0.0).margin(1e-12 * std::abs(there)));
  // Two pieces against one: only quadrature error is left.
  const double pieces =
      power_difference(settings, point, 2e-4, 1.7e-3) + power_difference(settings, point, 1.7e-3, 3e-3);
  CHECK(pieces == Approx(there).epsilon(1e-6));
}

TEST_CASE(
    "a quadratic with the secant stiffness of friction lies above its potential, and no softer one does",
    "[macroscale][contact]") {
  heddle::friction::Model model = rising();
  const int law = GENERATE(0, 1, 2);  // rising with speed, constant, falling
  if (law == 1) model.law = heddle::friction::Coulomb{0.3};
  if (law == 2) model.law = heddle::friction::ExponentialDecay{0.5, 0.3, 10e-3};
  const FrictionSettings settings{&model, 1e-4};
  const FrictionPoint point = loaded_point();
  const double size = GENERATE(2e-5, 0.9e-4, 3e-3, 0.1);
  const Vector3d v = slip_velocity(point, size * Vector3d(0.8, 0.5, 0.1));
  const Vector3d force = friction_force(settings, point, v);
  const Matrix3d secant = friction_tangent(settings, point, v, FrictionTangent::secant);
  const auto above = [&](const Vector3d& w, double stiffness) {
    const Vector3d d = w - v;
    const double bound = force.dot(d) + 0.5 * stiffness * d.dot(secant * d);
    return bound - power_difference(settings, point, v.norm(), w.norm());
  };
  const double scale = force.norm() * v.norm();
  const Vector3d across = point.normal.cross(v);
  for (double turn : {0.0, 0.3, 1.5, 3.0, 3.14159})
    for (double length : {0.0, 0.1, 0.5, 0.97, 1.0, 1.03, 2.0, 10.0})
      CHECK(above(length * (std::cos(turn) * v + std::sin(turn) * across), 1.0) >= -1e-6 * scale);
  // At the same speed the other way round both are equal, so one percent less does not hold.
  CHECK(above(-v, 1.0) == Approx(0.0).margin(1e-9 * scale));
  CHECK(above(-v, 0.99) < -1e-3 * scale);
}
