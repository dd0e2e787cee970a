#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "pipeline/case.h"
#include "pipeline/commands.h"
#include "pipeline/discover/design_exchange.h"
#include "pipeline/discover_plan_design.h"

namespace heddle::pipeline {

/// One design with what it can tell.
struct JudgedDesign {
  std::vector<discover::CouponCell> cells;
  discover::ForwardModel forward;
  discover::CouponNoise noise;
  discover::Isolability isolability;
};

/// A campaign as somebody planned it, and a better one at the same cost.
struct PlanRecord {
  std::string name;         ///< of the case
  std::string design_file;  ///< its name, without the folder
  int seed = 1;
  JudgedDesign given, proposed;
  discover::Exchange exchange;
  bool keeps_given = false;  ///< no exchange made the expected rate of right names better
  std::vector<std::string> notes;
};

/// What a planned campaign can tell apart, before anybody pulls a coupon.
/// @throws InputError  with every problem of case, design and effect files
PlanRecord plan_campaign_in(const Case& a_case, const std::filesystem::path& design,
                            const std::vector<std::filesystem::path>& own_effects = {});

/// discover/plan.json (docs/discover-plan.md lists its keys).
std::string plan_json(const PlanRecord& record);
/// discover/plan.html: the same for people.
std::string plan_html(const PlanRecord& record);

}  // namespace heddle::pipeline
