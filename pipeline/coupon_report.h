#pragma once

#include <string>

#include "mesoscale/coupon_curves.h"

/// Shear tests of the fabric as its laws predict them: tables and a section of the weave's report.
namespace heddle::pipeline {

/// picture_frame.csv and bias_extension.csv: crosshead speeds 0 (rate-free), 1 and 10 mm/s at the temperature
/// at which the melt's consistency holds; up to 60 deg, or the end of the fabric's shear table.
std::string picture_frame_csv(const mesoscale::FabricProperties& fabric);
std::string bias_extension_csv(const mesoscale::FabricProperties& fabric);

/// Body of the section: both tests, with what is recalled of room-temperature frames behind the first.
std::string coupon_section(const mesoscale::FabricProperties& fabric);

}  // namespace heddle::pipeline
