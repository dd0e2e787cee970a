#pragma once

#include <vector>

#include "pipeline/discover/discovery.h"
#include "pipeline/discover/isolability.h"

namespace heddle::discover {

/// A campaign before anybody pulled a coupon: what decides how much it can tell.
struct PlannedCampaign {
  std::vector<CouponCell> cells;
  CouponNoise noise;
  ForwardModel forward;
  Observations observations;  ///< with the forces that the baseline predicts
  MapFit baseline;
};

/// Slips at which a pull will be read, in the middle of stretches that are even in their logarithm.
/// @param pull_length  of the rig [m]
std::vector<double> planned_slips(int stretches, double pull_length);

/// @param cells  conditions, days and numbers of samples; their points are made here
/// @param days   how many there are; 0: as the cells say
/// @throws NumericalError  if the baseline has no finite force
PlannedCampaign planned_campaign(const CouponQuestion& question, std::vector<CouponCell> cells, int stretches,
                                 std::size_t days = 0);

/// What a planned campaign can tell apart.
Isolability isolability_of(const CouponQuestion& question, const PlannedCampaign& campaign);

}  // namespace heddle::discover
