#pragma once

#include <array>

#include "mesoscale/cell_spec.h"

namespace heddle::mesoscale {

/// Where the mass of the fabric is, from the tows' linear densities alone. It closes for both states because
/// the tow length per pitch is the as-woven one in both: on consolidation the pitch is kept and the length
/// that the flatter path no longer needs stays in the plane as waviness. Pairs are {warp, weft}.
struct MassBalance {
  std::array<double, 2> glass_area{};       ///< A_f of one tow, normal to its fibres [m^2]
  std::array<double, 2> resin_area{};       ///< A_m of one tow [m^2]
  double areal_density = 0.0;               ///< both directions [kg/m^2]
  std::array<double, 2> solid_thickness{};  ///< of one direction's glass and resin spread evenly [m]

  /// Of the void-free sheet at the same pitch [m].
  double consolidated_thickness() const { return solid_thickness[0] + solid_thickness[1]; }
};

/// @param crimp  as-woven l/p - 1 {warp, weft}, floats included [-]
MassBalance mass_balance(const WeaveSpec& weave, const std::array<double, 2>& crimp);

/// Share of a tow section taken by `area_along_fibres` of material, tow length l on volume A p [-].
double section_share(double area_along_fibres, double crimp, double section_area);

/// As-woven l/p - 1 {warp, weft} averaged over the steps of a weave [-].
std::array<double, 2> as_woven_crimp(const WeaveSpec& weave, const std::array<double, 2>& interlacing);

}  // namespace heddle::mesoscale
