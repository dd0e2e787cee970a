#pragma once

#include <vector>

#include "mesoscale/cell.h"
#include "mesoscale/compaction.h"

namespace heddle::mesoscale {

/// Two tows pressed together where they cross. With their crowns brought closer by c, they overlap at (xi,
/// eta) by
///     delta = c - G(xi) - G(eta),   G(u) = lens drop - path drop >= 0   (nearly conformal: G is small up to
///     the wrap)
/// and each takes half of it. Stress by TowSqueeze, summed over the overlap of the two tows with true areas.
/// The gaps are those of the as-woven paths: contact spreads as tows are squeezed, paths keep their radius.
/// Under shear they are carried along with the tow's oblique width, G(u) = G_0(u w / w_o): a loaded crossing
/// is thinner than the as-woven one, so it does not share the jam of the as-woven path.
class CrossoverContact {
 public:
  /// @param unsheared  the crossing at g = 0
  CrossoverContact(const CrossingGeometry& unsheared, double shear_angle, const CompactionLaw& law);

  struct Value {
    double energy;     ///< U_c of both tows [J]
    double force;      ///< V = dU_c/dc [N]
    double stiffness;  ///< dV/dc [N/m]
  };
  Value evaluate(double approach) const;
  double force(double approach) const;  ///< V alone, cheaper [N]
  /// Mean distance from the crossing's centre at which the pressure acts, int s r dA / int s dA [m]: the arm
  /// of friction when one tow turns on the other. At approach 0 that of the whole overlap.
  double arm(double approach) const;
  /// Approach at which the most squeezed fibres reach volume fraction V [m].
  double approach_at(double fibre_fraction) const { return 2.0 * squeeze_.squeeze_at(fibre_fraction); }

 private:
  TowSqueeze squeeze_;
  double shear_angle_;
  std::vector<double> place_, weight_, gap_;  ///< quadrature on [0, w_o/2]: distance, weight, G [m]
};

}  // namespace heddle::mesoscale
