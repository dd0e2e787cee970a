#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "answer.h"
#include "plan.h"
#include "statistics.h"

namespace heddle::blind {

/// A case with its truth and its answer.
struct Judged {
  PlannedCase planned;
  std::vector<blindgen::Hidden> truth;
  std::optional<Answer> answer =
      {};                    ///< nothing: no report, or none that can be read. Counts as wrong everywhere
  std::string failure = {};  ///< why there is no answer
  double wall_time = 0, cpu_time = 0;  ///< [s]
};

/// What came out of the cases of one setting (design, scatter, amplitude).
struct Scores {
  int cases = 0, failed = 0;
  // one effect
  Rate top1;                    ///< named alone and right, or first of a ONE_OF
  Rate named_alone;             ///< named alone and right
  Rate first_ranked;            ///< first single effect of the ranking, whatever the verdict
  Rate candidate_set;           ///< set holds the truth
  Rate precision;               ///< right, of single names given with P >= 0.9
  Rate improved;                ///< held-out error smaller after, of unsaturated names
  std::vector<double> shrinks;  ///< of the same
  std::vector<double> set_sizes;
  std::map<std::string, Rate> top1_of;  ///< by effect
  std::map<std::string, std::vector<double>> size_of;
  std::vector<Forecast> forecasts;  ///< of the first of the ranking, effect or set
  // nothing hidden
  Rate null_named, null_exact_named;  ///< a name or a set of names
  Rate null_name;                     ///< a name, not a set
  Rate null_gap;                      ///< any verdict but NO_GAP
  // two effects
  Rate pair_exact;  ///< named, or the most probable set of a ONE_OF, as top1 of one effect
  Rate pair_named;  ///< named
  Rate pair_one, pair_false;
  // not in the library
  Rate outside_clean;    ///< NAMED
  Rate outside_unknown;  ///< UNKNOWN, or a name with a remainder
  Rate outside_set;      ///< ONE_OF
  Rate outside_unseen;   ///< NO_GAP
  // the rig's own faults
  Rate rig_physics;    ///< called an effect of friction
  Rate rig_named;      ///< by its right name
  Rate any_precision;  ///< right, of single names given with P >= 0.9, over cases of every kind
  std::map<std::string, std::map<std::string, int>> confusion;  ///< truth -> answer -> cases
  std::vector<double> wall_times, cpu_times;                    ///< [s], one a case
  std::vector<const Judged*> failures;                          ///< every case that went wrong, in order
};

Scores score(std::span<const Judged> cases);

/// "static_peak+wear", "nothing"
std::string truth_name(const Judged& judged);
/// "wear", "wear*" if incomplete, "ONE_OF", "UNKNOWN", "NO_GAP", "no report"
std::string answer_name(const Judged& judged);
/// Whether the case counts as a success of its kind.
bool went_well(const Judged& judged);

/// Effects of the rig in the list of ids: not friction's.
bool is_rig_effect(const std::string& id);

/// One line of what must hold.
struct Requirement {
  std::string what;
  std::string value;          ///< as printed
  std::string bound;          ///< the bound that counts, and its limit
  std::optional<bool> holds;  ///< nothing: no case of that kind
};

/// The coupon rows of what must hold. Rates count by the bound of their 95 % interval.
std::vector<Requirement> requirements(const Scores& scores);

}  // namespace heddle::blind
