#include "pipeline/discover/map_fit.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/problem.h"

namespace heddle::discover {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Coordinates of one hypothesis with their bounds.
struct Room {
  Eigen::VectorXd low, high;
  Eigen::VectorXd into(const Eigen::VectorXd& z) const { return z.cwiseMax(low).cwiseMin(high); }
};

Room room_of(const std::vector<const Unknown*>& numbers) {
  const auto count = static_cast<Eigen::Index>(numbers.size());
  Room room{Eigen::VectorXd(count), Eigen::VectorXd(count)};
  for (Eigen::Index k = 0; k < count; ++k) {
    const auto [low, high] = numbers[static_cast<std::size_t>(k)]->prior.bounds();
    room.low[k] = low;
    room.high[k] = high;
  }
  return room;
}

/// Residuals and their slopes by differences: central, one-sided at a bound.
class Slopes {
 public:
  Slopes(const ForwardModel& model, const Whitened& data, const Hypothesis& hypothesis, const Room& room,
         double step)
      : model_(model), data_(data), hypothesis_(hypothesis), room_(room), step_(step) {}

  Eigen::VectorXd residual(const Eigen::VectorXd& z) {
    ++evaluations_;
    return data_.residual(model_.predict(trial_at(model_, hypothesis_, z)));
  }

  Eigen::MatrixXd jacobian(const Eigen::VectorXd& z, const Eigen::VectorXd& here) {
    Eigen::MatrixXd slopes(here.size(), z.size());
    for (Eigen::Index k = 0; k < z.size(); ++k) {
      Eigen::VectorXd moved = z;
      const double h = z[k] + step_ <= room_.high[k] ? step_ : -step_;
      moved[k] = z[k] + h;
      slopes.col(k) = (residual(moved) - here) / h;
    }
    return slopes;
  }
  int evaluations() const { return evaluations_; }

 private:
  const ForwardModel& model_;
  const Whitened& data_;
  const Hypothesis& hypothesis_;
  const Room& room_;
  double step_;
  int evaluations_ = 0;
};

/// The step that minimises the quadratic within the bounds: coordinates that run into one are held there.
Eigen::VectorXd bounded_step(const Eigen::MatrixXd& curvature, const Eigen::VectorXd& gradient,
                             const Eigen::VectorXd& z, const Room& room) {
  const Eigen::Index count = z.size();
  std::vector<bool> held(static_cast<std::size_t>(count), false);
  Eigen::VectorXd step = Eigen::VectorXd::Zero(count);
  for (Eigen::Index round = 0; round <= count; ++round) {
    Eigen::MatrixXd matrix = curvature;
    Eigen::VectorXd right = -gradient;
    for (Eigen::Index k = 0; k < count; ++k) {
      if (!held[static_cast<std::size_t>(k)]) continue;
      right -= matrix.col(k) * step[k];
      matrix.row(k).setZero();
      matrix.col(k).setZero();
      matrix(k, k) = 1.0;
      right[k] = step[k];
    }
    step = matrix.ldlt().solve(right);
    bool inside = true;
    for (Eigen::Index k = 0; k < count; ++k) {
      const double to = z[k] + step[k];
      if (held[static_cast<std::size_t>(k)] || (to >= room.low[k] && to <= room.high[k])) continue;
      step[k] = (to < room.low[k] ? room.low[k] : room.high[k]) - z[k];
      held[static_cast<std::size_t>(k)] = true;
      inside = false;
    }
    if (inside) break;
  }
  return step;
}

/// Laplace: the Gaussian about the unbounded optimum of the local quadratic, times each coordinate's mass
/// between its bounds.
void add_evidence(MapFit& fit, const std::vector<const Unknown*>& numbers, const Room& room) {
  const Eigen::Index count = fit.z.size();
  double log_prior_mass = 0.0;
  for (const Unknown* number : numbers) log_prior_mass += number->prior.log_mass();
  const Eigen::MatrixXd curvature =
      fit.jacobian.transpose() * fit.jacobian + Eigen::MatrixXd::Identity(count, count);
  const Eigen::LLT<Eigen::MatrixXd> root(curvature);
  fit.covariance = root.solve(Eigen::MatrixXd::Identity(count, count));
  const Eigen::VectorXd gradient = fit.jacobian.transpose() * fit.residual + fit.z;
  const Eigen::VectorXd to_optimum = -(fit.covariance * gradient);
  const double log_determinant = 2.0 * root.matrixLLT().diagonal().array().log().sum();
  fit.log_evidence = -0.5 * (fit.chi2 + fit.z.squaredNorm() + gradient.dot(to_optimum)) -
                     0.5 * log_determinant - log_prior_mass - 0.5 * fit.data->log_determinant();
  for (Eigen::Index k = 0; k < count; ++k) {
    const double sd = std::sqrt(fit.covariance(k, k)), centre = fit.z[k] + to_optimum[k];
    fit.log_evidence += log_normal_mass((room.low[k] - centre) / sd, (room.high[k] - centre) / sd);
  }
}

}  // namespace

