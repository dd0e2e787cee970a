// What a contact point knows of the fabric's directions: slip against the warp, trellis angle.
#include <catch2/catch.hpp>

#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

#include "macroscale/friction_lag.h"
#include "macroscale/scene.h"
#include "macroscale/solve.h"
#include "tests/macroscale/sample_fabric.h"

using namespace heddle::macroscale;
using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

/// A square sheet between two plates, sheared uniformly by gamma, that moves along `slip` in a frame turned
/// by `turn` about the normal of the plates and tilted with them: the points of both faces.
FrictionPoints points_of(double gamma, const Vector3d& slip, double turn, double tilt, bool swapped = false,
                         const heddle::mesoscale::DragDirection& drag = {}) {
  auto fabric = heddle::test::make_fabric({});
  fabric.contact.drag = drag;
  heddle::friction::Model model;
  model.law = heddle::friction::Coulomb{0.3};
  const Matrix3d frame =
      (Eigen::AngleAxisd(tilt, Vector3d(0.6, 0.8, 0.0)) * Eigen::AngleAxisd(turn, Vector3d::UnitZ()))
          .toRotationMatrix();
  const double half = 0.5 * fabric.thickness - 20e-6;  // plates that press
  Scene scene;
  scene.blank = make_blank({0.04, 0.04}, 0.01);
  scene.fabric = &fabric;
  scene.friction = &model;
  const Vector3d normal = frame.col(2);
  scene.tools = {{Role::die, PlaneShape{-half * normal, normal}, Motion::fixed, 0.0, 0.0},
                 {Role::binder, PlaneShape{half * normal, -normal}, Motion::fixed, 0.0, 0.0}};
  System system(scene);
  State state = initial_state(scene);
  // Both tows turn towards each other by half the angle; swapped: warp where weft was, counted from above
  // still.
  const double s = std::sin(0.5 * gamma), c = std::cos(0.5 * gamma);
  Matrix3d shear = Matrix3d::Identity();
  shear.topLeftCorner<2, 2>() << c, s, s, c;
  Matrix3d exchange = Matrix3d::Identity();
  if (swapped) exchange.topLeftCorner<2, 2>() << 0, 1, 1, 0;
  for (int i = 0; i < scene.blank.nodes(); ++i)
    state.x.segment<3>(3 * i) = frame * shear * exchange * scene.blank.reference[i];
  state.corner_angle = corner_angles(scene.blank, state);
  StepData step;
  step.dt = 0.01;
  step.start = &state;
  step.tool_z = state.tool_z;
  Eigen::VectorXd x = state.x;
  for (int i = 0; i < scene.blank.nodes(); ++i) x.segment<3>(3 * i) += step.dt * (frame * slip);
  return freeze(system, step, x, nodal_shear_angle(scene.blank, state.corner_angle));
}

double factor_at(const FrictionPoint& point) {
  heddle::friction::Model model;
  model.effects.orientation =
      heddle::friction::Orientation{.amplitude = 0.5, .form = heddle::friction::Orientation::Form::trellis};
  return law_at({&model, 1e-5}, point, 0.01).mu / 0.3;
}

}  // namespace

TEST_CASE("a contact point knows slip against the warp and trellis angle, on either face of the sheet",
          "[macroscale][contact][friction]") {
  const double gamma = GENERATE(-0.4, 0.0, 0.5), direction = GENERATE(0.0, 0.7, -1.2);
  const Vector3d slip = 0.02 * Vector3d(std::cos(direction), std::sin(direction), 0.0);
  const FrictionPoints points = points_of(gamma, slip, 0.0, 0.0);
  for (const auto& face : points)
    for (const FrictionPoint& point : face) {
      REQUIRE(point.load > 0.0);
      CHECK(point.context.shear_angle == Approx(gamma).margin(1e-12));
      // The warp itself has turned by half the shear.
      CHECK(point.context.slip_angle == Approx(direction - 0.5 * gamma).margin(1e-12));
    }
}

TEST_CASE("friction along the trellis does not see who looks at it",
          "[macroscale][contact][friction][invariant]") {
  const double gamma = 0.5;
  const Vector3d slip(0.015, -0.004, 0.0);
  const double mu = factor_at(points_of(gamma, slip, 0.0, 0.0)[0][7]);
  CHECK(std::abs(mu - 1.0) > 1e-3);
  const double turn = GENERATE(0.4, 2.0), tilt = GENERATE(0.0, 0.5);
  for (const auto& face : points_of(gamma, slip, turn, tilt))
    for (const FrictionPoint& point : face) CHECK(factor_at(point) == Approx(mu).epsilon(1e-9));
}

TEST_CASE("friction along the trellis is the same with warp and weft exchanged and in a mirror",
          "[macroscale][contact][friction][invariant]") {
  const double gamma = 0.5;
  const Vector3d slip(0.015, -0.004, 0.0), mirrored(0.015, 0.004, 0.0);
  const double mu = factor_at(points_of(gamma, slip, 0.0, 0.0)[0][7]);
  for (const auto& face : points_of(gamma, slip, 0.0, 0.0, true))
    for (const FrictionPoint& point : face) CHECK(factor_at(point) == Approx(mu).epsilon(1e-9));
  for (const auto& face : points_of(-gamma, mirrored, 0.0, 0.0))
    for (const FrictionPoint& point : face) CHECK(factor_at(point) == Approx(mu).epsilon(1e-9));
  CHECK(factor_at(points_of(gamma, mirrored, 0.0, 0.0)[0][7]) != Approx(mu).epsilon(1e-3));
}

TEST_CASE(
    "a contact point takes the film's drag at its own pressure and shear, and turns with it alike seen from "
    "anywhere",
    "[macroscale][contact][friction][invariant]") {
  const double gamma = GENERATE(-0.5, 0.5);
  const Vector3d slip(0.015, -0.004, 0.0);
  const auto drag = [](double share) {
    return heddle::CurveFamily(
        {0.0, 1.0}, {heddle::Curve({0.0, 20.0}, {0.0, 0.0}), heddle::Curve({0.0, 20.0}, {0.0, share})});
  };
  const heddle::mesoscale::DragDirection table{drag(0.2), drag(0.4)};
  const auto mu = [](const FrictionPoint& point) {
    heddle::friction::Model model;
    model.effects.orientation =
        heddle::friction::Orientation{.amplitude = 1.0, .form = heddle::friction::Orientation::Form::film};
    return law_at({&model, 1e-5}, point, 0.01).mu / 0.3;
  };
  const FrictionPoint first = points_of(gamma, slip, 0.0, 0.0, false, table)[0][7];
  const double level = 0.5 * std::log(first.context.pressure) / 20.0;
  CHECK(first.context.drag_cosine == Approx(0.2 * level).epsilon(1e-9));
  CHECK(first.context.drag_sine == Approx((gamma < 0.0 ? -0.4 : 0.4) * level).epsilon(1e-9));
  CHECK(std::abs(mu(first) - 1.0) > 1e-3);
  for (const auto& face : points_of(gamma, slip, 0.4, 0.5, false, table))
    for (const FrictionPoint& point : face) CHECK(mu(point) == Approx(mu(first)).epsilon(1e-6));
  const Vector3d mirrored(0.015, 0.004, 0.0);
  for (const auto& face : points_of(-gamma, mirrored, 0.0, 0.0, false, table))
    for (const FrictionPoint& point : face) CHECK(mu(point) == Approx(mu(first)).epsilon(1e-6));
}
