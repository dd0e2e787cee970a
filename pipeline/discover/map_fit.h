#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <array>
#include <memory>
#include <vector>

#include "pipeline/discover/hypothesis.h"

namespace heddle::discover {

/// Observations with the square root of their covariance, taken once.
class Whitened {
 public:
  /// @throws NumericalError  if the covariance is not positive definite
  Whitened(const Eigen::VectorXd& value, const Eigen::MatrixXd& covariance);
  Eigen::Index size() const { return value_.size(); }
  /// L^-1 (predicted - measured) with the covariance L L^T.
  Eigen::VectorXd residual(const Eigen::VectorXd& predicted) const;
  /// L^-1 of columns of changes.
  Eigen::MatrixXd operator()(const Eigen::MatrixXd& columns) const;
  /// L of whitened columns.
  Eigen::MatrixXd unwhitened(const Eigen::MatrixXd& columns) const;
  Eigen::MatrixXd covariance() const;
  double log_determinant() const;  ///< of the covariance
  const Eigen::VectorXd& value() const { return value_; }

 private:
  Eigen::VectorXd value_;
  Eigen::LLT<Eigen::MatrixXd> root_;
};

/// The most probable numbers of one hypothesis, and how much the data speak for it.
struct MapFit {
  Hypothesis hypothesis;
  std::shared_ptr<const Whitened> data;  ///< with the form error of the hypothesis' own effects
  Eigen::VectorXd z;           ///< coordinates: the free numbers of the baseline, then of each effect
  Trial trial;                 ///< the same as values
  Eigen::VectorXd residual;    ///< whitened, of the observations alone
  Eigen::MatrixXd jacobian;    ///< d residual / d z
  Eigen::MatrixXd covariance;  ///< of z, Laplace
  double chi2 = 0.0;           ///< |residual|^2
  /// ln of the evidence: Int exp(-|residual|^2/2)/sqrt(det C) prior(z) dz; Laplace's approximation, with each
  /// coordinate's mass between its bounds.
  double log_evidence = 0.0;
  double form_share = 0.0;  ///< of Observations::form that `data` allows its effects
  bool converged = false;
  int evaluations = 0;  ///< predictions asked for
};

/// Numbers of a hypothesis that are free, in the order of MapFit::z.
std::vector<const Unknown*> free_numbers(const ForwardModel& model, const Hypothesis& hypothesis);
Trial trial_at(const ForwardModel& model, const Hypothesis& hypothesis, const Eigen::VectorXd& z);

struct FitOptions {
  int iterations_max = 40;
  double tolerance = 0.01;  ///< of the expected gain in -ln posterior at which a search stops
  double step = 1e-4;       ///< of z in a difference
};

/// Gauss-Newton within the bounds, damped after Levenberg and Marquardt, on residuals and prior together.
/// @param start  of z; where the prediction is not finite there, `converged` is false and the evidence -inf
MapFit map_fit(const ForwardModel& model, std::shared_ptr<const Whitened> data, const Hypothesis& hypothesis,
               const Eigen::VectorXd& start, const FitOptions& options = {});

/// The best of several starts, forms taken as exact.
MapFit best_fit(const ForwardModel& model, const std::shared_ptr<const Whitened>& data,
                const Hypothesis& hypothesis, const std::vector<Eigen::VectorXd>& starts,
                const FitOptions& options = {});

/// How far the form of an effect may be off over each coordinate, as share of the variance allowed: 1 for the
/// one it depends on most, 0 for those it hardly sees. An effect that does not see the tool temperature may
/// not be wrong over it either. Designs are not balanced, so 3 % of the strongest dependence count as none.
/// @param effect  what it does to the observations
std::vector<double> form_weights(const Eigen::VectorXd& effect,
                                 const std::vector<FormCoordinate>& coordinates);

/// Covariance of the error of an effect's form, a share `form` of what it does: over each coordinate, and
/// over each pair of them together.
Eigen::MatrixXd form_covariance(const Eigen::VectorXd& effect, const std::vector<FormCoordinate>& coordinates,
                                double form);

/// The same of all effects of a trial, each a share Observations::form of what it does.
Eigen::MatrixXd form_covariance_of(const ForwardModel& model, const Observations& observations,
                                   const Trial& trial);

/// How far forms are off is not known either: these shares of Observations::form are as probable as each
/// other. A name that fits needs none of it, a poor one pays for it.
inline constexpr std::array form_shares{0.25, 0.5, 1.0, 2.0};

/// Once more with the covariance of the error that the forms of the effects have at a fit, at the share of it
/// that fits best; the evidence is the mean over all shares. What different names are compared by.
MapFit with_form_error(const ForwardModel& model, const Observations& observations, const MapFit& fit,
                       const FitOptions& options = {});

}  // namespace heddle::discover
