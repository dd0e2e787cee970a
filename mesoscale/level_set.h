#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "core/level_set.h"
#include "mesoscale/cell.h"
#include "mesoscale/pictures.h"

namespace heddle::mesoscale {

/// One tow of a repeat, cut flat half a pitch before its first crossing and one repeat further on, so that
/// every crossing of the repeat stands whole between the cuts.
struct TowPiece {
  TowDirection direction = TowDirection::warp;
  int index = 0;
};
std::vector<TowPiece> tow_pieces(const UnitCell& cell);

/// Signed distance of a place in the fabric plane to the tow's surface, cuts included [m]; negative inside.
///
/// The section is a vertical cut swept along the path, so the gap in z times cos(slope) is the distance to
/// first order only. Here the foot point on each face S(u, v) = (place(u, v), c(u) +- f(v)) is found by
/// Newton's method on |q - S|^2 with u and v held on the piece; the distance is second order in what is left
/// of its error. Valid near the tow (within its thickness), where the foot point is one of those the starts
/// find.
double tow_distance(const UnitCell& cell, const TowPiece& tow, const std::array<double, 3>& place);

/// The tow as a narrow band, sampled from tow_distance.
/// @param voxel  [m]
/// @throws InputError  if the voxel is more than a fifth of the tow thickness
LevelSet tow_level_set(const UnitCell& cell, const TowPiece& tow, double voxel,
                       double half_width_voxels = 2.5);

/// What the level sets of all tows of one repeat say about the closed forms.
struct LevelSetCheck {
  double voxel = 0.0;                      ///< [m]
  std::vector<TowPiece> tows;              ///< warps, then wefts
  std::vector<double> tow_volume;          ///< by level set [m^3], as tows
  std::vector<double> closed_form_volume;  ///< of each: area x pitch x crossings x cos g [m^3]
  double closed_form_total = 0.0;          ///< of all tows [m^3]
  double overlap_volume = 0.0;             ///< voxels inside a warp and a weft [m^3 per repeat]
  double overlap_share = 0.0;              ///< overlap_volume over closed_form_total [-]
  double largest_depth = 0.0;              ///< how deep a voxel lies in two tows; <= 0: apart [m]
  std::size_t memory = 0;                  ///< of all level sets [byte]
};
LevelSetCheck level_set_check(const UnitCell& cell, double voxel);

/// The check in six numbers, as every run states it.
struct TowBodies {
  double voxel = 0.0;          ///< [m]
  double volume_error = 0.0;   ///< largest over the tows, of section area times length [-]
  double overlap_share = 0.0;  ///< of the tow volume, in voxels inside a warp and a weft [-]
  double overlap_depth = 0.0;  ///< how deep a voxel lies in both; < 0: how far they stay apart [m]
  double height_depth =
      0.0;  ///< overlap in z by the closed forms, on 64 x 64 places a crossing; 0 = they touch [m]
  double height_volume = 0.0;  ///< the same, summed [m^3 per repeat]
};
/// With voxels of 2/15 of the thickness of the thinner tow.
TowBodies tow_bodies(const UnitCell& cell);

}  // namespace heddle::mesoscale
