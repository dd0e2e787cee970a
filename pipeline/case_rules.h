#pragma once

#include <set>
#include <string>
#include <vector>

#include "pipeline/case.h"

namespace heddle::pipeline {

/// Every rule that the rooms and the pipeline know between keys, on a case whose keys without a value hold
/// their defaults. Rules that look at one of those are left out.
Problems check_between_keys(const Case& a_case, const ReadConfig& config);

/// Whether one of these blocks, or a key below it, has no value.
bool any_below(const std::set<std::string>& failed, const std::vector<std::string>& blocks);

/// Puts problems behind others.
void append(Problems& problems, Problems more);

}  // namespace heddle::pipeline
