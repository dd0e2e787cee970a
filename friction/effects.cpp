#include "friction/effects.h"

#include <cmath>

#include "friction/hersey.h"

namespace heddle::friction {

namespace {

void scale_coefficient(Friction& friction, double factor) {
  friction.mu *= factor;
  friction.dmu_dspeed *= factor;
  friction.dmu_dpressure *= factor;
  friction.dmu_dfabric_temperature *= factor;
  friction.dmu_dtool_temperature *= factor;
}

}  // namespace

// With slope = 0 each line below adds zero or multiplies by one: exact, so the off value needs no branch.
void apply(const ToolTemperatureShift& effect, const Context& context, Friction& friction) {
  const double shift = effect.slope * (context.tool_temperature - effect.reference);
  if (effect.form == ToolTemperatureShift::Form::term) {
    friction.mu += shift;
    friction.dmu_dtool_temperature += effect.slope;
    return;
  }
  const double unshifted = friction.mu;
  scale_coefficient(friction, 1.0 + shift);
  friction.dmu_dtool_temperature += unshifted * effect.slope;
}

void apply_to_coefficient(const Effects& effects, const Inputs& inputs, const Sensitive& area,
                          const Sensitive& hersey, Friction& friction) {
  Sensitive mu = coefficient_of(friction);
  const auto multiply = [&](const auto& effect) {
    if (is_on(effect)) mu = mu * factor_of(*effect, inputs);
  };
  multiply(effects.static_peak);
  multiply(effects.sliding_evolution);
  multiply(effects.stick_slip);
  multiply(effects.orientation);
  if (is_on(effects.adhesion)) mu = mu + term_of(*effects.adhesion, inputs, area);
  if (is_on(effects.film_squeeze_out) && effects.film_squeeze_out->contact != 0.0)
    multiply(effects.film_squeeze_out);
  multiply(effects.dwell_ageing);
  multiply(effects.solidification);
  multiply(effects.wear);
  if (is_on(effects.boundary_lubrication)) mu = mu + term_of(*effects.boundary_lubrication, hersey);
  set_coefficient(friction, mu);
}

EffectStages stages_of(const Effects& effects) {
  const bool film = is_on(effects.tool_temperature_film) || is_on(effects.pressure_dependent_area) ||
                    is_on(effects.film_squeeze_out) || is_on(effects.shear_heating) ||
                    is_on(effects.viscosity_plateau);
  const bool coefficient =
      is_on(effects.static_peak) || is_on(effects.sliding_evolution) || is_on(effects.stick_slip) ||
      is_on(effects.orientation) || is_on(effects.adhesion) || is_on(effects.dwell_ageing) ||
      is_on(effects.solidification) || is_on(effects.wear) || is_on(effects.boundary_lubrication) ||
      (is_on(effects.film_squeeze_out) && effects.film_squeeze_out->contact != 0.0);
  return {.film = film, .coefficient = coefficient};
}

Sensitive contact_area(const Effects& effects, const Inputs& inputs) {
  if (is_on(effects.pressure_dependent_area)) return area_with(*effects.pressure_dependent_area, inputs);
  return inputs.area_fraction;
}

FilmState film_state(const Effects& effects, const Rheology& rheology, const PowerLawFilm& film,
                     const Inputs& inputs, const Sensitive& area) {
  FilmState state;
  state.temperature =
      is_on(effects.tool_temperature_film)
          ? temperature_with(*effects.tool_temperature_film, rheology.temperature, film, inputs)
          : inputs.fabric_temperature;
  state.thickness = is_on(effects.film_squeeze_out)
                        ? thickness_with(*effects.film_squeeze_out, film.thickness, inputs)
                        : Sensitive(film.thickness);

  const Sensitive rate = inputs.slip_speed / state.thickness;
  const PowerLawFilm::Value at = viscosity(rheology, film, rate.value, state.temperature.value);
  state.viscosity =
      combine(at.viscosity, at.dviscosity_drate, rate, at.dviscosity_dtemperature, state.temperature);
  const TemperatureShift shift = temperature_shift(rheology.temperature, film, state.temperature.value);
  if (is_on(effects.viscosity_plateau))
    state.viscosity = viscosity_with(*effects.viscosity_plateau, state.viscosity,
                                     state.temperature.mapped(shift.log, shift.slope));
  if (is_on(effects.shear_heating)) {
    const double cold = state.viscosity.value;
    state.viscosity = viscosity_with(
        heating_strength(*effects.shear_heating, inputs, film.thickness * film.rate_floor), state.viscosity,
        state.temperature.mapped(-shift.slope, -shift.curve), inputs.slip_speed);
    if (shift.slope < 0.0) state.heating = std::log(state.viscosity.value / cold) / shift.slope;
  }

  const FlooredPressure p = floored(inputs.pressure.value);
  const Sensitive floored_rate = sqrt(rate * rate + film.rate_floor * film.rate_floor);
  state.hersey = state.viscosity * floored_rate * area / inputs.pressure.mapped(p.value, p.slope);
  return state;
}

void advance(const Effects& effects, const Context& context, ContactState& state) {
  if (context.time_step == 0.0) return;
  if (is_on(effects.dwell_ageing)) state.age = age_after(*effects.dwell_ageing, context, state.age);
  if (is_on(effects.wear)) state.load_slip += context.pressure * context.slip_speed * context.time_step;
}

bool has_memory(const Effects& effects, bool conduction) {
  const auto& film = effects.tool_temperature_film;
  return is_on(effects.static_peak) || is_on(effects.sliding_evolution) || is_on(effects.film_squeeze_out) ||
         is_on(effects.dwell_ageing) || is_on(effects.solidification) || is_on(effects.wear) ||
         (is_on(film) && (conduction || film->settling > 0.0)) ||
         (is_on(effects.shear_heating) && (conduction || effects.shear_heating->settling > 0.0));
}

}  // namespace heddle::friction
