#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include "friction/contact_point.h"

namespace heddle::friction {

/// What a friction coefficient can change with, in the order of `Sensitive::slope`.
enum class Variable : std::size_t {
  slip_speed,
  pressure,
  fabric_temperature,
  tool_temperature,
  slip,
  dwell,
  age,
  load_slip,
  slip_resistance
};
inline constexpr std::size_t variable_count = 9;

/// A number with its slopes to every variable of the contact point, carried through sums, products and
/// functions by the chain rule: a new term states its value once and has exact slopes. (Forward automatic
/// differentiation.)
struct Sensitive {
  double value = 0.0;
  std::array<double, variable_count> slope{};

  Sensitive() = default;
  Sensitive(double constant) : value(constant) {}  // NOLINT: numbers mix with Sensitive as with double
  static Sensitive of(Variable variable, double value) {
    Sensitive result(value);
    result.slope[static_cast<std::size_t>(variable)] = 1.0;
    return result;
  }

  double slope_to(Variable variable) const { return slope[static_cast<std::size_t>(variable)]; }

  /// f(x) of known value f and slope df/dx at this x.
  Sensitive mapped(double f, double df) const {
    Sensitive result(f);
    for (std::size_t i = 0; i < variable_count; ++i) result.slope[i] = df * slope[i];
    return result;
  }
};

/// f(x, y) of known value and slopes.
inline Sensitive combine(double f, double df_dx, const Sensitive& x, double df_dy, const Sensitive& y) {
  Sensitive result(f);
  for (std::size_t i = 0; i < variable_count; ++i) result.slope[i] = df_dx * x.slope[i] + df_dy * y.slope[i];
  return result;
}

inline Sensitive operator+(const Sensitive& x, const Sensitive& y) {
  return combine(x.value + y.value, 1.0, x, 1.0, y);
}
inline Sensitive operator-(const Sensitive& x, const Sensitive& y) {
  return combine(x.value - y.value, 1.0, x, -1.0, y);
}
inline Sensitive operator*(const Sensitive& x, const Sensitive& y) {
  return combine(x.value * y.value, y.value, x, x.value, y);
}
inline Sensitive operator/(const Sensitive& x, const Sensitive& y) {
  const double quotient = x.value / y.value;
  return combine(quotient, 1.0 / y.value, x, -quotient / y.value, y);
}
inline Sensitive exp(const Sensitive& x) {
  const double e = std::exp(x.value);
  return x.mapped(e, e);
}
inline Sensitive sqrt(const Sensitive& x) {
  const double root = std::sqrt(x.value);
  return x.mapped(root, 0.5 / root);
}
inline Sensitive log1p(const Sensitive& x) {
  return x.mapped(std::log1p(x.value), 1.0 / (1.0 + x.value));
}
/// @param x  > 0
inline Sensitive pow(const Sensitive& x, double exponent) {
  const double power = std::pow(x.value, exponent);
  return x.mapped(power, exponent * power / x.value);
}

struct FilmConduction;  // friction/film/film_conduction.h

/// The variables of one contact point with the memory it brings into the step.
struct Inputs {
  Sensitive slip_speed, pressure, fabric_temperature, tool_temperature;
  Sensitive slip, dwell, age, load_slip, slip_resistance;
  Sensitive area_fraction;
  double slip_angle = 0.0;                    ///< [rad], frozen in the lag
  double shear_angle = 0.0;                   ///< [rad], the same
  double drag_cosine = 0.0, drag_sine = 0.0;  ///< [-], the same
  double time_step = 0.0;                     ///< [s]
  double interface_temperature = 0.0;         ///< [K], frozen in the lag; 0: not known
  /// How heat reaches the film; null = the effects' own closed forms.
  const FilmConduction* conduction = nullptr;

  Inputs(const Context& context, const ContactState& state, const FilmConduction* film_conduction = nullptr)
      : slip_speed(Sensitive::of(Variable::slip_speed, context.slip_speed)),
        pressure(Sensitive::of(Variable::pressure, context.pressure)),
        fabric_temperature(Sensitive::of(Variable::fabric_temperature, context.fabric_temperature)),
        tool_temperature(Sensitive::of(Variable::tool_temperature, context.tool_temperature)),
        slip(Sensitive::of(Variable::slip, state.slip)),
        dwell(Sensitive::of(Variable::dwell, state.dwell)),
        age(Sensitive::of(Variable::age, state.age)),
        load_slip(Sensitive::of(Variable::load_slip, state.load_slip)),
        slip_resistance(Sensitive::of(Variable::slip_resistance, state.slip_resistance)),
        area_fraction(pressure.mapped(context.area_fraction, context.area_slope)),
        slip_angle(context.slip_angle),
        shear_angle(context.shear_angle),
        drag_cosine(context.drag_cosine),
        drag_sine(context.drag_sine),
        time_step(context.time_step),
        interface_temperature(context.interface_temperature),
        conduction(film_conduction) {}
};

/// mu and its slopes as one number, and back.
inline Sensitive coefficient_of(const Friction& friction) {
  Sensitive mu(friction.mu);
  mu.slope = {friction.dmu_dspeed,
              friction.dmu_dpressure,
              friction.dmu_dfabric_temperature,
              friction.dmu_dtool_temperature,
              friction.history.dmu_dslip,
              friction.history.dmu_ddwell,
              friction.history.dmu_dage,
              friction.history.dmu_dload_slip,
              friction.history.dmu_dslip_resistance};
  return mu;
}

inline void set_coefficient(Friction& friction, const Sensitive& mu) {
  friction.mu = mu.value;
  friction.dmu_dspeed = mu.slope_to(Variable::slip_speed);
  friction.dmu_dpressure = mu.slope_to(Variable::pressure);
  friction.dmu_dfabric_temperature = mu.slope_to(Variable::fabric_temperature);
  friction.dmu_dtool_temperature = mu.slope_to(Variable::tool_temperature);
  friction.history = {.dmu_dslip = mu.slope_to(Variable::slip),
                      .dmu_ddwell = mu.slope_to(Variable::dwell),
                      .dmu_dage = mu.slope_to(Variable::age),
                      .dmu_dload_slip = mu.slope_to(Variable::load_slip),
                      .dmu_dslip_resistance = mu.slope_to(Variable::slip_resistance)};
}

}  // namespace heddle::friction
