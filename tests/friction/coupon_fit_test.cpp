#include "friction/calibration/coupon_fit.h"

#include <fmt/format.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "friction/calibrate.h"

using namespace heddle;
using namespace heddle::friction;

namespace {

const std::string table4 =
    "case,velocity_mm_s,normal_force_N,tool_temperature_C,fabric_temperature_C,force_measured_N\n"
    "baseline,16.67,1500,85,180,843\nvelocity,41.67,1500,85,180,896\nnormal_force,16.67,3000,85,180,1551\n"
    "tool_temperature,16.67,1500,140,180,690\n";

Model paper_law() {
  Model model{.law = HerseyPower{.scale = 0.3, .exponent = 0.1}, .film = {}, .effects = {}, .box = {}};
  model.effects.tool_temperature_shift = ToolTemperatureShift{.slope = 0.0};
  return model;
}

CouponFitSpec wish(const std::vector<std::string>& keys) {
  CouponFitSpec spec;
  for (const std::string& key : keys) spec.numbers.push_back({.key = key});
  return spec;
}
const std::vector<std::string> three{"friction.scale", "friction.exponent",
                                     "effects.tool_temperature_shift.slope"};

CouponFit fit_table4(const CouponFitSpec& spec, const FrictionRig& rig = {}) {
  return fit_coupons(paper_law(), parse_coupons(table4, "table4.csv", {}), rig, {}, spec);
}

/// A campaign about a baseline, the baseline repeated on every day.
struct Campaign {
  int days = 1, samples = 3;  ///< samples a condition
  double sample_sd = 0.05, day_sd = 0.0;
};

CouponData measured(const Model& truth, const Campaign& campaign, unsigned seed) {
  std::mt19937 generator(seed);
  std::normal_distribution<double> normal;
  const std::vector<std::array<double, 3>> conditions{
      {8.33, 1500, 85}, {83.3, 1500, 85},  {1.66, 1500, 85},   {16.67, 343, 85}, {16.67, 4000, 85},
      {83.3, 343, 85},  {16.67, 1500, 21}, {16.67, 1500, 140}, {83.3, 4000, 140}};
  std::string text =
      "condition_id,sample_id,day_id,velocity_mm_s,normal_force_N,tool_temperature_C,fabric_temperature_C,"
      "force_measured_N\n";
  std::vector<double> shifts;
  for (int d = 0; d < campaign.days; ++d) shifts.push_back(campaign.day_sd * normal(generator));
  int number = 0;
  const auto pull = [&](const std::array<double, 3>& c, const std::string& id, int day) {
    FrictionTestRow row;
    row.velocity = 1e-3 * c[0];
    row.normal_force = c[1];
    row.tool_temperature = 273.15 + c[2];
    const double force = run_friction_test(truth, row, {}).pull_force *
                         std::exp(shifts[day] + campaign.sample_sd * normal(generator));
    text += fmt::format("{},{},day {},{},{},{},180,{}\n", id, ++number, day, c[0], c[1], c[2], force);
  };
  for (int d = 0; d < campaign.days; ++d)
    for (int s = 0; s < campaign.samples; ++s) pull({16.67, 1500, 85}, "base", d);
  for (std::size_t k = 0; k < conditions.size(); ++k)
    for (int s = 0; s < campaign.samples; ++s)
      pull(conditions[k], fmt::format("c{}", k), static_cast<int>(k) % campaign.days);
  return parse_coupons(text, "made.csv", {});
}

Model truth_of_campaigns() {
  Model model = paper_law();
  model.law = HerseyPower{.scale = 0.325, .exponent = 0.136};
  model.effects.tool_temperature_shift->slope = -9e-4;
  return model;
}
const std::array<double, 3> truth{0.325, 0.136, -9e-4};

/// How many of the intervals hold the truth, for each of the three numbers.
std::array<int, 3> covered(const Campaign& campaign, const CouponFitSpec& spec, int seeds) {
  std::array<int, 3> count{};
  for (int seed = 1; seed <= seeds; ++seed) {
    const CouponData data = measured(truth_of_campaigns(), campaign, static_cast<unsigned>(seed));
    const CouponFit fit = fit_coupons(paper_law(), data, {}, {}, spec);
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [low, high] = fit.numbers[k].interval.value();
      if (low <= truth[k] && truth[k] <= high) ++count[k];
    }
  }
  return count;
}

