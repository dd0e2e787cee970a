#pragma once

#include <array>

namespace heddle::macroscale {

inline constexpr double standard_gravity = 9.80665;  ///< [m/s^2], CGPM 1901

/// What a press does besides pushing a punch straight down on a stiff frame. Everything is off by default,
/// and off is the baseline bit for bit (docs/theory/press.md).
struct PressSpec {
  bool gravity = false;                  ///< weight of the fabric (true mass) and of the binder
  double compliance = 0.0;               ///< of the frame: the punch stays behind its drive by this [m/N]
  double force_limit = 0.0;              ///< the punch yields at this force; 0 = never [N]
  std::array<double, 2> punch_offset{};  ///< of the punch's axis from that of die and binder [m]
  double binder_tilt = 0.0;         ///< of the binder, held, about a level axis through the punch's [rad]
  double binder_tilt_axis = 0.0;    ///< direction of that axis against x [rad]
  double binder_force_error = 0.0;  ///< of the force on the binder, over what was asked for [-]
  double dwell = 0.0;               ///< time that the tools stand still after the stroke [s]
  bool release = false;             ///< then punch and binder go up and the blank springs back
};

/// Rows of history after the stroke.
inline constexpr int dwell_rows = 20;

}  // namespace heddle::macroscale
