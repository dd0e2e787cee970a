// What stands between a fit and a name: errors of form, numbers that foretell, held-out conditions, verdicts.
#include <Eigen/Cholesky>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <set>

#include "pipeline/discover/foresight.h"
#include "pipeline/discover/search.h"
#include "pipeline/discover/split.h"
#include "pipeline/discover/verdict.h"
#include "tests/pipeline/discover/line_world.h"

using namespace heddle;
using namespace heddle::discover;
using namespace heddle::test;

namespace {

/// An error of form over x, one level a point.
FormCoordinate over(const Eigen::VectorXd& x) {
  FormCoordinate c;
  c.likeness.resize(x.size(), x.size());
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    c.level.push_back(static_cast<int>(i));
    for (Eigen::Index j = 0; j < x.size(); ++j) c.likeness(i, j) = std::exp(-0.5 * std::pow(x[i] - x[j], 2));
  }
  return c;
}

/// A free shape of x, as far as a verdict looks at it.
Shape free_shape(double log_evidence, int factors) {
  Shape shape;
  shape.over = "x";
  shape.factors = factors;
  shape.log_evidence = log_evidence;
  return shape;
}

double log_density(const Eigen::VectorXd& value, const Eigen::MatrixXd& covariance) {
  const Eigen::LLT<Eigen::MatrixXd> root(covariance);
  return -0.5 * value.dot(root.solve(value)) - root.matrixLLT().diagonal().array().log().sum();
}

}  // namespace

TEST_CASE("how far a form is off is averaged over: the mean of a linear model's marginal Gaussians",
          "[discover][evidence]") {
  const Line line;
  const ForwardModel model = line.model(normal(0.0, 0.4), false);
  Observations seen{.value = measured(line, 0.5, 0.02)->value(),
                    .covariance = 4e-4 * Eigen::MatrixXd::Identity(12, 12),
                    .coordinates = {over(line.x)}};
  seen.value.array() += 0.1 * line.x.array().pow(4);  // a form that the model has not
  const MapFit exact = map_fit(model, std::make_shared<const Whitened>(seen.value, seen.covariance), {0},
                               Eigen::VectorXd::Zero(3));
  const MapFit fit = with_form_error(model, seen, exact);

  Eigen::MatrixXd design(12, 3);
  design << Eigen::VectorXd::Ones(12), 0.5 * line.x, 0.4 * line.x.cwiseAbs2();
  const Eigen::MatrixXd known = seen.covariance + design * design.transpose();
  const Eigen::VectorXd effect = exact.trial.effects[0].second[0] * line.x.cwiseAbs2();
  const Eigen::MatrixXd form = form_covariance(effect, seen.coordinates, seen.form);
  double sum = 0.0;
  for (const double share : form_shares)
    sum += std::exp(log_density(seen.value, known + share * share * form));
  const double mean = std::log(sum / static_cast<double>(form_shares.size()));
  CHECK(fit.log_evidence == Approx(mean).margin(1e-3));
  CHECK(std::abs(log_density(seen.value, known + form) - mean) > 0.05);  // one share alone is another number
  // An effect whose form is right does not pay for the freedom: its evidence stays near that of the exact
  // form.
  seen.value = measured(line, 0.5, 0.02)->value();
  const MapFit right = map_fit(model, std::make_shared<const Whitened>(seen.value, seen.covariance), {0},
                               Eigen::VectorXd::Zero(3));
  CHECK(with_form_error(model, seen, right).log_evidence > right.log_evidence - 2.0);
}

