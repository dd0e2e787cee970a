#pragma once

#include <array>

#include "friction/term.h"

namespace heddle::friction {

/// A cam that holds the gap between the plates (paper, section 2): what the stack gives up in thickness under
/// load is load lost. The stack is two plies between two films,
///
///     p = p0 - K (2 (h0 - h) + c),    dh/dt = -B p h^3 / (2 h0^2),    dc/dt = (C p - c)/tau
///
/// with the film squeezed out as by Stefan (h = h0 (1 + B p t)^(-1/2) where p is held, as effect F9) and tows
/// that flatten by c. C = r/((1 - r) K) makes r the share of the load that tow flattening alone would take in
/// the end. All numbers are PRIORS: the paper says that the cam keeps its position, not what the force did.
struct CamGap {
  double stack_stiffness = 5e8;  ///< K of plies and frame together, as pressure over gap [Pa/m], > 0
  double squeeze_rate = 1e-6;    ///< B [1/(Pa s)], >= 0
  double tow_relaxation = 0.1;   ///< r [-], 0 <= r < 1
  double relaxation_time = 2.0;  ///< of the load under a held gap by tow flattening alone [s], > 0
};

/// The stack at one moment.
struct GapState {
  double pressure = 0.0;        ///< p [Pa]
  double film_thickness = 0.0;  ///< h [m]
  double tow_flattening = 0.0;  ///< c [m]
};

/// The stack when the cam has just come to its place.
GapState closed_gap(double pressure, double film_thickness);

/// The stack a time step later: trapezoid rule, second order.
/// @param start  the stack when the cam came to its place
GapState relax(const CamGap& cam, const GapState& start, const GapState& now, double time_step);

template <>
struct About<CamGap> {
  static constexpr const char* id = "cam";
  static constexpr const char* equation = "p = p0 - K (2 (h0 - h) + c)";
  static constexpr const char* source =
      "paper, section 2 (the cam keeps its position); Stefan 1874; numbers are priors";
  static constexpr std::array fields{
      Field<CamGap>{"stack_stiffness", "Pa/m", &CamGap::stack_stiffness, positive_range,
                    "Pressure over gap of plies and frame (prior)."},
      Field<CamGap>{"squeeze_rate", "1/(Pa s)", &CamGap::squeeze_rate, not_negative,
                    "B of the film squeezed out; effect F9 lets the law see it (prior)."},
      Field<CamGap>{"tow_relaxation",
                    "",
                    &CamGap::tow_relaxation,
                    {0.0, 1.0, false, true},
                    "Share of the load that flattening tows take in the end (prior)."},
      Field<CamGap>{"relaxation_time", "s", &CamGap::relaxation_time, positive_range,
                    "Over which they take it (prior)."}};
};

}  // namespace heddle::friction
