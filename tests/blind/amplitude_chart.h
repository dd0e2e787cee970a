#pragma once

#include <string>
#include <vector>

#include "score.h"

namespace heddle::blind {

/// Top-1 rate and candidate set against the amplitude of the hidden effect, with the 95 % interval of the
/// first.
/// @return SVG
std::string amplitude_chart(const std::vector<Judged>& cases);

}  // namespace heddle::blind
