#include "mesoscale/solid/woven_solid.h"

#include <utility>

namespace heddle::mesoscale::solid {

namespace {

WovenSolid filled(VoxelCell cell, const CrossingGeometry& crossing, double fibre_modulus,
                  const SolidSpec& spec) {
  const IsotropicPhase fibre{fibre_modulus, spec.fibre_poisson};
  const auto& [warp, weft] = crossing.tow;
  WovenSolid solid;
  solid.cell = std::move(cell);
  solid.tows = {tow(spec.tow_model, fibre, spec.resin, warp.fibre_fraction),
                tow(spec.tow_model, fibre, spec.resin, weft.fibre_fraction)};
  const std::array phases{stiffness(spec.resin), stiffness(solid.tows[0]), stiffness(solid.tows[1])};
  solid.stiffness = content_stiffness(solid.cell, phases);
  const auto held = [&](double fibre_strain, double resin_strain) {
    const auto of_tow = [&](const TowGeometry& t) {
      return schapery(fibre, fibre_strain, spec.resin, resin_strain, t.fibre_fraction);
    };
    const std::array strains{FreeStrain{resin_strain, resin_strain}, of_tow(warp), of_tow(weft)};
    return content_held_stress(solid.cell, phases, strains);
  };
  solid.held = {held(spec.fibre_expansion, spec.resin_expansion), held(0.0, 1.0)};
  return solid;
}

}  // namespace

WovenSolid woven_solid(const WeaveMatrix& weave, const PressedFabric& fabric, double fibre_modulus,
                       const SolidSpec& spec) {
  return filled(sample(unit_cell(weave, fabric.crossing), fabric.thickness, spec.grid), fabric.crossing,
                fibre_modulus, spec);
}

WovenSolid woven_solid(const StackedFabric& fabric, double fibre_modulus, const SolidSpec& spec) {
  return filled(sample(fabric.stack, spec.grid), fabric.crossing, fibre_modulus, spec);
}

}  // namespace heddle::mesoscale::solid
