#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "pipeline/discover/discovery.h"

/// Numbers behind report.html of a discovery: the gap of the fitted baseline over the space of conditions,
/// and what noise alone would make of it.
namespace heddle::pipeline {

/// The gap, point by point of the training cells.
struct GapTable {
  const discover::CouponFindings* findings = nullptr;  ///< must outlive the table
  std::vector<std::size_t> cell;                       ///< of each point, index in findings->training
  std::vector<discover::CouponPoint> point;
  Eigen::VectorXd gap;       ///< ln F_measured - ln F_baseline: positive where the model's force is too low
  Eigen::VectorXd baseline;  ///< ln F of the fitted baseline
};
GapTable gap_table(const discover::CouponFindings& findings);

/// What a fit with effects adds to the baseline at each point: ln F_fit - ln F_baseline.
Eigen::VectorXd added_by(const GapTable& table, const discover::Scored& scored);

/// Points gathered by one coordinate: a factor or the slip.
struct Levels {
  std::string name;  ///< for people: "tool temperature"
  std::string unit;  ///< for people: "°C"
  bool logarithmic = false;
  std::vector<double> at;         ///< mean of each level, rising [unit]
  std::vector<std::string> text;  ///< "85", or "80–95" of a level that gathers several values
  std::vector<std::size_t> of;    ///< level of each point

  std::size_t count() const { return at.size(); }
  std::string words(std::size_t level) const;  ///< "tool temperature 85 °C"
  std::string capital() const;                 ///< "Tool temperature"
  std::string title() const;                   ///< "Tool temperature (°C)"
};

/// Levels of every factor that varies, without the day; and of the slip where there are histories.
/// @param most  levels of one factor; where a campaign has more, its range is cut into so many even parts
std::vector<Levels> all_levels(const GapTable& table, std::size_t most);

/// Factors that have one value in the whole campaign, with it: "orientation 0°".
std::vector<std::string> constant_factors(const discover::CouponFindings& findings);

/// Weights of a mean over some points: 1 in sum; over the segment "trend" the second half of the pull less
/// the first. All 0 where the points hold none of the segment.
Eigen::VectorXd weights_of(const GapTable& table, std::string_view segment,
                           const std::function<bool(std::size_t point)>& take);

/// Covariance of weighted sums of ln F, from samples and days.
/// @param weights  points x sums
Eigen::MatrixXd noise_of(const GapTable& table, const Eigen::MatrixXd& weights);

struct WeightedMean {
  double value = 0.0;
  double noise = 0.0;  ///< standard deviation of the value from samples and days
  int cells = 0;       ///< that it is taken over
};
WeightedMean mean_of(const GapTable& table, const Eigen::VectorXd& values, const Eigen::VectorXd& weights);

/// A way to look at points: along a coordinate, of all conditions or of those at one level of another.
struct Cut {
  std::size_t along = 0;                                  ///< index of levels
  std::optional<std::pair<std::size_t, std::size_t>> at;  ///< levels and which of them
  double separation = 0.0;  ///< squared distance of the two, in standard deviations of noise
};
/// Where two predictions differ most against noise; none where they never do.
std::optional<Cut> cut_between(const GapTable& table, const std::vector<Levels>& levels,
                               const Eigen::VectorXd& one, const Eigen::VectorXd& other);
/// Means along a cut, level by level; `cells` is 0 where the cut has no points.
std::vector<WeightedMean> means_along(const GapTable& table, const std::vector<Levels>& levels,
                                      const Cut& cut, const Eigen::VectorXd& values);

/// "tool_temperature" as people write it.
std::string spaced(std::string_view id);
/// "static peak and load cell offset"; "nothing missing" of the empty hypothesis. A choice of R6 says which.
std::string in_words(const discover::ForwardModel& forward, const discover::Hypothesis& hypothesis,
                     std::string_view between = " and ");
/// To so many significant digits, without zeros at its end: "1500", "16.7", "85".
std::string plain_number(double value, int digits);

}  // namespace heddle::pipeline
