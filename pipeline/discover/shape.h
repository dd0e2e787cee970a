#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "pipeline/discover/coupon_campaign.h"
#include "pipeline/discover/map_fit.h"
#include "pipeline/discover/signature.h"

namespace heddle::discover {

/// A smooth gap without a name: a Gaussian process over one or two factors or over the slip, of which the
/// best amplitude and length are taken from a grid.
struct Shape {
  std::string over;        ///< "tool_temperature", "slip", "velocity x tool_temperature", "tow pitch"
  int factors = 1;         ///< that it is a function of
  double amplitude = 0.0;  ///< standard deviation of ln F [-]
  double length =
      0.0;  ///< over which it changes, as share of the factor's range; of "tow pitch" the period [m]
  double log_evidence = 0.0;  ///< against none, averaged over the grid
  Eigen::VectorXd mean;       ///< of ln F_measured - ln F_model at the observations
  Eigen::VectorXd sd;
};

/// The evidence for a smooth gap over each factor that varies, over the slip, over the slip with the period
/// of the tows, and over pairs of factors; best first. The baseline's own numbers are left free beside it.
/// @param fit    whose gap is looked at
/// @param pitch     of the tows [m], 0 where it is not known
std::vector<Shape> shapes_of(const std::vector<CouponCell>& cells, const MapFit& fit, double pitch);

/// One point of a curve for people.
struct ShapePoint {
  std::string over;
  double at = 0.0;                          ///< in the unit that people use
  double gap = 0.0, low = 0.0, high = 0.0;  ///< of ln F, mean and 95 % band
  double force = 0.0;                       ///< that the gap is, on the mean measured force of the point [N]
};

/// The shape's curve over its factor: mean over the cells of each level.
std::vector<ShapePoint> curve_of(const Shape& shape, const std::vector<CouponCell>& cells);

}  // namespace heddle::discover
