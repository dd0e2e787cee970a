#pragma once

#include <nlohmann/json_fwd.hpp>

#include "pipeline/discover/isolability.h"
#include "pipeline/discover/propose.h"

namespace heddle::pipeline {

/// {"effects": [ids], "lambda": rows {truth, rival}, "swap_rate": Phi(-sqrt(lambda)/2), "groups": [[ids]],
/// "not_seen": [ids], "right_names": mean rate, "name_rate": {id: rate}}.
nlohmann::ordered_json isolability_json(const discover::ForwardModel& forward,
                                        const discover::Isolability& isolability);

/// [{"id", "parameter", "amplitude": 3 standard deviations or null, "unit", "usual", "seen"}].
nlohmann::ordered_json detectable_json(const discover::ForwardModel& forward,
                                       const discover::Isolability& isolability);

/// [{conditions in the columns' units, "replicates", "expected_right", "expected_gain", "separates":
/// [[names]]}].
nlohmann::ordered_json next_experiments_json(const discover::Proposal& proposal);

/// {"rivals": [{"name", "probability"}], "right_before", "right_after", "not_separable": [[names]]}.
nlohmann::ordered_json proposal_json(const discover::Proposal& proposal);

}  // namespace heddle::pipeline
