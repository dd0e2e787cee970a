#pragma once

#include <string>
#include <vector>

#include "pipeline/discover/options.h"
#include "pipeline/discover/search.h"
#include "pipeline/discover/shape.h"
#include "pipeline/discover/stability.h"

namespace heddle::discover {

/// The five answers. A workflow that cannot say "nothing" or "something else" cannot be trusted.
enum class Answer { no_gap, named, one_of, named_incomplete, unknown };
const char* in_words(Answer answer);  ///< "NO_GAP", "NAMED", ...

/// What is known when the verdict is passed.
struct Evidence {
  double gate_p = 1.0;
  bool scatter_known = true;       ///< from replicates or given; else no one name
  double stability = 1.0;          ///< share of half-samples in which the best hypothesis wins
  std::vector<UnderPrior> priors;  ///< what would be best were the effects' priors another width
  std::vector<Shape> gap_shapes;   ///< of the baseline's gap, best first
  std::vector<Shape> rest_shapes;  ///< of what the best hypothesis leaves over
};

struct Decision {
  Answer answer = Answer::no_gap;
  Hypothesis named;                        ///< of the best hypothesis, whatever the answer; empty: none
  std::vector<std::string> candidate_set;  ///< ids that together hold the set's probability
  std::string group;                       ///< "a tool-temperature effect", where the set is one family
  double probability = 0.0;                ///< of the best hypothesis
  double lack_of_fit_p = 1.0;              ///< of what it leaves over
  double excess_removed = 0.0;
  std::vector<std::string> reasons;  ///< sentences: which rule decided
};

Decision decide(const ForwardModel& model, const SearchResult& result, const Evidence& evidence,
                const VerdictOptions& options = {});

/// That a chi-square of `freedom` degrees is at least `chi2` (Wilson and Hilferty's cube root; 1e-3 or better
/// above 10 degrees).
double chi_square_tail(double chi2, double freedom);

}  // namespace heddle::discover