Whitened::Whitened(const Eigen::VectorXd& value, const Eigen::MatrixXd& covariance)
    : value_(value), root_(covariance) {
  if (root_.info() != Eigen::Success)
    throw NumericalError("discover: the covariance of the observations is not positive definite");
}

Eigen::VectorXd Whitened::residual(const Eigen::VectorXd& predicted) const {
  return root_.matrixL().solve(predicted - value_);
}

Eigen::MatrixXd Whitened::operator()(const Eigen::MatrixXd& columns) const {
  return root_.matrixL().solve(columns);
}

Eigen::MatrixXd Whitened::unwhitened(const Eigen::MatrixXd& columns) const {
  return root_.matrixL() * columns;
}

Eigen::MatrixXd Whitened::covariance() const {
  return root_.reconstructedMatrix();
}

double Whitened::log_determinant() const {
  return 2.0 * root_.matrixLLT().diagonal().array().log().sum();
}

std::vector<const Unknown*> free_numbers(const ForwardModel& model, const Hypothesis& hypothesis) {
  std::vector<const Unknown*> numbers;
  const auto add = [&](const std::vector<Unknown>& all) {
    for (const Unknown& number : all)
      if (number.prior.is_free()) numbers.push_back(&number);
  };
  add(model.baseline);
  for (const std::size_t effect : hypothesis) add(model.candidates[effect].numbers);
  return numbers;
}

Trial trial_at(const ForwardModel& model, const Hypothesis& hypothesis, const Eigen::VectorXd& z) {
  Eigen::Index at = 0;
  const auto values = [&](const std::vector<Unknown>& numbers) {
    Eigen::VectorXd all(static_cast<Eigen::Index>(numbers.size()));
    for (std::size_t k = 0; k < numbers.size(); ++k) {
      const Prior& prior = numbers[k].prior;
      all[static_cast<Eigen::Index>(k)] = prior.value_at(prior.is_free() ? z[at++] : 0.0);
    }
    return all;
  };
  Trial trial{.baseline = values(model.baseline), .effects = {}};
  for (const std::size_t effect : hypothesis)
    trial.effects.emplace_back(effect, values(model.candidates[effect].numbers));
  return trial;
}

