#include "friction/least_squares.h"

#include <Eigen/QR>
#include <cmath>

namespace heddle::friction {

namespace {

/// Step that minimises |r + J step|^2 + damping |D step|^2, D = column norms, by QR of the stacked system:
/// the normal equations would square the condition number.
Eigen::VectorXd damped_step(const LeastSquaresResult& at, double damping) {
  const Eigen::Index rows = at.jacobian.rows(), columns = at.jacobian.cols();
  const Eigen::VectorXd norms = at.jacobian.colwise().norm();
  Eigen::MatrixXd stacked = Eigen::MatrixXd::Zero(rows + columns, columns);
  stacked.topRows(rows) = at.jacobian;
  stacked.bottomRows(columns).diagonal() = std::sqrt(damping) * norms;
  Eigen::VectorXd right = Eigen::VectorXd::Zero(rows + columns);
  right.head(rows) = -at.residuals;
  return stacked.colPivHouseholderQr().solve(right);
}

LeastSquaresResult evaluate_at(const ResidualFunction& function, Eigen::VectorXd parameters,
                               Eigen::Index rows) {
  LeastSquaresResult result;
  result.residuals.resize(rows);
  result.jacobian.resize(rows, parameters.size());
  result.parameters = std::move(parameters);
  function(result.parameters, result.residuals, result.jacobian);
  return result;
}

/// Close to the minimum a good step gains less than rounding; without this allowance it would be called a
/// failure.
constexpr double rounding = 1.0 + 1e-13;

bool finite(const LeastSquaresResult& result) {
  return result.residuals.allFinite() && result.jacobian.allFinite();
}

}  // namespace

LeastSquaresResult minimise_squares(const ResidualFunction& function, const Eigen::VectorXd& start,
                                    Eigen::Index residual_count, const LeastSquaresOptions& options) {
  LeastSquaresResult best = evaluate_at(function, start, residual_count);
  LeastSquaresSummary summary;
  if (!finite(best)) {
    summary.reason = "the residuals are not finite at the starting values";
    best.summary = summary;
    return best;
  }

  double damping = 0.0;  // plain Gauss-Newton until a step fails
  for (; summary.iterations < options.iterations_max; ++summary.iterations) {
    const Eigen::VectorXd step = damped_step(best, damping);
    // A step shrunk by damping says nothing about convergence, an undamped one does.
    if (damping == 0.0 && (best.jacobian * step).norm() <= options.tolerance) {
      summary.converged = true;
      summary.reason = "the next step changes no residual";
      break;
    }
    LeastSquaresResult trial = evaluate_at(function, best.parameters + step, residual_count);
    if (finite(trial) && trial.residuals.squaredNorm() <= rounding * best.residuals.squaredNorm()) {
      best = std::move(trial);
      damping = damping > 1e-6 ? 0.1 * damping : 0.0;
    } else {
      damping = damping > 0.0 ? 10.0 * damping : 1e-3;
    }
  }
  if (!summary.converged) summary.reason = "the number of iterations ran out";
  best.summary = summary;
  return best;
}

}  // namespace heddle::friction
