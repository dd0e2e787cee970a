#pragma once

#include <array>

#include "core/curve.h"
#include "mesoscale/cell_spec.h"
#include "mesoscale/tension.h"

namespace heddle::mesoscale {

/// A crossing that carries the reference tension at a trellis angle.
struct LoadedCrossing {
  std::array<double, 2> strain{};  ///< e {warp, weft} [-]
  std::array<double, 2> height{};  ///< h [m]
  double crossover_force = 0.0;    ///< V [N]
  double friction_arm = 0.0;       ///< mean distance of the pressure from the crossing's centre [m]
  double potential = 0.0;          ///< stored energy less the work of the tension, per initial area [J/m^2]
};

/// Rate-free shear flow by origin; power per initial area is T dg/dt [N/m].
struct ShearFlow {
  double dry = 0.0;      ///< friction of crossing tows that turn on each other
  double lateral = 0.0;  ///< tows squeezed sideways once the gap is closed
  double tension = 0.0;  ///< change of the crimp energy under the reference tension
  double total() const { return dry + lateral + tension; }
};

/// Shear resistance of the fabric at the reference tension n_ref in both directions.
///
///     T_dry = ramp(g) mu_t V a / (p1 p2),     ramp = g / sqrt(g^2 + g_0^2)
///     T_lat = sum_i (t / p) [sigma(V0 w / W) - sigma(V0)] (-dW/dg),  W = w_o cos g: the work of narrowing
///             the tows of each direction; once its gap is closed W = p cos g and its part is
///             t sin g [sigma(V0 cos g* / cos g) - sigma(V0)]
///     cos g T_tension = dE/dg,   E(g) = min_{e, h} [F(e, h; g) / (p1 p2) - n_ref (e1 + e2)]
///
/// V and a (arm of the pressure) come from the crossing under n_ref at that angle; the radius of the path is
/// held at its unsheared value. The ramp is friction taken as elastic over the first degree: a potential has
/// no jump at rest. Source: docs/theory/mesoscale.md (power balance of the picture frame).
struct ShearModel {
  FabricGeometry fabric;
  CompactionLaw law;
  TensionModel tension;                    ///< of the unsheared fabric: rest length, tow stiffness, bending
  double reference_tension = 800.0;        ///< n_ref [N/m]
  double tow_friction = 0.2;               ///< mu_t [-]
  double ramp_angle = 0.0174532925199433;  ///< g_0 [rad], one degree: prior

  /// F / (p1 p2) - n_ref (e1 + e2) at given strains and crimp heights {warp, weft} [J/m^2].
  double potential(double shear_angle, const std::array<double, 2>& strain,
                   const std::array<double, 2>& height) const;
  /// @throws NumericalError  if the tension cannot be balanced
  LoadedCrossing loaded(double shear_angle) const;
  /// U_lat per initial area, closed form; T_lat is its slope in g [J/m^2].
  double lateral_energy(double shear_angle) const;
  ShearFlow flow(double shear_angle) const;
};

/// dPsi/ds against s = sin g on an even grid: T(g) / cos g.
struct SineGrid {
  double highest = 0.98;  ///< 78.5 deg; tows of Table 1 are packed to V = 0.75 at 77.3 deg
  int points = 197;
};
/// Even grid up to the angle at which the tows, squeezed sideways, would be packed to V = 0.82, at most 0.98.
SineGrid sine_grid(const FabricGeometry& fabric);
/// Never falls: see the comment on snapping in the source. A plain weave of Table 1 needs no holding.
Curve tabulate(const ShearModel& model, const SineGrid& grid);

/// Smallest angle above 20 deg at which the tangent dT/dg is `multiple` times its value at 20 deg [rad].
/// @throws NumericalError  if there is none below the end of the table
double locking_angle(const Curve& shear_stress, double multiple = 10.0);

/// Rate-dependent part: film between turning tows and flow inside them, both power laws of the same index.
///
///     m_s = (m / h_f^n) <2 pi a^(n+3)> / ((n+3) p1 p2)  +  s_in sum_i (A / p) m K
///     K = saturation (1 + V0) / (1 - V0)
///
/// The film covers the geometric contact, with half axes R' sin th along a tow that changes sides, and as far
/// as the section has fallen by h_f, at most that, along one that floats; beyond, there is no resin to fill
/// the gap. <> is the mean over the kinds of quarter crossings, for an ellipse its mean over the angle.
/// K: parallel fibres in a fluid (longitudinal shear), times the share of the tow that is not void.
/// Taken at g = 0.
struct ShearRateParts {
  double film = 0.0;    ///< [N s^n / m]
  double in_tow = 0.0;  ///< [N s^n / m]
};
ShearRateParts shear_rate_parts(const FabricGeometry& fabric, const ResinSpec& resin, double in_tow_share);
ShearRate shear_rate(const FabricGeometry& fabric, const ResinSpec& resin, double in_tow_share);

}  // namespace heddle::mesoscale
