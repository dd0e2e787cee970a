#include "friction/laws/speed_laws.h"

#include <algorithm>

namespace heddle::friction {

namespace {

/// t^2 (3 - 2t) between 0 and 1.
Sensitive smooth_step(const Sensitive& x) {
  if (x.value <= 0.0) return x.mapped(0.0, 0.0);
  if (x.value >= 1.0) return x.mapped(1.0, 0.0);
  return x.mapped(x.value * x.value * (3.0 - 2.0 * x.value), 6.0 * x.value * (1.0 - x.value));
}

/// S - S0 of a contact that slips by `slip` in the step.
Sensitive resistance_after(const SlipResistance& law, const Sensitive& change, const Sensitive& slip) {
  const double whole = law.saturated - law.initial;
  return whole + (change - whole) * exp(slip / -law.length);
}

}  // namespace

Sensitive coefficient(const StaticKinetic& law, const Inputs& inputs) {
  const double peak = law.static_coefficient - law.kinetic_coefficient;
  return law.kinetic_coefficient + peak * (1.0 - smooth_step(inputs.slip / law.breakaway_slip));
}

Sensitive coefficient(const ExponentialDecay& law, const Inputs& inputs) {
  const double peak = law.static_coefficient - law.kinetic_coefficient;
  return law.kinetic_coefficient + peak * exp(inputs.slip_speed / -law.decay_speed);
}

Sensitive coefficient(const Darmstadt& law, const Inputs& inputs) {
  const Sensitive& p = inputs.pressure;
  const Sensitive& u = inputs.slip_speed;
  return law.base + law.square * exp(law.square_rate * u) * p * p +
         law.linear * exp(law.linear_rate * u) * p + law.constant * exp(law.constant_rate * u);
}

Sensitive coefficient(const Renard& law, const Inputs& inputs) {
  const Sensitive& u = inputs.slip_speed;
  if (u.value <= law.first_speed) {
    const Sensitive x = u / law.first_speed;
    return law.static_coefficient + (law.maximum - law.static_coefficient) * x * (2.0 - x);
  }
  if (u.value <= law.second_speed) {
    const Sensitive y = (u - law.first_speed) / (law.second_speed - law.first_speed);
    return law.maximum + (law.minimum - law.maximum) * smooth_step(y);
  }
  const Sensitive z = (u - law.second_speed) / law.recovery_speed;
  const double rise = law.dynamic_coefficient - law.minimum;
  return law.dynamic_coefficient - rise / (1.0 + rise * z * z);
}

Sensitive coefficient(const SlipResistance& law, const Inputs& inputs) {
  const Sensitive& u = inputs.slip_speed;
  const Sensitive slip =
      law.evolution == SlipResistance::Evolution::inside ? u * inputs.time_step : Sensitive{};
  const Sensitive resistance = law.initial + resistance_after(law, inputs.slip_resistance, slip);
  if (law.rate_exponent == 0.0) return resistance;
  return resistance * pow((u * u + rest_speed * rest_speed) / (law.reference_speed * law.reference_speed),
                          0.5 * law.rate_exponent);
}

double slip_resistance_after(const SlipResistance& law, const Context& context, const ContactState& state) {
  return resistance_after(law, state.slip_resistance, context.slip_speed * context.time_step).value;
}

}  // namespace heddle::friction
