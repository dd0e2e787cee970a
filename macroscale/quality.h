#pragma once

#include "macroscale/stamping.h"
#include "macroscale/system.h"

namespace heddle::macroscale {

/// Fields of the blank for pictures and files. `step` (may be null) gives pressure, slip and friction.
BlankState blank_state(const System& system, const State& state, const StepData* step);

/// Mean engineering strain of the tow segments that meet at each node, {warp, weft}.
std::vector<std::array<double, 2>> nodal_tow_strain(const Blank& blank, const State& state);

/// Largest motion of a point of the blank's edge along the inward normal of the flat edge [m].
double largest_draw_in(const Blank& blank, const State& state);

/// What the cumulative columns of a row leave over: work - stored - dissipated [J].
double ledger_residual(const HistoryRow& row);

/// Largest |cumulative residual| over max(cumulative punch work, 1 % of its final value), each row's own
/// columns.
double energy_residual_max(const std::vector<HistoryRow>& history);

/// True where the friction law falls with slip speed at a loaded, sliding point.
bool on_falling_branch(const System& system, const StepData& step, const State& end);

/// Largest contact pressure of any node on any tool [Pa].
double largest_pressure(const System& system, const StepData& step, const State& end);

/// Fills result.summary from the history and the end state.
void summarise(StampingResult& result, const Blank& blank, const State& state, double peak_force_balance);

}  // namespace heddle::macroscale
