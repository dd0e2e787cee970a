#pragma once

#include <cstdint>
#include <vector>

#include "pipeline/discover/noise.h"
#include "pipeline/discover/search.h"

namespace heddle::discover {

/// Share of random halves of the cells in which the best hypothesis stays the best of the `rivals` first:
/// each is linearised at its own fit, so that no half is fitted anew.
double stability_of(const SearchResult& result, const std::vector<CouponCell>& cells, std::uint64_t seed,
                    int halves = 100, std::size_t rivals = 4);

/// The best hypothesis with effects were their priors another width, and its margin over the next.
struct UnderPrior {
  double width = 1.0;      ///< of the effects' priors, beside what they are
  Hypothesis best;         ///< empty: none is likelier than no effect
  double probability = 0;  ///< of `best`, among all that were scored
};

/// What would be named were the priors of all effects half as wide, and twice: each hypothesis linearised at
/// its own fit, baseline priors as they are. Bounds of a prior keep their mass.
std::vector<UnderPrior> under_other_priors(const SearchResult& result);

}  // namespace heddle::discover
