#include "pipeline/discover/search.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <string>

namespace heddle::discover {

namespace {

/// ln prior probability of a hypothesis: ids share evenly, choices of one id share its part.
class HypothesisPrior {
 public:
  HypothesisPrior(const ForwardModel& model, const SearchOptions& options)
      : model_(model), options_(options) {
    std::set<std::string> ids;
    for (const Candidate& candidate : model.candidates) ids.insert(candidate.id);
    ids_ = static_cast<double>(ids.size());
  }
  double of(const Hypothesis& hypothesis) const {
    if (hypothesis.empty()) return std::log(options_.no_effect);
    return (hypothesis.size() == 1 ? of_one() : of_two()) + choice(hypothesis);
  }
  double of_one() const { return std::log(options_.one_effect / ids_); }
  double of_two() const { return std::log(options_.two_effects / std::max(0.5 * ids_ * (ids_ - 1.0), 1.0)); }
  double choice(const Hypothesis& hypothesis) const {
    double log_weight = 0.0;
    for (const std::size_t effect : hypothesis) log_weight += model_.candidates[effect].log_weight;
    return log_weight;
  }

 private:
  const ForwardModel& model_;
  const SearchOptions& options_;
  double ids_ = 0.0;
};

/// Standard deviations of its prior at which a number of the baseline has bent.
constexpr double far_off = 1.5;

/// Starts of a single effect: its strongest shape, the strongest other one, and the strongest from the middle
/// of the baseline's prior, since a baseline that bends for what it lacks may lie far from where it belongs.
std::vector<Eigen::VectorXd> starts_of(const ForwardModel& model, const MapFit& baseline,
                                       const std::vector<Signature>& signatures) {
  if (signatures.empty()) return {baseline.z};  // a choice without numbers
  std::vector<const Signature*> order;
  for (const Signature& signature : signatures) order.push_back(&signature);
  std::ranges::stable_sort(order, std::greater{}, [](const Signature* s) { return std::abs(s->score); });
  std::vector<Eigen::VectorXd> starts{start_from(model, baseline, *order.front())};
  for (const Signature* other : order)
    if (other->shape != order.front()->shape) {
      starts.push_back(start_from(model, baseline, *other));
      break;
    }
  if (baseline.z.cwiseAbs().maxCoeff() > far_off) {
    starts.push_back(starts.front());
    starts.back().head(baseline.z.size()).setZero();
    starts.back()[baseline.z.size()] = order.front()->amplitude;
  }
  return starts;
}

/// The numbers of two single fits side by side.
Eigen::VectorXd joined(const MapFit& baseline, const MapFit& first, const MapFit& second) {
  const Eigen::Index base = baseline.z.size();
  const Eigen::VectorXd of_first = first.z.tail(first.z.size() - base),
                        of_second = second.z.tail(second.z.size() - base);
  Eigen::VectorXd z(base + of_first.size() + of_second.size());
  z << first.z.head(base), of_first, of_second;
  return z;
}

/// Pairs of the best single effects with those that what they leave over asks for: a linear look at the score
/// of each candidate's signatures on the rest, since a pair must gain `bayes_factor` on its better half.
std::vector<Hypothesis> pairs_to_try(const std::vector<Scored>& singles,
                                     const std::vector<std::vector<Signature>>& signatures,
                                     const ForwardModel& model, const SearchOptions& options) {
  std::set<Hypothesis> pairs;
  std::set<std::string> firsts;
  for (const Scored& single : singles) {
    if (firsts.size() == options.pairs_of) break;
    const MapFit& fit = single.fit;
    const std::size_t first = fit.hypothesis[0];
    if (!firsts.insert(model.candidates[first].id).second) continue;
    const BesideBaseline beside(fit.jacobian);
    const Eigen::VectorXd gap = beside.gap_of(fit);
    std::vector<std::pair<double, std::size_t>> partners;
    for (std::size_t other = 0; other < signatures.size(); ++other) {
      if (model.candidates[other].id == model.candidates[first].id) continue;
      double score = 0.0;
      for (const Signature& signature : signatures[other]) {
        const Eigen::VectorXd direction = beside((*fit.data)(signature.change));
        const double along = -direction.dot(gap) / direction.norm();
        const auto [low, high] = model.candidates[other].numbers.front().prior.bounds();
        score = std::max(score, low >= 0.0 ? along : std::abs(along));
      }
      if (0.5 * score * score > options.bayes_factor) partners.emplace_back(score, other);
    }
    std::ranges::sort(partners, std::greater{});
    // Of the many choices under one id the strongest: they must not crowd the other names out.
    std::set<std::string> ids;
    std::erase_if(partners, [&](const auto& p) { return !ids.insert(model.candidates[p.second].id).second; });
    partners.resize(std::min(partners.size(), options.partners));
    for (const auto& [score, other] : partners)
      pairs.insert({std::min(first, other), std::max(first, other)});
  }
  return {pairs.begin(), pairs.end()};
}

/// The fit a hypothesis is weighed by.
MapFit weighed(const ForwardModel& model, const Observations& observations, const MapFit& exact,
               const SearchOptions& options) {
  if (!options.akaike) return with_form_error(model, observations, exact);
  MapFit fit = exact;
  if (std::isfinite(fit.log_evidence))
    fit.log_evidence = -0.5 * (fit.chi2 + fit.data->log_determinant()) - static_cast<double>(fit.z.size());
  return fit;
}

}  // namespace

const Scored* SearchResult::find(const Hypothesis& hypothesis) const {
  const auto at =
      std::ranges::find_if(scored, [&](const Scored& one) { return one.fit.hypothesis == hypothesis; });
  return at == scored.end() ? nullptr : &*at;
}

Scored* SearchResult::find(const Hypothesis& hypothesis) {
  const auto at =
      std::ranges::find_if(scored, [&](const Scored& one) { return one.fit.hypothesis == hypothesis; });
  return at == scored.end() ? nullptr : &*at;
}

double SearchResult::best_gain() const {
  double best = -std::numeric_limits<double>::infinity();
  for (const Scored& one : scored)
    if (!one.fit.hypothesis.empty())
      best = std::max(best, one.fit.log_evidence + one.log_choice - log_evidence_none);
  return best;
}

void give_probabilities(std::vector<Scored>& scored) {
  std::ranges::stable_sort(scored, std::greater{},
                           [](const Scored& one) { return one.fit.log_evidence + one.log_prior; });
  const double top = scored.front().fit.log_evidence + scored.front().log_prior;
  double sum = 0.0;
  for (Scored& one : scored) sum += one.probability = std::exp(one.fit.log_evidence + one.log_prior - top);
  for (Scored& one : scored) one.probability /= sum;
}

bool earns_its_place(const SearchResult& result, const Scored& pair, const SearchOptions& options) {
  if (!std::isfinite(pair.fit.log_evidence)) return false;
  for (const std::size_t member : pair.fit.hypothesis) {
    const Scored* alone = result.find({member});
    if (alone == nullptr) continue;
    const double of_first = alone->fit.log_evidence - result.log_evidence_none;
    const double wanted = std::max(options.bayes_factor, options.second * of_first);
    if (pair.fit.log_evidence - alone->fit.log_evidence <= wanted) return false;
  }
  return true;
}

SearchResult search(const ForwardModel& model, const Observations& observations,
                    const SearchOptions& options) {
  SearchResult result;
  const auto data = std::make_shared<const Whitened>(observations.value, observations.covariance);
  const HypothesisPrior prior(model, options);
  result.log_prior_one = prior.of_one();
  result.log_prior_two = prior.of_two();
  const auto free_baseline = std::ssize(free_numbers(model, {}));
  result.baseline =
      weighed(model, observations, map_fit(model, data, {}, Eigen::VectorXd::Zero(free_baseline)), options);
  result.log_evidence_none = result.baseline.log_evidence;
  if (!std::isfinite(result.log_evidence_none)) return result;
  const BesideBaseline beside(result.baseline.jacobian);
  result.gap = beside.gap_of(result.baseline);

  const std::size_t count = model.candidates.size();
  std::vector<std::vector<Signature>> signatures(count);
  std::vector<Scored> singles(count);
  tbb::parallel_for(std::size_t{0}, count, [&](std::size_t effect) {
    signatures[effect] = signatures_of(model, *data, result.baseline, beside, result.gap, effect);
    MapFit exact = best_fit(model, data, {effect}, starts_of(model, result.baseline, signatures[effect]));
    singles[effect] = {.fit = weighed(model, observations, exact, options),
                       .numbers = std::move(exact),
                       .log_prior = prior.of({effect}),
                       .log_choice = prior.choice({effect})};
  });
  for (const std::vector<Signature>& of : signatures)
    if (const Signature* best = strongest(of)) result.signatures.push_back(*best);
  std::vector<MapFit> by_effect;
  for (const Scored& single : singles) by_effect.push_back(single.numbers);
  std::erase_if(singles, [](const Scored& one) { return !std::isfinite(one.fit.log_evidence); });
  std::ranges::stable_sort(singles, std::greater{},
                           [](const Scored& one) { return one.fit.log_evidence + one.log_prior; });

  result.scored = singles;
  result.scored.push_back({.fit = result.baseline, .numbers = result.baseline, .log_prior = prior.of({})});
  // A pair can only win where a single effect does better than none.
  if (result.best_gain() > options.bayes_factor) {
    std::vector<Hypothesis> pairs = pairs_to_try(singles, signatures, model, options);
    std::erase_if(pairs, [&](const Hypothesis& pair) {
      return !std::isfinite(by_effect[pair[0]].log_evidence) ||
             !std::isfinite(by_effect[pair[1]].log_evidence);
    });
    std::vector<Scored> fitted(pairs.size());
    tbb::parallel_for(std::size_t{0}, pairs.size(), [&](std::size_t k) {
      const MapFit &first = by_effect[pairs[k][0]], &second = by_effect[pairs[k][1]];
      MapFit exact = map_fit(model, data, pairs[k], joined(result.baseline, first, second));
      fitted[k] = {.fit = weighed(model, observations, exact, options),
                   .numbers = std::move(exact),
                   .log_prior = prior.of(pairs[k]),
                   .log_choice = prior.choice(pairs[k])};
    });
    for (Scored& pair : fitted)
      if (earns_its_place(result, pair, options)) result.scored.push_back(std::move(pair));
  }
  give_probabilities(result.scored);
  return result;
}

}  // namespace heddle::discover
