#include "pipeline/discover/stability.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "pipeline/discover/random.h"

namespace heddle::discover {

namespace {

/// A hypothesis as a linear model of its observations about z = 0.
struct Linear {
  Eigen::VectorXd residual;  ///< at z = 0, not whitened
  Eigen::MatrixXd slopes;
  Eigen::MatrixXd covariance;
  double log_prior = 0.0;
};

/// ln of the marginal likelihood of some rows: residual ~ N(0, C + J J^T).
double log_evidence(const Linear& linear, const std::vector<Eigen::Index>& rows) {
  const Eigen::LLT<Eigen::MatrixXd> root(Eigen::MatrixXd(linear.covariance(rows, rows)));
  const Eigen::VectorXd residual = root.matrixL().solve(Eigen::VectorXd(linear.residual(rows)));
  const Eigen::MatrixXd slopes = root.matrixL().solve(Eigen::MatrixXd(linear.slopes(rows, Eigen::all)));
  const Eigen::LLT<Eigen::MatrixXd> curvature(slopes.transpose() * slopes +
                                              Eigen::MatrixXd::Identity(slopes.cols(), slopes.cols()));
  const Eigen::VectorXd along = slopes.transpose() * residual;
  return -0.5 * (residual.squaredNorm() - along.dot(curvature.solve(along))) -
         curvature.matrixLLT().diagonal().array().log().sum() -
         root.matrixLLT().diagonal().array().log().sum() + linear.log_prior;
}

/// By how much ln evidence changes where the priors of a hypothesis' effects are `width` times as wide:
/// r + J z with z of another standard deviation, all whitened.
double change_of_evidence(const MapFit& fit, Eigen::Index of_baseline, double width) {
  const Eigen::VectorXd residual = fit.residual - fit.jacobian * fit.z;
  const auto marginal = [&](double scale) {
    Eigen::MatrixXd slopes = fit.jacobian;
    slopes.rightCols(slopes.cols() - of_baseline) *= scale;
    const Eigen::LLT<Eigen::MatrixXd> curvature(slopes.transpose() * slopes +
                                                Eigen::MatrixXd::Identity(slopes.cols(), slopes.cols()));
    const Eigen::VectorXd along = slopes.transpose() * residual;
    return 0.5 * along.dot(curvature.solve(along)) - curvature.matrixLLT().diagonal().array().log().sum();
  };
  return marginal(width) - marginal(1.0);
}

}  // namespace

std::vector<UnderPrior> under_other_priors(const SearchResult& result) {
  std::vector<UnderPrior> all;
  for (const double width : {0.5, 2.0}) {
    UnderPrior under{.width = width, .best = {}, .probability = 0.0};
    std::vector<double> posterior;
    for (const Scored& one : result.scored)
      posterior.push_back(one.fit.log_evidence + one.log_prior +
                          change_of_evidence(one.fit, result.baseline.z.size(), width));
    const auto best = std::ranges::max_element(posterior);
    if (best == posterior.end()) return all;
    double sum = 0.0;
    for (const double value : posterior) sum += std::exp(value - *best);
    under.best = result.scored[static_cast<std::size_t>(best - posterior.begin())].fit.hypothesis;
    under.probability = 1.0 / sum;
    all.push_back(std::move(under));
  }
  return all;
}

double stability_of(const SearchResult& result, const std::vector<CouponCell>& cells, std::uint64_t seed,
                    int halves, std::size_t rivals) {
  std::vector<Linear> linear;
  std::size_t best = 0;
  bool found = false;
  for (const Scored& one : result.scored) {
    if (linear.size() == rivals && found) break;
    if (!found && !one.fit.hypothesis.empty()) {
      best = linear.size();
      found = true;
    }
    linear.push_back({.residual = one.fit.data->unwhitened(one.fit.residual - one.fit.jacobian * one.fit.z),
                      .slopes = one.fit.data->unwhitened(one.fit.jacobian),
                      .covariance = one.fit.data->covariance(),
                      .log_prior = one.log_prior});
  }
  // A wrong label is found in its own cell, which half of the halves do not have.
  const bool choice = found && result.scored[best].fit.z.size() == result.baseline.z.size();
  if (!found || choice || cells.size() < 4) return 1.0;
  Random random(seed);
  std::vector<std::size_t> order(cells.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  int won = 0;
  for (int half = 0; half < halves; ++half) {
    random.shuffle(order);
    std::vector<std::size_t> chosen(order.begin(), order.begin() + std::ssize(order) / 2);
    std::ranges::sort(chosen);
    const std::vector<Eigen::Index> rows = rows_of(cells, chosen);
    std::vector<double> evidence;
    for (const Linear& one : linear) evidence.push_back(log_evidence(one, rows));
    // Half of the data may well not tell the effect from none: that is no other name.
    double other = -1e300;
    for (std::size_t k = 0; k < linear.size(); ++k)
      if (k != best && !result.scored[k].fit.hypothesis.empty()) other = std::max(other, evidence[k]);
    if (evidence[best] >= other) ++won;
  }
  return static_cast<double>(won) / halves;
}

}  // namespace heddle::discover
