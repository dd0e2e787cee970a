#include <catch2/catch.hpp>
#include <cmath>

#include "friction/rig/curved_plates.h"

using namespace heddle::friction;
using heddle::Curve;

namespace {

const Curve linear({0.0, 1e-3}, {0.0, 1e9 * 1e-3});

Model coulomb(double mu) {
  return {.law = Coulomb{mu}, .film = {}, .effects = {}, .box = {}};
}

FrictionTestRow row(double normal_force = 1500.0) {
  FrictionTestRow r;
  r.name = "pull";
  r.velocity = 16.67e-3;
  r.normal_force = normal_force;
  return r;
}

}  // namespace

TEST_CASE("the path over curved plates comes back to level and turns smoothly",
          "[friction][rig][invariant]") {
  const SCurve path{.radius = 0.05, .angle = 0.4};
  CHECK(at(path, -1.0).slope == 0.0);
  CHECK(at(path, 0.02).slope == Approx(0.4));
  CHECK(at(path, 0.02 - 1e-9).slope == Approx(at(path, 0.02 + 1e-9).slope).epsilon(1e-6));
  CHECK(at(path, 0.04 - 1e-12).slope == Approx(0.0).margin(1e-9));
  CHECK(at(path, 0.01).curvature == -at(path, 0.03).curvature);
}

TEST_CASE("plates that hardly bend are pulled as flat ones, and the bend counts with its square",
          "[friction][rig][analytic]") {
  // Both plates carry the same vertical load, whatever tension moves from face to face.
  const auto excess = [](double angle) {
    const auto pull = pull_over({.radius = 0.2, .angle = angle}, coulomb(0.3), row(), {}, linear, 0.1);
    CHECK(pull.released == Approx(0.0).margin(1e-12));
    CHECK(pull.upper_load == Approx(1500.0).epsilon(1e-9));
    return pull.pull_force / 900.0 - 1.0;
  };
  const double small = excess(0.05), twice = excess(0.1);
  CAPTURE(small, twice);
  CHECK(twice > 0.0);
  CHECK(twice < 0.01);
  CHECK(twice / small == Approx(8.0).epsilon(0.15));  // slope squared, over an arc that is longer with it
}

TEST_CASE("where tension has lifted the fabric off one plate it grows as over a capstan",
          "[friction][rig][analytic]") {
  const double radius = 5e-3, mu = 0.4;
  const auto pull = pull_over({.radius = radius, .angle = 0.6}, coulomb(mu), row(), {}, linear, 0.1);
  REQUIRE(pull.released > 0.03);
  int found = 0;
  for (std::size_t k = 1; k < pull.s.size(); ++k) {
    const auto one = [&](std::size_t i) {
      return pull.lower_pressure[i] == 0.0 || pull.upper_pressure[i] == 0.0;
    };
    if (!one(k) || !one(k - 1)) continue;
    CHECK(std::log(pull.tension[k] / pull.tension[k - 1]) ==
          Approx(mu * (pull.s[k] - pull.s[k - 1]) / radius).epsilon(1e-4));
    ++found;
  }
  CHECK(found > 10);
}

TEST_CASE("the S of the assumed shape adds a few percent to a pull", "[friction][rig]") {
  Model model{.law = HerseyPower{.scale = 0.325, .exponent = 0.136}, .film = {}, .effects = {}, .box = {}};
  const double flat = run_friction_test(model, row(), {}).pull_force;
  const auto pull = pull_over({}, model, row(), {}, linear, 0.1);
  CHECK(pull.pull_force > flat);
  CHECK(pull.pull_force < 1.05 * flat);
}
