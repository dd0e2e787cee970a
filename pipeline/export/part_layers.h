#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>

#include "mesoscale/solid/stiffness.h"

namespace heddle::pipeline {

/// Three layers on one another that bend and stretch as a plate does whose stiffness is known, for solvers
/// that take materials and no [A B; B D]. Outer layers are as thick as each other; bottom first.
struct PartLayers {
  double thickness = 0.0;                    ///< of all three [m]
  double middle_share = 0.0;                 ///< of the thickness [-]
  std::array<Eigen::Matrix3d, 3> stiffness;  ///< in plane stress, 11, 22, 12 [Pa]
  std::array<Eigen::Vector3d, 3> expansion;  ///< free strain 11, 22, 12 (engineering) [1/K]
};

/// With outer layers of thickness a, the middle one of b, z = (a + b) / 2 and S, R the sum and the difference
/// of the outer stiffnesses (top less bottom)
///
///     A = a S + b Q_m,   B = a z R,   D = (a z^2 + a^3 / 12) S + (b^3 / 12) Q_m
///
/// which give S, R and Q_m: A, B and D are met exactly. {N, M} likewise; the middle layer expands as the free
/// plate's mid-surface does, so that a plate without B and M has layers that all expand alike.
/// @param plate         [A B; B D] [N/m, N, N m]
/// @param held          {N, M} where it is held flat [N/(m K), N/K]
/// @param thickness     of the layers together [m], > 0
/// @param middle_share  of it, 0..1
/// @return  nothing where a layer's stiffness is not positive definite: against A / thickness, in any
///          direction, less than `least`
std::optional<PartLayers> layers_of(const mesoscale::solid::Matrix6& plate,
                                    const mesoscale::solid::Vector6& held, double thickness,
                                    double middle_share, double least = 0.02);

/// [A B; B D] and {N, M} of layers, by integration.
mesoscale::solid::Matrix6 plate_of(const PartLayers& layers);
mesoscale::solid::Vector6 held_of(const PartLayers& layers);

/// A solid whose stiffness in plane stress is a given one, and which across the plane is as another solid:
/// its rows 33, 23, 13 are kept, and the rest is what leaves `plane` when they are free of stress. Positive
/// definite where both are.
/// @param plane  11, 22, 12 [Pa]  @param across  Voigt [Pa]
mesoscale::solid::Matrix6 solid_of(const Eigen::Matrix3d& plane, const mesoscale::solid::Matrix6& across);

/// Free strain of such a solid, Voigt: in the plane as given, across it what the other solid does.
/// @param across  free strain of the other solid [1/K]
mesoscale::solid::Vector6 solid_expansion(const Eigen::Vector3d& plane,
                                          const mesoscale::solid::Vector6& across);

}  // namespace heddle::pipeline
