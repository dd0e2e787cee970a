#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "pipeline/discover/map_fit.h"
#include "pipeline/discover/signature.h"

namespace heddle::discover {

/// Probabilities before the data, and how far the search goes.
struct SearchOptions {
  double no_effect = 0.5;     ///< prior probability that nothing is missing
  double one_effect = 0.4;    ///< shared evenly by all ids
  double two_effects = 0.1;   ///< shared evenly by all pairs
  double bayes_factor = 3.0;  ///< ln, that each effect more must gain
  /// And that the second must gain as share of what the first does: beside an effect that is plain, what its
  /// form is off by looks like another.
  double second = 0.005;
  std::size_t pairs_of = 4;  ///< single effects whose pairs are tried, the best by evidence
  std::size_t partners = 6;  ///< of each, the strongest by their score on what the first leaves over
};

/// One hypothesis that was fitted, with its probability among all that were.
struct Scored {
  MapFit fit;  ///< with the error of form of its effects: for evidence and for what is left over
  /// The numbers to predict with: forms taken as exact; of what is named, as foretells best (foresight.h).
  MapFit numbers;
  double log_prior = 0.0;
  double log_choice = 0.0;  ///< part of log_prior: one of many choices under an id (Candidate::log_weight)
  double probability = 0.0;
};

/// What the search found.
struct SearchResult {
  MapFit baseline;
  Eigen::VectorXd gap;                ///< residual of the baseline, beside what its numbers can do
  std::vector<Signature> signatures;  ///< strongest of each candidate, in their order
  std::vector<Scored> scored;         ///< best first; the empty hypothesis is among them
  double log_evidence_none = 0.0;

  const Scored& best() const { return scored.front(); }
  const Scored* find(const Hypothesis& hypothesis) const;
  Scored* find(const Hypothesis& hypothesis);
  /// ln Bayes factor of the best hypothesis with effects against none; a choice pays for the choosing.
  double best_gain() const;
};

/// Baseline, signatures, every single effect, pairs of the strongest: fitted, scored by Laplace evidence.
SearchResult search(const ForwardModel& model, const Observations& observations,
                    const SearchOptions& options = {});

/// Sorts and normalises.
void give_probabilities(std::vector<Scored>& scored);

/// Whether the second effect of every pair earned its place: against each of its members alone.
bool earns_its_place(const SearchResult& result, const Scored& pair, const SearchOptions& options);

}  // namespace heddle::discover
