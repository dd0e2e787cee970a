// What a campaign can tell apart: closed forms on made directions, the friction test's designs, and
// detectable amplitudes against simulated campaigns.
#include "pipeline/discover/isolability.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "pipeline/discover/coordinates.h"
#include "pipeline/discover/random.h"
#include "pipeline/discover/signature.h"
#include "shipped_question.h"

using namespace heddle;
using namespace heddle::discover;

namespace {

Unknown standard_normal(const std::string& key, double scale = 1.0) {
  return {.key = key, .unit = "", .prior = {.kind = Prior::Kind::normal, .centre = 0.0, .scale = scale}};
}

/// ln F = J z + sum of directions times amplitudes: every answer is known by hand.
ForwardModel linear_model(const Eigen::VectorXd& baseline, const std::vector<Eigen::VectorXd>& directions,
                          double amplitude_scale = 1.0) {
  ForwardModel model;
  model.baseline = {standard_normal("level")};
  for (std::size_t k = 0; k < directions.size(); ++k)
    model.candidates.push_back({.id = "effect " + std::to_string(k),
                                .numbers = {standard_normal("amplitude", amplitude_scale)},
                                .look_alikes = {},
                                .form = {},
                                .source = {}});
  model.predict = [baseline, directions](const Trial& trial) {
    Eigen::VectorXd value = baseline * trial.baseline[0];
    for (const auto& [effect, numbers] : trial.effects) value += directions[effect] * numbers[0];
    return value;
  };
  return model;
}

Observations exact_forms(const Eigen::VectorXd& value, double sd) {
  return {.value = value, .covariance = sd * sd * Eigen::MatrixXd::Identity(value.size(), value.size())};
}

struct Judged {
  ForwardModel model;
  Observations observations;
  MapFit baseline;
  Isolability found;
};

Judged judged(ForwardModel model, Observations observations) {
  Judged all{.model = std::move(model), .observations = std::move(observations), .baseline = {}, .found = {}};
  all.baseline = planned_baseline(all.model, all.observations.covariance);
  all.found = isolability_of(all.model, all.baseline, all.observations);
  return all;
}

std::size_t place_of(const ForwardModel& forward, const Isolability& found, const std::string& id) {
  for (std::size_t k = 0; k < found.effects.size(); ++k)
    if (forward.candidates[found.effects[k].effect].id == id) return k;
  throw std::runtime_error("no effect " + id);
}

bool together(const Isolability& found, std::size_t a, std::size_t b) {
  return std::ranges::any_of(found.groups, [&](const std::vector<std::size_t>& group) {
    return std::ranges::count(group, a) > 0 && std::ranges::count(group, b) > 0;
  });
}

}  // namespace

TEST_CASE("two directions at a known angle are as far apart as the angle says", "[discover][isolability]") {
  const double degrees = GENERATE(5.0, 30.0, 90.0);
  const double angle = degrees * 3.14159265358979 / 180.0, sd = 0.02;
  Eigen::VectorXd level(4), first(4), second(4);
  level << 1.0, 0.0, 0.0, 0.0;
  first << 0.0, 0.2, 0.0, 0.0;
  second << 0.0, 0.3 * std::cos(angle), 0.3 * std::sin(angle), 0.0;
  const Judged all = judged(linear_model(level, {first, second}), exact_forms(level, sd));
  const double g = 0.2 / sd, h = 0.3 / sd;
  CAPTURE(degrees);
  CHECK(all.found.effects[0].length == Approx(g).epsilon(1e-9));
  CHECK(all.found.effects[1].length == Approx(h).epsilon(1e-9));
  const double cosine = std::cos(angle);
  CHECK(all.found.lambda(0, 1) ==
        Approx(g * g * (1.0 - h * h * cosine * cosine / (1.0 + h * h))).epsilon(1e-9));
  CHECK(all.found.lambda(1, 0) ==
        Approx(h * h * (1.0 - g * g * cosine * cosine / (1.0 + g * g))).epsilon(1e-9));
  // Three standard deviations of the amplitude, by hand.
  CHECK(*all.found.effects[0].detectable == Approx(3.0 * sd / 0.2).epsilon(1e-6));
  // 15^2 sin^2(5 deg) = 1.7 is a group, 15^2 sin^2(30 deg) = 56 is none.
  CHECK(together(all.found, 0, 1) == (degrees < 10.0));
  CHECK(swap_rate(4.0) == Approx(0.158655).epsilon(1e-5));
}

TEST_CASE("what the baseline's own number can do is no sign of an effect", "[discover][isolability]") {
  Eigen::VectorXd level(3), along(3), across(3);
  level << 0.3, 0.0, 0.0;
  along << 0.1, 0.0, 0.0;
  across << 0.0, 0.1, 0.0;
  const double sd = 0.01;
  const Judged all = judged(linear_model(level, {along, across}), exact_forms(level, sd));
  CHECK(all.found.effects[0].length == Approx(10.0 / std::sqrt(1.0 + 30.0 * 30.0)).epsilon(1e-6));
  CHECK(all.found.effects[1].length == Approx(10.0).epsilon(1e-9));
  CHECK_FALSE(all.found.effects[0].seen);
  CHECK(all.found.effects[1].seen);
  CHECK(all.found.effects[0].right < 0.1);
  CHECK(all.found.effects[1].right > 0.95);
}

