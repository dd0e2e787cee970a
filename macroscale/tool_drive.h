#pragma once

#include "macroscale/tools.h"

namespace heddle::macroscale {

/// What moves a tool that has an unknown of its own, at one value of that unknown.
struct Drive {
  double energy = 0.0;         ///< of force, weight and spring together [J]
  double force = 0.0;          ///< its derivative: downwards, all of it [N]
  double stiffness = 0.0;      ///< d force / du [N/m]
  double spring_energy = 0.0;  ///< of the spring alone [J]
  double spring_force = 0.0;   ///< [N]
};

/// @param u  the tool's unknown: its displacement (Motion::loaded), or how far it stays behind its drive,
/// upwards
///           positive (Motion::sprung) [m]
Drive drive_at(const Tool& tool, double u);

/// The same of a lift of a tilting tool: its springs alone, for its force and weight act at its pivot.
Drive tilt_drive_at(const Tool& tool, double lift);

}  // namespace heddle::macroscale
