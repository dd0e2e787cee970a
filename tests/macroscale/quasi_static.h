#pragma once

#include <cmath>
#include <stdexcept>
#include <vector>

#include "tests/macroscale/steps.h"

namespace heddle::test {

/// Equilibria along a path in equal parts: steps of `dt`, at rest after each, so long that inertia does not
/// count (give `dt` far above the time a wave or a vibration takes).
/// @param before  called with the share of the path (0..1] before each step: sets loads
inline void run_at_rest(
    macroscale::System& system, macroscale::State& state, double dt, int steps,
    const std::function<void(double share)>& before,
    const std::function<void(double, Eigen::VectorXd&)>& prescribe = {},
    const std::function<void(const macroscale::StepData&, const macroscale::State&)>& look = {},
    const macroscale::SolveOptions& options = {}) {
  for (int k = 1; k <= steps; ++k) {
    if (before) before(static_cast<double>(k) / steps);
    run_steps(system, state, dt, 1, prescribe, look, options);
    state.v.setZero();
  }
}

/// Order p of e ~ h^p from two errors at spacings of ratio `ratio` (coarse over fine).
inline double observed_order(double coarse_error, double fine_error, double ratio = 2.0) {
  return std::log(std::abs(coarse_error / fine_error)) / std::log(ratio);
}

/// Value at h = 0 and order from values at h, h/2, h/4 (coarse first), by Richardson's extrapolation.
/// @throws std::runtime_error  where the differences do not shrink in one direction: no order to speak of
struct Extrapolation {
  double value, order;
};
inline Extrapolation extrapolate(const std::vector<double>& by_halves) {
  if (by_halves.size() != 3) throw std::invalid_argument("three values at h, h/2, h/4 are needed");
  const double first = by_halves[1] - by_halves[0], second = by_halves[2] - by_halves[1];
  if (!(first / second > 1.0)) throw std::runtime_error("differences do not shrink in one direction");
  return {by_halves[2] + second * second / (first - second), std::log2(first / second)};
}

}  // namespace heddle::test
