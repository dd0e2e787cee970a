#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "pipeline/discover/coupon_campaign.h"

namespace heddle::pipeline {

/// A campaign that somebody means to pull.
struct PlannedDesign {
  std::vector<discover::CouponCell> cells;  ///< without points
  std::vector<std::string> notes;           ///< what was assumed
};

/// What a design may leave open.
struct DesignDefaults {
  double dwell = 0.0;   ///< rest under load before the pull [s]
  int replicates = 5;   ///< of every condition (paper, section 2: five samples)
  int cells_a_day = 6;  ///< conditions that a rig pulls in a day; assumed
};

/// Reads a design: either factors that are varied one at a time (friction/test_design.h), or one row a
/// condition with velocity_mm_s, normal_force_N, tool_temperature_C, fabric_temperature_C and, if wanted,
/// condition_id, day_id, orientation_deg, dwell_s, replicates. Without day_id the conditions are pulled in
/// turn over as many days as they need, so that no factor goes with the day.
/// @throws InputError  with every problem and its line
PlannedDesign parse_design(std::string_view text, const std::string& file, const DesignDefaults& defaults);
PlannedDesign read_design(const std::filesystem::path& file, const DesignDefaults& defaults);

/// The second layout, for the lab: one row a condition in the columns of a coupon table.
std::string design_csv(const std::vector<discover::CouponCell>& cells);

}  // namespace heddle::pipeline
