#include "mesoscale/closure.h"

#include "mesoscale/path.h"
#include "mesoscale/section.h"

namespace heddle::mesoscale {

MassBalance mass_balance(const WeaveSpec& weave, double mean_crimp) {
  const double pitch = weave.tow_width + weave.gap;
  MassBalance balance;
  balance.glass_area = weave.linear_density * weave.fibre_mass_fraction / weave.fibre_density;
  balance.resin_area = weave.linear_density * (1.0 - weave.fibre_mass_fraction) / weave.resin_density;
  const double length_per_area = 2.0 * (1.0 + mean_crimp) / pitch;
  balance.areal_density = weave.linear_density * length_per_area;
  balance.consolidated_thickness = (balance.glass_area + balance.resin_area) * length_per_area;
  return balance;
}

double section_share(double area_along_fibres, double mean_crimp, double section_area) {
  return area_along_fibres * (1.0 + mean_crimp) / section_area;
}

double as_woven_crimp(const WeaveSpec& weave, double interlacing_share) {
  const LensSection section{weave.tow_width, weave.tow_thickness};
  const double pitch = weave.tow_width + weave.gap;
  const ArcPath path = arc_path(pitch, weave.tow_thickness, section.radius() + 0.5 * section.thickness);
  return interlacing_share * path.crimp();
}

}  // namespace heddle::mesoscale
