#pragma once

#include "core/curve.h"

namespace heddle::macroscale {

/// Dry friction between tows at their crossovers, as a share of the shear resistance that a loading test
/// shows: that curve is kept whatever the share, and unloading leaves a loop. See
/// docs/theory/shear-hysteresis.md.
struct ShearFriction {
  double share = 0.0;      ///< f of dPsi/ds, in [0, 1); 0 is off [-]
  double stiffness = 2.0;  ///< of a reversal, over the steepest slope of the friction part so far; >= 1 [-]

  bool on() const { return share > 0.0; }
};

/// What one corner remembers of its shear. As initialised: never sheared.
struct ShearMemory {
  double sine = 0.0;       ///< s = sin(gamma) reached last [-]
  double widest = 0.0;     ///< largest |s| so far [-]
  double stress = 0.0;     ///< q, friction's part of dW/ds [N/m]
  double stiffness = 0.0;  ///< K, dq/ds of a reversal from here [N/m]
};

/// A law of s: energy per area, and its slopes [N/m].
struct CornerScalar {
  double energy = 0.0, first = 0.0, second = 0.0;
};

/// Friction at s after a straight way from memory.sine. Return mapping in closed form: q follows K inside
/// +-f Psi'(widest), stays at that limit, and is +-f Psi'(|s|) where |s| has never been as large. `energy` is
/// the work along the way (dissipated part included), so that q is its slope: the condensed incremental
/// potential. C1 in s.
/// @param resistance  dPsi/ds against s >= 0 [N/m], rising from 0
CornerScalar tow_friction(const ShearFriction& law, const Curve& resistance, const ShearMemory& memory,
                          double s);

/// What is remembered once s has been reached.
ShearMemory sheared_to(const ShearFriction& law, const Curve& resistance, const ShearMemory& memory,
                       double s);

/// Energy held in bent crossovers, q^2 / (2 K) [J/m^2]; comes back on the way back.
double stored_in_crossovers(const ShearMemory& memory);

/// Dissipated on the straight way to s [J/m^2], >= 0: limit times slip inside the loop, and beyond it
/// f dPsi - d(q^2 / (2 K)).
/// @param reached  sheared_to(law, resistance, memory, s)
double dissipated_by_tows(const ShearFriction& law, const Curve& resistance, const ShearMemory& memory,
                          const ShearMemory& reached);

}  // namespace heddle::macroscale
