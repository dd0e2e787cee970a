#include "friction/effects/film_effects.h"

#include <numbers>

#include "friction/hersey.h"

namespace heddle::friction {

Sensitive settled_share(const Sensitive& time_over_settling) {
  // The share starts as sqrt(t), with no slope at t = 0: contact counts as a millionth of t_s old.
  constexpr double touch = 1e-6;
  const Sensitive tau = sqrt(time_over_settling * time_over_settling + touch * touch);
  const double root_pi = std::sqrt(std::numbers::pi);
  const double x = 0.5 / std::sqrt(tau.value);
  const double gauss = std::exp(-x * x);
  const double integral = gauss / root_pi - x * std::erfc(x);  // of erfc from x on
  return tau.mapped((1.0 / root_pi - integral) / x, (1.0 - gauss) / (root_pi * std::sqrt(tau.value)));
}

Sensitive temperature_with(const ToolTemperatureFilm& effect, const Inputs& inputs) {
  Sensitive share = effect.weight;
  if (effect.settling > 0.0) share = share * settled_share(inputs.dwell / effect.settling);
  return inputs.fabric_temperature + share * (inputs.tool_temperature - inputs.fabric_temperature);
}

Sensitive thickness_with(const FilmSqueezeOut& effect, double thickness, const Inputs& inputs) {
  return thickness * pow(1.0 + effect.rate * inputs.pressure * inputs.dwell, -0.5);
}

Sensitive area_with(const PressureDependentArea& effect, const Inputs& inputs) {
  const FlooredPressure p = floored(inputs.pressure.value);
  return inputs.area_fraction *
         pow(inputs.pressure.mapped(p.value, p.slope) / effect.reference_pressure, effect.exponent);
}

Sensitive viscosity_with(const ViscosityPlateau& effect, const Sensitive& viscosity,
                         const Sensitive& log_shift) {
  return viscosity / (1.0 + effect.fluidity * viscosity / exp(log_shift));
}

Sensitive viscosity_with(const ShearHeating& effect, const Sensitive& viscosity, const Sensitive& softening,
                         const Sensitive& speed) {
  const Sensitive x = effect.amplitude / (8.0 * effect.conductivity) * softening * viscosity * speed * speed;
  const double root = std::sqrt(x.value * (1.0 + x.value));
  // f = asinh(sqrt x)/sqrt(x (1 + x)) is smooth at 0; its series there, where the quotient is 0/0.
  const double factor = x.value < 1e-4
                            ? 1.0 - x.value * (2.0 / 3.0 - x.value * (8.0 / 15.0 - x.value * 16.0 / 35.0))
                            : std::asinh(std::sqrt(x.value)) / root;
  // From x (1 + x) f' = 1/2 - (1/2 + x) f.
  const double slope = x.value < 1e-4 ? -2.0 / 3.0 + x.value * (16.0 / 15.0 - x.value * 48.0 / 35.0)
                                      : (0.5 - (0.5 + x.value) * factor) / (x.value * (1.0 + x.value));
  return viscosity * x.mapped(factor, slope);
}

}  // namespace heddle::friction
