#pragma once

#include "macroscale/scene.h"
#include "macroscale/solve.h"
#include "macroscale/stamping.h"

namespace heddle::macroscale {

struct Released {
  StepSummary summary;  ///< of the last step, with the iterations of all
  Release release;
  BlankState blank;  ///< as it came to rest
};

/// Takes punch and binder away at once and lets the blank come to rest on the die, by itself and with its
/// weight where the scene has one: steps that double in length, velocities taken out after each, up to some
/// 40 s in all.
/// @param row  the last of the run, whose cumulative columns go on
Released release_blank(const Scene& scene, const System& system, const State& state, HistoryRow row,
                       const SolveOptions& options);

}  // namespace heddle::macroscale
