#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace heddle::discover {

/// How far model and measurement are apart on conditions that no fit saw, before and after an effect was
/// added.
struct Gap {
  double before = 0.0, after = 0.0;  ///< root mean square of ln F_model - ln F_measured over conditions [-]
  double floor = 0.0;                ///< what noise alone gives [-]
  double shrink = 0.0;               ///< 1 - after/before
  double shrink_low = 0.0, shrink_high = 0.0;  ///< 95 %, BCa bootstrap over conditions
  double closed =
      0.0;  ///< (before - after)/(before - floor): share of what could be closed; 0 where nothing could
  int conditions = 0;
};

/// One held-out condition.
struct HeldOut {
  std::size_t cell = 0;  ///< index in the campaign
  /// Root mean square over its points of ln F_model - ln F_measured, with the shift of its day as the
  /// training pulls of that day show it.
  double before = 0.0, after = 0.0;
  double noise = 0.0;  ///< standard deviation of its points [-]
};

/// @param conditions  at least one
Gap gap_of(const std::vector<HeldOut>& conditions, std::uint64_t seed);

}  // namespace heddle::discover
