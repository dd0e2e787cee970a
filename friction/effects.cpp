#include "friction/effects.h"

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

void apply(const Effects& effects, const Context& context, Friction& friction) {
  if (effects.tool_temperature_shift) apply(*effects.tool_temperature_shift, context, friction);
}

}  // namespace heddle::friction