TEST_CASE("an effect may be wrong over two coordinates together, and over none that it hardly sees",
          "[discover][evidence]") {
  // A grid of 4 x 4: an effect of u alone, of u v, and one of u with 1 % of v.
  Eigen::VectorXd u(16), v(16);
  FormCoordinate of_u, of_v;
  for (int i = 0; i < 16; ++i) {
    u[i] = i % 4;
    v[i] = i / 4;
    of_u.level.push_back(i % 4);
    of_v.level.push_back(i / 4);
  }
  of_u.likeness = over(u).likeness;
  of_v.likeness = over(v).likeness;
  const std::vector<FormCoordinate> both{of_u, of_v};
  CHECK(form_weights(u, both)[1] == 0.0);
  CHECK(form_weights(u + 0.1 * v, both)[1] == 0.0);
  CHECK(form_weights(u.cwiseProduct(v), both) == std::vector<double>{1.0, 1.0});
  const Eigen::VectorXd product = u.cwiseProduct(v);
  const Eigen::MatrixXd joint = of_u.likeness + of_v.likeness + of_u.likeness.cwiseProduct(of_v.likeness);
  const Eigen::MatrixXd wanted = product.asDiagonal() * joint * product.asDiagonal();
  CHECK(form_covariance(product, both, 0.5).isApprox(0.25 * wanted, 1e-12));
}

TEST_CASE("numbers are those that foretell: a form that is wrong within a pull does not spoil its level",
          "[discover][foresight]") {
  // Two readings a pull, precise beside each other, and pulls that scatter. The library has the effect twice
  // as strong in the second reading; nature has it nearly even. What is read precisely is what the form has
  // wrong.
  const Eigen::Index pulls = 24;
  Eigen::VectorXd x(2 * pulls), second(2 * pulls);
  std::vector<CouponCell> cells(pulls);
  for (Eigen::Index c = 0; c < pulls; ++c)
    for (Eigen::Index k = 0; k < 2; ++k) {
      x[2 * c + k] = -1.0 + 2.0 * static_cast<double>(c) / static_cast<double>(pulls - 1);
      second[2 * c + k] = static_cast<double>(k);
      cells[static_cast<std::size_t>(c)].points.push_back({.stretch = static_cast<int>(k)});
    }
  ForwardModel model;
  model.baseline = {{"level", "", normal(0.0, 1.0)}};
  Candidate bend;
  bend.id = "bend";
  bend.numbers = {{"bend.amplitude", "", normal(0.0, 1.0)}};
  model.candidates = {bend};
  model.predict = [=](const Trial& trial) -> Eigen::VectorXd {
    Eigen::VectorXd y = Eigen::VectorXd::Constant(x.size(), trial.baseline[0]);
    for (const auto& [effect, values] : trial.effects)
      y.array() += values[0] * x.array().square() * (1.0 + second.array());
    return y;
  };
  const Eigen::VectorXd truth = 0.5 * x.array().square() * (1.0 + 0.1 * second.array());
  Observations seen{.value = truth, .covariance = Eigen::MatrixXd::Zero(x.size(), x.size())};
  Random random(11);
  for (Eigen::Index c = 0; c < pulls; ++c) {
    seen.value.segment(2 * c, 2).array() += 0.03 * random.normal();
    seen.covariance.block(2 * c, 2 * c, 2, 2).setConstant(9e-4);
  }
  seen.covariance.diagonal().array() += 1e-6;
  for (double& value : seen.value) value += 1e-3 * random.normal();
  seen.coordinates = {over(x)};
  const MapFit exact = map_fit(model, std::make_shared<const Whitened>(seen.value, seen.covariance), {0},
                               Eigen::VectorXd::Zero(2));
  const MapFit chosen = best_in_foresight(model, seen, cells, exact, 5);
  const auto off = [&](const MapFit& fit) { return (model.predict(fit.trial) - truth).norm(); };
  CHECK(off(chosen) < 0.7 * off(exact));
  // Where the form is right, the weights of the noise are the best there are.
  seen.value += 0.5 * x.cwiseAbs2().cwiseProduct(0.9 * second);
  const MapFit right = map_fit(model, std::make_shared<const Whitened>(seen.value, seen.covariance), {0},
                               Eigen::VectorXd::Zero(2));
  const MapFit kept = best_in_foresight(model, seen, cells, right, 5);
  CHECK(kept.trial.effects[0].second[0] == Approx(0.5).epsilon(0.05));
}

