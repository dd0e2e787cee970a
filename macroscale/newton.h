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
  bool stopped = false;                    ///< SolveOptions::stop said so
  FailureKind kind = FailureKind::search;  ///< where not converged
};

/// Newton's method with line search on the incremental potential at frozen friction loads, from x.
/// @param x          start, and where the search ended, whatever ended it
/// @param tolerance  largest nodal residual accepted [N]
/// @param summary    iterations are added, residual and worst unknown written
/// @throws NumericalError  if a residual is not finite; the message names the node
Pass minimise(System& system, const StepData& step, Eigen::VectorXd& x, const SolveOptions& options,
              double tolerance, StepSummary& summary);

/// Steps along the factors of the last iteration, as long as each halves the residual: a back-substitution
/// costs a fraction of a factorisation, and far below the tolerance the result no longer depends on the
/// iteration at which a search happened to end. (Slopes to small parameters are taken as differences of
/// runs.) For the end of a step: what comes before it is searched again.
/// @param x  where a search with at least one iteration converged
void polish(System& system, const StepData& step, Eigen::VectorXd& x, StepSummary& summary);

}  // namespace heddle::macroscale
