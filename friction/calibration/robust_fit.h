#pragma once

#include <Eigen/Core>
#include <functional>
#include <limits>
#include <vector>

#include "friction/least_squares.h"

namespace heddle::friction {

/// What a block of residuals r costs, with x = |r|/k: `none` |r|^2/2; `huber` linear beyond x = 1; `cauchy`
/// k^2/2 ln(1 + x^2), so that a block far off hardly counts.
enum class Loss { none, huber, cauchy };

/// Residuals that belong together: the readings of one sample, or one prior. The loss acts on their length.
struct ResidualBlock {
  Eigen::Index rows = 1;
  bool robust = false;  ///< false: always |r|^2/2, as for a prior
  /// Fills residuals (rows) and, unless null, jacobian (rows x variables), both already sized.
  /// @return false where they cannot be had: such a trial is rejected
  std::function<bool(const Eigen::VectorXd& x, Eigen::VectorXd& residuals, Eigen::MatrixXd* jacobian)>
      evaluate;
};

struct FitVariable {
  double start = 0.0;
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  double size = 1.0;  ///< > 0, by which the search scales it, so that its unit does not matter
};

struct RobustFitOptions {
  Loss loss = Loss::none;
  double loss_scale = 1.0;  ///< k, in the unit of the residuals
  int iterations_max = 300;
};

struct RobustFit {
  Eigen::VectorXd x;
  Eigen::VectorXd residuals;  ///< of all blocks in a row, without the loss
  Eigen::MatrixXd jacobian;   ///< d residual / d x, without the loss
  Eigen::VectorXd weights;    ///< rho' of each row's block: 1 without loss, towards 0 for what lies far off
  std::vector<bool> at_bound;
  LeastSquaresSummary summary;
};

/// Minimises the summed cost of all blocks between the bounds, by the trust region of Ceres 2.1 (which stays
/// in robust_fit.cpp) on one thread, then by a few Gauss-Newton steps: same input, same bits.
/// @param variables  start within the bounds
/// @return  where the residuals are not finite at the start: summary and x alone
RobustFit robust_fit(const std::vector<ResidualBlock>& blocks, const std::vector<FitVariable>& variables,
                     const RobustFitOptions& options = {});

/// rho'(s) of a block with s = |r|^2.
double loss_weight(Loss loss, double scale, double square);

}  // namespace heddle::friction
