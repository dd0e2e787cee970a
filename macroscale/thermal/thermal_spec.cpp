#include "macroscale/thermal/thermal_spec.h"

#include <cmath>

#include <fmt/format.h>

namespace heddle::macroscale::thermal {

Slope ContactConductance::at(double nominal_pressure) const {
  const double rest = (full - light) * std::exp(-nominal_pressure / pressure);
  return {full - rest, rest / pressure};
}

Problems check(const ThermalSpec& spec) {
  Problems problems;
  if (spec.contact.full < spec.contact.light)
    problems.push_back(
        {"thermal.contact.full.order"_rule,
         "thermal.contact.full",
         fmt::format("{:g} W/(m^2 K)", spec.contact.full),
         fmt::format("must not be below thermal.contact.light = {:g} W/(m^2 K)", spec.contact.light),
         "A tool that is pressed on takes heat at least as well as one that barely touches.",
         "",
         0,
         {"thermal.contact.light"}});
  return problems;
}

Problems check_films(const ThermalSpec& spec, double areal_density) {
  Problems problems;
  const double films = 2.0 * spec.film_thickness * spec.film.density;
  if (films > 0.5 * areal_density)
    problems.push_back(
        {"thermal.film.density.mass"_rule,
         "thermal.film.density",
         fmt::format("{:g} kg/m^3", spec.film.density),
         fmt::format("gives the two films {:.3g} kg/m^2, more than half of the blank's {:.3g} kg/m^2", films,
                     areal_density),
         "Films are a skin on the ply: take a thinner resin.film_thickness.",
         "",
         0,
         {"resin.film_thickness", "weave.tow_width", "weave.gap", "weave.linear_density"}});
  return problems;
}

}  // namespace heddle::macroscale::thermal
