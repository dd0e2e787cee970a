#include "friction/effects/coefficient_effects.h"

#include "friction/film/film_conduction.h"
#include "friction/hersey.h"

namespace heddle::friction {

Sensitive factor_of(const StaticPeak& effect, const Inputs& inputs) {
  return 1.0 + effect.amplitude * exp(inputs.slip / -effect.length);
}

Sensitive factor_of(const SlidingEvolution& effect, const Inputs& inputs) {
  return 1.0 + effect.amplitude * (1.0 - exp(inputs.slip / -effect.length));
}

Sensitive factor_of(const StickSlip& effect, const Inputs& inputs) {
  return 1.0 + effect.amplitude * exp(inputs.slip_speed / -effect.speed);
}

namespace {

// sin^2(gamma) cos 2(theta - theta_d) with 2 theta_d = sign(gamma) (90 deg - |gamma|) written out.
double along_the_long_diagonal(double theta, double gamma) {
  const double sine = std::sin(gamma), side = sine < 0.0 ? -1.0 : 1.0;
  return sine * sine *
         (std::cos(2.0 * theta) * std::abs(sine) + side * std::sin(2.0 * theta) * std::cos(gamma));
}

}  // namespace

Sensitive factor_of(const Orientation& effect, const Inputs& inputs) {
  if (effect.form == Orientation::Form::trellis)
    return 1.0 + effect.amplitude * along_the_long_diagonal(inputs.slip_angle, inputs.shear_angle);
  if (effect.form == Orientation::Form::film)
    return 1.0 + effect.amplitude * (inputs.drag_cosine * std::cos(2.0 * inputs.slip_angle) +
                                     inputs.drag_sine * std::sin(2.0 * inputs.slip_angle));
  const double sine = std::sin(2.0 * inputs.slip_angle);
  return 1.0 + effect.amplitude * sine * sine;
}

Sensitive factor_of(const DwellAgeing& effect, const Inputs& inputs) {
  return 1.0 + effect.amplitude * log1p(inputs.age / effect.time);
}

Sensitive factor_of(const Solidification& effect, const Inputs& inputs) {
  Sensitive interface;
  if (inputs.interface_temperature > 0.0)
    interface = inputs.interface_temperature;
  else if (inputs.conduction)
    interface = inputs.fabric_temperature + face_share(*inputs.conduction, inputs.dwell) *
                                                (inputs.tool_temperature - inputs.fabric_temperature);
  else
    interface =
        effect.tool_weight * inputs.tool_temperature + (1.0 - effect.tool_weight) * inputs.fabric_temperature;
  const Sensitive solid = 1.0 / (1.0 + exp((interface - effect.onset) / effect.width));
  return 1.0 + effect.amplitude * (1.0 - exp(inputs.dwell / -effect.time)) * solid;
}

Sensitive factor_of(const Wear& effect, const Inputs& inputs) {
  return 1.0 - effect.amplitude * (1.0 - exp(inputs.load_slip / -effect.load_slip));
}

Sensitive term_of(const Adhesion& effect, const Inputs& inputs, const Sensitive& area) {
  const FlooredPressure p = floored(inputs.pressure.value);
  return effect.stress * area / inputs.pressure.mapped(p.value, p.slope);
}

Sensitive term_of(const BoundaryLubrication& effect, const Sensitive& hersey) {
  return effect.amplitude * exp(hersey / -effect.transition);
}

double age_after(const DwellAgeing& effect, const Context& context, double age) {
  const double wiped = context.slip_speed * context.time_step / effect.reset_slip;
  const double grown = wiped > 0.0 ? -std::expm1(-wiped) / wiped : 1.0;
  return age * std::exp(-wiped) + context.time_step * grown;
}

}  // namespace heddle::friction
