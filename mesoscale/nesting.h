#pragma once

#include <array>
#include <vector>

#include "mesoscale/cell.h"
#include "mesoscale/state.h"

namespace heddle::mesoscale {

/// Where a ply lies against the lowest of its stack: {along warp, along weft} in the parameter plane [m].
using PlyShift = std::array<double, 2>;

/// How far the middle of one ply stands above that of an equal ply below it where they touch and nowhere
/// overlap [m].
///
/// A face of a tow is a function of xi plus one of eta: its path along the tow, its section across. So the
/// largest overlap of two tows is the largest value of one function of xi plus that of one of eta, and the
/// approach is the largest of these over all pairs of tows: exact but for rounding, without a grid in the
/// plane. At most the thickness of a ply; for crowns on crowns just that.
double closest_approach(const UnitCell& ply, const PlyShift& shift);

/// Equal plies on one another.
struct PlyStack {
  UnitCell ply;
  std::vector<PlyShift> shift;
  std::vector<double> height;  ///< of the plies' middles above that of the lowest [m], rising
  double thickness = 0.0;      ///< crown to crown [m]

  /// A ply's middle above that of the stack [m].
  double middle(std::size_t ply_index) const { return height[ply_index] - 0.5 * height.back(); }
};

/// Each ply sunk into those below it until it touches one of them. Plies further down count as well: through
/// gaps a ply may reach the next but one.
/// @param shift  of each ply, at least one
PlyStack nested(const UnitCell& ply, const std::vector<PlyShift>& shift);

/// Largest overlap of two tows of different plies on an even grid of samples a pitch; negative: they are
/// apart [m]. A check of `nested` that shares nothing with it.
double sampled_overlap(const PlyStack& stack, int samples_per_pitch);

/// A stack in the fabric's state, with what it is made of.
struct StackedFabric {
  PlyStack stack;
  CrossingGeometry crossing;  ///< of a ply in the stack
  SheetShares shares;
  double swelling = 1.0;  ///< tow thickness over that of the lone ply [-]; 1 unless consolidated
};

/// As woven and compacted: tows keep their sections, plies nest, and voids shrink. Glass and resin need their
/// room all the same, so nested plies stay as far apart as these ask for.
StackedFabric stacked(const FabricGeometry& fabric, double shear_angle, const std::vector<PlyShift>& shift);

/// Consolidated: without voids the stack is as thick as its mass says, however the plies lie. What nesting
/// gives back goes to the tows, which swell until the nested stack has that thickness.
StackedFabric consolidated_stack(const FabricGeometry& consolidated, double shear_angle,
                                 const std::vector<PlyShift>& shift);

/// The stack that the specification asks for, in its state, not sheared.
StackedFabric stacked(const CellSpec& spec);

/// Numbers of a stack for records and reports.
struct StackSummary {
  int plies = 0;
  double thickness = 0.0;  ///< [m]
  double apart = 0.0;      ///< as many plies one on the other without nesting [m]
  double swelling = 1.0;   ///< StackedFabric::swelling [-]
  SheetShares shares;
};
StackSummary summary_of(const StackedFabric& fabric, double ply_thickness);

/// Thickness of two plies over the shift of the upper one, over one repeat: n x n, along warp fastest.
struct NestingMap {
  int n = 0;
  std::array<double, 2> step{};   ///< of the shift along {warp, weft} [m]
  std::vector<double> thickness;  ///< [m]
};
NestingMap nesting_map(const UnitCell& ply, int n);

}  // namespace heddle::mesoscale
