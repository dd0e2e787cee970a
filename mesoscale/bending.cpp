#include "mesoscale/bending.h"

#include <cmath>

namespace heddle::mesoscale {

std::array<BendingStiffness, 2> bending_stiffness(const FabricGeometry& consolidated,
                                                  const BendingInput& input) {
  const CrossingGeometry& crossing = consolidated.crossing;
  const double axial = consolidated.mass.glass_area * input.fibre_modulus / crossing.pitch;
  const double half_height = 0.5 * crossing.path.height;
  std::array<BendingStiffness, 2> result{};
  for (std::size_t i = 0; i < 2; ++i) {
    // Floats lie at the full half height; the steps between follow the path.
    const double share = consolidated.interlacing[i];
    const double path =
        share * crossing.path.mean_square_height() + (1.0 - share) * half_height * half_height;
    const double sliding = axial * input.fibre_diameter * input.fibre_diameter / 16.0;
    const double bonded = axial * (path + crossing.section.mean_square_height());
    result[i] = {sliding, bonded, std::pow(sliding, 1.0 - input.bonding) * std::pow(bonded, input.bonding)};
  }
  return result;
}

Curve constant_in_temperature(double value) {
  return Curve({273.15, 573.15}, {value, value});
}

}  // namespace heddle::mesoscale
