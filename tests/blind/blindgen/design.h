#pragma once

#include <optional>
#include <string_view>
#include <vector>

namespace blindgen {

/// Conditions of one pull, as the rig is set. SI, kelvin, radians.
struct Condition {
  double velocity;            ///< U [m/s]
  double normal_force;        ///< N [N]
  double tool_temperature;    ///< [K]
  double fabric_temperature;  ///< [K]
  double orientation;         ///< of the tows to the pull [rad]
  double dwell;               ///< rest under load before the pull [s]
  bool operator==(const Condition&) const = default;
};

/// Table 2 of Gorczyca, Sherwood & Chen: 16.6 mm/s, 1500 N, tool 85 degC, fabric 180 degC, 0 deg. The rest of
/// 10 s is ours; the paper gives none.
Condition baseline();

enum class Design {
  oat22,      ///< the baseline and the 21 single changes of Table 2
  crossed22,  ///< the baseline, fabric temperatures, orientations, 15 cells of tool T x N x U
  oat48,      ///< oat22 and 26 of its cells again, on other days
  crossed48   ///< oat22 and the 26 cells of a 3 x 3 x 3 of tool T, N, U round the baseline
};

std::optional<Design> design_named(std::string_view name);
std::string_view name_of(Design design);

/// One cell: a condition that is set up once and pulled with several samples.
struct Cell {
  Condition condition;
  int round = 0;  ///< cells of round 1 are run after all of round 0
};

/// @return the cells of a design, 22 or 48; the first is the baseline. Rest before slip varies over the
/// crossed
///         cells (2, 10, 60 s) in balance with the three other factors.
std::vector<Cell> cells_of(Design design);

}  // namespace blindgen