std::vector<std::string> problems_of(const Model& start, const std::string& text, const CouponFitSpec& spec) {
  std::vector<std::string> ids;
  try {
    fit_coupons(start, parse_coupons(text, "x.csv", {}), {}, {}, spec);
  } catch (const InputError& error) {
    for (const Problem& problem : error.problems()) {
      ids.push_back(problem.id.text());
      CHECK_FALSE(problem.way_out.empty());
    }
  }
  return ids;
}
using Ids = std::vector<std::string>;

}  // namespace

TEST_CASE("Table 4 with n from rheology has one degree of freedom and the constants of a run",
          "[friction][calibration][paper]") {
  const CouponFit fit = fit_table4(wish(three));
  CHECK(fit.summary.converged);
  CHECK(fit.degrees_of_freedom == 1);
  CHECK_FALSE(fit.saturated());
  CHECK(fit.rms_error == Approx(0.0051).epsilon(0.02));
  CHECK(fit.noise.sample.source == Scatter::Source::residuals);
  CHECK(fit.noise.sample.degrees_of_freedom == 1);
  CHECK(fit.noise.day.source == Scatter::Source::assumed);
  for (const FittedNumber& number : fit.numbers) {
    CHECK(number.interval.has_value());
    CHECK(number.told_apart);
    CHECK(number.exact_slope);
  }
  // The fit inside runs takes F - F_measured over F_measured, this one the logarithm: alike to the square of
  // the errors of 0.5 %.
  const auto rows = parse_friction_table(table4, "table4.csv");
  const Calibration run = calibrate(paper_law(), rows, {});
  for (std::size_t k = 0; k < 3; ++k) {
    CAPTURE(fit.numbers[k].key, run.parameters[k].value);
    CHECK(run.parameters[k].key == fit.numbers[k].key);
    CHECK(fit.numbers[k].value == Approx(run.parameters[k].value).epsilon(0.005));
  }
  CHECK(fit.model.box.hersey_low == Approx(run.model.box.hersey_low).epsilon(1e-12));
  CHECK(fit.model.box.pressure_high == Approx(3e5));
}

TEST_CASE("Table 4 with n free is saturated: it meets the rows and states no scatter",
          "[friction][calibration][paper]") {
  auto keys = three;
  keys.push_back("resin.power_index");
  const CouponFit fit = fit_table4(wish(keys));
  CHECK(fit.saturated());
  CHECK(fit.rms_error < 1e-9);
  CHECK(fit.numbers[1].value == Approx(0.1204).epsilon(2e-3));  // s, and n of the exact power fit
  CHECK(fit.numbers[3].value == Approx(0.553).epsilon(2e-3));
  CHECK(fit.noise.sample.source == Scatter::Source::unknown);
  for (const FittedNumber& number : fit.numbers) CHECK_FALSE(number.sd.has_value());
  CHECK(fit.covariance.size() == 0);
  // With a scatter from elsewhere it says how wide n is: far too wide.
  CouponFitSpec spec = wish(keys);
  spec.noise.sample = 0.02;
  const CouponFit with = fit_table4(spec);
  CHECK(*with.numbers[3].sd > 0.2);
  // A prior takes the place of a row.
  spec = wish(keys);
  spec.numbers[3].prior = Prior{0.38, 0.02};
  const CouponFit held = fit_table4(spec);
  CHECK(held.degrees_of_freedom == 1);
  CHECK(held.from_priors == 1);
  CHECK(held.numbers[3].value == Approx(0.38).margin(0.02));
}

