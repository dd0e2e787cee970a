#pragma once

#include <string>
#include <vector>

#include "mesoscale/fabric_properties.h"
#include "pipeline/commands.h"
#include "pipeline/shear_tests.h"

namespace heddle::pipeline {

/// Measured and predicted shear flow of pieces that were meant alike, at one angle.
struct ShearGap {
  ShearTest test = ShearTest::picture_frame;
  std::string condition;
  double shear_angle = 0.0;  ///< [rad]
  int samples = 0;           ///< that reach it
  double measured = 0.0;     ///< T_s, mean over samples [N/m]
  double scatter = 0.0;      ///< standard deviation over samples [N/m]; 0 of one
  double model = 0.0;        ///< T_s of the fabric's laws at the mean rate and temperature [N/m]
};

/// Every 5 degrees up to where the furthest piece of each condition goes.
std::vector<ShearGap> shear_gaps(const std::vector<ShearCurve>& curves,
                                 const mesoscale::FabricProperties& fabric);

/// `discover` on a table of shear tests: what the case's fabric and the measurement say of T_s. No effect of
/// the library acts on it, so that nothing is named.
/// @throws InputError  with every problem of the data, or of a case without a weave
int discover_shear(const DiscoverOptions& options);

}  // namespace heddle::pipeline
