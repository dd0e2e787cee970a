#pragma once

#include <nlohmann/json_fwd.hpp>

#include "pipeline/discover/isolability.h"

namespace heddle::pipeline {

/// {"effects": [ids], "lambda": rows {truth, rival}, "swap_rate": Phi(-sqrt(lambda)/2), "groups": [[ids]],
/// "not_seen": [ids], "right_names": mean rate, "name_rate": {id: rate}}.
nlohmann::ordered_json isolability_json(const discover::ForwardModel& forward,
                                        const discover::Isolability& isolability);

/// [{"id", "parameter", "amplitude": 3 standard deviations or null, "unit", "usual", "seen"}].
nlohmann::ordered_json detectable_json(const discover::ForwardModel& forward,
                                       const discover::Isolability& isolability);

}  // namespace heddle::pipeline
