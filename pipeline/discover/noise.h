#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "friction/calibration/scatter.h"
#include "pipeline/discover/coupon_campaign.h"

namespace heddle::discover {

/// What the user says of the scatter of ln F; what is empty comes from the data.
struct NoiseWish {
  std::optional<double> sample = {};  ///< standard deviation from piece to piece of fabric
  std::optional<double> day = {};     ///< from day to day, shared by all that was pulled on one
  double sample_assumed = 0.05;       ///< where no condition was repeated; prior
  double day_assumed = 0.02;          ///< where no condition was repeated on three days; prior
  double reading = 0.015;             ///< of one stretch beside the next, where replicates do not tell; prior
  /// How far the law's own curve over ln Hs may be off before its error counts as a missing effect, and over
  /// how long a stretch of ln Hs it wanders: a smooth Gaussian process.
  double form = 0.02;
  double form_length = 1.5;
  /// How far a pull may be from even along its slip, alike in all conditions, before that counts: rigs take
  /// up, fabrics settle. Over one e-fold of slip.
  double history = 0.01;
  /// The same of an effect: a share of what it does to ln F over each factor and over ln slip, wandering over
  /// this share of their ranges.
  double effect_form = 0.25;
  double effect_form_length = 0.5;
};

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
