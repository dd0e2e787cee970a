#include "friction/calibration/model_numbers.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <set>

#include "friction/combinations.h"
#include "tests/derivative_check.h"
#include "tests/friction/every_model.h"

using namespace heddle::friction;
using heddle::test::derivative_gap;

namespace {

/// A pull in the middle of the campaign, where every branch of the sample laws is alive.
PullReading reading_of(double slip = 5e-3) {
  PullReading reading;
  reading.context = heddle::test::contact_at(0.02, 1.5e5, 450.0, 380.0);
  reading.context.time_step = 0.0;
  reading.slip = slip;
  reading.dwell = 0.3;
  return reading;
}

/// What a difference of steps by hand gives for one number.
double gap(const Model& model, const PullReading& reading, const ModelNumber& number, double slope) {
  const auto mu = [&](double x) {
    Model other = model;
    number_in(other, number.key) = x;
    return coefficient_of(other, reading);
  };
  const double scale = number.value != 0.0 ? std::abs(number.value) : 1.0;
  return derivative_gap(mu, number.value, scale, slope);
}

void check_all_numbers(const Model& model) {
  const PullReading reading = reading_of();
  const std::vector<ModelNumber> numbers = numbers_of(model);
  std::vector<std::string> keys;
  for (const ModelNumber& number : numbers) keys.push_back(number.key);
  const std::vector<NumberSlope> slopes = number_slopes(model, reading, keys);
  const double mu = coefficient_of(model, reading);
  for (std::size_t k = 0; k < numbers.size(); ++k) {
    const double relative = slopes[k].value * std::max(std::abs(numbers[k].value), 1e-9) / mu;
    CAPTURE(id_of(model.law), keys[k], slopes[k].value, relative);
    CHECK(slopes[k].error < 1e-6);
    if (std::abs(relative) < 1e-6) continue;  // hardly acts here: differences by hand have nothing to hold
    CHECK(gap(model, reading, numbers[k], slopes[k].value) < 1e-6);
    CHECK(gap(model, reading, numbers[k], 1.01 * slopes[k].value) > 1e-4);  // the check can fail
  }
}

}  // namespace

TEST_CASE("slopes of mu in every number of every law and rheology agree with central differences",
          "[friction][calibration][derivative]") {
  for (const Law& law : heddle::test::every_law())
    for (const Rheology& rheology : heddle::test::every_rheology()) {
      if (!reads_hersey_number(law) && !rheology.of_the_film()) continue;
      check_all_numbers({.law = law, .film = {}, .effects = {}, .box = {}, .rheology = rheology});
    }
}

TEST_CASE("slopes of mu in every number of every effect agree with central differences",
          "[friction][calibration][derivative]") {
  for (const auto& effect : heddle::test::every_effect()) {
    Model model{.law = HerseyPower{.scale = 0.325, .exponent = 0.136}, .film = {}, .effects = {}, .box = {}};
    effect.set(model.effects, effect.usual);
    // At 0 s walls are warm at once, where mu has no slope to the time: it goes as its root.
    if (model.effects.shear_heating) model.effects.shear_heating->settling = 0.05;
    CAPTURE(effect.id);
    REQUIRE(check_combinations(model).empty());
    check_all_numbers(model);
  }
}

TEST_CASE("a number that starts at nothing, or at the end of its range, has its slope",
          "[friction][calibration][derivative]") {
  Model model{.law = HerseyPower{.scale = 0.325, .exponent = 0.136}, .film = {}, .effects = {}, .box = {}};
  model.effects.adhesion = Adhesion{.stress = 0.0};  // mu += c phi/p: closed form
  const PullReading reading = reading_of();
  const double per_stress = number_slopes(model, reading, {"effects.adhesion.stress"})[0].value;
  CHECK(per_stress == Approx(reading.context.area_fraction / 1.5e5).epsilon(1e-9));
  // At n = 1 only smaller n may be tried.
  model.film.index = 1.0;
  model.rheology.flow = HerschelBulkley{.power_index = 1.0};
  const NumberSlope slope = number_slopes(model, reading, {"resin.herschel_bulkley.power_index"})[0];
  CHECK_FALSE(slope.exact);
  const auto mu = [&](double n) {
    Model other = model;
    std::get<HerschelBulkley>(other.rheology.flow).power_index = n;  // the formula goes on beyond 1
    return coefficient_of(other, reading);
  };
  CHECK(derivative_gap(mu, 1.0, 1.0, slope.value) < 1e-5);
}

TEST_CASE("the paper's law has exact slopes in all that acts", "[friction][calibration]") {
  Model model{.law = HerseyPower{.scale = 0.325, .exponent = 0.136}, .film = {}, .effects = {}, .box = {}};
  model.effects.tool_temperature_shift = ToolTemperatureShift{.slope = -9e-4};
  std::vector<std::string> keys;
  for (const ModelNumber& number : numbers_of(model)) keys.push_back(number.key);
  const std::set<std::string> expected{"friction.scale",
                                       "friction.exponent",
                                       "resin.consistency",
                                       "resin.power_index",
                                       "resin.film_thickness",
                                       "resin.activation_energy",
                                       "resin.reference_temperature",
                                       "resin.rate_floor",
                                       "effects.tool_temperature_shift.slope",
                                       "effects.tool_temperature_shift.reference"};
  CHECK(std::set<std::string>(keys.begin(), keys.end()) == expected);
  const auto slopes = number_slopes(model, reading_of(), keys);
  for (std::size_t k = 0; k < keys.size(); ++k) {
    CAPTURE(keys[k]);
    CHECK(slopes[k].exact == (keys[k] != "effects.tool_temperature_shift.reference"));
  }
  CHECK_THROWS_AS(number_in(model, "friction.offset"), std::out_of_range);
  CHECK(numbers_of({.law = Coulomb{}, .film = {}, .effects = {}, .box = {}}).size() == 1);  // sees no film
}
