#pragma once

#include <string>
#include <vector>

#include "pipeline/report.h"

namespace heddle::pipeline {

/// The section on the temperatures of the blank; empty where the run had one temperature.
std::string heat_section(const ReportInput& input);
/// What they say, in words.
std::vector<Verdict> heat_verdicts(const macroscale::HeatSummary& heat);

}  // namespace heddle::pipeline
