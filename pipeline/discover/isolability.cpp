#include "pipeline/discover/isolability.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/problem.h"
#include "pipeline/discover/random.h"
#include "pipeline/discover/signature.h"

namespace heddle::discover {

namespace {

bool is_usual(const Signature& signature) {
  return signature.shape.isZero(0.0);
}

/// Slopes with each shape number, from the changes at -1, 0 and 1 of it; one-sided where one has no finite
/// prediction.
Eigen::MatrixXd slopes_of(const std::vector<Signature>& signatures, const Eigen::VectorXd& own) {
  const Eigen::Index numbers = signatures.front().shape.size();
  Eigen::MatrixXd slopes = Eigen::MatrixXd::Zero(own.size(), numbers);
  for (Eigen::Index k = 0; k < numbers; ++k) {
    int sides = 0;
    for (const Signature& signature : signatures)
      if (signature.shape[k] != 0.0) {
        slopes.col(k) += signature.shape[k] * (signature.change - own);
        ++sides;
      }
    if (sides > 0) slopes.col(k) /= sides;
  }
  return slopes;
}

/// The least amplitude coordinate that makes `visible` standard deviations, on the way that the effect really
/// takes: the signature's slope, then secants.
std::optional<double> detectable_coordinate(const ForwardModel& model, const MapFit& baseline,
                                            const BesideBaseline& beside, const Fingerprint& print,
                                            double visible) {
  const double length = print.own.norm();
  if (!(length > 1e-9)) return std::nullopt;
  const auto [low, high] = model.candidates[print.effect].numbers.front().prior.bounds();
  const Eigen::VectorXd at_baseline = model.predict(baseline.trial);
  const auto numbers = std::ssize(free_numbers(model, {print.effect})) - baseline.z.size();
  double z = visible / length;
  for (int secant = 0; secant < 4; ++secant) {
    Eigen::VectorXd at(baseline.z.size() + numbers);
    at << baseline.z, std::min(z, high), Eigen::VectorXd::Zero(numbers - 1);
    const Eigen::VectorXd change = model.predict(trial_at(model, {print.effect}, at)) - at_baseline;
    if (!change.allFinite()) break;
    const double makes = beside((*baseline.data)(change)).norm();
    if (z >= high && makes < visible) return std::nullopt;
    if (!(makes > 0.0)) break;
    z = std::min(z, high) * visible / makes;
  }
  if (z > high) return std::nullopt;
  return z;
}

Eigen::LLT<Eigen::MatrixXd> root_of(const Eigen::MatrixXd& freedoms) {
  return Eigen::LLT<Eigen::MatrixXd>(freedoms.transpose() * freedoms +
                                     Eigen::MatrixXd::Identity(freedoms.cols(), freedoms.cols()));
}

double separation_with(const Eigen::LLT<Eigen::MatrixXd>& root, const Eigen::VectorXd& truth,
                       const Eigen::MatrixXd& freedoms) {
  const Eigen::VectorXd taken_up = root.matrixL().solve(freedoms.transpose() * truth);
  return std::max(truth.squaredNorm() - taken_up.squaredNorm(), 0.0);
}

/// Gaussian hypotheses in what their freedoms allow, asked of draws.
class Naming {
 public:
  Naming(const std::vector<Fingerprint>& prints, const IsolabilityOptions& options)
      : options_(options), count_(prints.size()) {
    Eigen::Index columns = 0, widest = 0;
    for (const Fingerprint& print : prints) {
      first_.push_back(columns);
      columns += print.freedoms.cols();
      widest = std::max(widest, print.freedoms.cols());
    }
    first_.push_back(columns);
    freedoms_.resize(prints.front().own.size(), columns);
    for (std::size_t k = 0; k < count_; ++k) {
      freedoms_.middleCols(first_[k], width(k)) = prints[k].freedoms;
      roots_.emplace_back(root_of(prints[k].freedoms));
    }
    Random random(options.seed);
    Eigen::MatrixXd noise(freedoms_.rows(), options.draws);
    for (Eigen::Index d = 0; d < noise.cols(); ++d) noise.col(d) = random.normals(noise.rows());
    of_noise_ = freedoms_.transpose() * noise;
    for (int d = 0; d < options.draws; ++d) numbers_.push_back(random.normals(widest));
  }

