#include "friction/calibration/robust_fit.h"

#include <ceres/ceres.h>

#include <Eigen/QR>
#include <cmath>
#include <stdexcept>

namespace heddle::friction {

namespace {

/// One block, over all variables in units of their size.
class BlockCost : public ceres::CostFunction {
 public:
  BlockCost(const ResidualBlock& block, const Eigen::VectorXd& size) : block_(block), size_(size) {
    set_num_residuals(static_cast<int>(block.rows));
    mutable_parameter_block_sizes()->push_back(static_cast<int>(size.size()));
  }

  bool Evaluate(double const* const* scaled, double* residuals, double** jacobians) const override {
    const Eigen::VectorXd x = Eigen::Map<const Eigen::VectorXd>(scaled[0], size_.size()).cwiseProduct(size_);
    Eigen::VectorXd r(block_.rows);
    Eigen::MatrixXd slopes(block_.rows, size_.size());
    const bool slopes_wanted = jacobians != nullptr && jacobians[0] != nullptr;
    if (!block_.evaluate(x, r, slopes_wanted ? &slopes : nullptr) || !r.allFinite()) return false;
    Eigen::Map<Eigen::VectorXd>(residuals, block_.rows) = r;
    if (!slopes_wanted) return true;
    if (!slopes.allFinite()) return false;
    using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    Eigen::Map<RowMajor>(jacobians[0], block_.rows, size_.size()) = slopes * size_.asDiagonal();
    return true;
  }

