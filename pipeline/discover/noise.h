#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "friction/calibration/scatter.h"
#include "pipeline/discover/coupon_campaign.h"
#include "pipeline/discover/noise_wish.h"

namespace heddle::discover {

/// Scatter of the means of the cells.
struct CouponNoise {
  Eigen::MatrixXd sample;  ///< of one piece of fabric, stretches x stretches
  friction::Scatter::Source sample_source = friction::Scatter::Source::unknown;
  int sample_freedom = 0;
  double day = 0.0;
  friction::Scatter::Source day_source = friction::Scatter::Source::unknown;
  int day_freedom = 0;
  double form = 0.0, form_length = 1.0, history = 0.0;
  std::vector<std::string> notes = {};

  /// Of the mean over stretches of one piece.
  double sample_sd() const;
  bool from_replicates() const { return sample_source == friction::Scatter::Source::replicates; }
};

/// Scatter within cells from replicates (pooled covariance of the stretches where there are enough of them,
/// inflated for being an estimate by nu/(nu - q - 1); else gain and reading alone), and of days from the
/// condition that most days repeat, pulled towards `day_assumed` by the weight of three days.
CouponNoise noise_of(const CouponCampaign& campaign, const friction::CouponData& data, const NoiseWish& wish,
                     int faces);

/// Covariance of the points of the cells: replicates, shared days, and the form of the law where Hersey
/// numbers are given.
/// @param hersey  one a cell; empty: no form error
Eigen::MatrixXd covariance_of(const CouponNoise& noise, const std::vector<CouponCell>& cells,
                              const std::vector<double>& hersey);

/// Indices of the rows that belong to some cells, in the order of their points.
std::vector<Eigen::Index> rows_of(const std::vector<CouponCell>& all, const std::vector<std::size_t>& cells);

}  // namespace heddle::discover
