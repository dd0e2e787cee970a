#pragma once

#include <functional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "macroscale/system.h"

namespace heddle::macroscale {

struct SolveOptions {
  double force_tolerance = 1e-3;     ///< largest nodal residual accepted [N]
  double relative_tolerance = 1e-3;  ///< of the mean nodal contact force; the larger of the two holds
  double first_pass_factor = 30.0;   ///< looser tolerance while friction loads are still to be updated
  double largest_increment = 2e-3;   ///< of any unknown in one Newton iteration [m]; tool bands reach past it
  double stagnation = 1e-9;          ///< an increment this small is progress no more [m]
  double lag_tolerance = 0.01;       ///< change of all friction force by one more update, relative
  double lag_limit = 0.05;           ///< a step whose friction still moves by more than this is rejected
  bool frictionless = false;         ///< friction off for this step
  int newton_limit = 200;            ///< iterations a pass; slip that sets in as a front takes one a node
  int lag_limit_iterations = 16;     ///< updates of the friction loads a step
  int line_search_limit = 30;
  bool may_cross = false;           ///< a step that takes one part of the sheet through another is accepted
  std::function<bool()> stop = {};  ///< asked before each Newton iteration; true ends the step (empty: never)
};

/// How one time step ended. Not converging is a result; a value that is not finite throws NumericalError.
struct StepSummary {
  bool converged = false;
  bool stopped = false;                    ///< SolveOptions::stop said so
  std::string reason;                      ///< "converged", or what went wrong in words
  FailureKind kind = FailureKind::search;  ///< of what went wrong
  int newton_iterations = 0;
  int factorisations = 0;  ///< those of matrices that turned out indefinite included
  int lag_iterations = 0;
  double residual = 0.0;  ///< largest nodal residual at the end [N]
  double lag_residual = 0.0;
  /// Contact came and went with each update of the friction loads (a film that drags at the first touch): the
  /// loads stand at the mean of that, and lag_residual says what share of friction swings about it.
  bool swings = false;
  std::string worst;  ///< unknown with the largest residual, by name
};

/// One time step from `state`: lag loop around projected Newton with line search.
/// @param prescribe  writes the prescribed positions of held unknowns into x (end of step); may be empty
/// @param tool_z   end positions of fixed and driven tools [m]
/// @param end      state at the end of the step, written only when converged
/// @param step     what was held (frozen friction loads of the last pass), for the ledger; step.iterate is
/// where the
///                 search ended, whatever ended it, NumericalError included
StepSummary advance(System& system, const State& state, double dt, const std::vector<double>& tool_z,
                    const std::function<void(double time, Eigen::VectorXd& x)>& prescribe,
                    const SolveOptions& options, State& end, StepData& step);

/// The blank at step.iterate, without a new memory of contact: what a step that failed looked like in the
/// end.
State state_at_iterate(const System& system, const StepData& step);

/// Trellis angle of each corner of a blank whose nodes stand as the state says, 4 a quad [rad].
std::vector<double> corner_angles(const Blank& blank, const State& state);

/// Name of an unknown: "node 12", or "binder (tool 2)" for those behind the nodes.
std::string name_of(const System& system, int unknown);
/// Of a contact point: "node 12", or "cell 7" where contact is at Gauss points.
std::string name_of_contact(const System& system, int point);

}  // namespace heddle::macroscale
