#pragma once

#include <array>

#include <Eigen/Core>

#include "macroscale/tools.h"

namespace heddle::macroscale {

/// Where a tool stands, from where its shape says: up along z and, where it tilts, turned a little about
/// level axes through its pivot. A point x of space is where the tool as drawn has
///     y = x - z e_z - theta x (x - pivot),   theta = lift / arm,
/// the turn to first order: an angle of 0.01 rad is off by 5e-5 of every length.
struct Pose {
  double z = 0.0;                ///< [m]
  std::array<double, 2> lift{};  ///< at the arm of its Tilt, of the turns about x and y [m]
};

/// Distance to the tool where it stands.
Distance distance(const Tool& tool, const Pose& pose, const Eigen::Vector3d& x);

/// How far the tool's material at x moved from one pose to another [m].
Eigen::Vector3d carried(const Tool& tool, const Pose& from, const Pose& to, const Eigen::Vector3d& x);

/// Angle between the tool's face and level [rad]; 0 where it does not tilt.
double angle_of(const Tool& tool, const Pose& pose);

/// Way of a tilting tool's material at x for each of its unknowns z and lift, by that unknown [-].
std::array<Eigen::Vector3d, 3> ways_at(const Tilt& tilt, const Eigen::Vector3d& x);

/// Slopes of the distance at x to those unknowns [-].
/// @param normal  of `distance` there
Eigen::Vector3d slopes_at(const Tilt& tilt, const Pose& pose, const Eigen::Vector3d& x,
                          const Eigen::Vector3d& normal);

/// Second derivatives of the distance at x to those unknowns [1/m].
struct TiltCurvature {
  Eigen::Matrix3d with_point;  ///< column j: of d/dx with unknown j
  Eigen::Matrix3d own;         ///< of two unknowns
};
TiltCurvature curvature_at(const Tilt& tilt, const Pose& pose, const Eigen::Vector3d& x,
                           const Distance& surface);

}  // namespace heddle::macroscale
