#pragma once

#include <string>
#include <vector>

#include "page.h"

namespace heddle::blind {

/// Every case with truth and answer as CSV, to look into where the two part: campaign, seed, case, kind,
/// truth, size of the first effect (of the force), answer, right, candidate set, first of the ranking with
/// its probability, held-out errors.
std::string case_list(const std::vector<Scored>& campaigns);

}  // namespace heddle::blind
