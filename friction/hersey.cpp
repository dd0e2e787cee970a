#include "friction/hersey.h"

#include <cmath>

namespace heddle::friction {

FlooredPressure floored(double pressure) {
  const double value = std::sqrt(pressure * pressure + pressure_floor * pressure_floor);
  return {.value = value, .slope = pressure / value};
}

HerseyNumber hersey_number(const PowerLawFilm& film, const Context& context) {
  const double rest_speed = film.thickness * film.rate_floor;
  const double speed_square = context.slip_speed * context.slip_speed + rest_speed * rest_speed;
  const FlooredPressure pressure = floored(context.pressure);
  const auto [eta, deta_drate, deta_dtemperature] =
      film.evaluate(film.shear_rate(context.slip_speed), context.fabric_temperature);

  return {.value = eta * std::sqrt(speed_square) * context.area_fraction / (pressure.value * film.thickness),
          // ln Hs = ln eta(U/h) + ln U_f + ln phi - ln p_f - ln h
          .dlog_dspeed = deta_drate / (eta * film.thickness) + context.slip_speed / speed_square,
          .dlog_dpressure = context.area_slope / context.area_fraction - pressure.slope / pressure.value,
          .dlog_dfabric_temperature = deta_dtemperature / eta,
          .viscosity = eta};
}

}  // namespace heddle::friction
