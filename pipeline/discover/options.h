#pragma once

#include <cstddef>

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
  /// Hypotheses are weighed by Akaike's criterion of the forms as they are, not by evidence: to see what
  /// evidence is worth.
  bool akaike = false;
  std::size_t pairs_of = 4;  ///< ids whose pairs are tried, the best by evidence
  std::size_t partners = 6;  ///< ids of each, the strongest by their score on what the first leaves over
};

/// When a name is given.
struct VerdictOptions {
  double gate = 0.01;         ///< family-wise p below which there is a gap
  double probability = 0.9;   ///< of the one name
  double set = 0.95;          ///< probability that the candidate set holds
  double bayes_factor = 3.0;  ///< ln
  double lack_of_fit = 0.01;  ///< p below which something is left over
  double excess = 0.8;        ///< share of the excess chi-square that a name must remove
  double captured = 0.75;     ///< share of a free shape's ln Bayes factor that a name must reach
  double stability = 0.8;     ///< share of half-samples in which it wins
  bool unknown = true;        ///< off: free shapes of the gap say nothing, to see what UNKNOWN is worth
};

}  // namespace heddle::discover
