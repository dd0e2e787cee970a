#pragma once

#include <filesystem>

#include "pipeline/case.h"

namespace heddle::pipeline {

/// The rooms' specifications out of the settings of a file. A key that could not be read leaves the default
/// of its struct: the case is not used then, only looked through for more problems.
/// @param folder  against which file keys are resolved
Case case_of(const ReadConfig& config, const std::filesystem::path& folder);

/// Reads the table of the punch's motion, if there is one, into stroke, time and profile.
/// @return the problems of the table
Problems read_punch_motion(Case& a_case, const std::filesystem::path& folder);
/// Reads the drawing of a blank, if it is one, into its polygon.
/// @return the problems of the drawing
Problems read_drawing(Case& a_case, const std::filesystem::path& folder);

/// Whether the slope of effect tool_temperature_shift is written as `fitted`.
bool slope_is_fitted(const Settings& settings);

}  // namespace heddle::pipeline
