#include "friction/effects/film_effects.h"

#include <array>
#include <numbers>

#include "friction/film/film_conduction.h"
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

Sensitive heated_share(const Sensitive& time_over_settling) {
  // 96/(pi^4 n^4); the last holds what the modes above it would, so that nothing is left over at the start.
  struct Mode {
    double rate, weight;
  };
  constexpr std::array modes{Mode{1.0, 0.985534}, Mode{9.0, 0.012167}, Mode{25.0, 0.002299}};
  double share = 0.0, slope = 0.0;
  for (const Mode& mode : modes) {
    const double decay = std::exp(-mode.rate * time_over_settling.value);
    share += mode.weight * (1.0 - decay);
    slope += mode.weight * mode.rate * decay;
  }
  return time_over_settling.mapped(share, slope);
}

namespace {

/// The temperature of an even film as thin as one with these temperatures through it.
Sensitive as_thin_as(const std::array<Sensitive, film_points>& through, const TemperatureLaw& law,
                     const PowerLawFilm& film) {
  Sensitive mean, thinness;  // mean of T, and of a^(-1/n)
  for (std::size_t i = 0; i < film_points; ++i) {
    const TemperatureShift a = temperature_shift(law, film, through[i].value);
    mean = mean + film_point_weight[i] * through[i];
    thinness = thinness + film_point_weight[i] * exp(through[i].mapped(a.log, a.slope) / -film.index);
  }
  if (temperature_shift(law, film, mean.value).slope == 0.0) return mean;  // a resin that heat does not thin
  const double temperature =
      temperature_at_shift(law, film, -film.index * std::log(thinness.value), mean.value);
  const double slope = temperature_shift(law, film, temperature).slope;
  return thinness.mapped(temperature, -film.index / (thinness.value * slope));
}

}  // namespace

Sensitive temperature_with(const ToolTemperatureFilm& effect, const TemperatureLaw& law,
                           const PowerLawFilm& film, const Inputs& inputs) {
  const Sensitive difference = inputs.tool_temperature - inputs.fabric_temperature;
  if (inputs.conduction) {
    std::array<Sensitive, film_points> through;
    for (std::size_t i = 0; i < film_points; ++i)
      through[i] = inputs.fabric_temperature +
                   effect.weight * point_share(*inputs.conduction, i, inputs.dwell) * difference;
    return as_thin_as(through, law, film);
  }
  Sensitive share = effect.weight;
  if (effect.settling > 0.0) share = share * settled_share(inputs.dwell / effect.settling);
  return inputs.fabric_temperature + share * difference;
}

Sensitive thickness_with(const FilmSqueezeOut& effect, double thickness, const Inputs& inputs) {
  return thickness * pow(1.0 + effect.rate * inputs.pressure * inputs.dwell, -0.5);
}

Sensitive factor_of(const FilmSqueezeOut& effect, const Inputs& inputs) {
  return 1.0 + effect.contact * (1.0 - thickness_with(effect, 1.0, inputs));
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

Sensitive heating_strength(const ShearHeating& effect, const Inputs& inputs, double rest_speed) {
  const double settled = effect.amplitude / (8.0 * effect.conductivity);
  if (!inputs.conduction && effect.settling == 0.0) return settled;
  // The heat that counts is that of the last settling times; over those a point slides at about its present
  // speed.
  const Sensitive sheared =
      inputs.slip / sqrt(inputs.slip_speed * inputs.slip_speed + rest_speed * rest_speed);
  if (!inputs.conduction) return settled * heated_share(sheared / effect.settling);
  return 12.0 * effect.amplitude / (8.0 * inputs.conduction->spec.film_conductivity) *
         heating_rise(*inputs.conduction, sheared);
}

Sensitive viscosity_with(const Sensitive& strength, const Sensitive& viscosity, const Sensitive& softening,
                         const Sensitive& speed) {
  const Sensitive x = strength * softening * viscosity * speed * speed;
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
