// Numbers of every law, rheology and effect out of forces that were made with them.
#include <fmt/format.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <set>

#include "friction/calibration/coupon_fit.h"
#include "friction/calibration/model_numbers.h"
#include "friction/combinations.h"
#include "tests/friction/every_model.h"

using namespace heddle::friction;

namespace {

/// A crossed campaign that varies all that any law or effect sees, pulled with a known model.
CouponData measured(const Model& truth) {
  std::string text =
      "velocity_mm_s,normal_force_N,tool_temperature_C,fabric_temperature_C,orientation_deg,dwell_s,sample_"
      "id,"
      "displacement_mm,force_measured_N\n";
  int sample = 0;
  for (const double velocity : {0.3, 1.66, 5.0, 16.67, 83.3, 300.0})
    for (const double load : {218.0, 1000.0, 4000.0})
      for (const double tool : {85.0, 118.0, 140.0})
        for (const double dwell : {0.02, 0.3, 3.0}) {
          ++sample;
          FrictionTestRow row;
          row.velocity = 1e-3 * velocity;
          row.normal_force = load;
          row.tool_temperature = 273.15 + tool;
          row.fabric_temperature = 273.15 + 160.0 + 20.0 * (sample % 3);
          row.orientation = 0.3 * (sample % 4);
          FrictionRig rig;
          rig.pull_length = 1e-3 * std::array{0.4, 0.7, 50.0}[static_cast<std::size_t>(sample / 3 % 3)];
          rig.dwell_before = dwell;
          text +=
              fmt::format("{},{},{},{},{},{},{},{},{}\n", velocity, load, tool,
                          row.fabric_temperature - 273.15, row.orientation * 180.0 / 3.141592653589793, dwell,
                          sample, 1e3 * rig.pull_length, run_friction_test(truth, row, rig).pull_force);
        }
  return parse_coupons(text, "made.csv", {});
}

struct Found {
  CouponFit fit;
  double error = 0.0;  ///< largest of the numbers that the data tell, as a share of the true one
};

std::string words_of(const CouponFit& fit) {
  std::string words;
  for (const Confusion& confusion : fit.confusions) words += confusion.words + "\n";
  for (const FittedNumber& number : fit.numbers) words += fmt::format("{} = {}\n", number.key, number.value);
  return words;
}

/// All of `keys` from 5 % off.
Found fit_from_nearby(const Model& truth, const std::vector<std::string>& keys) {
  const CouponData data = measured(truth);
  Model start = truth;
  CouponFitSpec spec;
  spec.noise = {.sample = 0.02, .day = 0.0};
  std::map<std::string, double> wanted;
  for (const ModelNumber& number : numbers_of(truth)) {
    if (std::ranges::count(keys, number.key) == 0) continue;
    wanted[number.key] = number.value;
    const double off = number.range.contains(1.05 * number.value) ? 1.05 : 0.95;
    number_in(start, number.key) = off * number.value;
    spec.numbers.push_back({.key = number.key});
  }
  Found found{.fit = fit_coupons(start, data, {}, {}, spec)};
  for (const FittedNumber& number : found.fit.numbers)
    if (number.told_apart)
      found.error = std::max(found.error, std::abs(number.value / wanted.at(number.key) - 1.0));
  return found;
}

}  // namespace

TEST_CASE("the numbers of every law come back from the forces it made", "[friction][calibration]") {
  for (const Law& law : heddle::test::every_law()) {
    const Model truth{.law = law, .film = {}, .effects = {}, .box = {}};
    std::vector<std::string> keys;
    for (const ModelNumber& number : numbers_of(truth))
      if (number.key.starts_with("friction.") && number.value != 0.0) keys.push_back(number.key);
    if (keys.empty()) continue;  // a table has none
    const Found found = fit_from_nearby(truth, keys);
    CAPTURE(id_of(law), keys, found.fit.summary.reason);
    INFO(words_of(found.fit));
    CHECK(found.fit.rms_error < 1e-6);
    CHECK(found.error < 1e-4);
    // One combination each that no pull can tell, and it is named: slope and reference of a straight line;
    // S0, S* and U0; the end of Renard's recovery, far beyond the fastest pull.
    const std::set<std::string> with_one{"linear", "three_branch", "slip_resistance", "renard"};
    const auto total = std::ranges::count_if(found.fit.confusions, &Confusion::total);
    CHECK(total == (with_one.contains(id_of(law)) ? 1 : 0));
  }
}

TEST_CASE("the numbers of every rheology come back, with those of the law held", "[friction][calibration]") {
  for (const Rheology& rheology : heddle::test::every_rheology()) {
    const Model truth{.law = HerseyPower{.scale = 0.325, .exponent = 0.136},
                      .film = {},
                      .effects = {},
                      .box = {},
                      .rheology = rheology};
    std::vector<std::string> keys;
    for (const ModelNumber& number : numbers_of(truth))
      if (number.key.starts_with("resin.") && number.value != 0.0) keys.push_back(number.key);
    // One temperature and one rate below all pulls, and h that acts with the others alone: known from
    // elsewhere.
    std::erase_if(keys, [](const std::string& key) {
      return key == "resin.reference_temperature" || key == "resin.rate_floor" ||
             key == "resin.film_thickness" || key.ends_with("sharpness");
    });
    const Found found = fit_from_nearby(truth, keys);
    CAPTURE(keys, found.fit.summary.reason);
    CHECK(found.fit.rms_error < 1e-6);
    CHECK(found.error < 1e-3);
    INFO(words_of(found.fit));
    CHECK(std::ranges::none_of(found.fit.confusions, &Confusion::total));
  }
}

TEST_CASE("the amplitude of every effect comes back beside the constants of the law",
          "[friction][calibration]") {
  for (const auto& effect : heddle::test::every_effect()) {
    Model truth{.law = HerseyPower{.scale = 0.325, .exponent = 0.136}, .film = {}, .effects = {}, .box = {}};
    effect.set(truth.effects, effect.usual);
    REQUIRE(check_combinations(truth).empty());
    std::string amplitude;
    for (const ModelNumber& number : numbers_of(truth))
      if (number.key.starts_with("effects.") && amplitude.empty()) amplitude = number.key;
    const Found found = fit_from_nearby(truth, {"friction.scale", "friction.exponent", amplitude});
    CAPTURE(effect.id, found.fit.numbers[2].value, found.fit.summary.reason);
    INFO(words_of(found.fit));
    CHECK(found.fit.rms_error < 1e-6);
    CHECK(found.error < 1e-4);
    CHECK(std::ranges::none_of(found.fit.confusions, &Confusion::total));
  }
}
