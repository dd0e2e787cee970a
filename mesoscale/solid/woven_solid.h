#pragma once

#include <array>
#include <vector>

#include "mesoscale/solid/solid_cell.h"

namespace heddle::mesoscale::solid {

/// A weave as voxels, with what its contents are made of.
struct WovenSolid {
  VoxelCell cell;
  std::array<TransverseIsotropy, 2> tows;  ///< {warp, weft}
  std::vector<Matrix6> stiffness;          ///< of each content [Pa]
  std::vector<HeldStress> held;            ///< by HeldCause
};

WovenSolid woven_solid(const WeaveMatrix& weave, const PressedFabric& fabric, double fibre_modulus,
                       const SolidSpec& spec);
/// Of plies on one another.
WovenSolid woven_solid(const StackedFabric& fabric, double fibre_modulus, const SolidSpec& spec);

}  // namespace heddle::mesoscale::solid
