#pragma once

#include "macroscale/ledger.h"
#include "macroscale/stamping.h"
#include "macroscale/system.h"

namespace heddle::macroscale {

/// Adds one accepted step to the cumulative columns of a row; forces are those of the step.
void add_to_history(HistoryRow& row, const StepAccount& account, const Scene& scene);

/// Time, place and deformation at the end of a row's step.
void finish_row(HistoryRow& row, const BlankState& blank, const State& state, const System& system);
/// The same of the blank alone.
void measure_blank(HistoryRow& row, const BlankState& blank, const State& state, const Scene& scene);

}  // namespace heddle::macroscale
