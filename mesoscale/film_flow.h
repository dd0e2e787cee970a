#pragma once

#include <Eigen/Core>

namespace heddle::mesoscale {

/// Resin between fabric and tool: shear rate against shear stress.
///
///     g(tau) = (|tau| / m)^(1/n) tau / |tau|,   that is eta = m |g|^(n-1)
///
/// Numbers only: temperature is the caller's, who gives m at it. The stress is floored at what `rate_floor`
/// needs, since for n < 1 the fluid at rest would not flow at all; it shows only where the tool stands still.
struct FilmFluid {
  double consistency = 6790.0;  ///< m [Pa s^n], > 0
  double index = 0.38;          ///< n [-], 0 < n <= 1
  double rate_floor = 1e-6;     ///< [1/s], > 0; the slowest film of Table 2 is sheared at 24 1/s

  /// eta [Pa s] at a shear rate [1/s].
  double viscosity(double rate) const;
};

/// One column of film: the fabric below stands still, the tool above slides with U; pressure gradient G.
/// With the stress T + s G at the height s from the middle,
///
///     int g(T + s G) ds = U           gives T
///     q = U h / 2 - Q,   Q = int s g(T + s G) ds,   s from -h/2 to h/2
///
/// T is the minimum over T of the convex L(T, G) = int W(T + s G) ds - T . U with W' = g, and Q is the slope
/// of Psi(G) = min_T L: so Q has a symmetric positive tangent and the film equation an energy.
struct FilmFlow {
  double potential = 0.0;           ///< Psi [W/m^2]
  Eigen::Vector2d middle_stress{};  ///< T [Pa]
  Eigen::Vector2d pressure_flux{};  ///< Q [m^2/s]; for a Newtonian film h^3 G / (12 eta)
  Eigen::Matrix2d conductance{};    ///< dQ/dG [m^3/(Pa s)]
};

/// @param gap       h [m], > 0
/// @param sliding   U [m/s]
/// @param gradient  G [Pa/m]
/// @param start     T to start from; any
/// @throws NumericalError  if T is not found (names gap, speed and gradient)
FilmFlow film_flow(const FilmFluid& fluid, double gap, const Eigen::Vector2d& sliding,
                   const Eigen::Vector2d& gradient, const Eigen::Vector2d& start);
/// T without a pressure gradient, eta(U/h) U/h [Pa].
Eigen::Vector2d drag_stress(const FilmFluid& fluid, double gap, const Eigen::Vector2d& sliding);

}  // namespace heddle::mesoscale
