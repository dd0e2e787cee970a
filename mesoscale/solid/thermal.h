#pragma once

#include <span>
#include <vector>

#include "mesoscale/solid/macro_load.h"
#include "mesoscale/solid/micromechanics.h"
#include "mesoscale/solid/voxel_cell.h"

namespace heddle::mesoscale::solid {

/// Free strain of a material with one axis of rotation, per kelvin or of a shrinkage.
struct FreeStrain {
  double axial;       ///< [1/K] or [-]
  double transverse;  ///< the same across
};

/// A tow of parallel fibres in a matrix that expand by alpha_f and alpha_m:
///
///     alpha_L = (E_f alpha_f Vf + E_m alpha_m Vm) / E_L
///     alpha_T = (1 + nu_f) alpha_f Vf + (1 + nu_m) alpha_m Vm - alpha_L nu_LT
///
/// Linear in both, so a shrinkage of the resin alone is alpha_f = 0. Source: Schapery 1968 (recalled).
/// @param fibre_fraction  Vf [-], 0..1
FreeStrain schapery(const IsotropicPhase& fibre, double fibre_strain, const IsotropicPhase& matrix,
                    double matrix_strain, double fibre_fraction);

/// What the contents of a cell would press with if they were held in shape, C : alpha, one vector of the
/// materials for each cause. Voigt [Pa/K] or [Pa].
using HeldStress = std::vector<Vector6>;

/// Contents of several phases are laminates, as in content_stiffness: each layer strains by its own share of
/// the voxel's strain, and by reciprocity (Levin 1967) presses with the same share.
/// @param phases  stiffness of each phase, its axis 1 along the direction [Pa]
/// @param strain  free strain of each phase
HeldStress content_held_stress(const VoxelCell& cell, std::span<const Matrix6> phases,
                               std::span<const FreeStrain> strain);

/// For each load case the integral over the cell of its whole strain field times the held stress [J/K] or
/// [J]: by reciprocity what the cell held at zero mean strain presses with, without a solution of its own.
/// @param u      fluctuations of the solver's load cases, from number `first` on, as it left them
/// @return  of those load cases, the others zero
Vector6 held_work(const ElasticCell& cell, const MacroLoad& load, const Field& u, const CellSolver& solver,
                  int first, const HeldStress& held);

}  // namespace heddle::mesoscale::solid
