#pragma once

#include <array>
#include <vector>

#include "core/curve.h"
#include "mesoscale/cell.h"

namespace heddle::mesoscale {

/// Where a flat tool touches the upper face of the sheared fabric, and at which nominal pressure it gets
/// there. By the measure of PlateContact: a point is touched once the plate has come down to it.
struct TouchedFace {
  double shear_angle = 0.0;  ///< [rad]
  int n = 0;                 ///< samples each way over one repeat, cell centres of the parameter plane
  std::array<double, 2> along_warp{}, along_weft{};  ///< edges of the repeat in the fabric plane [m]
  /// Nominal pressure at first touch, row-major, along the warp fastest [Pa]; infinite where no tow is or
  /// where the compaction table ends before
  std::vector<double> pressure;
};

/// @param compaction  P [Pa] against d [m], parameter g (FabricProperties::compaction)
/// @param n           samples each way, >= 1
TouchedFace touched_face(const FabricGeometry& fabric, const CurveFamily& compaction, double shear_angle,
                         int n);

}  // namespace heddle::mesoscale