TEST_CASE("conditions held out leave the usual level of every factor, and no end of one",
          "[discover][split]") {
  CouponCampaign campaign;
  const auto add = [&](double velocity, double load, double degrees, std::size_t condition, std::size_t day) {
    CouponCell cell;
    cell.pull.velocity = velocity;
    cell.pull.normal_force = load;
    cell.pull.orientation = degrees * std::numbers::pi / 180.0;
    cell.condition = condition;
    cell.day = day;
    campaign.cells.push_back(cell);
  };
  for (std::size_t day = 0; day < 4; ++day) add(0.0166, 1500.0, 0.0, 0, day);
  std::size_t condition = 0;
  for (const double degrees : {30.0, 45.0, 60.0, 90.0}) add(0.0166, 1500.0, degrees, ++condition, 1);
  for (const double velocity : {0.00166, 0.0166, 0.0833})
    for (const double load : {343.0, 1500.0, 4000.0})
      if (velocity != 0.0166 || load != 1500.0) add(velocity, load, 0.0, ++condition, 2);
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Split split = split_conditions(campaign, 0.25, seed);
    std::set<double> degrees, speeds, loads;
    for (const std::size_t c : split.held_out) {
      const friction::FrictionTestRow& pull = campaign.cells[c].pull;
      degrees.insert(std::round(pull.orientation * 180.0 / std::numbers::pi));
      speeds.insert(pull.velocity);
      loads.insert(pull.normal_force);
      CHECK(campaign.cells[c].condition != 0);
    }
    CAPTURE(seed);
    CHECK(std::ranges::any_of(degrees, [](double d) { return d > 0.0; }));
    CHECK_FALSE(degrees.contains(90.0));
    CHECK((speeds.contains(0.00166) || speeds.contains(0.0833)));
    CHECK((loads.contains(343.0) || loads.contains(4000.0)));
    CHECK(split.held_out.size() + split.training.size() == campaign.cells.size());
  }
}

TEST_CASE("a free shape is one of many: it must say more than its choosing costs to make a name unknown",
          "[discover][verdict]") {
  const Line line;
  const ForwardModel model = line.model(normal(0.0, 0.4), false);
  const auto data = measured(line, 0.25, 0.1);
  const SearchResult result =
      search(model, {.value = data->value(), .covariance = 0.01 * Eigen::MatrixXd::Identity(12, 12)});
  const double gain = result.best_gain();
  REQUIRE(gain > 3.0);
  REQUIRE(gain < 12.0);
  const auto answer_with = [&](double more, int factors, const VerdictOptions& options = {}) {
    Evidence evidence;
    evidence.gate_p = 0.0;
    evidence.gap_shapes.assign(20, free_shape(gain + more, factors));
    evidence.rest_shapes.assign(1, free_shape(4.0, factors));
    return decide(model, result, evidence, options).answer;
  };
  const double price = 3.0 + std::log(20.0);
  CHECK(answer_with(price - 0.5, 1) == Answer::named_incomplete);
  CHECK(answer_with(price + 0.5, 1) == Answer::unknown);
  // A function of two factors is as likely as two effects: 0.1 before the data, where one has 0.4.
  CHECK(answer_with(price + std::log(4.0) - 0.1, 2) == Answer::named_incomplete);
  CHECK(answer_with(price + std::log(4.0) + 0.1, 2) == Answer::unknown);
  CHECK(answer_with(price + 0.5, 1, {.unknown = false}) == Answer::named_incomplete);
}

TEST_CASE("where UNKNOWN is off a gap that only a free shape sees is none", "[discover][verdict]") {
  const Line line;
  const ForwardModel model = line.model(normal(0.0, 0.4), false);
  const SearchResult result = search(model, {.value = measured(line, 0.0, 0.1)->value(),
                                             .covariance = 0.01 * Eigen::MatrixXd::Identity(12, 12)});
  REQUIRE(result.best_gain() < 3.0);
  Evidence evidence;
  evidence.gate_p = 0.0;
  evidence.gap_shapes.assign(1, free_shape(20.0, 1));
  CHECK(decide(model, result, evidence).answer == Answer::unknown);
  CHECK(decide(model, result, evidence, {.unknown = false}).answer == Answer::no_gap);
}

