#include "pipeline/discover/signature.h"

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>

namespace heddle::discover {

BesideBaseline::BesideBaseline(const Eigen::MatrixXd& slopes) {
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(slopes, Eigen::ComputeThinU);
  directions_ = svd.matrixU();
  shrink_ = (1.0 + svd.singularValues().array().square()).rsqrt() - 1.0;
}

Eigen::MatrixXd BesideBaseline::operator()(const Eigen::MatrixXd& columns) const {
  return columns + directions_ * (shrink_.asDiagonal() * (directions_.transpose() * columns));
}

Eigen::VectorXd BesideBaseline::gap_of(const MapFit& fit) const {
  return (*this)(fit.residual - fit.jacobian * fit.z);
}

namespace {

/// Free numbers of an effect; the amplitude is the first.
Eigen::Index free_count(const Candidate& candidate) {
  return std::ranges::count_if(candidate.numbers, [](const Unknown& n) { return n.prior.is_free(); });
}

}  // namespace

std::vector<Signature> signatures_of(const ForwardModel& model, const Whitened& data, const MapFit& baseline,
                                     const BesideBaseline& beside, const Eigen::VectorXd& gap,
                                     std::size_t effect) {
  const Candidate& candidate = model.candidates[effect];
  const Eigen::Index numbers = free_count(candidate);
  if (numbers == 0) return {};
  std::vector<Eigen::VectorXd> shapes{Eigen::VectorXd::Zero(numbers - 1)};
  for (Eigen::Index k = 0; k + 1 < numbers; ++k)
    for (const double z : {-1.0, 1.0}) {
      shapes.push_back(Eigen::VectorXd::Zero(numbers - 1));
      shapes.back()[k] = z;
    }
  const auto [low, high] = candidate.numbers.front().prior.bounds();
  const std::vector<double> amplitudes = low >= 0.0 ? std::vector{0.5} : std::vector{0.5, -0.5};
  const Eigen::VectorXd at_baseline = model.predict(baseline.trial);
  std::vector<Signature> signatures;
  for (const Eigen::VectorXd& shape : shapes)
    for (const double amplitude : amplitudes) {
      Eigen::VectorXd z(baseline.z.size() + numbers);
      z << baseline.z, std::min(amplitude, high), shape;
      const Eigen::VectorXd predicted = model.predict(trial_at(model, {effect}, z));
      if (!predicted.allFinite()) continue;
      Signature signature{.effect = effect,
                          .shape = shape,
                          .amplitude = std::min(amplitude, high),
                          .direction = {},
                          .change = {}};
      signature.change = (predicted - at_baseline) / signature.amplitude;
      signature.direction = beside(data(signature.change));
      const double length = signature.direction.norm();
      // The residual is model less measured: an effect that is missing shows with the other sign.
      signature.score = length > 1e-9 ? -signature.direction.dot(gap) / length : 0.0;
      if (low >= 0.0) signature.score = std::max(signature.score, 0.0);
      signatures.push_back(std::move(signature));
    }
  return signatures;
}

const Signature* strongest(const std::vector<Signature>& signatures) {
  const auto best =
      std::ranges::max_element(signatures, {}, [](const Signature& s) { return std::abs(s.score); });
  return best == signatures.end() ? nullptr : &*best;
}

Eigen::VectorXd start_from(const ForwardModel& model, const MapFit& baseline, const Signature& signature) {
  const Eigen::Index numbers = free_count(model.candidates[signature.effect]);
  const double square = signature.direction.squaredNorm();
  const auto [low, high] = model.candidates[signature.effect].numbers.front().prior.bounds();
  const double wanted = signature.score * std::sqrt(square) / (1.0 + square);
  Eigen::VectorXd z(baseline.z.size() + numbers);
  z << baseline.z, std::clamp(wanted, std::max(low, -3.0), std::min(high, 3.0)), signature.shape;
  if (low >= 0.0 && z[baseline.z.size()] < 0.05) z[baseline.z.size()] = 0.05;
  return z;
}

}  // namespace heddle::discover
