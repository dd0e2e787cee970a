#pragma once

#include <array>
#include <vector>

#include "mesoscale/cell.h"
#include "mesoscale/compaction.h"

namespace heddle::mesoscale {

/// Two tows pressed together where they cross. With their crowns brought closer by c, they overlap at (xi,
/// eta) by
///     delta = c - G(xi) - G(eta),   G(u) = section drop - path drop >= 0   (nearly conformal: G is small up
///     to the wrap)
/// which they share by equal stress (PairSqueeze), summed over the overlap of the two tows with true areas.
/// Towards a crossing at which a tow floats its path drop is 0. Along xi the section is the weft's and the
/// path the warp's, along eta the other way round.
/// The gaps are those of the as-woven paths: contact spreads as tows are squeezed, paths keep their radius.
/// Under shear they are carried along with the tow's oblique width, G(u) = G_0(u w / w_o): a loaded crossing
/// is thinner than the as-woven one, so it does not share the jam of the as-woven path. Sections that cut
/// into the path (G < 0) are taken as touching there. The drop is that of the face that meets the other tow:
/// where upper and lower halves differ, crossings with the warp on top and with the weft on top have each
/// their share.
class CrossoverContact {
 public:
  /// @param unsheared  the crossing at g = 0
  /// @param quarters   shares of the kinds of crossing; the mean crossing is taken
  CrossoverContact(const CrossingGeometry& unsheared, double shear_angle, const CompactionLaw& law,
                   const QuarterShares& quarters = plain_quarters);

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
  double approach_at(double fibre_fraction) const { return squeeze_.squeeze_at(fibre_fraction); }

 private:
  /// Quadrature on [0, w_o/2] along one tow.
  struct Line {
    std::vector<double> place, weight;  ///< [m]
    /// G by the family on top, and where the tow {changes sides, floats} [m].
    std::array<std::array<std::vector<double>, 2>, 2> gap;
  };
  static Line line_along(const CrossingGeometry& unsheared, double shear_angle, std::size_t tow);
  template <class Add>
  void for_each_place(double approach, const Add& add) const;

  PairSqueeze squeeze_;
  double shear_angle_;
  std::vector<QuarterKind> kinds_;
  std::array<Line, 2> line_;  ///< along {warp, weft}
};

}  // namespace heddle::mesoscale
