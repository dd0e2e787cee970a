#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

#include "pipeline/discover/coupon_campaign.h"
#include "pipeline/discover/hypothesis.h"

namespace heddle::discover {

/// A coordinate of every observation, 0 to 1 over the campaign.
struct Coordinate {
  std::string name;
  Eigen::VectorXd at;
};

/// A number of each observation, in the order of cells and points.
Eigen::VectorXd of_points(const std::vector<CouponCell>& cells,
                          const std::function<double(const CouponCell&, const CouponPoint&)>& value);

/// The factors that vary (without the day), and the logarithm of the slip where there are histories.
std::vector<Coordinate> coordinates_of(const std::vector<CouponCell>& cells);

/// exp(-(x/length)^2/2)
double gaussian(double distance, double length);

/// Over each coordinate a smooth error of form (Gaussian kernel). One coordinate at a time: a product of
/// kernels would let the error wander from cell to cell, which no law's form does.
/// @param centred_over  the first so many observations, whose mean is taken out; 0: all
std::vector<FormCoordinate> form_coordinates(const std::vector<CouponCell>& cells, double length,
                                             Eigen::Index centred_over = 0);

}  // namespace heddle::discover