MapFit map_fit(const ForwardModel& model, std::shared_ptr<const Whitened> data, const Hypothesis& hypothesis,
               const Eigen::VectorXd& start, const FitOptions& options) {
  const std::vector<const Unknown*> numbers = free_numbers(model, hypothesis);
  const Room room = room_of(numbers);
  Slopes slopes(model, *data, hypothesis, room, options.step);
  MapFit fit;
  fit.data = std::move(data);
  fit.hypothesis = hypothesis;
  fit.z = room.into(start);
  fit.residual = slopes.residual(fit.z);
  fit.log_evidence = -infinity;
  if (!fit.residual.allFinite()) return fit;
  const auto cost_of = [](const Eigen::VectorXd& residual, const Eigen::VectorXd& z) {
    return 0.5 * (residual.squaredNorm() + z.squaredNorm());
  };
  double cost = cost_of(fit.residual, fit.z);
  double damping = 0.0;
  for (int iteration = 0; iteration < options.iterations_max && !fit.converged; ++iteration) {
    fit.jacobian = slopes.jacobian(fit.z, fit.residual);
    if (!fit.jacobian.allFinite()) break;
    const Eigen::VectorXd gradient = fit.jacobian.transpose() * fit.residual + fit.z;
    Eigen::MatrixXd curvature = fit.jacobian.transpose() * fit.jacobian;
    curvature.diagonal().array() += 1.0;
    for (int trial = 0; trial < 12; ++trial) {
      Eigen::MatrixXd damped = curvature;
      damped.diagonal() *= 1.0 + damping;
      const Eigen::VectorXd step = bounded_step(damped, gradient, fit.z, room);
      const double expected = -gradient.dot(step) - 0.5 * step.dot(curvature * step);
      if (expected < options.tolerance) {
        fit.converged = true;
        break;
      }
      const Eigen::VectorXd z = room.into(fit.z + step);
      const Eigen::VectorXd residual = slopes.residual(z);
      const double next = residual.allFinite() ? cost_of(residual, z) : infinity;
      if (next < cost - 0.01 * expected) {
        damping = cost - next > 0.5 * expected ? 0.2 * damping : damping;
        if (damping < 1e-4) damping = 0.0;
        cost = next;
        fit.z = z;
        fit.residual = residual;
        break;
      }
      damping = std::max(10.0 * damping, 0.03);
    }
  }
  fit.chi2 = fit.residual.squaredNorm();
  fit.trial = trial_at(model, hypothesis, fit.z);
  if (!fit.converged) fit.jacobian = slopes.jacobian(fit.z, fit.residual);
  fit.evaluations = slopes.evaluations();
  if (fit.jacobian.allFinite()) add_evidence(fit, numbers, room);
  return fit;
}

MapFit best_fit(const ForwardModel& model, const std::shared_ptr<const Whitened>& data,
                const Hypothesis& hypothesis, const std::vector<Eigen::VectorXd>& starts,
                const FitOptions& options) {
  MapFit best;
  int evaluations = 0;
  for (const Eigen::VectorXd& start : starts) {
    MapFit fit = map_fit(model, data, hypothesis, start, options);
    evaluations += fit.evaluations;
    if (best.z.size() == 0 || fit.log_evidence > best.log_evidence) best = std::move(fit);
  }
  best.evaluations = evaluations;
  return best;
}

namespace {

/// How much of an effect's variation lies between the levels of a coordinate, 0 to 1.
double share_between(const Eigen::VectorXd& effect, const std::vector<int>& level) {
  const int count = *std::ranges::max_element(level) + 1;
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(count), number = Eigen::VectorXd::Zero(count);
  for (std::size_t i = 0; i < level.size(); ++i) {
    sum[level[i]] += effect[static_cast<Eigen::Index>(i)];
    number[level[i]] += 1.0;
  }
  const double mean = effect.mean(), total = (effect.array() - mean).square().sum();
  const double between = ((sum.array() / number.array() - mean).square() * number.array()).sum();
  return total > 1e-12 ? between / total : 0.0;
}

}  // namespace

std::vector<double> form_weights(const Eigen::VectorXd& effect,
                                 const std::vector<FormCoordinate>& coordinates) {
  constexpr double none = 0.03;
  std::vector<double> weights;
  for (const FormCoordinate& c : coordinates) weights.push_back(share_between(effect, c.level));
  const double strongest = weights.empty() ? 0.0 : *std::ranges::max_element(weights);
  for (double& weight : weights)
    weight = weight > none * strongest ? (weight / strongest - none) / (1.0 - none) : 0.0;
  return weights;
}