  /// Share of draws in which the truth's own name is the most probable answer.
  double rate(std::size_t truth) const {
    const Eigen::MatrixXd gram = freedoms_.transpose() * freedoms_.middleCols(first_[truth], width(truth));
    Eigen::MatrixXd along = of_noise_;
    for (Eigen::Index d = 0; d < along.cols(); ++d) {
      Eigen::VectorXd numbers = numbers_[static_cast<std::size_t>(d)].head(width(truth));
      numbers[0] = 1.0;  // the amplitude is the usual one
      along.col(d) += gram * numbers;
    }
    // ln Bayes factors against none: -ln det(1 + D^T D)/2 + t^T (1 + D^T D)^-1 t/2, t = D^T y.
    Eigen::MatrixXd gain(static_cast<Eigen::Index>(count_), along.cols());
    for (std::size_t k = 0; k < count_; ++k) {
      const Eigen::MatrixXd solved =
          roots_[k].matrixL().solve(Eigen::MatrixXd(along.middleRows(first_[k], width(k))));
      gain.row(static_cast<Eigen::Index>(k)) =
          0.5 * solved.colwise().squaredNorm().array() - roots_[k].matrixLLT().diagonal().array().log().sum();
    }
    const SearchOptions& prior = options_.prior;
    const double needed = std::max(
        prior.bayes_factor, std::log(prior.no_effect * static_cast<double>(count_) / prior.one_effect));
    int right = 0;
    for (Eigen::Index d = 0; d < gain.cols(); ++d) {
      Eigen::Index best = 0;
      const double most = gain.col(d).maxCoeff(&best);
      right += best == static_cast<Eigen::Index>(truth) && most > needed ? 1 : 0;
    }
    return static_cast<double>(right) / static_cast<double>(gain.cols());
  }

 private:
  Eigen::Index width(std::size_t k) const { return first_[k + 1] - first_[k]; }

