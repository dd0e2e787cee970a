#pragma once

#include <string>

#include "macroscale/stamping.h"

namespace heddle::macroscale {

/// What to try after a stamping that failed: the cure depends on what ended it, and where. Names the keys of
/// the configuration, with values to put there.
/// @param failure  of a run of `spec` that ended with `summary`
std::string advice_for(const StampingFailure& failure, const StampingSpec& spec,
                       const StampingSummary& summary);

}  // namespace heddle::macroscale
