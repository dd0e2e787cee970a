#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "mesoscale/cell_spec.h"
#include "mesoscale/closure.h"
#include "mesoscale/path.h"
#include "mesoscale/section.h"
#include "mesoscale/weave.h"

namespace heddle::mesoscale {

/// A tow of one family as it stands at a crossing, in the parameter plane.
struct TowGeometry {
  double spacing = 0.0;         ///< p: middle to middle of neighbours of the family [m]
  Section section{};            ///< width in the parameter plane, w_o = min(w / cos g, p), rounded
  ArcPath path{};               ///< where it changes sides; its pitch is the spacing of the other family
  double fibre_fraction = 0.0;  ///< V0, glass in the stress-free tow [-]

  bool operator==(const TowGeometry&) const = default;
};

/// Geometry of one crossing at a trellis angle g. Everything stands in the parameter plane (xi, eta) of an
/// orthogonal cell of the same pitch; the fabric is its image under x = xi + eta sin g, y = eta cos g. The
/// map is one-to-one, so tows that are apart stay apart, and it scales all areas by cos g.
///
/// Crimp heights: each family rises by the thickness of the other, h1 = t2 and h2 = t1. So the crowns of both
/// lie at (t1 + t2) / 2, the faces of the fabric are flush, and no path is too steep for the section it goes
/// round as long as tows are no wider than their pitch. Where the weave says otherwise the warps rise by an
/// excess more and the wefts by as much less, as far as the sections leave room; closing gaps take it away.
struct CrossingGeometry {
  double shear_angle = 0.0;          ///< g [rad]
  std::array<TowGeometry, 2> tow{};  ///< {warp, weft}

  double area() const { return tow[0].spacing * tow[1].spacing; }  ///< of one crossing at g = 0 [m^2]
  bool balanced() const { return tow[0] == tow[1]; }
};

/// The fabric as the later rooms read it: one state, no shear yet. Pairs are {warp, weft}.
struct FabricGeometry {
  WeaveMatrix weave;
  QuarterShares quarters{};
  std::array<double, 2> interlacing{};  ///< [-]
  MassBalance mass;
  std::array<double, 2> as_woven_crimp{};      ///< floats included [-]
  std::array<double, 2> tow_solid_fraction{};  ///< [-]
  double thickness = 0.0;                      ///< H of the state [m]
  CrossingGeometry crossing;                   ///< at g = 0
};

/// @param state  as woven or consolidated; compacted asks for a thickness
/// @throws InputError  if weave.pattern is no weave
FabricGeometry fabric_geometry(const WeaveSpec& weave, CellState state);

/// The fabric pressed to thickness H between flat plates. Each direction gives up the same share of what it
/// can, c = (H0 - H) / (H0 - H_c), down to the consolidated thickness H_c: t = (1 - c) t0 + c t_c. Sections
/// keep width and shape, tows their length a pitch and so their glass: V0 rises as the sections shrink.
/// @param thickness  H [m], from the consolidated to the as-woven one
/// @throws InputError  if weave.pattern is no weave
FabricGeometry compacted_geometry(const WeaveSpec& weave, double thickness);

/// As-woven section of one direction. @param direction  0 = warp, 1 = weft
Section section_of(const WeaveSpec& weave, std::size_t direction);

/// The path of a tow of section `own` over tows of section `under`, `pitch` apart: it rises by their
/// thickness and an excess, round the circle that encloses them and half its own thickness further out.
ArcPath path_over(const Section& own, const Section& under, double pitch, double excess = 0.0);

/// The part of an excess of the warps' crimp height for which there is room [m]: a path that rises by h jams
/// at R_jam = (p^2 + h^2) / (4 h), which must not be less than the radius of the section under it.
/// @param spacing  of {warp, weft} [m]
double excess_with_room(const std::array<Section, 2>& section, const std::array<double, 2>& spacing,
                        double excess);
/// Of the as-woven tows.
double excess_with_room(const WeaveSpec& weave, double excess);

/// Trellis angle at which the first neighbouring tows touch, acos(w / p) [rad].
double gap_closure_angle(const TowGeometry& unsheared);
double gap_closure_angle(const CrossingGeometry& unsheared);

/// Tow widths scatter about their mean, so gaps close one after another: min(w / cos g, p) is rounded by a
/// parabola while w / cos g is within this share of the pitch. A prior; it keeps forces continuous at gap
/// closure.
inline constexpr double width_scatter = 0.05;

/// Width of a tow in the parameter plane, min(w / cos g, p) rounded, and its slope.
struct OpenWidth {
  double width;  ///< w_o [m]
  double slope;  ///< d w_o / dg [m/rad]
};
OpenWidth oblique_width(const TowGeometry& unsheared, double shear_angle);

/// The crossing at trellis angle g (sign ignored), |g| < 90 deg. Until the gaps close, the tow turns
/// unchanged; from there its true width is p cos g at constant thickness, and V0 rises by cos g* / cos g
/// (drained: resin that has no room flows into the pores between the tows).
CrossingGeometry sheared(const CrossingGeometry& unsheared, double shear_angle);

/// One repeat with every tow, for sampling, pictures and the penetration check. Lengths in the parameter
/// plane.
struct UnitCell {
  struct Tow {
    double spacing;  ///< middle to middle of neighbours [m]
    Section section;
    Path path;  ///< over one spacing of the other family
  };
  WeaveMatrix weave;
  std::array<Tow, 2> tow;  ///< {warp, weft}
  double shear_angle;      ///< [rad]

