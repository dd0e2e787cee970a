#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "blindgen/design.h"

namespace heddle::blind {

struct Weighted {
  std::string id;
  double probability = 0;  ///< as stated, 0..1
};

/// What a report says, as far as it is scored.
struct Answer {
  std::string verdict;  ///< NO_GAP, NAMED, ONE_OF, NAMED_INCOMPLETE or UNKNOWN
  std::vector<Weighted> named = {};
  std::vector<std::string> candidates = {};
  std::vector<Weighted> ranking = {};  ///< of effects, and of sets as "a+b", best first
  std::optional<double> held_out_before = {}, held_out_after = {}, shrink = {};
  bool saturated = false;  ///< no shrink is claimed
  std::vector<blindgen::Condition> next_experiments = {};

  /// A name is given, alone or with a remainder.
  bool gives_name() const { return verdict == "NAMED" || verdict == "NAMED_INCOMPLETE"; }
};

/// @param report  text of report.json
/// @throws std::runtime_error  the text is no report: says what is missing or out of range
Answer read_answer(std::string_view report);

}  // namespace heddle::blind
