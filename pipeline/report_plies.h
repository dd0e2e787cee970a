#pragma once

#include <string>

#include "pipeline/report.h"

namespace heddle::pipeline {

/// Numbers of each ply and what they do to each other, and every ply from above; empty for one ply.
std::string plies_section(const ReportInput& input);

}  // namespace heddle::pipeline
