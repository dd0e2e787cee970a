#pragma once

#include <span>
#include <string>

#include "mesoscale/solid/solid_cell.h"

namespace heddle::mesoscale::solid {

/// A phase of a deck: what a voxel that holds it alone is made of, with the axis 1 of the constants along the
/// portion's direction.
struct DeckPhase {
  std::string name;  ///< letters and digits, begins with a letter: "WARP"
  TransverseIsotropy material;
};

/// The cell as an input file that CalculiX runs unmodified: C3D8 elements, millimetres and MPa, and six
/// steps, one mean stress of 1 MPa each in the order 11, 22, 33, 23, 13, 12.
///
/// Three nodes of their own (set DRIVERS, the last of the mesh) carry the displacement U_k of one period L_k
/// along x, y and z; every node on a far face is tied to its image on the near one by equations that name
/// nodes, in dofs 1 to 3: u(far) - u(near) - sum of the drivers crossed = 0. The stress is a force on each
/// driver, V sigma times the dual vector of its period; the strain is the even part of H with H L_k = U_k,
/// which ccx prints to the .dat file. (ccx prints no forces of nodes that only equations hold, so that
/// strains cannot be the load.)
///
/// Voxels of one phase have a section with the phase's engineering constants and an *ORIENTATION along the
/// tow; mixed voxels have the stiffness of their layers (21 constants, global axes).
/// @param phases             of the cell's portions, in order
/// @param content_stiffness  of each content of the cell [Pa]
/// @throws std::invalid_argument  if there are fewer phases than the cell holds, or a voxel is a void: a node
///         without stiffness would stop ccx
std::string ccx_deck(const VoxelCell& cell, std::span<const DeckPhase> phases,
                     std::span<const Matrix6> content_stiffness);

/// The deck of a weave's consolidated state at a trellis angle: phases RESIN, WARP and WEFT.
/// @throws InputError  if check(spec) finds something
std::string ccx_deck(const WeaveSpec& weave, double shear_angle, const SolidSpec& spec);

/// Stiffness out of the .dat file that ccx leaves: the strains of the six steps are the columns of its
/// inverse [Pa].
/// @throws InputError  if it does not hold the displacements of three drivers in six steps
Matrix6 stiffness_from_ccx(const std::string& dat, const std::string& file, const Eigen::Matrix3d& edges);

}  // namespace heddle::mesoscale::solid
