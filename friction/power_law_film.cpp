#include "friction/power_law_film.h"

#include <cmath>

namespace heddle::friction {

namespace {
constexpr double gas_constant = 8.31446261815324;  ///< [J/(mol K)], exact since the SI of 2019
}

double PowerLawFilm::consistency_at(double temperature) const {
  const double shift = activation_energy / gas_constant * (1.0 / temperature - 1.0 / reference_temperature);
  return consistency * std::exp(shift);
}

PowerLawFilm::Value PowerLawFilm::evaluate(double rate, double temperature) const {
  const double square = rate * rate + rate_floor * rate_floor;
  const double eta = consistency_at(temperature) * std::pow(square, 0.5 * (index - 1.0));
  return {.viscosity = eta,
          .dviscosity_drate = eta * (index - 1.0) * rate / square,
          .dviscosity_dtemperature = -eta * activation_energy / (gas_constant * temperature * temperature)};
}

}  // namespace heddle::friction
