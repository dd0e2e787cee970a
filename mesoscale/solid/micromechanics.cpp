#include "mesoscale/solid/micromechanics.h"

#include <cmath>

namespace heddle::mesoscale::solid {

Matrix6 stiffness(const IsotropicPhase& phase) {
  return isotropic_stiffness(phase.bulk(), phase.shear());
}

TransverseIsotropy chamis(const IsotropicPhase& fibre, const IsotropicPhase& matrix, double fibre_fraction) {
  const double root = std::sqrt(fibre_fraction);
  const auto across = [&](double of_fibre, double of_matrix) {
    return of_matrix / (1.0 - root * (1.0 - of_matrix / of_fibre));
  };
  const auto along = [&](double of_fibre, double of_matrix) {
    return fibre_fraction * of_fibre + (1.0 - fibre_fraction) * of_matrix;
  };
  const double shear = across(fibre.shear(), matrix.shear());
  return {along(fibre.modulus, matrix.modulus), across(fibre.modulus, matrix.modulus), shear, shear,
          along(fibre.poisson, matrix.poisson)};
}

TransverseIsotropy hashin(const IsotropicPhase& fibre, const IsotropicPhase& matrix, double fibre_fraction) {
  const double f = fibre_fraction, m = 1.0 - fibre_fraction;
  const double kf = fibre.plane_strain_bulk(), km = matrix.plane_strain_bulk();
  const double gf = fibre.shear(), gm = matrix.shear();
  const double grip = m / kf + f / km + 1.0 / gm;
  const double poisson_gap = fibre.poisson - matrix.poisson;
  const double axial =
      f * fibre.modulus + m * matrix.modulus + 4.0 * f * m * poisson_gap * poisson_gap / grip;
  const double poisson =
      f * fibre.poisson + m * matrix.poisson + f * m * poisson_gap * (1.0 / km - 1.0 / kf) / grip;
  const double axial_shear = gm * (gm * m + gf * (1.0 + f)) / (gm * (1.0 + f) + gf * m);
  // Written with the differences in the numerator, so that equal phases are no special case.
  const double bulk = km + f * (kf - km) / (1.0 + m * (kf - km) / (km + gm));
  const double soft = (km + 2.0 * gm) / (2.0 * gm * (km + gm));
  const double transverse_shear = gm + f * (gf - gm) / (1.0 + m * (gf - gm) * soft);
  const double lateral = 1.0 + 4.0 * bulk * poisson * poisson / axial;
  const double transverse = 4.0 * transverse_shear * bulk / (bulk + lateral * transverse_shear);
  return {axial, transverse, axial_shear, transverse_shear, poisson};
}

TransverseIsotropy tow(TowModel model, const IsotropicPhase& fibre, const IsotropicPhase& matrix,
                       double fibre_fraction) {
  return model == TowModel::chamis ? chamis(fibre, matrix, fibre_fraction)
                                   : hashin(fibre, matrix, fibre_fraction);
}

}  // namespace heddle::mesoscale::solid
