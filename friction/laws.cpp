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

namespace {

/// The curve between two Hersey numbers, its log slope held beyond them.
template <class AnyCurve>
LawValue held_beyond(const AnyCurve& law, double hersey, double low, double high) {
  const double edge = std::clamp(hersey, low, high);
  const LawValue at = curve_value(law, edge);
  if (edge == hersey) return at;
  if (!(at.mu > 0.0)) return {.mu = at.mu, .dmu_dlog_hersey = 0.0};  // no log slope to hold
  const double log_slope = at.dmu_dlog_hersey / at.mu;
  const double held = at.mu * std::pow(hersey / edge, log_slope);
  return {.mu = held, .dmu_dlog_hersey = log_slope * held};
}

}  // namespace

LawValue law_value(const StribeckCurve& law, double hersey, const CalibrationBox& box) {
  return held_beyond(law, hersey, box.hersey_low, box.hersey_high);
}

LawValue law_value(const FilmSolid& law, double hersey, const CalibrationBox& box) {
  return held_beyond(law, hersey, box.hersey_low, box.hersey_high);
}

LawValue law_value(const HerseyTable& law, double hersey, const CalibrationBox&) {
  // The table is its own box.
  return held_beyond(law, hersey, law.hersey.front(), law.hersey.back());
}

bool reads_hersey_number(const Law& law) {
  return std::visit([]<class L>(const L&) { return HerseyLaw<L>; }, law);
}

const char* id_of(const Law& law) {
  return std::visit([]<class L>(const L&) { return About<L>::id; }, law);
}

}  // namespace heddle::friction
