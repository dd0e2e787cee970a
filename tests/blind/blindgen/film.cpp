#include "film.h"

#include <cmath>

namespace blindgen {

namespace {

constexpr double gas_constant = 8.314;     // [J/(mol K)]
constexpr double melt_reference = 453.15;  // 180 degC [K]
constexpr double known_rate = 238.0;       // U / h at the baseline [1/s]

}  // namespace

double Melt::shift(double temperature) const {
  return std::exp(vogel_slope / (temperature - vogel_temperature) -
                  vogel_slope / (melt_reference - vogel_temperature));
}

double Melt::viscosity(double rate, double temperature) const {
  const double a = shift(temperature);
  const double reduced = a * relaxation * rate;
  if (exact) return a * zero_shear * std::pow(reduced, index - 1.0);
  return a * zero_shear * std::pow(1.0 + std::pow(reduced, yasuda), (index - 1.0) / yasuda);
}

Melt draw_melt(Stream& stream, bool exact) {
  Melt melt{};
  melt.exact = exact;
  melt.index = stream.uniform(0.36, 0.42);
  melt.relaxation = 1.0 / stream.log_uniform(0.3, 2.0);
  melt.yasuda = stream.uniform(0.8, 2.0);
  melt.vogel_temperature = stream.uniform(90.0, 150.0);
  const double activation = stream.uniform(38e3, 46e3);  // apparent, at 180 degC [J/mol]
  const double room = 1.0 - melt.vogel_temperature / melt_reference;
  melt.vogel_slope = activation / gas_constant * room * room;
  const double viscosity = stream.log_uniform(60.0, 250.0);  // at the baseline [Pa s]
  melt.zero_shear = 1.0;
  melt.zero_shear = viscosity / melt.viscosity(known_rate, melt_reference);
  return melt;
}

double StribeckCurve::friction(double x) const {
  const double power = std::pow(x, exponent);
  switch (form) {
    case Form::offset_power:
      return low + high * power;
    case Form::pure_power:
      return high * power;
    case Form::load_sharing:
      break;
  }
  return (low + high * balance * power) / (1.0 + balance * power);
}

StribeckCurve draw_curve(Stream& stream, bool exact) {
  const double level = stream.uniform(0.25, 0.31);  // mu at the baseline
  const double slope = stream.uniform(0.10, 0.14);  // d ln mu / d ln H there
  const double exponent = stream.uniform(0.20, 0.35);
  const double low = level * stream.uniform(0.45, 0.60);
  const double high = level * stream.uniform(1.6, 2.2);
  const bool sharing = stream.uniform() < 0.5;
  using Form = StribeckCurve::Form;
  if (exact) return {Form::pure_power, 0.0, level, slope, 0.0};
  if (!sharing) {
    const double share = slope / exponent;  // of the rate-dependent part at the baseline
    return {Form::offset_power, level * (1.0 - share), level * share, exponent, 0.0};
  }
  const double balance = (level - low) / (high - level);
  const double steepness = slope * level * (1.0 + balance) * (1.0 + balance) / (balance * (high - low));
  return {Form::load_sharing, low, high, steepness, balance};
}

}  // namespace blindgen
