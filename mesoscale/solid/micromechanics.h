#pragma once

#include "mesoscale/solid/stiffness.h"

namespace heddle::mesoscale::solid {

struct IsotropicPhase {
  double modulus;  ///< E [Pa]
  double poisson;  ///< nu [-], -1 < nu < 0.5

  double shear() const { return 0.5 * modulus / (1.0 + poisson); }
  double bulk() const { return modulus / (3.0 * (1.0 - 2.0 * poisson)); }
  /// K + G / 3: resistance to widening at fixed length [Pa].
  double plane_strain_bulk() const { return bulk() + shear() / 3.0; }
};

Matrix6 stiffness(const IsotropicPhase& phase);

enum class TowModel { chamis, hashin };

/// A tow of parallel fibres in a matrix, by the square-root rules of Chamis: along the fibres the rule of
/// mixtures, across them E_T = E_m / (1 - sqrt(Vf) (1 - E_m / E_f)) and the shear moduli likewise.
/// Source: Chamis 1984 (recalled); simplified, neither bound nor exact. Vf = 0 gives the matrix, 1 the fibre.
/// @param fibre_fraction  Vf [-], 0..1
TransverseIsotropy chamis(const IsotropicPhase& fibre, const IsotropicPhase& matrix, double fibre_fraction);

/// The same by Hashin's composite-cylinder assemblage: E_L, nu_LT, G_LT and the plane-strain bulk modulus
/// are exact for it; G_TT is the lower bound of Hill and Hashin for fibres stiffer than the matrix, from
/// which E_T follows.
/// Source: Hashin 1983, J. Appl. Mech. 50:481 (recalled).
TransverseIsotropy hashin(const IsotropicPhase& fibre, const IsotropicPhase& matrix, double fibre_fraction);

TransverseIsotropy tow(TowModel model, const IsotropicPhase& fibre, const IsotropicPhase& matrix,
                       double fibre_fraction);

}  // namespace heddle::mesoscale::solid
