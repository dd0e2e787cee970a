#pragma once

#include <string>

#include "page.h"

namespace heddle::blind {

/// Columns of docs/blind.csv, the history of all runs. `passes` has a letter for each row of what must hold,
/// in order: y, n, or - where there was no case.
std::string history_header();

/// The lines that a campaign adds, one for each of its settings.
/// @param date  of the commit that answered, YYYY-MM-DD
std::string history_lines(const Scored& campaign, const std::string& date);

}  // namespace heddle::blind
