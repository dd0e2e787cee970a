#pragma once

#include <array>
#include <vector>

#include "core/curve.h"
#include "mesoscale/cell.h"
#include "mesoscale/compaction.h"
#include "mesoscale/fabric_properties.h"

namespace heddle::mesoscale {

/// A rigid flat plate pressed by d below the crowns of the upper face. Above a quarter crossing (u along the
/// upper tow a, v across it, up to half a pitch of the lower tow b and of a) the faces lie below the crown
/// plane by
///     upper tow: D_a(u) + L_a(v), v <= w_a/2      lower tow: h_b - D_b(v) + L_b(u), u <= w_b/2
/// with L the section drop and D the path drop of a step that changes sides (0 where the tow floats); where
/// faces are not flush, both further down by what the crowns of a and b lie below the highest. So for
/// each u the touched v form intervals with closed-form ends, and only u is left to integrate. See
/// docs/theory/mesoscale.md.
struct PlateContact {
  CrossingGeometry crossing;
  QuarterShares quarters;
  std::array<TowSqueeze, 2> squeeze;  ///< of a {warp, weft}
  int panels = 8;                     ///< six-point panels between kinks along u

  /// phi: touched area over cell area; the shear map scales both alike [-].
  double touched_fraction(double depth) const;
  /// P(d) = (1 / A) int s(d - depth of the face) dA, per CURRENT area of the sheared fabric [Pa].
  double pressure(double depth) const;
  /// The depth at which P is reached [m].
  /// @throws NumericalError  if not even fibres packed to V = 1.2 carry it, or the bracket does not hold it
  double depth_at(double pressure) const;
  double depth_between(double pressure, double shallow, double deep) const;  ///< the same inside a bracket
};

PlateContact plate_contact(const FabricGeometry& fabric, const CompactionLaw& law, double shear_angle);

/// phi = 2 pi d sqrt(R R') / p^2, mean of both families, with R at the crown: crowns as paraboloids, for
/// small d in a plain weave [-].
double shallow_touched_fraction(const CrossingGeometry& crossing, double depth);

struct ContactTables {
  CurveFamily compaction;  ///< P [Pa] against d [m], parameter g
  ContactArea contact;
  double grid_error = 0.0;  ///< largest relative change of phi and P against half the panels [-]
};

struct ContactGrid {
  std::vector<double> shear_angles_deg{0, 10, 20, 30, 40, 50, 60};
  double lowest_pressure =
      10.0;  ///< of the area table [Pa]; below, phi ~ sqrt(P), which the held log slope follows
  double highest_pressure = 6e6;  ///< [Pa]
  int pressures = 57;             ///< even in ln P
  int depths = 128;               ///< even in d, from 0
};
ContactTables contact_tables(const FabricGeometry& fabric, const CompactionLaw& law,
                             const ContactGrid& grid = {});

}  // namespace heddle::mesoscale