TEST_CASE("by Akaike's criterion a hypothesis pays one for each number and nothing for its prior",
          "[discover][search]") {
  const Line line;
  const Observations seen{.value = measured(line, 0.5, 0.1)->value(),
                          .covariance = 0.01 * Eigen::MatrixXd::Identity(12, 12)};
  const SearchResult result = search(line.model(normal(0.0, 0.4), false), seen, {.akaike = true});
  const Scored* bend = result.find({0});
  REQUIRE(bend != nullptr);
  CHECK(bend->fit.log_evidence - result.log_evidence_none ==
        Approx(0.5 * (result.baseline.chi2 - bend->fit.chi2) - 1.0));
  // Of a number with a wide prior the evidence thinks less.
  const SearchResult wide = search(line.model(normal(0.0, 40.0), false), seen);
  const SearchResult wide_akaike = search(line.model(normal(0.0, 40.0), false), seen, {.akaike = true});
  CHECK(wide.best_gain() < result.best_gain() - 2.0);
  CHECK(wide_akaike.best_gain() == Approx(result.best_gain()).margin(0.3));
}

TEST_CASE("two names on one factor must say more than one unknown function of it", "[discover][verdict]") {
  // Nature is a parabola and a cube of x, far above the noise; the library has both.
  const Line line;
  ForwardModel model = line.model(normal(0.0, 0.4), false);
  Candidate cube = model.candidates[0];
  cube.id = "cube";
  cube.numbers = {{"cube.amplitude", "", normal(0.0, 0.4)}};
  model.candidates.push_back(cube);
  model.predict = [x = line.x](const Trial& trial) -> Eigen::VectorXd {
    Eigen::VectorXd y = trial.baseline[0] + (trial.baseline[1] * x.array());
    for (const auto& [effect, values] : trial.effects)
      y.array() += values[0] * x.array().pow(effect == 0 ? 2.0 : 3.0);
    return y;
  };
  const auto data = measured(line, 0.5, 0.02);
  const Eigen::VectorXd value = data->value() + (0.8 * line.x.array().cube()).matrix();
  const SearchResult result =
      search(model, {.value = value, .covariance = 4e-4 * Eigen::MatrixXd::Identity(12, 12)});
  REQUIRE(result.best().fit.hypothesis == Hypothesis{0, 1});
  const double gain = result.best_gain();
  const auto decision_with = [&](double more, int factors) {
    Evidence evidence;
    evidence.gate_p = 0.0;
    evidence.gap_shapes.assign(8, free_shape(gain + more, factors));
    return decide(model, result, evidence);
  };
  // One effect has 0.2 before the data and so has the function, shared by eight factors; the pair has 0.1.
  const double price = 3.0 + std::log(8.0) - std::log(2.0);
  CHECK(decision_with(price - 0.1, 1).answer == Answer::named);
  CHECK(decision_with(price + 0.1, 1).answer == Answer::unknown);
  CHECK(decision_with(price + 0.1, 1).reasons.back().find("One unknown function of x") == 0);
  CHECK(decision_with(price + 0.1, 2).answer == Answer::named);  // of two factors: no rival of two names
}

TEST_CASE(
    "an effect is also tried from the middle of the baseline's prior, where the baseline bent far for it",
    "[discover][search]") {
  // The level b alone reaches the data at b = 2.5; with the effect the same data lie at b = 0, behind a
  // ridge.
  Eigen::VectorXd along(12), across(12);
  for (Eigen::Index i = 0; i < 12; ++i) {
    along[i] = i % 2 == 0 ? 1.0 : 0.5;
    across[i] = i % 2 == 0 ? 0.5 : -1.0;
  }
  ForwardModel model;
  model.baseline = {{"b", "", normal(0.0, 1.0)}};
  Candidate push;
  push.id = "push";
  push.numbers = {{"push.amplitude", "", normal(0.0, 1.0)}};
  model.candidates = {push};
  model.predict = [=](const Trial& trial) -> Eigen::VectorXd {
    const double b = trial.baseline[0];
    Eigen::VectorXd y = b / 2.5 * along + 0.4 * std::sin(std::numbers::pi * b / 2.5) * across;
    for (const auto& [effect, values] : trial.effects) y += values[0] * along;
    return y;
  };
  const SearchResult result =
      search(model, {.value = along, .covariance = 4e-4 * Eigen::MatrixXd::Identity(12, 12)});
  REQUIRE(result.baseline.z[0] > 2.0);
  const Scored* push_alone = result.find({0});
  REQUIRE(push_alone != nullptr);
  CHECK(push_alone->fit.z[0] == Approx(0.0).margin(0.3));
  CHECK(push_alone->fit.trial.effects[0].second[0] == Approx(1.0).margin(0.15));
}

