#pragma once

#include <cstdint>
#include <vector>

#include "pipeline/discover/coupon_campaign.h"

namespace heddle::discover {

/// Cells of a campaign, apart before anything is fitted.
struct Split {
  std::vector<std::size_t> training, held_out;  ///< indices of cells, rising
};

/// Holds whole conditions out, never rows: `share` of them, two of which lie at corners (most factors away
/// from the condition that is most repeated), and at least one away from that condition's level of each
/// factor. A condition that most days repeat stays in training, and so does one that alone has a level of
/// some factor, but where a factor has no other and levels on either side stay. Below eight conditions
/// nothing is held out.
Split split_conditions(const CouponCampaign& campaign, double share, std::uint64_t seed);

std::vector<CouponCell> pick(const std::vector<CouponCell>& cells, const std::vector<std::size_t>& indices);

}  // namespace heddle::discover
