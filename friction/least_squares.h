#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>

namespace heddle::friction {

struct LeastSquaresOptions {
  int iterations_max = 100;
  /// Stop when the next step changes the residuals by less than this (norm). Residuals here are relative
  /// force errors, so 1e-12 is far below any measurement and still above rounding.
  double tolerance = 1e-12;
};

/// How the search ended. Not converging is a result.
struct LeastSquaresSummary {
  bool converged = false;
  std::string reason;  ///< why it stopped, in words
  int iterations = 0;
};

struct LeastSquaresResult {
  Eigen::VectorXd parameters;
  Eigen::VectorXd residuals;
  Eigen::MatrixXd jacobian;  ///< d residual / d parameter, one row a residual
  LeastSquaresSummary summary;
};

/// Fills residuals and Jacobian, already sized, at the given parameters. May leave values that are not
/// finite: such a trial is rejected.
using ResidualFunction = std::function<void(const Eigen::VectorXd& parameters, Eigen::VectorXd& residuals,
                                            Eigen::MatrixXd& jacobian)>;

/// Minimises the sum of squares by Gauss-Newton steps, damped after Levenberg and Marquardt while they fail.
/// Parameters are scaled by their columns, so their units do not matter.
/// @param start  finite residuals are needed here
LeastSquaresResult minimise_squares(const ResidualFunction& function, const Eigen::VectorXd& start,
                                    Eigen::Index residual_count, const LeastSquaresOptions& options = {});

}  // namespace heddle::friction
