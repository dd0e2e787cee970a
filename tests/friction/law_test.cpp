#include <catch2/catch.hpp>
#include <cmath>

#include "friction/laws.h"
#include "tests/derivative_check.h"

using namespace heddle::friction;
using heddle::test::derivative_gap;

namespace {

const CalibrationBox box{.hersey_low = 0.18, .hersey_high = 0.51};
const HerseyPower power{.scale = 0.325, .exponent = 0.136};
const HerseyLinear linear{.offset = 0.237, .slope = 0.044, .reference = 0.362};

double log_slope(const LawValue& value) {
  return value.dmu_dlog_hersey / value.mu;
}

template <class HerseyLaw>
void check_slope(const HerseyLaw& law, double hersey) {
  const auto mu = [&](double log_hersey) { return law_value(law, std::exp(log_hersey), box).mu; };
  const double slope = law_value(law, hersey, box).dmu_dlog_hersey;
  CHECK(derivative_gap(mu, std::log(hersey), 1.0, slope) < 1e-7);
  CHECK(derivative_gap(mu, std::log(hersey), 1.0, 1.01 * slope) > 1e-4);  // the check can fail
}

}  // namespace

TEST_CASE("law slopes in the Hersey number agree with central differences", "[friction][derivative]") {
  const double hersey = GENERATE(1e-6, 0.05, 0.3, 0.5, 4.0, 40.0);  // below, inside and above the box
  CAPTURE(hersey);
  check_slope(power, hersey);
  check_slope(linear, hersey);
}

TEST_CASE("power law holds its log slope everywhere", "[friction][analytic]") {
  const double hersey = GENERATE(1e-8, 0.1, 0.3, 50.0);
  CHECK(log_slope(law_value(power, hersey, box)) == Approx(power.exponent).epsilon(1e-14));
}

TEST_CASE("power law is the same with and without a calibrated box", "[friction][analytic]") {
  const double hersey = GENERATE(1e-8, 0.1, 0.3, 50.0);
  CHECK(law_value(power, hersey, box).mu == law_value(power, hersey, {}).mu);
}

TEST_CASE("linear law is a straight line inside the calibrated box", "[friction][analytic]") {
  const double hersey = GENERATE(0.18, 0.3, 0.51);
  CHECK(law_value(linear, hersey, box).mu == linear.offset + linear.slope * hersey / linear.reference);
}

TEST_CASE("linear law is held as a power law beyond the calibrated box", "[friction][analytic]") {
  const double edge = GENERATE(0.18, 0.51);
  const double outward = edge < 0.3 ? 0.1 : 10.0;
  const LawValue at_edge = law_value(linear, edge, box);
  const LawValue beyond = law_value(linear, edge * outward, box);
  CHECK(log_slope(beyond) == Approx(log_slope(at_edge)).epsilon(1e-13));
  CHECK(beyond.mu == Approx(at_edge.mu * std::pow(outward, log_slope(at_edge))).epsilon(1e-13));
}

TEST_CASE("linear law is continuous with its slope at the edges of the calibrated box",
          "[friction][invariant]") {
  const double edge = GENERATE(0.18, 0.51);
  const LawValue below = law_value(linear, edge * (1.0 - 1e-9), box);
  const LawValue above = law_value(linear, edge * (1.0 + 1e-9), box);
  CHECK(below.mu == Approx(above.mu).epsilon(1e-8));
  CHECK(below.dmu_dlog_hersey == Approx(above.dmu_dlog_hersey).epsilon(1e-8));
}

TEST_CASE("linear law does not blow up at low pressure when held", "[friction][bound]") {
  const double hersey_at_8_kPa = 16.0;                     // 160 mm/s
  CHECK(law_value(linear, hersey_at_8_kPa, {}).mu > 2.0);  // the straight line
  CHECK(law_value(linear, hersey_at_8_kPa, box).mu < 0.65);
}

TEST_CASE("calibrated box counts its edges as inside and asks for all three quantities", "[friction]") {
  const CalibrationBox all{.hersey_low = 0.2,
                           .hersey_high = 0.5,
                           .pressure_low = 1.5e5,
                           .pressure_high = 3e5,
                           .speed_low = 0.016,
                           .speed_high = 0.042};
  const Context inside{.slip_speed = 0.016, .pressure = 3e5};
  CHECK(all.contains(inside, 0.2));
  CHECK(all.contains(inside, 0.5));
  CHECK_FALSE(all.contains(inside, 0.19));
  CHECK_FALSE(all.contains(inside, 0.51));
  CHECK_FALSE(all.contains({.slip_speed = 0.0159, .pressure = 3e5}, 0.3));
  CHECK_FALSE(all.contains({.slip_speed = 0.0421, .pressure = 3e5}, 0.3));
  CHECK_FALSE(all.contains({.slip_speed = 0.02, .pressure = 1.49e5}, 0.3));
  CHECK_FALSE(all.contains({.slip_speed = 0.02, .pressure = 3.01e5}, 0.3));
}

TEST_CASE("a box nobody set contains everything", "[friction]") {
  CHECK(CalibrationBox{}.contains({.slip_speed = 0.0, .pressure = 0.0}, 0.0));
  CHECK(CalibrationBox{}.contains({.slip_speed = 1e3, .pressure = 1e12}, 1e12));
}
