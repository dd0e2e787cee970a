#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>

#include "macroscale/system.h"

namespace heddle::macroscale {

/// Where the energy of one step went [J]: work in, energy stored, energy dissipated. Each entry is computed
/// for itself, from forces at the end of the step times increments; none is a remainder.
struct StepLedger {
  double work_driven = 0.0;  ///< by driven tools (the punch), or by the drive of sprung ones
  double work_loaded = 0.0;  ///< by forces on loaded tools (the binder)
  double work_held = 0.0;    ///< by supports that move
  double work_dead = 0.0;    ///< by dead loads on nodes and the weight of loaded tools
  double press = 0.0;        ///< change of the energy in springs of tools
  double tow = 0.0, shear = 0.0, bending = 0.0, twist = 0.0, compaction = 0.0;  ///< change of stored energy
  double kinetic = 0.0;                                                         ///< change of kinetic energy
  double compaction_plies = 0.0;  ///< change of what is stored between plies
  std::vector<double> friction;   ///< dissipated at each tool, and behind them between plies
  double shear_rate = 0.0;        ///< dissipated by rate-dependent shear: force times increment
  double shear_hysteresis = 0.0;  ///< dissipated between tows that turn at their crossovers
  double tow_rate = 0.0;          ///< dissipated by tows that resist the rate of their stretch
  double artefact = 0.0;          ///< dissipated by the stabilisation switch
  double numerical = 0.0;  ///< of backward Euler: 1/2 |dv|^2_M and the second-order part of each stored term
  double pairing =
      0.0;  ///< part of `numerical`: plies meet elsewhere at the end than where they were held to
  double friction_outside = 0.0;  ///< share of friction done outside the calibrated box [J]

  double stored() const {
    return tow + shear + bending + twist + compaction + compaction_plies + kinetic + press;
  }
  double dissipated() const;
  double work() const { return work_driven + work_loaded + work_held + work_dead; }
  double residual() const { return work() - stored() - dissipated(); }
};

/// Forces on each tool by the fabric, and the balance of the blank.
struct StepForces {
  std::vector<Eigen::Vector3d> on_tool;  ///< by the fabric on tool k [N]
  Eigen::Vector3d by_supports =
      Eigen::Vector3d::Zero();  ///< on the blank, by what holds its held unknowns [N]
  double imbalance = 0.0;       ///< |sum of forces on the blank - sum m a| [N]
};

struct StepAccount {
  StepLedger ledger;
  StepForces forces;
};

StepAccount account(const System& system, const StepData& step, const State& end);

}  // namespace heddle::macroscale