  const IsolabilityOptions& options_;
  std::size_t count_;
  std::vector<Eigen::Index> first_;
  Eigen::MatrixXd freedoms_;
  std::vector<Eigen::LLT<Eigen::MatrixXd>> roots_;
  Eigen::MatrixXd of_noise_;
  std::vector<Eigen::VectorXd> numbers_;
};

/// Connected components of two or more.
std::vector<std::vector<std::size_t>> components(
    std::size_t count, const std::vector<std::pair<std::size_t, std::size_t>>& edges) {
  std::vector<std::size_t> label(count);
  std::iota(label.begin(), label.end(), std::size_t{0});
  for (const auto& [a, b] : edges) {
    const std::size_t from = std::max(label[a], label[b]), to = std::min(label[a], label[b]);
    std::ranges::replace(label, from, to);
  }
  std::vector<std::vector<std::size_t>> groups;
  for (std::size_t k = 0; k < count; ++k) {
    std::vector<std::size_t> group;
    for (std::size_t m = k; m < count; ++m)
      if (label[m] == k) group.push_back(m);
    if (group.size() > 1) groups.push_back(std::move(group));
  }
  return groups;
}

}  // namespace

Eigen::MatrixXd smooth_modes(const Eigen::MatrixXd& likeness, double share) {
  Eigen::VectorXd left = likeness.diagonal();
  const double most = left.size() > 0 ? left.maxCoeff() : 0.0;
  Eigen::MatrixXd modes(likeness.rows(), 0);
  Eigen::Index at = 0;
  while (modes.cols() < likeness.cols() && left.maxCoeff(&at) > share * most) {
    const Eigen::VectorXd rest = likeness.col(at) - modes * modes.row(at).transpose();
    modes.conservativeResize(Eigen::NoChange, modes.cols() + 1);
    modes.rightCols<1>() = rest / std::sqrt(left[at]);
    left -= modes.rightCols<1>().cwiseAbs2();
  }
  return modes;
}

Changes changes_of(const ForwardModel& model, const MapFit& baseline) {
  const BesideBaseline beside(baseline.jacobian);
  const Eigen::VectorXd no_gap = Eigen::VectorXd::Zero(baseline.residual.size());
  Changes changes{.baseline = baseline.data->unwhitened(baseline.jacobian), .effects = {}};
  for (std::size_t effect = 0; effect < model.candidates.size(); ++effect) {
    std::vector<Signature> signatures =
        signatures_of(model, *baseline.data, baseline, beside, no_gap, effect);
    std::erase_if(signatures, [](const Signature& s) { return s.amplitude < 0.0; });
    const auto usual = std::ranges::find_if(signatures, is_usual);
    if (usual == signatures.end()) continue;
    changes.effects.push_back(
        {.effect = effect, .own = usual->change, .slopes = slopes_of(signatures, usual->change)});
  }
  return changes;
}

std::vector<Fingerprint> fingerprints_of(const Changes& changes, const Whitened& data,
                                         const Observations& observations) {
  const BesideBaseline beside(data(changes.baseline));
  std::vector<Eigen::MatrixXd> modes;
  for (const FormCoordinate& c : observations.coordinates)
    modes.push_back(observations.form * smooth_modes(c.likeness));
  std::vector<Fingerprint> prints;
  for (const Changes::OfEffect& of : changes.effects) {
    if (!of.own.allFinite() || !of.slopes.allFinite()) continue;
    Eigen::MatrixXd freedoms(of.own.size(), 1 + of.slopes.cols());
    freedoms << of.own, of.slopes;
    const std::vector<double> weights = form_weights(of.own, observations.coordinates);
    for (std::size_t k = 0; k < weights.size(); ++k) {
      if (weights[k] == 0.0) continue;
      freedoms.conservativeResize(Eigen::NoChange, freedoms.cols() + modes[k].cols());
      freedoms.rightCols(modes[k].cols()) = std::sqrt(weights[k]) * (of.own.asDiagonal() * modes[k]);
    }
    Fingerprint print{.effect = of.effect, .own = {}, .freedoms = beside(data(freedoms))};
    print.own = print.freedoms.col(0);
    prints.push_back(std::move(print));
  }
  return prints;
}

double separation(const Fingerprint& truth, const Fingerprint& rival) {
  return separation_with(root_of(rival.freedoms), truth.own, rival.freedoms);
}

Eigen::MatrixXd separations(const std::vector<Fingerprint>& prints) {
  const auto count = std::ssize(prints);
  Eigen::MatrixXd lambda = Eigen::MatrixXd::Zero(count, count);
  for (Eigen::Index rival = 0; rival < count; ++rival) {
    const Eigen::MatrixXd& freedoms = prints[static_cast<std::size_t>(rival)].freedoms;
    const Eigen::LLT<Eigen::MatrixXd> root = root_of(freedoms);
    for (Eigen::Index truth = 0; truth < count; ++truth)
      if (truth != rival)
        lambda(truth, rival) = separation_with(root, prints[static_cast<std::size_t>(truth)].own, freedoms);
  }
  return lambda;
}

double swap_rate(double lambda) {
  return normal_probability(-0.5 * std::sqrt(lambda));
}

Isolability isolability_of(const ForwardModel& model, const MapFit& baseline,
                           const Observations& observations, const IsolabilityOptions& options) {
  const std::vector<Fingerprint> prints =
      fingerprints_of(changes_of(model, baseline), *baseline.data, observations);
  const BesideBaseline beside(baseline.jacobian);
  Isolability found{.effects = {}, .lambda = separations(prints), .groups = {}};
  if (prints.empty()) return found;
  const Naming naming(prints, options);
  for (std::size_t k = 0; k < prints.size(); ++k) {
    EffectSight sight{.effect = prints[k].effect, .length = prints[k].own.norm()};
    if (const auto z = detectable_coordinate(model, baseline, beside, prints[k], options.visible)) {
      sight.detectable = model.candidates[sight.effect].numbers.front().prior.value_at(*z);
      sight.seen = *z <= 1.0;
    }
    sight.right = naming.rate(k);
    found.right_names += sight.right / static_cast<double>(prints.size());
    found.effects.push_back(sight);
  }
  std::vector<std::pair<std::size_t, std::size_t>> edges;
  for (std::size_t k = 0; k < prints.size(); ++k)
    for (std::size_t m = 0; m < k; ++m) {
      const auto a = static_cast<Eigen::Index>(k), b = static_cast<Eigen::Index>(m);
      const double stronger =
          found.effects[k].length > found.effects[m].length ? found.lambda(a, b) : found.lambda(b, a);
      if (found.effects[k].seen && found.effects[m].seen && stronger < options.visible * options.visible)
        edges.emplace_back(m, k);
    }
  found.groups = components(prints.size(), edges);
  return found;
}

MapFit planned_baseline(const ForwardModel& model, const Eigen::MatrixXd& covariance) {
  const Eigen::VectorXd centre = Eigen::VectorXd::Zero(std::ssize(free_numbers(model, {})));
  const Eigen::VectorXd value = model.predict(trial_at(model, {}, centre));
  if (!value.allFinite())
    throw NumericalError("discover: the model has no finite force for every condition of the design");
  return map_fit(model, std::make_shared<const Whitened>(value, covariance), {}, centre);
}

}  // namespace heddle::discover
