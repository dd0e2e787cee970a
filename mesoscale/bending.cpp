#include "mesoscale/bending.h"

#include <cmath>

namespace heddle::mesoscale {

std::array<BendingStiffness, 2> bending_stiffness(const FabricGeometry& consolidated,
                                                  const BendingInput& input) {
  std::array<BendingStiffness, 2> result{};
  double over = 0.0;  // share of the crossings with the warp on top
  for (const auto& upper : consolidated.quarters[0]) over += upper[0] + upper[1];
  for (std::size_t i = 0; i < 2; ++i) {
    const TowGeometry& tow = consolidated.crossing.tow[i];
    const double axial = consolidated.mass.glass_area[i] * input.fibre_modulus / tow.spacing;
    const double half_height = 0.5 * tow.path.height;
    // Floats lie at the full half height; the steps between follow the path.
    const double share = consolidated.interlacing[i];
    const double path = share * tow.path.mean_square_height() + (1.0 - share) * half_height * half_height;
    const double sliding = axial * input.fibre_diameter * input.fibre_diameter / 16.0;
    // Over the mid-plane, of the path; 0 where a tow is as often above as below.
    const double mean_path = (i == 0 ? 2.0 * over - 1.0 : 1.0 - 2.0 * over) * half_height;
    const double bonded =
        axial * (path + 2.0 * mean_path * mean_height(tow.section) + mean_square_height(tow.section));
    result[i] = {sliding, bonded, std::pow(sliding, 1.0 - input.bonding) * std::pow(bonded, input.bonding)};
  }
  return result;
}

Curve constant_in_temperature(double value) {
  return Curve({273.15, 573.15}, {value, value});
}

}  // namespace heddle::mesoscale