TEST_CASE("an error of form brings a look-alike nearer, and smooth modes hold all of it",
          "[discover][isolability]") {
  const std::vector<CouponCell> cells = test::crossed_cells();
  const PlannedCampaign plan = planned_campaign(test::shipped_question(), cells, 2);
  REQUIRE_FALSE(plan.observations.coordinates.empty());
  for (const FormCoordinate& c : plan.observations.coordinates) {
    const Eigen::MatrixXd modes = smooth_modes(c.likeness, 1e-6);
    CHECK((modes * modes.transpose() - c.likeness).cwiseAbs().maxCoeff() < 1e-5 * c.likeness.maxCoeff());
    CHECK(smooth_modes(c.likeness).cols() < c.likeness.cols());
  }

  const Changes changes = changes_of(plan.forward, plan.baseline);
  Observations exact = plan.observations;
  exact.form = 0.0;
  const Eigen::MatrixXd with = separations(fingerprints_of(changes, *plan.baseline.data, plan.observations)),
                        without = separations(fingerprints_of(changes, *plan.baseline.data, exact));
  CHECK((without - with).minCoeff() > -1e-9 * without.maxCoeff());
  // What its own form can be off by brings a rival nearer to some truth, by a tenth or more.
  Eigen::Index brought_nearer = 0;
  for (Eigen::Index rival = 0; rival < with.cols(); ++rival)
    brought_nearer += (with.col(rival).array() < 0.9 * without.col(rival).array()).any() ? 1 : 0;
  CHECK(brought_nearer >= 8);
}

TEST_CASE(
    "crossing tool temperature with speed and load tells a shifted curve from a cooled film, one factor "
    "at a time does not",
    "[discover][isolability]") {
  const CouponQuestion question = test::shipped_question();
  const auto judge = [&](const std::vector<CouponCell>& cells) {
    const PlannedCampaign plan = planned_campaign(question, cells, 8);
    const Isolability found = isolability_of(question, plan);
    const std::size_t film = place_of(plan.forward, found, "tool_temperature_film"),
                      shift = place_of(plan.forward, found, "tool_temperature_shift");
    return std::tuple{together(found, film, shift),
                      found.lambda(static_cast<Eigen::Index>(shift), static_cast<Eigen::Index>(film)),
                      found.right_names};
  };
  const auto [paper_group, paper_lambda, paper_rate] = judge(test::paper_cells());
  const auto [crossed_group, crossed_lambda, crossed_rate] = judge(test::crossed_cells());
  CHECK(paper_group);
  CHECK_FALSE(crossed_group);
  CHECK(paper_lambda < 9.0);
  CHECK(crossed_lambda > 9.0);
  CHECK(crossed_rate > paper_rate + 0.03);
}

TEST_CASE("an amplitude one standard deviation above the detectable is seen in five campaigns of six",
          "[discover][isolability]") {
  const CouponQuestion question = test::shipped_question();
  const PlannedCampaign plan = planned_campaign(question, test::crossed_cells(), 3);
  const Isolability found = isolability_of(question, plan);
  const std::string id =
      GENERATE("tool_temperature_shift", "orientation", "gain_drift", "pressure_dependent_area");
  const EffectSight& sight = found.effects[place_of(plan.forward, found, id)];
  REQUIRE(sight.detectable);
  const Candidate& candidate = plan.forward.candidates[sight.effect];
  // Four of its standard deviations, of which three are asked: Phi(1) = 0.841.
  Eigen::VectorXd numbers(std::ssize(candidate.numbers));
  for (std::size_t k = 0; k < candidate.numbers.size(); ++k)
    numbers[static_cast<Eigen::Index>(k)] = candidate.numbers[k].prior.value_at(0.0);
  const double seen_at = GENERATE(1.0, 4.0 / 3.0);
  numbers[0] = seen_at * *sight.detectable;
  Trial truth = plan.baseline.trial;
  truth.effects.emplace_back(sight.effect, numbers);
  const Eigen::VectorXd force = plan.forward.predict(truth);
  Random random(5);
  const int campaigns = 200;
  int seen = 0;
  for (int campaign = 0; campaign < campaigns; ++campaign) {
    const Eigen::VectorXd measured = force + plan.baseline.data->unwhitened(random.normals(force.size()));
    const auto data = std::make_shared<const Whitened>(measured, plan.observations.covariance);
    const MapFit fit = map_fit(plan.forward, data, {}, plan.baseline.z);
    const BesideBaseline beside(fit.jacobian);
    const std::vector<Signature> signatures =
        signatures_of(plan.forward, *data, fit, beside, beside.gap_of(fit), sight.effect);
    seen += signatures.front().score > 3.0 ? 1 : 0;
  }
  const double rate = static_cast<double>(seen) / campaigns,
               expected = normal_probability(3.0 * seen_at - 3.0);
  CAPTURE(id, seen_at, rate, expected);
  const double binomial = 3.0 * std::sqrt(0.25 / campaigns);
  CHECK(rate > expected - binomial);
  // Beside a power of the load the baseline's exponent moves further than its slopes at the prior's centre
  // tell: there the detectable amplitude is on the safe side.
  if (id != "pressure_dependent_area") CHECK(rate < expected + binomial);
}

TEST_CASE("one seed gives the same rates, another nearly so", "[discover][isolability]") {
  CouponQuestion question = test::shipped_question();
  const PlannedCampaign plan = planned_campaign(question, test::paper_cells(), 3);
  const Isolability first = isolability_of(question, plan), again = isolability_of(question, plan);
  question.seed = 77;
  const Isolability other = isolability_of(question, plan);
  for (std::size_t k = 0; k < first.effects.size(); ++k)
    CHECK(first.effects[k].right == again.effects[k].right);
  CHECK(other.right_names != first.right_names);
  CHECK(other.right_names == Approx(first.right_names).margin(0.03));
}
