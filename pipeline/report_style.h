#pragma once

#include <string>

namespace heddle::pipeline {

/// CSS of a report page and of the pictures in it: light, dark, narrow screens and paper.
std::string report_style();

}  // namespace heddle::pipeline
