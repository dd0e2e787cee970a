#pragma once

#include <string>

#include "pipeline/discover_command.h"

namespace heddle::pipeline {

/// discover/report.html: the verdict in a sentence, where the gap is, what it is called, the proof on
/// conditions that no fit saw, the doubts, and what to do next. Equal records give equal bytes.
std::string discover_html(const DiscoveryRecord& record);

}  // namespace heddle::pipeline
