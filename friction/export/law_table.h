#pragma once

#include <string>
#include <vector>

#include "friction/export/fric_coef.h"

namespace heddle::friction {

/// mu on a grid of pressure, slip speed and temperatures, for programs that interpolate.
struct LawTable {
  std::vector<double> pressures;            ///< [Pa], even in their logarithm
  std::vector<double> speeds;               ///< [m/s], even in their logarithm
  std::vector<double> tool_temperatures;    ///< [K]
  std::vector<double> fabric_temperatures;  ///< [K]
  std::vector<double> mu;                   ///< fabric outermost, then tool, pressure, speed innermost
  /// Largest error of an interpolation linear in ln p, ln U and both temperatures, in the middle of the
  /// cells, as a share of mu.
  double middle_error = 0.0;
};

/// The grid: 1 kPa to 1 MPa and 0.1 mm/s to 1 m/s, eight a decade; Table 2's tool temperatures 20 to 140 degC
/// and fabric temperatures 160 to 200 degC by 20 K.
LawTable usual_grid();

/// Fills in mu and the error.
/// @throws InputError      from check_export
/// @throws NumericalError  where mu is negative or not finite
LawTable law_table(const ExportedLaw& law, LawTable grid = usual_grid());

/// Columns pressure_Pa, slip_speed_mm_s, tool_temperature_C, fabric_temperature_C, friction_coefficient.
std::string law_table_csv(const LawTable& table);

}  // namespace heddle::friction
