#include "mesoscale/touched_face.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace heddle::mesoscale {

namespace {

// The least depth at which a table ends that counts at this angle.
double depth_known(const CurveFamily& compaction, double angle) {
  const std::vector<double>& at = compaction.parameter();
  const auto above = static_cast<std::size_t>(std::lower_bound(at.begin(), at.end(), angle) - at.begin());
  double deepest = std::numeric_limits<double>::infinity();
  if (above < at.size()) deepest = compaction.curves()[above].x().back();
  if (above > 0 && !(above < at.size() && at[above] == angle))
    deepest = std::min(deepest, compaction.curves()[above - 1].x().back());
  return deepest;
}

}  // namespace

TouchedFace touched_face(const FabricGeometry& fabric, const CurveFamily& compaction, double shear_angle,
                         int n) {
  const UnitCell cell = unit_cell(fabric, shear_angle);
  const HeightField field = height_field(cell, n);
  TouchedFace face{shear_angle, n, field.along_warp, field.along_weft, {}};
  const double crown = cell.crown();
  const double deepest = depth_known(compaction, std::abs(shear_angle));
  for (std::size_t k = 0; k < field.top.size(); ++k) {
    const double depth = crown - field.top[k];
    const bool known = field.covered[k] != 0 && depth <= deepest;
    face.pressure.push_back(known ? compaction.evaluate(std::max(depth, 0.0), std::abs(shear_angle)).y
                                  : std::numeric_limits<double>::infinity());
  }
  return face;
}

}  // namespace heddle::mesoscale
