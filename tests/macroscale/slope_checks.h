#pragma once

#include <catch2/catch.hpp>

#include <algorithm>
#include <random>

#include <Eigen/Core>

#include "macroscale/system.h"
#include "tests/derivative_check.h"
#include "tests/macroscale/matrix_product.h"

namespace heddle::test {

/// Adds to every entry a number between -size and size.
inline void shake(Eigen::VectorXd& x, double size, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-size, size);
  for (double& value : x) value += uniform(random);
}

/// Smallest relative gap between a tangent and central differences of a residual over three step sizes.
/// @param residual  at t along a direction
/// @param tangent   its slope there at t = 0
template <class Residual>
double tangent_gap(const Residual& residual, const Eigen::VectorXd& tangent) {
  double best = 1e300;
  for (const double t : {1e-6, 1e-7, 1e-8}) {
    const Eigen::VectorXd difference = (residual(t) - residual(-t)) / (2.0 * t);
    best = std::min(best, (difference - tangent).norm() / tangent.norm());
  }
  return best;
}

/// The exact matrix at x, times d.
inline Eigen::VectorXd tangent_of(macroscale::System& system, const macroscale::StepData& step,
                                  const Eigen::VectorXd& x, const Eigen::VectorXd& d) {
  system.assemble(step, x, macroscale::Filter::none);
  return multiply(system.solver().pattern(), system.solver().values(), d);
}

/// The residual is the slope of the incremental potential, the matrix that of the residual, at x along d; and
/// slopes that are one percent off would be seen.
inline void check_slopes(macroscale::System& system, const macroscale::StepData& step,
                         const Eigen::VectorXd& x, const Eigen::VectorXd& d) {
  const double slope = system.gradient(step, x).dot(d);
  const auto potential = [&](double t) {
    const Eigen::VectorXd y = x + t * d;
    return system.potential(step, y).total() + system.friction_difference(step, x, y);
  };
  CHECK(derivative_gap(potential, 0.0, 1e-4, slope) < 1e-6);
  CHECK(derivative_gap(potential, 0.0, 1e-4, 1.01 * slope) > 1e-4);
  const Eigen::VectorXd tangent = tangent_of(system, step, x, d);
  const auto residual = [&](double t) { return system.gradient(step, Eigen::VectorXd(x + t * d)); };
  CHECK(tangent_gap(residual, tangent) < 1e-6);
  CHECK(tangent_gap(residual, 1.01 * tangent) > 1e-3);
}

/// The same step where no pair meets: what pairs of plies or of parts of a sheet do is the difference.
inline macroscale::StepData without_pairs(const macroscale::StepData& step) {
  macroscale::StepData apart = step;
  for (macroscale::PlyPair& pair : apart.pairs) pair.quad = -1;
  for (macroscale::FrictionPoint& point : apart.friction.back()) point.load = 0.0;
  return apart;
}

/// check_slopes of the pairs by themselves: the whole could hide their faults behind stiff tows.
inline void check_slopes_of_pairs(macroscale::System& system, const macroscale::StepData& step,
                                  const Eigen::VectorXd& x, const Eigen::VectorXd& d) {
  const macroscale::StepData apart = without_pairs(step);
  const auto residual = [&](double t) -> Eigen::VectorXd {
    const Eigen::VectorXd y = x + t * d;
    return system.gradient(step, y) - system.gradient(apart, y);
  };
  const auto between = [&](double t) {
    const Eigen::VectorXd y = x + t * d;
    return system.potential(step, y).compaction_plies + system.friction_difference(step, x, y);
  };
  const double slope = residual(0.0).dot(d);
  CHECK(derivative_gap(between, 0.0, 1e-4, slope) < 1e-6);
  CHECK(derivative_gap(between, 0.0, 1e-4, 1.01 * slope) > 1e-3);
  const Eigen::VectorXd tangent = tangent_of(system, step, x, d) - tangent_of(system, apart, x, d);
  CHECK(tangent_gap(residual, tangent) < 1e-6);
  CHECK(tangent_gap(residual, 1.01 * tangent) > 1e-3);
}

}  // namespace heddle::test
