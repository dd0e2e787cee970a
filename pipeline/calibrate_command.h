#pragma once

#include "pipeline/calibration_record.h"
#include "pipeline/case.h"
#include "pipeline/commands.h"

namespace heddle::pipeline {

/// Fits what the case asks for to its coupons.
/// @throws InputError  with every problem of data and wish
CalibrationFindings calibrate(const Case& a_case, const std::filesystem::path& data);

/// The settings with the fitted numbers in place, and the box of the data; what a run would have fitted is
/// there as a number too, and friction.calibration.data is gone.
Settings patched_settings(const Case& a_case, const CalibrationFindings& findings);

}  // namespace heddle::pipeline
