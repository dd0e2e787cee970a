#pragma once

#include "macroscale/scene.h"
#include "macroscale/solve.h"

namespace heddle::macroscale {

/// Rest under the binder force before the punch moves: without friction and weight of the fabric, the nodes
/// held in their plane. Takes no time: the clock stands at 0 after it.
/// @param scene  of the system; its supports change while this runs
/// @param state  in: tools and blank where their shapes say; out: at rest
StepSummary close_binder(Scene& scene, System& system, const SolveOptions& options, State& state,
                         StepData& step);

/// Then rest under the weight of the fabric: held in its plane where the binder presses it on the die, free
/// and without friction elsewhere. Takes no time either.
StepSummary settle(Scene& scene, System& system, const SolveOptions& options, State& state, StepData& step);

/// Weight of the fabric over its nodes, per unknown, downwards [N]; true mass, whatever mass_scaling says.
std::vector<double> weight_of_fabric(const Scene& scene);
/// Its mean over the nodes [N].
double mean_weight(const Scene& scene);

}  // namespace heddle::macroscale
