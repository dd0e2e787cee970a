#pragma once

#include "mesoscale/solid/cell_solver.h"

namespace heddle::mesoscale::solid {

/// The mean deformation of each load case: strain = stretch + z curvature, Voigt form. Curvature has
/// components 11, 22, 12 only.
struct MacroLoad {
  std::array<Vector6, loads> stretch;    ///< [-]
  std::array<Vector6, loads> curvature;  ///< [1/m]
};

/// The six unit strains.
MacroLoad unit_strains();
/// Unit strains 11, 22, 12, then unit curvatures 11, 22, 12.
MacroLoad unit_plate_loads();

/// Height of the middle of a layer of voxels over the middle of the cell [m].
double layer_height(const ElasticCell& cell, int layer);

/// Nodal forces that the mean deformation leaves to the fluctuation, - B^T C (E + z K), exact over each
/// voxel.
/// @param first  load case that comes first in the field, of as many as the solver has side by side
void add_forces(const ElasticCell& cell, const MacroLoad& load, const CellSolver& solver, Field& force,
                int first = 0);

/// Energy products of the mean deformations alone, sum over the voxels of V (E_a + z K_a) : C : (E_b + z K_b)
/// [J].
Matrix6 macro_energy(const ElasticCell& cell, const MacroLoad& load);

}  // namespace heddle::mesoscale::solid
