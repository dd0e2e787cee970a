#pragma once

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "core/curve.h"
#include "core/problem.h"
#include "core/surface.h"

namespace heddle::mesoscale {

/// Rate-dependent part of the shear resistance, as one dissipation potential per initial area:
///     R = m_s(T) / (n + 1) |gdot|^(n+1)      [W/m^2]
/// crossover film and in-tow flow together (T_visc of docs/theory/mesoscale.md).
struct ShearRate {
  double consistency = 0.0;               ///< m_s at the reference temperature [N s^n / m]
  double index = 1.0;                     ///< n [-]
  double activation_temperature = 0.0;    ///< E / R_gas of the Arrhenius shift [K]
  double reference_temperature = 453.15;  ///< [K]

  double consistency_at(double temperature) const {
    return consistency * std::exp(activation_temperature * (1.0 / temperature - 1.0 / reference_temperature));
  }
};

/// Friction over the direction of sliding theta against the warp, from the film under the sheared fabric:
///     mu = mean (1 + K_c cos 2 theta + K_s sin 2 theta)
struct DragDirection {
  CurveFamily cosine, sine;  ///< K_c, K_s against ln(p / 1 Pa); parameter: trellis shear angle [rad], >= 0

  struct Value {
    double cosine = 0.0, sine = 0.0;  ///< K_c, K_s [-]
  };
  bool empty() const { return cosine.empty(); }
  /// Held beyond the table; nothing where it is empty. Fabric sheared the other way is its mirror image about
  /// the warp: K_s changes its sign.
  Value evaluate(double pressure, double shear_angle) const;
};

/// Where a fabric touches a flat tool: real over nominal contact area of one face, phi(p, gamma), stored as
/// ln phi against ln p for several shear angles, so that beyond the table the log slope is held. An area has
/// no direction; drag has, where the film under a sheared fabric was asked for.
struct ContactArea {
  CurveFamily log_fraction;  ///< ln phi against ln(p / 1 Pa); parameter: trellis shear angle [rad]
  DragDirection drag = {};   ///< empty where no film was asked for

  struct Value {
    double fraction;  ///< phi [-], 0..1
    double slope;     ///< d phi / d p [1/Pa]
  };
  /// @param pressure  nominal pressure [Pa], > 0
  /// @param shear_angle  trellis shear angle [rad], sign ignored
  Value evaluate(double pressure, double shear_angle) const;
};

/// What two plies that face each other make of the fabric: how near their middles come before they press, and
/// the pressure from there. Without a table they press each other as each presses a flat plate.
struct PlyFacing {
  double rest = 0.0;  ///< distance of the middles at which they touch [m]
  Curve compaction =
      {};  ///< P [Pa] against d = (rest - g) / 2 [m], half of the closing for each of the two faces

  bool empty() const { return compaction.empty(); }
};

/// Where numbers come from: hash of the specification, and how far a finer grid would move them.
struct Provenance {
  std::string specification;            ///< hash of the resolved cell specification
  std::vector<std::string> unverified;  ///< names of constants that are priors, not measurements
  double grid_error = 0.0;  ///< largest relative change of contact and compaction against half the grid
};

/// All that the macroscale learns of the fabric. SI units; axes 1 = warp, 2 = weft. Per-area quantities use
/// the initial (unsheared, unstretched) area.
struct FabricProperties {
  double areal_density = 0.0;     ///< glass + resin [kg/m^2]
  std::array<double, 2> pitch{};  ///< tow width + gap, {warp, weft} [m]
  double thickness = 0.0;         ///< stress-free fabric thickness H [m]

  Surface tension_energy;  ///< w(e1, e2) [J/m^2], engineering strains; n_i = dw/de_i [N/m]
  Curve shear_stress;      ///< dPsi/ds [N/m] against s = sin(gamma) in [0, 1); odd in s
  ShearRate shear_rate;
  std::array<Curve, 2> bending;  ///< B [N m] against temperature [K], {along warp, along weft}
  /// Pressure [Pa, per CURRENT area of the sheared fabric] against approach d [m] of ONE face; h = H - 2 d;
  /// parameter: trellis shear angle [rad]. Zero and flat at d = 0.
  CurveFamily compaction;
  ContactArea contact;
  PlyFacing facing = {};  ///< empty: as against a flat plate
  Provenance provenance;
};

/// Tables that are not monotone where they must be, not finite, or not convex.
Problems check(const FabricProperties& fabric);

}  // namespace heddle::mesoscale
