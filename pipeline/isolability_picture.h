#pragma once

#include "pipeline/discover/isolability.h"
#include "pipeline/painter.h"

namespace heddle::pipeline {

/// Who is taken for whom: one row a truth, one column a rival, as dark as the two are close. Figures are the
/// swap rate in percent where it is 2 or more. Effects that are not seen are written faint.
Canvas draw(const discover::ForwardModel& forward, const discover::Isolability& isolability);

}  // namespace heddle::pipeline
