#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/problem.h"
#include "pipeline/config_tree.h"
#include "pipeline/settings.h"

namespace heddle::pipeline {

/// Reads the value of one key; adds what is wrong with it.
/// @param folder  of the configuration: file keys are relative to it
/// @return whether `setting` now holds a value
bool read_value(const Key& key, const ConfigNode& node, const std::filesystem::path& folder, Setting& setting,
                Problems& problems);

/// The word nearest to `word`, or "" if none is near enough to be what was meant.
std::string nearest(const std::string& word, const std::vector<std::string>& words);

/// What was written, on one line.
std::string flow_text(const ConfigNode& node);

/// "tow_width" of "weave.tow_width"
std::string last_name(const std::string& path);

}  // namespace heddle::pipeline
