#pragma once

#include <Eigen/Core>
#include <vector>

namespace heddle::friction {

/// Applies the square root of the inverse covariance sd^2 11^T + reading^2 I of the rows of one sample: they
/// share its gain, and each has its own reading. A sample of one row has its whole scatter in sd.
/// @param rows  residuals or their slopes, one row a reading; changed in place
/// @param sd, reading  > 0
void whiten(Eigen::Ref<Eigen::MatrixXd> rows, double sd, double reading);

/// What rows of unit variance say of the variables in their columns.
struct Uncertainty {
  Eigen::MatrixXd covariance;  ///< (rows^T rows)^-1 in the directions that the rows fix
  std::vector<bool> fixed;     ///< false: the variable takes part in a direction that nothing fixes
};
Uncertainty uncertainty_of(const Eigen::MatrixXd& rows);

/// Independent columns (to 1e-6), whatever their length.
Eigen::Index rank_of(const Eigen::MatrixXd& rows);

}  // namespace heddle::friction
