#pragma once

#include <string>

namespace heddle::pipeline {

/// docs/reference/config.md: every key of the schema, as `heddle check --reference` prints it.
std::string config_reference();

}  // namespace heddle::pipeline
