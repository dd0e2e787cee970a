#pragma once

#include <array>
#include <string>

#include "macroscale/stamping.h"

namespace heddle::macroscale {

/// How far the grid of the blank moves the answer: one companion run on about twice the spacing, same steps.
/// Each error is the change from the companion to the run, divided by (spacing ratio - 1): what is left if
/// errors shrink in proportion to the spacing, and three times what is left if they shrink with its square.
/// It is an estimate, not a bound; docs/decisions/grid-error.md says how it fared where finer grids were run.
struct GridError {
  bool known = false;
  std::string reason;               ///< why not, when not known
  std::array<double, 2> spacing{};  ///< of the companion [m]
  int nodes = 0;                    ///< of the companion
  double companion_force = 0.0;     ///< its peak punch force [N]
  double force =
      0.0;  ///< the largest over the stroke, so that curves that cross at the peak hide nothing [N]
  double force_share = 0.0;         ///< of the peak punch force [-]
  double extrapolated_force = 0.0;  ///< peak punch force at zero spacing, were the error of first order [N]
  double shear_angle = 0.0;         ///< of the largest shear angle [rad]
  double draw_in = 0.0;             ///< of the largest draw-in [m]
};

/// The case on a grid of half as many cells each way (rounded up), everything else the same.
StampingSpec coarse_companion(const StampingSpec& spec);

/// Compares two runs of one case. Neither is run again; either may have stopped, then `reason` says so.
GridError compare_grids(const StampingResult& run, const StampingResult& companion);

/// Runs the companion of a case that was run, and compares. Costs about a sixth of the run.
/// Where the companion's grid would be too coarse to be run, the error is not known, and `reason` names the
/// rule; nor is it where `control` stopped the companion.
GridError grid_error(const StampingSpec& spec, const mesoscale::FabricProperties& fabric,
                     const friction::Model& friction, const StampingResult& run,
                     const StampingControl& control = {});

}  // namespace heddle::macroscale
