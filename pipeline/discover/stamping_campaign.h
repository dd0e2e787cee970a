#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "friction/calibration/coupon_data.h"
#include "pipeline/discover/coupon_campaign.h"
#include "pipeline/discover/split.h"

/// Measured stampings: punch force against stroke, one curve a blank. To discovery a curve is what a pull is
/// to a coupon campaign, so that scatter, contrasts, shapes and the verdict are the same code: the velocity
/// of a cell is the speed of the punch, its normal force the binder's, its fabric temperature the blank's,
/// its slip the stroke, and a stretch is a bin of stroke.
namespace heddle::discover {

/// What was set at the press.
struct StampingCondition {
  std::string name;
  double speed_scale = 1.0;        ///< of the case's punch profile [-]
  double binder_force = 0.0;       ///< [N]
  double tool_temperature = 0.0;   ///< [K]
  double blank_temperature = 0.0;  ///< [K]
  double orientation = 0.0;        ///< warp against x [rad]
  bool operator==(const StampingCondition&) const = default;
};

/// Measured stampings, reduced to bins of stroke.
struct StampingData {
  friction::CouponData curves;                ///< a row a bin and blank; F of the punch as measured_force
  std::vector<StampingCondition> conditions;  ///< by CouponRow::condition
  std::vector<double> edges;                  ///< of the bins of stroke, rising [m]
};

struct StampingReduction {
  int bins = 12;
  /// Stroke before the first bin, as share of the stroke that all curves reach: the first contact of a few
  /// nodes says more of the grid than of the cloth.
  double start = 0.2;
  double stroke = 0.05;       ///< of the case: no bin ends beyond it [m]
  double punch_speed = 0.16;  ///< mean of the case at speed_scale 1 [m/s]
};

/// Whether the header of a table is one of stampings (it has punch_force_N) and not of coupons.
bool is_stamping_table(std::string_view text);

/// Reads measured stampings, one row a sample point.
///
/// Columns: condition_id, sample_id, speed_scale, binder_force_N, tool_temperature_C, blank_temperature_C,
/// punch_displacement_mm, punch_force_N; if wanted day_id, orientation_deg, draw_in_max_mm,
/// shear_angle_max_deg (the last two are read and checked, and no fit uses them yet). Any order.
/// @throws InputError  with every problem and its line: columns, numbers, curves that go back or are too
/// short,
///                     conditions that differ under one name, numbers that suggest another unit
StampingData parse_stampings(std::string_view text, const std::string& file,
                             const StampingReduction& reduction);

/// Mean force over each bin of a curve that is straight between its points [N]; NaN where the curve does not
/// cover the bin.
/// @param stroke  strictly rising [m]
std::vector<double> bin_means(const std::vector<double>& stroke, const std::vector<double>& force,
                              const std::vector<double>& edges);

/// Holds whole conditions out: `share` of all, from those that lie at no end of a factor that varies, so that
/// what is held out lies between what was fitted. Nothing where fewer than three would stay in training.
Split split_stampings(const CouponCampaign& campaign, double share, std::uint64_t seed);

}  // namespace heddle::discover
