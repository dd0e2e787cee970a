#include "macroscale/thermal/crystallisation.h"

#include <cmath>
#include <numbers>

namespace heddle::macroscale::thermal {

namespace {
constexpr double bell = 4.0 * std::numbers::ln2;
}

Slope Crystallisation::rate_at(double temperature) const {
  const double x = (temperature - peak_temperature) / width;
  const double value = rate * std::exp(-bell * x * x);
  return {value, -2.0 * bell * x / width * value};
}

Slope Crystallisation::degree_at(double progress) const {
  if (progress <= 0.0) return {0.0, exponent == 1.0 ? 1.0 : 0.0};
  const double power = std::pow(progress, exponent);
  const double formed = -std::expm1(-power);
  return {formed, exponent * power / progress * (1.0 - formed)};
}

double Crystallisation::steepest() const {
  return rate * std::sqrt(2.0 * bell / std::numbers::e) / width;
}

}  // namespace heddle::macroscale::thermal
