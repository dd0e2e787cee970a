#pragma once

#include "macroscale/stamping.h"

namespace heddle::pipeline {

/// Where a formed blank is sheared: what shapes of one part are compared by.
struct ShearPlace {
  double angle = 0.0;        ///< largest at a node, without sign [rad]
  double flat_radius = 0.0;  ///< of that node from the punch's axis before it moved [m]
  double direction = 0.0;    ///< of that node from the axis, against x, folded into 0 to 90 deg [rad]
  double radius = 0.0;       ///< from the axis, in the formed blank [m]
  double depth = 0.0;        ///< below the level it had in the flat blank [m]
  double deep_rms =
      0.0;  ///< root of the mean square angle of nodes deeper than half the stroke [rad]; 0: none
  double level_rms = 0.0;  ///< the same of nodes that have sunk by less than 2 % of the stroke [rad]; 0: none
};

/// Of several nodes that are sheared alike within a millionth, as symmetry has it, the one nearest to the
/// axis counts.
/// @param stroke  of the punch so far [m], > 0
ShearPlace shear_place(const macroscale::BlankState& blank, double stroke);

}  // namespace heddle::pipeline
