#pragma once

#include <map>
#include <string>
#include <vector>

#include "score.h"
#include "store.h"

namespace heddle::blind {

/// A campaign that has been scored.
struct Scored {
  Manifest manifest;
  std::vector<Judged> cases;
};

/// What cases have in common apart from what is hidden in them.
struct Setting {
  blindgen::Design design{};
  double sample_scatter = 0, day_scatter = 0, amplitude = 0;
  FollowUp follow_up = FollowUp::none;
  std::size_t ablation = 0;
  auto operator<=>(const Setting&) const = default;
};

Setting setting_of(const PlannedCase& planned);

using Settings = std::map<Setting, std::vector<Judged>>;
Settings by_setting(const std::vector<Judged>& cases);

/// Where the page looks for the picture of the amplitudes campaign, beside itself.
constexpr const char* amplitude_picture = "pictures/blind-amplitudes.svg";

/// docs/blind.md: every figure, every failure, and the commands that made them.
/// @param others  pages of other campaigns beside this one, without .md, to link to
std::string page(const std::vector<Scored>& campaigns, const std::vector<std::string>& others = {});

/// The figures of one campaign for a terminal.
std::string summary(const Scored& campaign);

}  // namespace heddle::blind
