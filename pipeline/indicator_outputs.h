#pragma once

#include <string>
#include <vector>

#include "macroscale/folds.h"
#include "macroscale/indicators.h"
#include "pipeline/export_vtu.h"

namespace heddle::pipeline {

/// The blank as mesh_of has it, with its indicators: tow_load_warp_weft, gap_opening_warp_weft_mm,
/// wrinkle_height_mm, thickening; and fold_turn_deg, self_distance_mm of its folds.
QuadMesh mesh_with_indicators(const macroscale::BlankState& blank, const mesoscale::FabricProperties& fabric);

/// indicators.csv: name, value, unit, and where the largest is [mm].
std::string indicators_csv(const std::vector<macroscale::LargestIndicator>& indicators);

/// From where on an indicator is a warning.
struct IndicatorLimits {
  double tow_load = 1.0;          ///< torn
  double tow_compression = 0.01;  ///< a tow shortens by this only by buckling
  double wrinkle_height = 0.0;    ///< what the grid leaves by itself [m] (macroscale::wrinkle_floor)
  double gap_opening = 0.0;       ///< a tenth of the pitch [m]
};
IndicatorLimits indicator_limits(const macroscale::StampingSpec& spec,
                                 const mesoscale::FabricProperties& fabric,
                                 const std::array<double, 2>& spacing);

/// A sentence for each indicator beyond its limit, for report and terminal.
std::vector<std::string> indicator_warnings(const std::vector<macroscale::LargestIndicator>& indicators,
                                            const IndicatorLimits& limits);
/// Sentences on a sheet that folds, comes near itself or has passed through itself, in the last state or
/// before.
std::vector<std::string> fold_warnings(const macroscale::Folds& folds,
                                       const macroscale::StampingSummary& run);
/// One sentence with all of them, for the log.
std::string indicator_line(const std::vector<macroscale::LargestIndicator>& indicators);

}  // namespace heddle::pipeline
