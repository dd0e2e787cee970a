#pragma once

#include "page.h"

namespace heddle::blind {

/// Reads every report of a campaign folder, then makes the truth again.
/// @throws std::runtime_error  a case has not been run yet, or a stored report has changed
Scored judge(const Store& store);

}  // namespace heddle::blind