TEST_CASE("what acts alike on every row is named with the product that is fixed", "[friction][calibration]") {
  auto keys = three;
  keys.push_back("resin.consistency");
  CouponFitSpec spec = wish(keys);
  spec.noise.sample = 0.02;
  const CouponFit fit = fit_table4(spec);
  REQUIRE(fit.confusions.size() >= 1);
  const Confusion& confusion = fit.confusions.front();
  CHECK(confusion.total);
  // mu = C Hs^s with Hs ~ m: C m^s.
  const double s = fit.numbers[1].value;
  const bool product = confusion.words.find(fmt::format("friction.scale x resin.consistency^{:.4g}", s)) !=
                           std::string::npos ||
                       confusion.words.find(fmt::format("resin.consistency x friction.scale^{:.4g}",
                                                        1.0 / s)) != std::string::npos;
  CAPTURE(confusion.words);
  CHECK(product);
  CHECK_FALSE(fit.numbers[0].told_apart);
  CHECK_FALSE(fit.numbers[0].sd.has_value());
  CHECK(fit.degrees_of_freedom == 1);  // C and m are one number to these rows
  CHECK(fit.numbers[1].told_apart);    // the exponent is not part of it
  CHECK(fit.numbers[1].sd.has_value());
  CHECK_FALSE(fit.numbers[3].told_apart);
  // Table 4 was pulled at one fabric temperature: it says nothing of E.
  keys.back() = "resin.activation_energy";
  const CouponFit blind = fit_table4(wish(keys));
  REQUIRE(blind.confusions.size() >= 1);
  CHECK(blind.confusions.front().words.find("No force changes with resin.activation_energy") == 0);
  // A prior on m fixes C as well, but the data still cannot tell them apart.
  keys.back() = "resin.consistency";
  spec = wish(keys);
  spec.noise.sample = 0.02;
  spec.numbers[3].prior = Prior{6790.0, 500.0};
  const CouponFit held = fit_table4(spec);
  CHECK(held.numbers[0].sd.has_value());
  CHECK(*held.numbers[3].sd == Approx(500.0).epsilon(1e-6));
  CHECK_FALSE(held.numbers[0].told_apart);
}

TEST_CASE("the plate area moves the scale of the law and neither its exponent nor the shift",
          "[friction][calibration][paper]") {
  const CouponFitSpec spec = wish(three);
  const CouponData data = parse_coupons(table4, "table4.csv", {});
  const FrictionRig rig;
  const CouponFit assumed = fit_coupons(paper_law(), data, rig, {}, spec);
  const PlateAreaEffect effect = plate_area_effect(paper_law(), data, rig, {}, spec, assumed);
  CHECK(effect.moves == std::vector<bool>{true, false, false});
  // Hs ~ A: C A^s is fixed.
  CHECK(effect.low.numbers[0].value / effect.high.numbers[0].value ==
        Approx(std::pow(4.0, assumed.numbers[1].value)).epsilon(1e-6));
  CHECK(effect.low.rms_error == Approx(assumed.rms_error).epsilon(1e-6));
}

TEST_CASE("a fit gives back the numbers that made the forces", "[friction][calibration][analytic]") {
  const CouponData data = measured(truth_of_campaigns(), {.days = 1, .samples = 1, .sample_sd = 0.0}, 1);
  for (const Loss loss : {Loss::none, Loss::huber, Loss::cauchy}) {
    CouponFitSpec spec = wish(three);
    spec.loss = loss;
    spec.noise.day = 0.0;
    const CouponFit fit = fit_coupons(paper_law(), data, {}, {}, spec);
    for (std::size_t k = 0; k < 3; ++k) CHECK(fit.numbers[k].value == Approx(truth[k]).epsilon(1e-7));
  }
}

TEST_CASE("laws and effects with a memory are fitted to stretches of a pull", "[friction][calibration]") {
  Model made{
      .law = ExponentialDecay{.static_coefficient = 0.4, .kinetic_coefficient = 0.28, .decay_speed = 2e-2},
      .film = {},
      .effects = {},
      .box = {}};
  made.effects.static_peak = StaticPeak{.amplitude = 0.4, .length = 3e-3};
  std::string text =
      "sample_id,velocity_mm_s,normal_force_N,tool_temperature_C,fabric_temperature_C,displacement_mm,"
      "pull_force_N\n";
  int sample = 0;
  for (const double velocity : {1.66, 8.33, 16.67, 83.3}) {
    ++sample;
    for (double slip = 0.5; slip < 50.0; slip *= 1.01) {
      FrictionTestRow row;
      row.velocity = 1e-3 * velocity;
      row.normal_force = 1500.0;
      FrictionRig rig;
      rig.pull_length = 1e-3 * slip;
      text += fmt::format("{},{},1500,85,180,{},{}\n", sample, velocity, slip,
                          run_friction_test(made, row, rig).pull_force);
    }
  }
  const CouponData data = parse_coupons(text, "pulls.csv", {.stretches = 12});
  CHECK(data.samples.size() == 4);
  CHECK(data.rows.size() == 48);
  Model start = made;
  start.law = ExponentialDecay{.static_coefficient = 0.3, .kinetic_coefficient = 0.3, .decay_speed = 1e-2};
  start.effects.static_peak = StaticPeak{.amplitude = 0.1, .length = 2e-3};
  CouponFitSpec spec =
      wish({"friction.exponential_decay.static_coefficient", "friction.exponential_decay.kinetic_coefficient",
            "friction.exponential_decay.decay_speed", "effects.static_peak.amplitude",
            "effects.static_peak.length"});
  spec.noise = {.sample = 0.02, .day = 0.0};
  const CouponFit fit = fit_coupons(start, data, {}, {}, spec);
  const std::array<double, 5> expected{0.4, 0.28, 2e-2, 0.4, 3e-3};
  CHECK(fit.summary.converged);
  CHECK(fit.worst_difference < 1e-6);
  for (std::size_t k = 0; k < 5; ++k) {
    CAPTURE(fit.numbers[k].key, fit.numbers[k].value);
    CHECK_FALSE(fit.numbers[k].exact_slope);
    CHECK(fit.numbers[k].value ==
          Approx(expected[k]).epsilon(0.02));  // a mean over a stretch is not its middle
  }
}