Eigen::MatrixXd form_covariance(const Eigen::VectorXd& effect, const std::vector<FormCoordinate>& coordinates,
                                double form) {
  const std::vector<double> weights = form_weights(effect, coordinates);
  Eigen::MatrixXd likeness = Eigen::MatrixXd::Zero(effect.size(), effect.size());
  for (std::size_t k = 0; k < weights.size(); ++k) {
    if (weights[k] == 0.0) continue;
    likeness += weights[k] * coordinates[k].likeness;
    for (std::size_t m = 0; m < k; ++m)
      if (weights[m] > 0.0)
        likeness += weights[k] * weights[m] * coordinates[k].likeness.cwiseProduct(coordinates[m].likeness);
  }
  const Eigen::VectorXd size = form * effect;
  return size.asDiagonal() * likeness * size.asDiagonal();
}

Eigen::MatrixXd form_covariance_of(const ForwardModel& model, const Observations& observations,
                                   const Trial& trial) {
  Eigen::MatrixXd covariance =
      Eigen::MatrixXd::Zero(observations.covariance.rows(), observations.covariance.cols());
  const Eigen::VectorXd whole = model.predict(trial);
  for (std::size_t k = 0; k < trial.effects.size(); ++k) {
    Trial without = trial;
    without.effects.erase(without.effects.begin() + static_cast<std::ptrdiff_t>(k));
    const Eigen::VectorXd effect = whole - model.predict(without);
    if (effect.allFinite())
      covariance += form_covariance(effect, observations.coordinates, observations.form);
  }
  return covariance;
}

namespace {

/// A fit moved to where it would be with other weights, its slopes held.
MapFit reweighed(const ForwardModel& model, const MapFit& fit, std::shared_ptr<const Whitened> data) {
  const std::vector<const Unknown*> numbers = free_numbers(model, fit.hypothesis);
  const Room room = room_of(numbers);
  MapFit moved = fit;
  moved.data = std::move(data);
  moved.residual = (*moved.data)(fit.data->unwhitened(fit.residual));
  moved.jacobian = (*moved.data)(fit.data->unwhitened(fit.jacobian));
  const Eigen::MatrixXd curvature =
      moved.jacobian.transpose() * moved.jacobian + Eigen::MatrixXd::Identity(fit.z.size(), fit.z.size());
  const Eigen::VectorXd gradient = moved.jacobian.transpose() * moved.residual + fit.z;
  const Eigen::VectorXd step = bounded_step(curvature, gradient, fit.z, room);
  moved.z += step;
  moved.residual += moved.jacobian * step;
  moved.chi2 = moved.residual.squaredNorm();
  moved.trial = trial_at(model, fit.hypothesis, moved.z);
  add_evidence(moved, numbers, room);
  return moved;
}

}  // namespace

MapFit with_form_error(const ForwardModel& model, const Observations& observations, const MapFit& fit,
                       const FitOptions& options) {
  if (observations.coordinates.empty() || observations.form == 0.0 || !std::isfinite(fit.log_evidence))
    return fit;
  const Eigen::MatrixXd form = form_covariance_of(model, observations, fit.trial);
  std::vector<std::shared_ptr<const Whitened>> weights;
  for (const double share : form_shares)
    weights.push_back(
        std::make_shared<const Whitened>(observations.value, observations.covariance + share * share * form));
  MapFit best;
  double share = 0.0;
  for (std::size_t k = 0; k < weights.size(); ++k) {
    MapFit moved = reweighed(model, fit, weights[k]);
    if (best.data != nullptr && !(moved.log_evidence > best.log_evidence)) continue;
    best = std::move(moved);
    share = form_shares[k];
  }
  best = map_fit(model, best.data, best.hypothesis, best.z, options);
  best.form_share = share;
  if (!std::isfinite(best.log_evidence)) return best;
  double sum = 0.0;
  for (const auto& data : weights) {
    const double evidence = data == best.data ? best.log_evidence : reweighed(model, best, data).log_evidence;
    sum += std::exp(evidence - best.log_evidence);
  }
  best.log_evidence += std::log(sum / static_cast<double>(weights.size()));
  return best;
}

}  // namespace heddle::discover
