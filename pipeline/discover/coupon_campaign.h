#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <string>
#include <vector>

#include "friction/calibration/coupon_data.h"

namespace heddle::discover {

/// Mean over replicates of one stretch of slip.
struct CouponPoint {
  int stretch = 0;
  bool steady = false;        ///< one line a pull: no history behind it
  double slip = 0.0;          ///< mean [m]
  double normal_force = 0.0;  ///< geometric mean, measured where it was [N]
  double log_force = 0.0;     ///< mean of ln F
};

/// One condition on one day: the unit that a campaign repeats, holds out and proposes.
struct CouponCell {
  friction::FrictionTestRow pull;  ///< its conditions; normal_force the nominal mean
  double dwell = 0.0;              ///< [s]
  std::size_t condition = 0, day = 0;
  int samples = 0;
  bool load_measured = false;
  std::vector<CouponPoint> points;
};

/// Measured coupons, reduced to cells, and how replicates scatter about them.
struct CouponCampaign {
  std::vector<CouponCell> cells;
  std::vector<std::string> days;
  std::vector<std::string> condition_names;
  int stretches = 1;
  Eigen::MatrixXd pooled;      ///< of ln F within cells, stretches x stretches, over complete samples
  int degrees_of_freedom = 0;  ///< behind `pooled`
  std::vector<std::string> notes;
  /// Samples left out because they lie far from their replicates.
  std::vector<std::string> outliers;
};

/// Groups rows by condition and day and pools their scatter.
///
/// A sample whose mean ln F lies more than `outlier` robust standard deviations (pooled over cells) from the
/// median of its cell, where the cell has four or more, is left out and named: a wrong label on one sample is
/// no scatter.
/// @param faces  F = faces mu N
CouponCampaign campaign_of(const friction::CouponData& data, int stretches, double outlier = 5.0);

/// Numbers of the conditions that a campaign may vary, for contrasts and designs.
struct Factor {
  const char* name;                    ///< "tool_temperature"
  const char* unit;                    ///< for people
  double (*of)(const CouponCell&);     ///< as contrasts see it: logarithms of speed, load and dwell
  double (*shown)(const CouponCell&);  ///< as people read it off the machine, in `unit`; days from 1
};
const std::vector<Factor>& factors();

}  // namespace heddle::discover
