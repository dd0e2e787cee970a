#pragma once

#include <functional>
#include <stdexcept>
#include <vector>

#include "macroscale/ledger.h"
#include "macroscale/solve.h"

namespace heddle::test {

/// Runs equal steps from a state; calls `look` after each. Throws when a step does not converge.
inline void run_steps(
    macroscale::System& system, macroscale::State& state, double dt, int steps,
    const std::function<void(double, Eigen::VectorXd&)>& prescribe,
    const std::function<void(const macroscale::StepData&, const macroscale::State&)>& look = {},
    const macroscale::SolveOptions& options = {}) {
  for (int k = 0; k < steps; ++k) {
    macroscale::State end;
    macroscale::StepData step;
    const auto summary = macroscale::advance(system, state, dt, state.tool_z, prescribe, options, end, step);
    if (!summary.converged) throw std::runtime_error("step " + std::to_string(k) + ": " + summary.reason);
    if (look) look(step, end);
    state = std::move(end);
  }
}

}  // namespace heddle::test
