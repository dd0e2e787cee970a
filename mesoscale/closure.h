#pragma once

#include "mesoscale/cell_spec.h"

namespace heddle::mesoscale {

/// Where the mass of the fabric is, from the tow's linear density alone. It closes for both states because
/// the tow length per pitch is the as-woven one in both: on consolidation the pitch is kept and the length
/// that the flatter path no longer needs stays in the plane as waviness.
struct MassBalance {
  double glass_area = 0.0;              ///< A_f of one tow, normal to its fibres [m^2]
  double resin_area = 0.0;              ///< A_m of one tow [m^2]
  double areal_density = 0.0;           ///< both directions [kg/m^2]
  double consolidated_thickness = 0.0;  ///< of the void-free sheet at the same pitch [m]
};

/// @param mean_crimp  as-woven l/p - 1, mean of both directions [-]
MassBalance mass_balance(const WeaveSpec& weave, double mean_crimp);

/// Share of a tow section taken by `area_along_fibres` of material, tow length l on volume A p [-].
double section_share(double area_along_fibres, double mean_crimp, double section_area);

/// As-woven l/p - 1 averaged over a weave in which a share of the steps changes sides [-].
double as_woven_crimp(const WeaveSpec& weave, double interlacing_share);

}  // namespace heddle::mesoscale
