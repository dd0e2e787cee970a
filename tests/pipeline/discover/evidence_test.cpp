// The fit, its evidence and the statistics built on it, against closed forms, brute force and repeated draws.
#include <Eigen/Cholesky>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "pipeline/discover/map_fit.h"
#include "pipeline/discover/random.h"
#include "pipeline/discover/signature.h"
#include "pipeline/discover/validate.h"
#include "pipeline/discover/verdict.h"
#include "tests/pipeline/discover/line_world.h"

using namespace heddle;
using namespace heddle::discover;
using namespace heddle::test;

namespace {

/// ln of the mean likelihood over prior draws.
double brute_force(const ForwardModel& model, const Whitened& data, const Hypothesis& hypothesis, int draws) {
  Random random(7);
  const auto numbers = free_numbers(model, hypothesis);
  std::vector<double> logs;
  for (int draw = 0; draw < draws; ++draw) {
    Eigen::VectorXd z(std::ssize(numbers));
    for (Eigen::Index k = 0; k < z.size(); ++k) {
      const auto [low, high] = numbers[static_cast<std::size_t>(k)]->prior.bounds();
      do z[k] = random.normal();
      while (z[k] < low || z[k] > high);
    }
    logs.push_back(-0.5 * data.residual(model.predict(trial_at(model, hypothesis, z))).squaredNorm());
  }
  const double top = *std::max_element(logs.begin(), logs.end());
  double sum = 0.0;
  for (const double value : logs) sum += std::exp(value - top);
  return top + std::log(sum / draws) - 0.5 * data.log_determinant();
}

}  // namespace

TEST_CASE("the evidence of a linear model is the density of its marginal Gaussian", "[discover][evidence]") {
  const Line line;
  const ForwardModel model = line.model(normal(0.0, 0.4), false);
  const auto data = measured(line, 0.2, 0.1);
  const MapFit fit = map_fit(model, data, {0}, Eigen::VectorXd::Zero(3));
  REQUIRE(fit.converged);
  Eigen::MatrixXd design(line.x.size(), 3);
  design << Eigen::VectorXd::Ones(line.x.size()), 0.5 * line.x, 0.4 * line.x.cwiseAbs2();
  const Eigen::LLT<Eigen::MatrixXd> marginal(0.01 * Eigen::MatrixXd::Identity(12, 12) +
                                             design * design.transpose());
  const double exact = -0.5 * data->value().dot(marginal.solve(data->value())) -
                       marginal.matrixLLT().diagonal().array().log().sum();
  CHECK(fit.log_evidence == Approx(exact).margin(1e-6));
  CHECK(std::abs(fit.log_evidence - exact - 0.01) > 1e-3);  // the check can fail
}

TEST_CASE("Laplace's evidence is within 0.5 of a hundred thousand prior draws", "[discover][evidence]") {
  const Line line;
  for (const auto& [prior, bend, curved] : {std::tuple{normal(0.0, 0.4), 0.5, true},
                                            {half_normal(0.4), 0.3, true},
                                            {half_normal(0.4), 0.0, false},
                                            {half_normal(0.4), -0.2, true}}) {
    const ForwardModel model = line.model(prior, curved);
    const auto data = measured(line, bend, 0.15);
    const MapFit fit = map_fit(model, data, {0}, Eigen::VectorXd::Constant(3, 0.1));
    CAPTURE(bend, curved);
    CHECK(std::abs(fit.log_evidence - brute_force(model, *data, {0}, 100000)) < 0.5);
  }
}

TEST_CASE("beside the baseline noise is white: scores and squares of the gap keep their distribution",
          "[discover][evidence]") {
  const Line line;
  const ForwardModel model = line.model(normal(0.0, 0.4), false);
  const Eigen::Index size = line.x.size();
  Eigen::MatrixXd covariance = 0.01 * Eigen::MatrixXd::Identity(size, size);
  covariance.topLeftCorner(6, 6).array() += 0.02;  // six of them share a day
  const Eigen::MatrixXd root = covariance.llt().matrixL();
  Random random(11);
  double squares = 0.0, scores = 0.0, unshared = 0.0;
  constexpr int draws = 400;
  for (int draw = 0; draw < draws; ++draw) {
    const Eigen::VectorXd numbers = random.normals(2);
    Eigen::VectorXd y = numbers[0] + 0.5 * numbers[1] * line.x.array();
    y += root * random.normals(size);
    const auto gap_with = [&](const Eigen::MatrixXd& assumed, double* score) {
      const auto data = std::make_shared<const Whitened>(y, assumed);
      const MapFit fit = map_fit(model, data, {}, Eigen::VectorXd::Zero(2));
      const BesideBaseline beside(fit.jacobian);
      const Eigen::VectorXd gap = beside.gap_of(fit);
      if (score != nullptr) *score = strongest(signatures_of(model, *data, fit, beside, gap, 0))->score;
      return gap.squaredNorm();
    };
    double score = 0.0;
    squares += gap_with(covariance, &score) / draws;
    scores += score * score / draws;
    unshared += gap_with(0.01 * Eigen::MatrixXd::Identity(size, size), nullptr) / draws;
  }
  // Standard errors over 400 draws: 0.24 of the mean of chi-square with 12, 0.07 of the mean square of a
  // score.
  CHECK(squares == Approx(12.0).margin(0.8));
  CHECK(scores == Approx(1.0).margin(0.25));
  CHECK(unshared > 13.0);  // a day that is not modelled shows as a gap
}

TEST_CASE("a number that lies at its bound leaves the gap that a free one leaves", "[discover][evidence]") {
  const Line line;
  ForwardModel model = line.model(normal(0.0, 0.4), false);
  const auto data = measured(line, 0.3, 0.1);  // its slope is 0.2
  const MapFit free = map_fit(model, data, {}, Eigen::VectorXd::Zero(2));
  model.baseline[1].prior.high = 0.0;
  const MapFit held = map_fit(model, data, {}, Eigen::VectorXd::Zero(2));
  REQUIRE(held.trial.baseline[1] == 0.0);
  REQUIRE(free.trial.baseline[1] > 0.1);
  const Eigen::VectorXd gap = BesideBaseline(free.jacobian).gap_of(free);
  CHECK(BesideBaseline(held.jacobian).gap_of(held).isApprox(gap, 1e-6));
  CHECK((held.residual - free.residual).norm() > 0.1 * gap.norm());  // as fitted they differ
}

TEST_CASE("the tail of chi-square is the published one", "[discover][verdict]") {
  CHECK(chi_square_tail(18.307, 10.0) == Approx(0.05).margin(1e-3));
  CHECK(chi_square_tail(135.807, 100.0) == Approx(0.01).margin(5e-4));
  CHECK(chi_square_tail(300.0, 300.0) == Approx(0.489).margin(2e-3));
}

TEST_CASE("the shrink of a gap and its interval follow the conditions", "[discover][gap]") {
  std::vector<HeldOut> even(12, HeldOut{.cell = 0, .before = 0.06, .after = 0.03, .noise = 0.02});
  const Gap same = gap_of(even, 1);
  CHECK(same.shrink == Approx(0.5));
  CHECK(same.shrink_low == Approx(0.5));
  CHECK(same.shrink_high == Approx(0.5));
  CHECK(same.closed == Approx(0.75));
  even[0].after = 0.2;  // one condition that became much worse
  const Gap torn = gap_of(even, 1);
  CHECK(torn.shrink < 0.0);
  CHECK(torn.shrink_low < torn.shrink);
  CHECK(torn.shrink_high > 0.3);
}