  double crown() const;  ///< highest point of any tow above the mid-plane [m]
  std::array<double, 2> size() const {
    return {tow[1].spacing * weave.wefts, tow[0].spacing * weave.warps};
  }  ///< along {xi, eta}
  /// Point of the fabric plane above (xi, eta) [m].
  std::array<double, 2> place(double xi, double eta) const;
};

UnitCell unit_cell(const WeaveMatrix& weave, const CrossingGeometry& crossing);
UnitCell unit_cell(const FabricGeometry& fabric, double shear_angle);

/// A fabric that was sheared and then consolidated, without voids: its area has shrunk by cos g, so it is
/// thicker by 1 / cos g. Tows are as wide as sheared, fill the thickness as the unsheared ones do, and hold
/// their glass.
struct PressedFabric {
  CrossingGeometry crossing;
  double thickness;  ///< [m]
};
/// @param consolidated  at g = 0
PressedFabric pressed(const FabricGeometry& consolidated, double shear_angle);

/// The same tows `factor` times as thick: as wide as before, with the same glass in larger sections.
CrossingGeometry thickened(const CrossingGeometry& crossing, double factor);

/// Height of a tow's centreline above the mid-plane at distance `along` from the tow's first crossing [m].
double warp_centre(const UnitCell& cell, int warp, double along);
double weft_centre(const UnitCell& cell, int weft, double along);

/// What stands above one point of the parameter plane. Warp i runs along xi at eta = i p, weft j along eta at
/// xi = j p; at most one of each covers a point.
struct Column {
  bool warp = false, weft = false;                                              ///< is there one
  double warp_top = 0.0, warp_bottom = 0.0, weft_top = 0.0, weft_bottom = 0.0;  ///< z [m]
};
Column column(const UnitCell& cell, double xi, double eta);

/// How far tows reach into each other on an even grid of samples per pitch.
struct Penetration {
  double depth;       ///< largest overlap of two tows in z; 0 = they touch, negative = apart [m]
  double volume;      ///< positive overlaps [m^3 per repeat]
  double tow_volume;  ///< all tows, sampled on the same grid [m^3 per repeat]
};
Penetration penetration(const UnitCell& cell, int samples_per_pitch);

/// Upper and lower face on n x n samples of one repeat (cell centres of the parameter plane), row-major, xi
/// fastest.
struct HeightField {
  int n = 0;
  std::array<double, 2> along_warp{}, along_weft{};  ///< edges of the repeat in the fabric plane [m]
  std::vector<double> top, bottom;                   ///< z [m]; 0 where no tow is
  std::vector<std::uint8_t> covered;                 ///< 1 where a tow is
};
HeightField height_field(const UnitCell& cell, int n);

}  // namespace heddle::mesoscale
