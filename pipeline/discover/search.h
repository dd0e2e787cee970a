#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "pipeline/discover/map_fit.h"
#include "pipeline/discover/options.h"
#include "pipeline/discover/signature.h"

namespace heddle::discover {

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
  double log_prior_one = 0.0, log_prior_two = 0.0;  ///< of one id, and of one pair of ids

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
