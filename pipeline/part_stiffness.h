#pragma once

#include <string>
#include <vector>

#include "macroscale/stamping.h"
#include "mesoscale/solid/solid_cell.h"

namespace heddle::pipeline {

/// Stiffness of one cell of the formed blank once it is solid, in axes of its own: 1 along the warp, 3 normal
/// to the cell, 2 across both.
struct CellStiffness {
  std::array<int, 2> cell{};                       ///< grid lines (i, j) of its first corner
  std::array<double, 3> centre{};                  ///< [m]
  std::array<double, 3> warp{}, weft{}, normal{};  ///< unit
  double shear_angle = 0.0;                        ///< trellis, signed [rad]
  bool beyond_table = false;                       ///< sheared further than the table: its end is taken
  double thickness = 0.0;                          ///< [m]
  double tow_fibre_fraction = 0.0;                 ///< of its fuller tows [-]
  mesoscale::solid::Matrix6 plate;                 ///< [A B; B D]
  mesoscale::solid::Vector6 expansion{};           ///< {N, M} where it is held flat, a kelvin
  mesoscale::solid::Matrix6 stack;                 ///< C of many such cells on one another, Voigt [Pa]
  mesoscale::solid::Vector6 stack_held{};          ///< stress where that is held in shape [Pa/K]
  double crystallised = 0.0;                       ///< mean of its nodes [-]
};

/// The hand-over to a structural model: every cell of the blank with the stiffness that the weave's solid
/// part has at the cell's trellis angle, smooth between the angles of the table. A table without negative
/// angles is taken as that of a weave which is its own mirror image along the warp (every plain weave is):
/// terms that couple shear with the rest change sign.
/// @param table  at least two different angles
/// @throws std::invalid_argument  if it has fewer
std::vector<CellStiffness> part_stiffness(const macroscale::BlankState& blank,
                                          const std::vector<mesoscale::solid::ShearedSolid>& table);

/// One row a cell.
std::string part_stiffness_csv(const std::vector<CellStiffness>& cells);

}  // namespace heddle::pipeline
