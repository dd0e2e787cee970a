#include "mesoscale/closure.h"

#include "mesoscale/cell.h"

namespace heddle::mesoscale {

MassBalance mass_balance(const WeaveSpec& weave, const std::array<double, 2>& crimp) {
  MassBalance balance;
  for (std::size_t i = 0; i < 2; ++i) {
    const TowSpec tow = weave.tow(i);
    const double length_per_area = (1.0 + crimp[i]) / tow.pitch();
    balance.glass_area[i] = tow.linear_density * weave.fibre_mass_fraction / weave.fibre_density;
    balance.resin_area[i] = tow.linear_density * (1.0 - weave.fibre_mass_fraction) / weave.resin_density;
    balance.areal_density += tow.linear_density * length_per_area;
    balance.solid_thickness[i] = (balance.glass_area[i] + balance.resin_area[i]) * length_per_area;
  }
  return balance;
}

double section_share(double area_along_fibres, double crimp, double section_area) {
  return area_along_fibres * (1.0 + crimp) / section_area;
}

std::array<double, 2> as_woven_crimp(const WeaveSpec& weave, const std::array<double, 2>& interlacing) {
  const std::array<Section, 2> sections{section_of(weave, 0), section_of(weave, 1)};
  const double excess = excess_with_room(weave, weave.crimp_excess());
  std::array<double, 2> crimp{};
  for (std::size_t i = 0; i < 2; ++i)
    crimp[i] =
        interlacing[i] *
        path_over(sections[i], sections[1 - i], weave.tow(1 - i).pitch(), i == 0 ? excess : -excess).crimp();
  return crimp;
}

}  // namespace heddle::mesoscale