TEST_CASE("95 % intervals hold the truth in 90 to 98 % of 200 campaigns",
          "[friction][calibration][statistics][long]") {
  CouponFitSpec spec = wish(three);
  spec.noise.day = 0.0;
  const auto check_coverage = [&](const Campaign& campaign) {
    for (const int count : covered(campaign, spec, 200)) {
      CHECK(count >= 180);
      CHECK(count <= 196);
    }
  };
  const Campaign of_days{.days = 9, .samples = 3, .sample_sd = 0.02, .day_sd = 0.05};
  SECTION("scatter of samples from replicates") {
    check_coverage({.days = 1, .samples = 3});
  }
  SECTION("scatter of samples from the residuals") {
    check_coverage({.days = 1, .samples = 1});
  }
  SECTION("a day effect, estimated from anchors") {
    spec.noise.day.reset();
    check_coverage(of_days);
  }
  SECTION("the check can fail: a day effect that is left out") {
    const auto count = covered(of_days, spec, 200);
    CHECK(*std::min_element(count.begin(), count.end()) < 160);
  }
}

TEST_CASE("scatter of samples and days is found from replicates and anchors",
          "[friction][calibration][analytic]") {
  // Two samples a day, 2 % apart; days at 0, +10, -10 %.
  std::string text =
      "condition_id,sample_id,day_id,velocity_mm_s,normal_force_N,tool_temperature_C,fabric_temperature_C,"
      "force_measured_N\n";
  for (const auto& [day, shift] : {std::pair{"a", 0.0}, std::pair{"b", 0.1}, std::pair{"c", -0.1}})
    for (const double gain : {0.01, -0.01})
      text +=
          fmt::format("base,{}{},{},16.67,1500,85,180,{}\n", day, gain, day, 900.0 * std::exp(shift + gain));
  const CouponData data = parse_coupons(text, "x.csv", {});
  const Scatter sample = scatter_of_samples(data, 2, 0.01).value();
  CHECK(sample.sd == Approx(0.01 * std::sqrt(2.0)).epsilon(1e-9));
  CHECK(sample.degrees_of_freedom == 3);
  const Scatter day = scatter_of_days(data, 2, sample.sd).value();
  CHECK(day.sd == Approx(std::sqrt(0.01 - 0.0001)).epsilon(1e-9));
  CHECK(day.degrees_of_freedom == 2);
  CHECK(scatter_of_days(data, 2, 1.0).value().sd == 0.0);  // samples explain it all
  CHECK_FALSE(scatter_of_samples(parse_coupons(table4, "x.csv", {}), 2, 0.01).has_value());
  CHECK_FALSE(scatter_of_days(parse_coupons(table4, "x.csv", {}), 2, 0.01).has_value());
}

