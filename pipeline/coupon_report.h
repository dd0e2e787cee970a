#pragma once

#include <optional>
#include <string>
#include <vector>

#include "mesoscale/coupon_curves.h"

/// Shear tests of the fabric as its laws predict them: tables and a section of the weave's report.
namespace heddle::pipeline {

/// picture_frame.csv and bias_extension.csv: crosshead speeds 0 (rate-free), 1 and 10 mm/s at the temperature
/// at which the melt's consistency holds; up to 60 deg, or the end of the fabric's shear table.
std::string picture_frame_csv(const mesoscale::FabricProperties& fabric);
std::string bias_extension_csv(const mesoscale::FabricProperties& fabric);

/// A picture frame that goes to and fro without the rate's part, where a share of the resistance is friction
/// between tows: shear force per width over the shear angle.
struct ShearLoop {
  struct Way {
    std::vector<double> angle, force;  ///< [rad], [N/m]
  };
  double share = 0.0;  ///< f [-]
  Way first, cycles;   ///< first loading; to 20 and 40 deg, each to both sides
};

/// Body of the section: both tests, with what is recalled of room-temperature frames behind the first, and
/// the loop where there is one.
std::string coupon_section(const mesoscale::FabricProperties& fabric,
                           const std::optional<ShearLoop>& loop = {});

}  // namespace heddle::pipeline
