#pragma once

#include "mesoscale/solid/cell_solver.h"
#include "mesoscale/solid/thermal.h"

namespace heddle::mesoscale::solid {

/// How well the numbers of one homogenisation hold together.
struct HomogenisationChecks {
  /// Largest over the load cases of |mean(sigma : epsilon) - mean(sigma) : E| over the energy (Hill-Mandel)
  double hill_mandel = 0.0;
  /// |C - C^T| / |C| of the stiffness taken from mean stresses. The one that is returned comes from energies:
  /// symmetric by construction, and with an error that is the square of the fields'.
  double asymmetry = 0.0;
};

/// Effective stiffness of a cell that repeats in x, y and z.
struct PeriodicStiffness {
  Matrix6 stiffness;  ///< Voigt [Pa]
  Matrix6 voigt;      ///< mean stiffness, upper bound [Pa]
  Matrix6 reuss;      ///< inverse of the mean compliance, lower bound [Pa]; zero where the cell has voids
  /// Mean stress with which the cell presses where it is held in shape, of each cause:
  /// sigma = C E - held [Pa/K] or [Pa]
  std::vector<Vector6> held;
  SolverSummary solver;
  HomogenisationChecks checks;
  std::size_t memory = 0;  ///< of the solver [byte]
};

/// @param held  of the cell's materials, for each cause (thermal.h)
/// @throws NumericalError  if the mean stiffness is not positive definite
PeriodicStiffness periodic_stiffness(const ElasticCell& cell, const SolverOptions& options = {},
                                     std::span<const HeldStress> held = {});

/// Effective stiffness of a plate: a cell that repeats in x and y and has free faces.
///
///     u = (E + z K) . x + w,  w periodic;   {N, M} = [A B; B D] {E, K}
///
/// in the limit of a cell thin against the wave of the load, with strains and curvatures 11, 22, 12
/// (engineering) about the middle of the cell.
/// Source: Caillerie 1984, Kohn and Vogelius 1984 (recalled).
struct PlateStiffness {
  Eigen::Matrix3d a;  ///< [N/m]
  Eigen::Matrix3d b;  ///< [N]
  Eigen::Matrix3d d;  ///< [N m]
  Matrix6 all;        ///< [A B; B D]
  void set_parts();   ///< A, B and D from it
  Matrix6 upper;      ///< the same of fields without w: upper bound
  /// {N, M} with which the plate presses where it is held flat, of each cause:
  /// {N, M} = [A B; B D] {E, K} - held [N/m, N] a kelvin, or a unit of strain
  std::vector<Vector6> held;
  SolverSummary solver;
  HomogenisationChecks checks;
  std::size_t memory = 0;  ///< of the solver [byte]
};

/// @throws NumericalError  if the mean stiffness is not positive definite
PlateStiffness plate_stiffness(const ElasticCell& cell, const SolverOptions& options = {},
                               std::span<const HeldStress> held = {});

/// Mean over the voxels [Pa].
Matrix6 mean_stiffness(const ElasticCell& cell);

}  // namespace heddle::mesoscale::solid
