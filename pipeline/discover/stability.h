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

}  // namespace heddle::discover
