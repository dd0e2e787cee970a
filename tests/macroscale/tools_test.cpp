#include <catch2/catch.hpp>

#include "macroscale/tools.h"
#include "tests/derivative_check.h"

using namespace heddle::macroscale;
using Eigen::Vector3d;
using heddle::test::derivative_gap;

namespace {

struct Probe {
  Shape shape;
  Vector3d x;
};

// One point in each region of each tool.
std::vector<Probe> probes() {
  const HemisphereShape punch{{0.001, 0.002, 0.0}, 0.07};
  const RingShape die{-0.7e-3, 0.072, 0.02, true}, binder{0.7e-3, 0.092, 0.002, false};
  const CurvedPlateShape lower{{.radius = 0.05, .angle = 0.4}, 0.01, 0.002, 1.5e-3, true},
      upper{{.radius = 0.05, .angle = 0.4}, 0.01, 0.002, 1.5e-3, false};
  return {{PlaneShape{{0, 0, 0.1}, Vector3d(0.1, 0.2, 0.9).normalized()}, {0.3, 0.1, 0.4}},
          {CylinderShape{{0, 0, -0.05}, 0.05}, {0.02, 0.3, 0.01}},
          {punch, {0.03, -0.02, 0.005}},
          {punch, {0.08, 0.01, 0.09}},
          {die, {0.12, 0.05, 0.001}},
          {die, {0.055, 0.055, -0.004}},
          {die, {0.04, -0.05, -0.03}},
          {binder, {0.12, 0.05, -0.001}},
          {binder, {0.066, 0.0655, 0.0012}},
          {binder, {0.05, 0.07, 0.01}},
          {lower, {0.0, 0.03, 0.003}},
          {lower, {0.02, 0.03, 0.001}},
          {lower, {0.04, 0.03, -0.006}},
          {lower, {0.06, 0.03, -0.002}},
          {upper, {0.02, 0.03, 0.001}},
          {upper, {0.04, 0.03, -0.006}}};
}

}  // namespace

TEST_CASE("a tool's normal is the slope of its distance, and its curvature the slope of the normal",
          "[macroscale][tools][derivative]") {
  const auto all = probes();
  const std::size_t index = GENERATE(range(0, 16));
  const Probe& probe = all[index];
  CAPTURE(index);
  const Distance at = distance(probe.shape, probe.x);
  CHECK(at.normal.norm() == Approx(1.0).epsilon(1e-12));
  for (int c = 0; c < 3; ++c) {
    const auto moved = [&](double t) {
      Vector3d y = probe.x;
      y[c] = t;
      return distance(probe.shape, y);
    };
    const auto value = [&](double t) { return moved(t).distance; };
    if (std::abs(at.normal[c]) > 1e-3) {
      CHECK(derivative_gap(value, probe.x[c], 0.01, at.normal[c]) < 1e-7);
      CHECK(derivative_gap(value, probe.x[c], 0.01, 1.01 * at.normal[c]) > 1e-4);
    }
    for (int r = 0; r < 3; ++r) {
      const auto slope = [&](double t) { return moved(t).normal[r]; };
      const double h = 1e-6;
      const double difference = (slope(probe.x[c] + h) - slope(probe.x[c] - h)) / (2.0 * h);
      CHECK(at.curvature(r, c) == Approx(difference).margin(1e-5));
    }
  }
}

TEST_CASE("both curved plates stand half a gap off their common path, which its length measures",
          "[macroscale][tools]") {
  const CurvedPlateShape lower{{.radius = 0.05, .angle = 0.4}, 0.01, 0.002, 1.5e-3, true};
  CurvedPlateShape upper = lower;
  upper.up = false;
  Vector3d before = place_on(lower, -0.011);
  double length = 0.0;
  for (int k = -10; k <= 60; ++k) {
    const Vector3d x = place_on(lower, 1e-3 * k);
    CAPTURE(k);
    CHECK(distance(lower, x).distance == Approx(0.75e-3).epsilon(1e-9));
    CHECK(distance(upper, x).distance == Approx(0.75e-3).epsilon(1e-9));
    CHECK((distance(lower, x).normal + distance(upper, x).normal).norm() < 1e-12);
    CHECK((x - before).norm() == Approx(1e-3).epsilon(1e-4));  // chords of a path by its length
    length += (x - before).norm();
    before = x;
  }
  CHECK(length == Approx(0.071).epsilon(1e-4));
}

TEST_CASE("flat face, rounded edge and wall of a ring meet with one normal", "[macroscale][tools]") {
  const RingShape die{0.0, 0.072, 0.02, true};
  const double e = 1e-9;
  const auto jump = [&](const Vector3d& a, const Vector3d& b) {
    return (distance(die, a).normal - distance(die, b).normal).norm();
  };
  CHECK(jump({0.092 - e, 0, 0.001}, {0.092 + e, 0, 0.001}) < 1e-6);
  CHECK(jump({0.0715, 0, -0.02 - e}, {0.0715, 0, -0.02 + e}) < 1e-6);
  CHECK(distance(die, {0.0715, 0, -0.03}).distance == Approx(0.0005));
  CHECK(distance(die, {0.1, 0, 0.003}).distance == Approx(0.003));
}
