#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "mesoscale/cell_spec.h"
#include "mesoscale/solid/solid_cell.h"

namespace heddle::mesoscale::study {

/// One number of a weave that a study follows.
struct Property {
  std::string key;    ///< column of the table, with its unit: "bending_warp_N_mm"
  std::string name;   ///< for readers: "bending stiffness, warp"
  std::string unit;   ///< in which it is shown; "" for plain numbers, "%" for fractions
  double per_si;      ///< shown value over SI value
  bool of_the_angle;  ///< whether it changes with the trellis angle; else it is one number of the weave
  bool solid;         ///< of the solid part: only where that is homogenised
};

/// All of them, in the order of the values below. Where they are taken:
///     fabric     mass per current area, thickness and contact under 10 kPa, contact 0.05 mm below the
///     crowns tension    both directions strained by 0.5 % shear      rate-free flow at the angle, at 20 and
///     at 40 deg, under the reference tension solid      moduli A / H and bending D of the ply with free
///     faces
const std::vector<Property>& properties();

/// Index of a property. @throws std::logic_error  if there is none of this key
std::size_t index_of(const std::string& key);

inline constexpr double contact_depth = 0.05e-3;  ///< [m]
inline constexpr double pressed_at = 10e3;        ///< nominal pressure [Pa]
inline constexpr double stretched_by = 0.005;     ///< both directions [-]

/// Values in SI, one row an angle, one column a property; NaN where a weave has none (no locking below the
/// end of its shear table, no solid part asked for).
struct CellProperties {
  std::vector<std::vector<double>> at;
};

/// @param angles  trellis angles [rad]
/// @throws InputError      if the cell has problems
/// @throws NumericalError  as the models
CellProperties cell_properties(const CellSpec& cell, const std::optional<solid::SolidSpec>& solid,
                               std::span<const double> angles);

}  // namespace heddle::mesoscale::study
