#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace heddle::pipeline {

/// JSON as the files of a run hold it: an object has a line for each key, a list of numbers stays on one
/// line, numbers are the shortest text that reads back.
/// @throws OutputError  naming a number that is not finite
std::string file_text(const nlohmann::ordered_json& root);

}  // namespace heddle::pipeline
