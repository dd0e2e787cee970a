#include "friction/laws.h"

#include <algorithm>
#include <cmath>

namespace heddle::friction {

bool CalibrationBox::contains(const Context& context, double hersey) const {
  const auto within = [](double low, double x, double high) { return low <= x && x <= high; };
  return within(hersey_low, hersey, hersey_high) && within(pressure_low, context.pressure, pressure_high) &&
         within(speed_low, context.slip_speed, speed_high);
}

LawValue law_value(const HerseyPower& law, double hersey, const CalibrationBox&) {
  const double mu = law.scale * std::pow(hersey, law.exponent);
  return {.mu = mu, .dmu_dlog_hersey = law.exponent * mu};
}

LawValue law_value(const HerseyLinear& law, double hersey, const CalibrationBox& box) {
  const double edge = std::clamp(hersey, box.hersey_low, box.hersey_high);
  const double rise = law.slope * edge / law.reference;
  const double mu = law.offset + rise;
  if (edge == hersey) return {.mu = mu, .dmu_dlog_hersey = rise};

  const double log_slope = rise / mu;  // d ln mu / d ln Hs at the edge
  const double held = mu * std::pow(hersey / edge, log_slope);
  return {.mu = held, .dmu_dlog_hersey = log_slope * held};
}

}  // namespace heddle::friction
