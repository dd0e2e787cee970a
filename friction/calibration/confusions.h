#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "friction/calibration/coupon_fit.h"

namespace heddle::friction {

/// Directions in the space of the numbers along which no force moves (to 1e-6 of what the numbers do alone),
/// each with as few numbers in it as the others allow.
/// @param slopes  d ln F / d number, rows x numbers
/// @param values  of the numbers; changes are relative to them (absolute where one is 0)
std::vector<Confusion> total_confusions(const Eigen::MatrixXd& slopes, const std::vector<std::string>& keys,
                                        const Eigen::VectorXd& values);

/// Pairs whose correlation is beyond 0.95 either way.
std::vector<Confusion> high_correlations(const Eigen::MatrixXd& correlation,
                                         const std::vector<std::string>& keys);

}  // namespace heddle::friction