TEST_CASE("the shift of a day is found, and a mean of samples is no surer than its days",
          "[friction][calibration][analytic]") {
  // One Coulomb coefficient: ln mu is the mean over days, with variance (day^2 + sample^2/r)/D.
  Model law{.law = Coulomb{0.3}, .film = {}, .effects = {}, .box = {}};
  const Campaign campaign{.days = 4, .samples = 3, .sample_sd = 0.02, .day_sd = 0.05};
  CouponData data = measured(law, campaign, 11);
  std::erase_if(data.rows, [](const CouponRow& row) { return row.condition != 0; });
  CouponFitSpec spec = wish({"friction.coefficient"});
  spec.noise = {.sample = 0.02, .day = 0.05};
  const CouponFit fit = fit_coupons(law, data, {}, {}, spec);
  double mean = 0.0;
  for (const CouponRow& row : data.rows) mean += std::log(measured_coefficient(row, 2)) / 12.0;
  CHECK(std::log(fit.numbers[0].value) == Approx(mean).epsilon(1e-9));
  CHECK(*fit.numbers[0].sd / fit.numbers[0].value ==
        Approx(std::sqrt((0.05 * 0.05 + 0.02 * 0.02 / 3.0) / 4.0)).epsilon(1e-6));
  CHECK(fit.numbers[0].degrees_of_freedom == 0.0);  // both scatters were given
  CHECK((fit.numbers[0].interval->at(1) - fit.numbers[0].value) == Approx(1.959964 * *fit.numbers[0].sd));
  REQUIRE(fit.day_shifts.size() == 4);
  // Each day's shift is its own mean, drawn in by (1 + sample^2/(r day^2)).
  double first_day = 0.0;
  for (std::size_t i = 0; i < 3; ++i)
    first_day += (std::log(measured_coefficient(data.rows[i], 2)) - mean) / 3.0;
  CHECK(fit.day_shifts[0] == Approx(first_day / (1.0 + 0.02 * 0.02 / (3.0 * 0.05 * 0.05))).epsilon(1e-6));
}

TEST_CASE("a mislabelled sample hardly moves a fit with Cauchy's loss", "[friction][calibration]") {
  CouponData data = measured(truth_of_campaigns(), {.days = 1, .samples = 3, .sample_sd = 0.02}, 5);
  data.rows[7].pull.measured_force = 2.0 * *data.rows[7].pull.measured_force;
  CouponFitSpec spec = wish(three);
  spec.noise = {.sample = 0.02, .day = 0.0};
  const CouponFit plain = fit_coupons(paper_law(), data, {}, {}, spec);
  spec.loss = Loss::cauchy;
  const CouponFit robust = fit_coupons(paper_law(), data, {}, {}, spec);
  CHECK(std::abs(robust.numbers[0].value - truth[0]) < 0.5 * std::abs(plain.numbers[0].value - truth[0]));
  CHECK(robust.rows[7].weight < 0.02);
  CHECK(robust.rows[3].weight > 0.3);
}

TEST_CASE("a bound that binds is said and has no interval", "[friction][calibration]") {
  CouponFitSpec spec = wish(three);
  spec.numbers[1].bounds = {0.0, 0.105};
  const CouponFit fit = fit_table4(spec);
  CHECK(fit.numbers[1].value == Approx(0.105).epsilon(1e-9));
  CHECK(fit.numbers[1].at_bound);
  CHECK_FALSE(fit.numbers[1].interval.has_value());
  CHECK(fit.numbers[0].interval.has_value());
}

TEST_CASE("a wish that cannot be answered is refused with every reason",
          "[friction][calibration][wrong input]") {
  const auto keys = [](std::vector<std::string> list) { return wish(list); };
  CHECK(problems_of(paper_law(), table4, keys({})) == Ids{"calibrate.parameters.none"});
  CHECK(problems_of(paper_law(), table4, keys({"friction.offset", "friction.scale", "friction.scale"})) ==
        Ids{"calibrate.parameters.acts", "calibrate.parameters.twice"});
  CouponFitSpec spec = wish(three);
  spec.numbers[0].bounds = {0.5, 0.4};
  spec.numbers[1].bounds = {0.2, 0.4};
  spec.numbers[2].prior = Prior{0.0, 0.0};
  CHECK(problems_of(paper_law(), table4, spec) ==
        Ids{"calibrate.bounds.order", "calibrate.bounds.start", "calibrate.prior.sd"});
  const std::string two_rows = table4.substr(0, table4.find("normal_force,16"));
  CHECK(problems_of(paper_law(), two_rows, wish(three)) == Ids{"calibrate.data.rows"});
  std::string alike = table4.substr(0, table4.find("baseline"));
  for (int i = 0; i < 5; ++i) alike += fmt::format("s{},16.67,1500,85,180,{}\n", i, 840 + i);
  CHECK(problems_of(paper_law(), alike, wish(three)) == Ids{"calibrate.data.alike"});
  const Model coulomb{.law = Coulomb{0.3}, .film = {}, .effects = {}, .box = {}};
  CHECK(problems_of(coulomb, alike, wish({"friction.coefficient"})).empty());  // one number is told
}
