#pragma once

#include <optional>
#include <vector>

#include "macroscale/thermal/thermal_spec.h"
#include "pipeline/case.h"
#include "pipeline/config_schema.h"
#include "pipeline/settings.h"

/// The block `thermal:` of a configuration: temperatures through the thickness of the blank.
namespace heddle::pipeline {

std::vector<Key> thermal_keys();

/// Nothing where the block is not there.
std::optional<macroscale::thermal::ThermalSpec> thermal_of(const Settings& settings);

/// Of the block itself, and what else in the file would count the film's cooling once more.
Problems check_thermal(const Case& a_case, const ReadConfig& config);

}  // namespace heddle::pipeline
