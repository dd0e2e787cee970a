#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace heddle::pipeline {

/// A record as the text of its file: a line for each key of an object, a list of numbers on one line, numbers
/// in the shortest form that reads back as the same double.
/// @throws OutputError  naming a number that is not finite
std::string json_text(const nlohmann::ordered_json& root);

}  // namespace heddle::pipeline
