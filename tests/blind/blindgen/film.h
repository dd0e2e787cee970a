#pragma once

#include "random.h"

namespace blindgen {

/// Resin film of 0.07 mm between fabric and tool, both faces of a plate of 0.01 m^2. Thickness as in the
/// paper; the plate is an assumption the data file states too.
constexpr double film_thickness = 0.07e-3;  // [m]
constexpr double plate_area = 0.01;         // [m^2]

/// Polypropylene melt: Carreau-Yasuda with time-temperature superposition after Vogel, Fulcher and Tammann,
///
///     eta(g, T) = a eta0 (1 + (a lambda g)^y)^((n-1)/y),   a(T) = exp(B / (T - T0) - B / (453 K - T0))
///
/// so that far above 1 / lambda it is a power law of consistency ~ a^n. `exact` leaves the power law alone.
struct Melt {
  double zero_shear;         ///< eta0 at 180 degC [Pa s]
  double relaxation;         ///< lambda at 180 degC [s]
  double index;              ///< n [-]
  double yasuda;             ///< y [-]
  double vogel_temperature;  ///< T0 [K]
  double vogel_slope;        ///< B [K]
  bool exact = false;

  double shift(double temperature) const;                   ///< a [-]
  double viscosity(double rate, double temperature) const;  ///< [Pa s]
};

/// Drawn in the ranges of docs/decisions/blind-test.md.
Melt draw_melt(Stream& stream, bool exact);

/// Friction against the Hersey number relative to its value at the baseline, x = H / H0. Two forms of a curve
/// that rises with x: a constant and a power, or two friction levels that share the load,
///
///     mu = low + rise x^a        or        mu = (low + high y x^a) / (1 + y x^a)
struct StribeckCurve {
  enum class Form { offset_power, load_sharing, pure_power } form;
  double low;       ///< [-]
  double high;      ///< rise of the first form, upper level of the second [-]
  double exponent;  ///< a [-]
  double balance;   ///< y of the second form [-]

  double friction(double x) const;  ///< mu [-], x > 0
};

StribeckCurve draw_curve(Stream& stream, bool exact);

}  // namespace blindgen
