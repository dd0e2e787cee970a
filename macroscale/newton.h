#pragma once

#include <string>

#include <Eigen/Core>

#include "macroscale/solve.h"
#include "macroscale/system.h"

namespace heddle::macroscale {

/// How one search ended.
struct Pass {
  bool converged = false;
  std::string reason;
  bool stopped = false;  ///< SolveOptions::stop said so
};

/// Newton's method with line search on the incremental potential at frozen friction loads, from x.
/// @param x          start, and where the search ended, whatever ended it
/// @param tolerance  largest nodal residual accepted [N]
/// @param summary    iterations are added, residual and worst unknown written
/// @throws NumericalError  if a residual is not finite; the message names the node
Pass minimise(System& system, const StepData& step, Eigen::VectorXd& x, const SolveOptions& options,
              double tolerance, StepSummary& summary);

}  // namespace heddle::macroscale