 private:
  const ResidualBlock& block_;
  const Eigen::VectorXd& size_;
};

ceres::LossFunction* loss_function(Loss loss, double scale) {
  switch (loss) {
    case Loss::none:
      return nullptr;
    case Loss::huber:
      return new ceres::HuberLoss(scale);
    case Loss::cauchy:
      return new ceres::CauchyLoss(scale);
  }
  throw std::logic_error("no such loss");
}

ceres::Solver::Options solver_options(int iterations_max) {
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.num_threads = 1;
  options.max_num_iterations = iterations_max;
  options.logging_type = ceres::SILENT;
  options.function_tolerance = 1e-16;
  options.gradient_tolerance = 1e-13;
  options.parameter_tolerance = 1e-12;
  return options;
}

LeastSquaresSummary in_words(const ceres::Solver::Summary& summary) {
  LeastSquaresSummary words;
  words.converged = summary.termination_type == ceres::CONVERGENCE;
  words.iterations = static_cast<int>(summary.iterations.size());
  switch (summary.termination_type) {
    case ceres::CONVERGENCE:
      words.reason = "the next step changes nothing";
      break;
    case ceres::NO_CONVERGENCE:
      words.reason = "the number of iterations ran out";
      break;
    default:
      words.reason = "the search failed: " + summary.message;
  }
  return words;
}

/// Residuals and slopes of every block at the end of the search.
void evaluate_at_end(const std::vector<ResidualBlock>& blocks, const RobustFitOptions& options,
                     RobustFit& fit) {
  Eigen::Index rows = 0, at = 0;
  for (const ResidualBlock& block : blocks) rows += block.rows;
  fit.residuals.resize(rows);
  fit.jacobian.resize(rows, fit.x.size());
  fit.weights.resize(rows);
  for (const ResidualBlock& block : blocks) {
    Eigen::VectorXd r(block.rows);
    Eigen::MatrixXd slopes(block.rows, fit.x.size());
    block.evaluate(fit.x, r, &slopes);
    fit.residuals.segment(at, block.rows) = r;
    fit.jacobian.middleRows(at, block.rows) = slopes;
    fit.weights.segment(at, block.rows)
        .setConstant(block.robust ? loss_weight(options.loss, options.loss_scale, r.squaredNorm()) : 1.0);
    at += block.rows;
  }
}

}  // namespace

double loss_weight(Loss loss, double scale, double square) {
  const double x = std::sqrt(square) / scale;
  switch (loss) {
    case Loss::none:
      return 1.0;
    case Loss::huber:
      return x > 1.0 ? 1.0 / x : 1.0;
    case Loss::cauchy:
      return 1.0 / (1.0 + x * x);
  }
  throw std::logic_error("no such loss");
}

namespace {

/// Gradient of the cost in the variables that stand free, in units of their size.
Eigen::VectorXd gradient_of(const RobustFit& fit, const Eigen::VectorXd& size) {
  Eigen::VectorXd gradient =
      size.cwiseProduct(fit.jacobian.transpose() * fit.weights.cwiseProduct(fit.residuals));
  for (Eigen::Index k = 0; k < gradient.size(); ++k)
    if (fit.at_bound[static_cast<std::size_t>(k)]) gradient[k] = 0.0;
  return gradient;
}

/// The cost is flat at its minimum, so a search by cost ends within the root of the rounding of it. Its slope
/// is not flat: Gauss-Newton steps as long as they halve it.
void polish(const std::vector<ResidualBlock>& blocks, const std::vector<FitVariable>& variables,
            const RobustFitOptions& options, const Eigen::VectorXd& size, RobustFit& fit) {
  for (int round = 0; round < 10; ++round) {
    const Eigen::VectorXd gradient = gradient_of(fit, size);
    Eigen::MatrixXd rows = fit.weights.cwiseSqrt().asDiagonal() * fit.jacobian * size.asDiagonal();
    for (Eigen::Index k = 0; k < rows.cols(); ++k)
      if (fit.at_bound[static_cast<std::size_t>(k)]) rows.col(k).setZero();
    const Eigen::VectorXd step =
        -rows.completeOrthogonalDecomposition().solve(fit.weights.cwiseSqrt().cwiseProduct(fit.residuals));
    RobustFit next = fit;
    next.x += size.cwiseProduct(step);
    for (Eigen::Index k = 0; k < next.x.size(); ++k) {
      const FitVariable& variable = variables[static_cast<std::size_t>(k)];
      if (!(next.x[k] >= variable.low && next.x[k] <= variable.high)) return;
    }
    evaluate_at_end(blocks, options, next);
    if (!next.residuals.allFinite() || !(gradient_of(next, size).norm() < 0.5 * gradient.norm())) return;
    fit = std::move(next);
  }
}

/// Ceres would say so on standard error.
bool can_start(const std::vector<ResidualBlock>& blocks, const Eigen::VectorXd& x) {
  for (const ResidualBlock& block : blocks) {
    Eigen::VectorXd r(block.rows);
    Eigen::MatrixXd slopes(block.rows, x.size());
    if (!block.evaluate(x, r, &slopes) || !r.allFinite() || !slopes.allFinite()) return false;
  }
  return true;
}

}  // namespace

RobustFit robust_fit(const std::vector<ResidualBlock>& blocks, const std::vector<FitVariable>& variables,
                     const RobustFitOptions& options) {
  const auto count = static_cast<Eigen::Index>(variables.size());
  Eigen::VectorXd size(count), scaled(count);
  for (Eigen::Index k = 0; k < count; ++k) {
    size[k] = variables[static_cast<std::size_t>(k)].size;
    scaled[k] = variables[static_cast<std::size_t>(k)].start / size[k];
  }
  RobustFit fit;
  if (!can_start(blocks, scaled.cwiseProduct(size))) {
    fit.summary.reason = "the residuals are not finite at the starting values";
    fit.x = scaled.cwiseProduct(size);
    fit.at_bound.assign(variables.size(), false);
    return fit;
  }
  ceres::Problem problem;
  problem.AddParameterBlock(scaled.data(), static_cast<int>(count));
  for (const ResidualBlock& block : blocks)
    problem.AddResidualBlock(new BlockCost(block, size),
                             block.robust ? loss_function(options.loss, options.loss_scale) : nullptr,
                             scaled.data());
  for (Eigen::Index k = 0; k < count; ++k) {
    const FitVariable& variable = variables[static_cast<std::size_t>(k)];
    if (std::isfinite(variable.low))
      problem.SetParameterLowerBound(scaled.data(), static_cast<int>(k), variable.low / size[k]);
    if (std::isfinite(variable.high))
      problem.SetParameterUpperBound(scaled.data(), static_cast<int>(k), variable.high / size[k]);
  }
  ceres::Solver::Summary summary;
  ceres::Solve(solver_options(options.iterations_max), &problem, &summary);

  fit.x = scaled.cwiseProduct(size);
  fit.summary = in_words(summary);
  for (Eigen::Index k = 0; k < count; ++k) {
    const FitVariable& variable = variables[static_cast<std::size_t>(k)];
    const double near = 1e-9 * size[k];
    fit.at_bound.push_back(fit.x[k] <= variable.low + near || fit.x[k] >= variable.high - near);
  }
  evaluate_at_end(blocks, options, fit);
  if (fit.summary.converged) polish(blocks, variables, options, size, fit);
  return fit;
}

}  // namespace heddle::friction
