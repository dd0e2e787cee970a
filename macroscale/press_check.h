#pragma once

#include "core/problem.h"
#include "macroscale/stamping.h"

namespace heddle::macroscale {

/// What a press can be asked for, by numbers alone: offsets, bottoms, gaps.
Problems check_press(const StampingSpec& spec);

}  // namespace heddle::macroscale
