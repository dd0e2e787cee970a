#include "friction/rheology/rheology.h"

#include <cmath>

namespace heddle::friction {

namespace {

/// F(g) and d ln F / d ln g of a flow curve, and the part of F that no temperature moves.
struct FlowValue {
  double viscosity;       ///< F [Pa s], without the held part
  double log_slope;       ///< d ln F / d ln g
  double held = 0.0;      ///< [Pa s]
  double held_slope = 0;  ///< d held / d g [Pa s^2]
};

/// tau_y (1 - exp(-M g)) / g, and its slope in g.
void add_yield(FlowValue& value, double yield, double sharpness, double g) {
  const double decay = -std::expm1(-sharpness * g);
  value.held = yield * decay / g;
  value.held_slope = yield * (sharpness * std::exp(-sharpness * g) - decay / g) / g;
}

FlowValue flow(const Bingham& law, const PowerLawFilm&, double g) {
  FlowValue value{.viscosity = law.viscosity, .log_slope = 0.0};
  add_yield(value, law.yield_stress, law.sharpness, g);
  return value;
}

FlowValue flow(const HerschelBulkley& law, const PowerLawFilm&, double g) {
  const double slope = law.power_index - 1.0;
  FlowValue value{.viscosity = law.consistency * std::pow(g, slope), .log_slope = slope};
  add_yield(value, law.yield_stress, law.sharpness, g);
  return value;
}

FlowValue flow(const PowerLaw&, const PowerLawFilm& film, double g) {
  return {.viscosity = film.consistency * std::pow(g, film.index - 1.0), .log_slope = film.index - 1.0};
}

FlowValue flow(const CarreauYasuda& law, const PowerLawFilm&, double g) {
  const double power = std::pow(law.relaxation_time * g, law.transition);
  const double thinning = (law.zero_viscosity - law.infinite_viscosity) *
                          std::pow(1.0 + power, (law.power_index - 1.0) / law.transition);
  const double eta = law.infinite_viscosity + thinning;
  return {.viscosity = eta, .log_slope = thinning / eta * (law.power_index - 1.0) * power / (1.0 + power)};
}

FlowValue flow(const Cross& law, const PowerLawFilm&, double g) {
  const double power = std::pow(law.relaxation_time * g, 1.0 - law.power_index);
  return {.viscosity = law.zero_viscosity / (1.0 + power),
          .log_slope = (law.power_index - 1.0) * power / (1.0 + power)};
}

template <class AnyFlow>
inline constexpr bool superposed = false;
template <>
inline constexpr bool superposed<CarreauYasuda> = true;
template <>
inline constexpr bool superposed<Cross> = true;

template <class AnyFlow>
PowerLawFilm::Value shifted(const AnyFlow& law, const PowerLawFilm& film, const TemperatureShift& shift,
                            double rate) {
  const double g = std::sqrt(rate * rate + film.rate_floor * film.rate_floor);
  const double a = std::exp(shift.log);
  if constexpr (superposed<AnyFlow>) {
    const FlowValue at = flow(law, film, a * g);
    const double eta = a * at.viscosity;
    return {.viscosity = eta,
            .dviscosity_drate = eta * at.log_slope * rate / (g * g),
            .dviscosity_dtemperature = eta * shift.slope * (1.0 + at.log_slope)};
  } else {
    const FlowValue at = flow(law, film, g);
    const double viscous = a * at.viscosity;
    return {.viscosity = viscous + at.held,
            .dviscosity_drate = (viscous * at.log_slope / g + at.held_slope) * rate / g,
            .dviscosity_dtemperature = viscous * shift.slope};
  }
}

TemperatureShift shift_of(const Arrhenius&, const PowerLawFilm& film, double temperature) {
  constexpr double gas_constant = 8.31446261815324;  // [J/(mol K)], exact since the SI of 2019
  const double e = film.activation_energy / gas_constant;
  const double inverse = 1.0 / temperature;
  return {.log = e * (inverse - 1.0 / film.reference_temperature),
          .slope = -e * inverse * inverse,
          .curve = 2.0 * e * inverse * inverse * inverse};
}

TemperatureShift shift_of(const Wlf& law, const PowerLawFilm& film, double temperature) {
  const double difference = temperature - film.reference_temperature;
  const double below = law.c2 + difference;
  const double slope = -law.c1 * law.c2 / (below * below);
  return {.log = -law.c1 * difference / below, .slope = slope, .curve = -2.0 * slope / below};
}

}  // namespace

TemperatureShift temperature_shift(const TemperatureLaw& law, const PowerLawFilm& film, double temperature) {
  return std::visit([&](const auto& chosen) { return shift_of(chosen, film, temperature); }, law);
}

double temperature_at_shift(const TemperatureLaw& law, const PowerLawFilm& film, double log_shift,
                            double start) {
  double temperature = start;
  for (int k = 0; k < 50; ++k) {
    const TemperatureShift a = temperature_shift(law, film, temperature);
    if (a.slope == 0.0) return start;
    const double step = (log_shift - a.log) / a.slope;
    temperature += step;
    if (std::abs(step) < 1e-12 * temperature) break;
  }
  return temperature;
}

double temperature_as_thin_as(const TemperatureLaw& law, const PowerLawFilm& film,
                              std::span<const double> temperature, std::span<const double> thickness) {
  double whole = 0.0, mean = 0.0, thinness = 0.0;  // thinness: of a^(-1/n)
  for (std::size_t i = 0; i < temperature.size(); ++i) {
    whole += thickness[i];
    mean += thickness[i] * temperature[i];
    thinness += thickness[i] * std::exp(-temperature_shift(law, film, temperature[i]).log / film.index);
  }
  return temperature_at_shift(law, film, -film.index * std::log(thinness / whole), mean / whole);
}

PowerLawFilm::Value viscosity(const Rheology& rheology, const PowerLawFilm& film, double rate,
                              double temperature) {
  if (rheology.of_the_film()) return film.evaluate(rate, temperature);
  const TemperatureShift shift = temperature_shift(rheology.temperature, film, temperature);
  return std::visit([&](const auto& law) { return shifted(law, film, shift, rate); }, rheology.flow);
}

}  // namespace heddle::friction
