#pragma once

#include <optional>
#include <string>
#include <vector>

#include "friction/calibration/coupon_fit.h"
#include "pipeline/calibrate_keys.h"
#include "pipeline/report.h"

/// What `heddle calibrate` leaves behind, as text.
namespace heddle::pipeline {

/// A fit with its data and what it rests on.
struct CalibrationFindings {
  std::string name;       ///< of the case
  std::string data_file;  ///< its name, without the folder
  std::string law;        ///< id
  friction::CouponData data;
  friction::CouponFitSpec spec;
  friction::CouponFit fit;
  friction::FrictionRig rig;
  /// The fit at the ends of the plate area band; absent where the band is one area or no pressure is seen.
  std::optional<friction::PlateAreaEffect> plate_area;
  bool plate_area_given = true;    ///< false: the default stands for what the case does not say
  std::vector<std::string> notes;  ///< of the case and of the table
};

/// What the numbers say, in words: how many degrees of freedom are left, where the scatter comes from, what
/// the data cannot tell, what only the plate area fixes.
std::vector<Verdict> calibration_verdicts(const CalibrationFindings& findings);

/// "1.234e-3 1/K" in the unit of the configuration, to `digits` digits.
std::string quantity_text(double value, const std::string& unit, int digits);

std::string calibration_json(const CalibrationFindings& findings);
/// One row a number.
std::string calibration_numbers_csv(const CalibrationFindings& findings);
/// One row a row of the data.
std::string calibration_residuals_csv(const CalibrationFindings& findings);
std::string calibration_html(const CalibrationFindings& findings);

}  // namespace heddle::pipeline
