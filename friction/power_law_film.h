#pragma once

namespace heddle::friction {

/// Shear-thinning resin film between fabric and tool, thinner when hotter:
///
///     eta(g, T) = m(T) (g^2 + g0^2)^((n-1)/2),   m(T) = m exp(E/R (1/T - 1/T_ref)),   g = U / h
///
/// For g >> g0 this is the power law eta = m g^(n-1).
/// Source: Gorczyca, Sherwood & Chen, Eqs 4 and 5, h = 0.07 mm; m and n of polypropylene at 180 degC from
/// Tadmor & Gogos (CD460: 6790 Pa s^n, n = 0.37; n = 0.37..0.41 between 180 and 200 degC), E within
/// the 38..46 kJ/mol of polypropylene melts. The paper prints none of the three. The floor g0 is ours: for n
/// < 1 the bare power law is singular at rest, where sticking contact lives. At 1 1/s it moves eta by 0.06 %
/// at the slowest test (24 1/s).
struct PowerLawFilm {
  double consistency = 6790.0;            ///< m [Pa s^n] at the reference temperature, > 0
  double index = 0.38;                    ///< n [-], 0 < n <= 1
  double thickness = 0.07e-3;             ///< h [m], > 0
  double activation_energy = 42.0e3;      ///< E [J/mol], >= 0
  double reference_temperature = 453.15;  ///< T_ref [K], > 0
  double rate_floor = 1.0;                ///< g0 [1/s], > 0

  struct Value {
    double viscosity;                ///< eta [Pa s]
    double dviscosity_drate;         ///< d eta / d g [Pa s^2]
    double dviscosity_dtemperature;  ///< d eta / d T [Pa s/K]
  };

  /// Eq. 4. Even and smooth in g.
  /// @param rate         shear rate g [1/s], any sign
  /// @param temperature  of the film [K], > 0
  Value evaluate(double rate, double temperature) const;

  /// Eq. 5: g = U / h.
  /// @param slip_speed  U [m/s]
  /// @return            [1/s]
  double shear_rate(double slip_speed) const { return slip_speed / thickness; }

  /// m(T) [Pa s^n].
  double consistency_at(double temperature) const;
};

}  // namespace heddle::friction
