#pragma once

#include "core/problem.h"
#include "core/surface.h"
#include "macroscale/shear_friction.h"
#include "mesoscale/fabric_properties.h"

namespace heddle::macroscale {

/// Shear resistance beyond that of the hand-over's table once tows lie side by side (effect M2):
///     dPsi/dgamma += A ((|gamma| - gamma_L) / 10 deg)^m   beyond gamma_L, in the sense of gamma.
struct ShearLocking {
  double amplitude = 0.0;             ///< A, 10 degrees beyond the angle [N/m], >= 0; 0 is off
  double angle = 0.6981317007977318;  ///< gamma_L [rad], 40 deg
  double exponent = 2.0;              ///< m >= 2: energy twice differentiable with a continuous tangent [-]

  bool on() const { return amplitude > 0.0; }
};

/// What locking adds to the energy per area, as a law of s = sin(gamma), |s| < 1.
CornerScalar locking_law(const ShearLocking& law, double s);

/// Shear resistance that grows with the tension of the tows (effect M3), from one potential:
///     W = w(e1, e2) + Psi(s) [1 + c g(e1, e2)],
///     g = (psi(n1) + psi(n2)) / n_ref,  psi(n) = n^2 / (n + n_ref) for n > 0, else 0,  n_i = dw/de_i.
/// g is 0 in slack or pressed tows, 1 where both carry n_ref, and grows like (n1 + n2) / n_ref beyond.
struct TensionCoupling {
  double amplitude = 0.0;     ///< c: rise of the shear resistance where both tows carry n_ref [-]; 0 is off
  double reference = 1000.0;  ///< n_ref [N/m], > 0

  bool on() const { return amplitude > 0.0; }
};

/// c g(e1, e2) [-] as a spline, so that its slopes are exact: through its values on the grid of the tension
/// table, each step of it divided by four. Empty where the effect is off.
Surface coupling_of(const TensionCoupling& law, const Surface& tension_energy);

/// Rate-free shear resistance that follows the temperature (effect M8): times exp(-b (T - T_ref)).
struct ShearSoftening {
  double rate = 0.0;          ///< b [1/K]; 0 is off
  double reference = 453.15;  ///< T_ref [K]

  bool on() const { return rate != 0.0; }
  double factor_at(double temperature) const;  ///< [-]
};

/// What may be wrong with a fabric beside the rate of its shear: effects M2 to M5, M7, M8 and P5. As
/// initialised all are off, and off is the baseline bit for bit (docs/theory/forming-effects.md).
struct FabricEffects {
  double bending = 1.0;        ///< factor on the bending stiffness of both tows [-], > 0; 1 is off
  double inertia = 1.0;        ///< factor on the areal density [-], > 0; 1 is off
  double crimp_stretch = 0.0;  ///< a: tension curves reach any load at (1 + a) times the toe [-], > -1
  double tow_viscosity = 0.0;  ///< eta_t: a tow resists the rate of its stretch by eta_t de/dt [N s/m], >= 0
  ShearLocking shear_locking;
  TensionCoupling tension_coupling;
  ShearSoftening softening;
};

/// The fabric with the effects that only change its numbers: bending, inertia, crimp_stretch. Tension keeps
/// its convexity and the stiffness of straight tows: w -> k^2 w(e / k), k = 1 + a.
mesoscale::FabricProperties with_effects(mesoscale::FabricProperties fabric, const FabricEffects& effects);

Problems check(const FabricEffects& effects);

}  // namespace heddle::macroscale
