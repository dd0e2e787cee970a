#include "friction/sled.h"

#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <cmath>

#include "friction/calibration/coupon_fit.h"

using namespace heddle::friction;

namespace {

Model model_of(const Law& law) {
  return {.law = law, .film = {}, .effects = {}, .box = {}};
}

}  // namespace

TEST_CASE("the sled of ASTM D 1894 weighs 1.96 N on 486 Pa", "[friction][sled][analytic]") {
  CHECK(Sled{}.normal_force() == 0.2 * 9.80665);
  CHECK(Sled{}.pressure() == 0.2 * 9.80665 / (63.5e-3 * 63.5e-3));
  CHECK(Sled{}.pressure() == Approx(486.4).epsilon(1e-3));
}

TEST_CASE("the sled reads the static coefficient at its first pull and the kinetic one as the mean beyond",
          "[friction][sled][analytic]") {
  const SledResult coulomb = sled_test(model_of(Coulomb{0.3}), {});
  CHECK(coulomb.static_coefficient == 0.3);
  CHECK(coulomb.kinetic_coefficient == Approx(0.3).epsilon(1e-12));
  const SledResult both = sled_test(
      model_of(StaticKinetic{.static_coefficient = 0.36, .kinetic_coefficient = 0.3, .breakaway_slip = 1e-3}),
      {});
  CHECK(both.static_coefficient == 0.36);
  CHECK(both.kinetic_coefficient == Approx(0.3).epsilon(1e-12));
  // mu (1 + A exp(-s/s0)): its mean from 10 to 130 mm in closed form.
  Model peak = model_of(Coulomb{0.3});
  peak.effects.static_peak = StaticPeak{.amplitude = 0.4, .length = 8e-3};
  const SledResult found = sled_test(peak, {});
  CHECK(found.static_coefficient == Approx(0.42).epsilon(1e-12));
  const double tail = 0.4 * 8e-3 * (std::exp(-10.0 / 8.0) - std::exp(-130.0 / 8.0)) / 120e-3;
  CHECK(found.kinetic_coefficient == Approx(0.3 * (1.0 + tail)).epsilon(1e-5));
}

TEST_CASE("a law fitted between plates is told to stand outside its box under a sled", "[friction][sled]") {
  Model model = model_of(HerseyPower{.scale = 0.325, .exponent = 0.136});
  model.box.pressure_low = 150e3;
  model.box.pressure_high = 300e3;
  CHECK_FALSE(sled_test(model, {}).calibrated);
  model.box = {};
  CHECK(sled_test(model, {}).calibrated);
}

TEST_CASE("the kinetic coefficient comes back from a sled's forces with one face sliding",
          "[friction][sled][calibration]") {
  const Model truth = model_of(Coulomb{0.31});
  std::string table =
      "case,velocity_mm_s,normal_force_N,tool_temperature_C,fabric_temperature_C,force_measured_N\n";
  for (const double gain : {0.98, 1.0, 1.03})
    table += fmt::format("sled,2.5,{},23,23,{}\n", Sled{}.normal_force(),
                         gain * sled_test(truth, {}).kinetic_coefficient * Sled{}.normal_force());
  const CouponReduction one_face{.stretches = 1, .faces = 1};
  CouponFitSpec spec;
  spec.numbers = {{.key = "friction.coefficient"}};
  spec.faces = 1;
  spec.noise.day = 0.0;
  const CouponFit fit =
      fit_coupons(model_of(Coulomb{0.2}), parse_coupons(table, "sled.csv", one_face), {}, {}, spec);
  CHECK(fit.numbers[0].value == Approx(0.31 * std::cbrt(0.98 * 1.03)).epsilon(1e-9));
  CHECK(fit.noise.sample.degrees_of_freedom == 2);  // three samples of one condition
}
