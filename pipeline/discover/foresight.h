#pragma once

#include <cstdint>
#include <vector>

#include "pipeline/discover/noise.h"
#include "pipeline/discover/search.h"

namespace heddle::discover {

/// Root mean square of ln F_model - ln F_measured over cells that were left out of a fit: a fifth of the
/// cells at a time, the rest fitted anew with the weights of `fit`, from its numbers.
double left_out_error(const ForwardModel& model, const MapFit& fit, const std::vector<CouponCell>& cells,
                      std::uint64_t seed);

/// The numbers of a hypothesis that foretell best. A form that is taken as exact makes the most of an effect
/// that the library has right and goes to any length to bend one that it has not; errors of form do the
/// reverse. The fits with none and with rising shares of it foretell cells that they have not seen, and the
/// best of them stays. Below ten cells: `exact` itself.
/// @param exact  fit with forms taken as exact
MapFit best_in_foresight(const ForwardModel& model, const Observations& observations,
                         const std::vector<CouponCell>& cells, const MapFit& exact, std::uint64_t seed);

}  // namespace heddle::discover
