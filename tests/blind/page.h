#pragma once

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
  auto operator<=>(const Setting&) const = default;
};

Setting setting_of(const PlannedCase& planned);

/// Where the page looks for the picture of the amplitudes campaign, beside itself.
constexpr const char* amplitude_picture = "pictures/blind-amplitudes.svg";

/// docs/blind.md: every figure, every failure, and the commands that made them.
std::string page(const std::vector<Scored>& campaigns);

/// The figures of one campaign for a terminal.
std::string summary(const Scored& campaign);

/// Columns of docs/blind.csv, and the line that a run appends.
std::string record_header();
std::string record_line(const Scored& campaign, const std::string& date);

}  // namespace heddle::blind
