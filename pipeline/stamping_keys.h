#pragma once

#include <vector>

#include "pipeline/config_schema.h"

/// Blocks of a configuration that say what is stamped, by what and how.
namespace heddle::pipeline {

std::vector<Key> process_keys();
/// Effects of the press: its frame, a punch off its axis, a binder out of level.
std::vector<Key> press_effect_keys();
std::vector<Key> blank_keys();
std::vector<Key> contact_keys();
std::vector<Key> tool_keys();  ///< punch, die and binder, by shape or from files

}  // namespace heddle::pipeline
