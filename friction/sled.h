#pragma once

#include "friction/model.h"

namespace heddle::friction {

/// The sled of ASTM D 1894: one face slides under the sled's own weight. Numbers of the standard, recalled.
struct Sled {
  double mass = 0.2;                          ///< [kg], 0.2 +- 0.005
  double side = 63.5e-3;                      ///< of the square face [m]
  double speed = 2.5e-3;                      ///< [m/s], 150 +- 30 mm/min
  double start = 10e-3;                       ///< slip within which the first peak is read [m]; ours
  double travel = 130e-3;                     ///< slip up to which the mean is taken, from `start` on [m]
  double tool_temperature = 296.15;           ///< [K], 23 degC
  double fabric_temperature = 296.15;         ///< [K]
  static constexpr double gravity = 9.80665;  ///< [m/s^2]

  double normal_force() const { return mass * gravity; }              ///< 1.96 N
  double pressure() const { return normal_force() / (side * side); }  ///< 486 Pa
};

/// What the standard reports.
struct SledResult {
  double static_coefficient = 0.0;   ///< highest force within `start`, over the weight
  double kinetic_coefficient = 0.0;  ///< mean force beyond it, over the weight
  bool calibrated = true;            ///< the law was fitted where the sled stands
};

/// Pulls the sled over the law, F = mu N: between plates it would be 2 mu N.
SledResult sled_test(const Model& model, const Sled& sled);

}  // namespace heddle::friction
