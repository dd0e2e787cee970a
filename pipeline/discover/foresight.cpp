#include "pipeline/discover/foresight.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "pipeline/discover/random.h"

namespace heddle::discover {

namespace {

constexpr std::size_t folds = 5;
constexpr std::array shares{0.4, 0.8};  ///< of Observations::form
/// A fold starts where the whole fit ended: few steps tell what it foretells.
constexpr FitOptions of_a_fold{.iterations_max = 4, .tolerance = 0.05};

}  // namespace

double left_out_error(const ForwardModel& model, const MapFit& fit, const std::vector<CouponCell>& cells,
                      std::uint64_t seed) {
  std::vector<std::size_t> order(cells.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  Random(seed).shuffle(order);
  const Eigen::MatrixXd covariance = fit.data->covariance();
  const Eigen::VectorXd& value = fit.data->value();
  double sum = 0.0;
  for (std::size_t fold = 0; fold < folds; ++fold) {
    std::vector<std::size_t> in, out;
    for (std::size_t k = 0; k < order.size(); ++k) (k % folds == fold ? out : in).push_back(order[k]);
    std::ranges::sort(in);
    std::ranges::sort(out);
    const std::vector<Eigen::Index> rows = rows_of(cells, in), unseen = rows_of(cells, out);
    ForwardModel part = model;
    part.predict = [&](const Trial& trial) -> Eigen::VectorXd { return model.predict(trial)(rows); };
    const MapFit without = map_fit(part,
                                   std::make_shared<const Whitened>(Eigen::VectorXd(value(rows)),
                                                                    Eigen::MatrixXd(covariance(rows, rows))),
                                   fit.hypothesis, fit.z, of_a_fold);
    const Eigen::VectorXd predicted = model.predict(without.trial)(unseen);
    sum += (predicted - Eigen::VectorXd(value(unseen))).squaredNorm();
  }
  return std::sqrt(sum / static_cast<double>(value.size()));
}

MapFit best_in_foresight(const ForwardModel& model, const Observations& observations,
                         const std::vector<CouponCell>& cells, const MapFit& exact, std::uint64_t seed) {
  if (cells.size() < 2 * folds || observations.coordinates.empty() || observations.form == 0.0) return exact;
  const Eigen::MatrixXd& noise = observations.covariance;
  const Eigen::MatrixXd form = form_covariance_of(model, observations, exact.trial);
  std::vector<Eigen::MatrixXd> weights;
  for (const double share : shares) weights.push_back(noise + share * share * form);
  const double points = static_cast<double>(noise.rows()) / static_cast<double>(cells.size());
  weights.emplace_back(points * Eigen::MatrixXd(noise.diagonal().asDiagonal()));
  struct Tried {
    MapFit fit;
    double error = 0.0;
  };
  std::vector<Tried> tried(1 + weights.size());
  tbb::parallel_for(std::size_t{0}, tried.size(), [&](std::size_t k) {
    MapFit fit = exact;
    if (k > 0)
      fit = map_fit(model, std::make_shared<const Whitened>(observations.value, weights[k - 1]),
                    exact.hypothesis, exact.z);
    const double error = std::isfinite(fit.log_evidence) ? left_out_error(model, fit, cells, seed) : NAN;
    tried[k] = {std::move(fit), error};
  });
  const Tried* best = &tried.front();
  for (const Tried& one : tried)
    if (one.error < best->error || (std::isfinite(one.error) && !std::isfinite(best->error))) best = &one;
  return best->fit;
}

}  // namespace heddle::discover
