#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "mesoscale/cell_spec.h"
#include "mesoscale/solid/homogenise.h"
#include "mesoscale/solid/micromechanics.h"
#include "mesoscale/solid/sampler.h"
#include "mesoscale/solid/voxel_file.h"

namespace heddle::mesoscale::solid {

/// The solid part of a weave: cold, consolidated. SI units.
struct SolidSpec {
  SamplerOptions grid;
  TowModel tow_model = TowModel::chamis;
  double fibre_poisson = 0.22;        ///< of glass [-]; prior
  IsotropicPhase resin{1.5e9, 0.40};  ///< solid polypropylene; prior
  double fibre_expansion = 5e-6;      ///< of E-glass [1/K]; recalled
  double resin_expansion = 1.2e-4;  ///< of solid polypropylene [1/K], linear; recalled, grades differ by 30 %
  std::vector<double> shear_angles;  ///< trellis angles of the table, besides the unsheared ply [rad]
  StackSpec stack;                   ///< plies of a laminate, besides the lone ply; one: no laminate
  SolverOptions solver;
};

/// Ranges (keys of the configuration file below "solid").
Problems check(const SolidSpec& spec);

/// Two numbers that are the same in a balanced weave.
struct BalancePair {
  std::string first_name, second_name;  ///< "C11", "C22"
  double first, second;                 ///< in SI
  std::string unit;                     ///< in which they are shown: "MPa"
  double per_unit;                      ///< times SI
  double gap() const;                   ///< relative to the larger [-]
};

/// Causes of free strain in PlateStiffness::held and PeriodicStiffness::held of a weave.
enum HeldCause : std::size_t {
  expansion,  ///< one kelvin in glass and resin
  shrinkage,  ///< a linear strain of one in the resin alone: crystallisation, by its negative
  held_causes
};

/// The consolidated fabric after shear by a trellis angle: axis 1 along the warp, the weft at 90 deg less the
/// angle.
struct ShearedSolid {
  double shear_angle = 0.0;                       ///< [rad]
  double thickness = 0.0;                         ///< [m]
  double fibre_fraction = 0.0;                    ///< of its fuller tows [-]
  bool converged = false;                         ///< ply and stack
  Matrix6 plate;                                  ///< [A B; B D] of the ply
  Matrix6 stack;                                  ///< C of the stack [Pa]
  std::array<Vector6, held_causes> plate_held{};  ///< {N, M}
  std::array<Vector6, held_causes> stack_held{};  ///< [Pa/K] and [Pa]
};

/// Plies consolidated together (nesting.h), unsheared.
struct LaminateSolid {
  int plies = 0;
  double thickness = 0.0;       ///< [m]
  double swelling = 1.0;        ///< tow thickness over that of the lone ply [-]
  double fibre_fraction = 0.0;  ///< of its fuller tows [-]
  double tow_share = 0.0;       ///< volume of the tows [-]
  bool converged = false;
  Matrix6 plate;  ///< [A B; B D] of the laminate
  Matrix6 apart;  ///< of as many lone plies by classical lamination: a lower bound where plies do not nest
};

/// [A B; B D] of equal plies on one another that bend and stretch together but otherwise know nothing of
/// each other. @param ply  [A B; B D] of one  @param thickness  of one [m]
Matrix6 laminated(const Matrix6& ply, double thickness, int plies);

struct SolidResult {
  std::array<int, 3> voxels{};
  double thickness = 0.0;                  ///< of the cell [m]
  std::optional<PlateStiffness> plate;     ///< of one ply with free faces; absent for a periodic voxel file
  std::optional<PeriodicStiffness> stack;  ///< of plies on one another without end; absent for a voxel plate
  /// Of a weave: what its tows are made of, {warp, weft}
  std::optional<std::array<TransverseIsotropy, 2>> tow;
  double tow_share = 0.0;  ///< of a weave: volume of the tows [-]
  std::size_t different_voxels = 0;
  std::vector<ShearedSolid> sheared;  ///< of a weave, at the angles asked for
  std::optional<LaminateSolid> laminate;
  bool balanced = true;              ///< warp and weft can be exchanged, as far as is known
  std::vector<BalancePair> balance;  ///< all that were compared: none if they cannot
};

/// What a balanced weave has twice; nothing of one that is not.
std::vector<BalancePair> balance_of(const SolidResult& result);

/// Those that differ by more than 0.1 %: from an unbalanced weave, or from axes in the wrong order.
std::vector<BalancePair> imbalances(const SolidResult& result);

/// The weave's consolidated state by sampled voxels, whatever state its forming laws are for.
/// @throws InputError      if the weave or the specification has problems
/// @throws NumericalError  as the solver
SolidResult analyse(const WeaveSpec& weave, const SolidSpec& spec);

/// One ply of the weave's consolidated state with free faces, at a trellis angle; without the stack and the
/// thermal resultants, which take longer than the ply.
struct Ply {
  double thickness = 0.0;  ///< [m]
  PlateStiffness stiffness;
};
/// @throws as analyse
Ply ply(const WeaveSpec& weave, double shear_angle, const SolidSpec& spec);

/// The free strains that `held` of a result makes, {E, K} of the ply or the strain of the stack.
Vector6 free_strain(const Matrix6& stiffness, const Vector6& held);

/// A cell from a voxel file.
/// @param solver  except for the load cases side by side, which the file's specification gives
/// @throws InputError  if check(spec) finds something
SolidResult analyse(const VoxelFileSpec& spec, SolverOptions solver = {});

}  // namespace heddle::mesoscale::solid
