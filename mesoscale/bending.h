#pragma once

#include <array>

#include "core/curve.h"
#include "mesoscale/cell.h"

namespace heddle::mesoscale {

/// Bending stiffness per width along one tow direction, and its bounds [N m].
///
///     sliding: B_s = A_f E_f d_f^2 / (16 p)            every fibre bends on its own
///     bonded:  B_b = A_f E_f (<z_c^2> + I/A) / p        glass at its place in the consolidated sheet, one
///     curvature B = B_s^(1 - chi) B_b^chi                         geometric: the bounds lie a factor of
///     hundreds apart
///
/// <z_c^2> is the mean over the tow's path, I/A that of its section. chi = forming.bonding is a prior.
/// Source: docs/theory/mesoscale.md; the voxel cell gives 5.0e-2 N m for the bonded solid with resin.
struct BendingStiffness {
  double sliding, bonded, value;
};

struct BendingInput {
  double fibre_modulus;   ///< E_f [Pa]
  double fibre_diameter;  ///< d_f [m]
  double bonding;         ///< chi [-], 0..1
};
/// @param consolidated  the fabric in the consolidated state (its mass balance holds A_f)
std::array<BendingStiffness, 2> bending_stiffness(const FabricGeometry& consolidated,
                                                  const BendingInput& input);

/// Constant in temperature until something is measured: two points, 273.15 K and 573.15 K.
Curve constant_in_temperature(double value);

}  // namespace heddle::mesoscale
