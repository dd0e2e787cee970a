#pragma once

#include "macroscale/checkpoint.h"
#include "macroscale/stamping.h"
#include "macroscale/system.h"

namespace heddle::macroscale {

/// What the plies do to each other, at the nodes.
void add_ply_fields(const System& system, const State& state, const StepData* step, BlankState& blank);

/// What held pairs leave out: sum of sizes over the punch's work [-].
double pairing_share(const StampingCheckpoint& at);

/// Numbers of each ply and between them.
StackSummary stack_summary(const Blank& blank, const StampingCheckpoint& at);

}  // namespace heddle::macroscale