TEST_CASE("a name that another width of the priors would change is not given alone", "[discover][verdict]") {
  const Line line;
  const Observations seen{.value = measured(line, 0.15, 0.1)->value(),
                          .covariance = 0.01 * Eigen::MatrixXd::Identity(12, 12)};
  const ForwardModel model = line.model(normal(0.0, 0.4), false);
  const SearchResult result = search(model, seen);
  // All is linear: the search with priors of that width says the same.
  const std::vector<UnderPrior> under = under_other_priors(result);
  REQUIRE(under.size() == 2);
  for (const UnderPrior& one : under) {
    const SearchResult anew = search(line.model(normal(0.0, 0.4 * one.width), false), seen);
    CHECK(one.best == anew.best().fit.hypothesis);
    CHECK(one.probability == Approx(anew.best().probability).epsilon(1e-4));
  }
  CHECK(under[0].probability != Approx(under[1].probability).epsilon(0.05));

  const SearchResult plain = search(model, {.value = measured(line, 0.5, 0.02)->value(),
                                            .covariance = 4e-4 * Eigen::MatrixXd::Identity(12, 12)});
  Evidence evidence;
  evidence.gate_p = 0.0;
  evidence.priors = {{.width = 0.5, .best = {0}, .probability = 1.0},
                     {.width = 2.0, .best = {0}, .probability = 1.0}};
  CHECK(decide(model, plain, evidence).answer == Answer::named);
  evidence.priors[1].best = {};
  const Decision open = decide(model, plain, evidence);
  CHECK(open.answer == Answer::one_of);
  CHECK(open.reasons.back().find("2 times as wide it is no effect") != std::string::npos);
}

TEST_CASE("many choices under one id do not crowd another name out of the pairs", "[discover][search]") {
  // Beside a parabola: x^3 alone, and seven choices of one id, all nearer to what is left over than it is.
  const Line line;
  ForwardModel model = line.model(normal(0.0, 0.4), false);
  const auto add = [&](const char* id) {
    Candidate candidate = model.candidates[0];
    candidate.id = id;
    candidate.numbers = {{std::string(id) + ".amplitude", "", normal(0.0, 0.4)}};
    model.candidates.push_back(candidate);
  };
  for (int k = 0; k < 7; ++k) add("label");
  add("cube");
  const std::size_t cube = 8;
  model.predict = [x = line.x, cube](const Trial& trial) -> Eigen::VectorXd {
    Eigen::VectorXd y = trial.baseline[0] + (trial.baseline[1] * x.array());
    for (const auto& [effect, values] : trial.effects) {
      if (effect == 0) y.array() += values[0] * x.array().square();
      if (effect == cube) y.array() += values[0] * x.array().cube();
      if (effect > 0 && effect < cube)
        y.array() +=
            values[0] * (x.array().cube() + (1.0 + 0.01 * static_cast<double>(effect)) * x.array().pow(5));
    }
    return y;
  };
  Eigen::VectorXd value = measured(line, 0.8, 0.02)->value();
  value.array() += 0.3 * (line.x.array().cube() + line.x.array().pow(5));
  const SearchResult result =
      search(model, {.value = value, .covariance = 4e-4 * Eigen::MatrixXd::Identity(12, 12)});
  CHECK(result.find({0, cube}) != nullptr);
  const auto with_label = std::ranges::count_if(result.scored, [&](const Scored& one) {
    return one.fit.hypothesis.size() == 2 && one.fit.hypothesis[0] == 0 && one.fit.hypothesis[1] < cube;
  });
  CHECK(with_label == 1);
}
