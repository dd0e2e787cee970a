#pragma once

#include "friction/contact_point.h"
#include "friction/power_law_film.h"

namespace heddle::friction {

/// p0 [Pa]. A power law in p diverges without load, where traction is nothing anyway: mu sees sqrt(p^2 +
/// p0^2). 1 Pa is a seventh of the fabric's own weight per area; at 5 kPa it moves the Hersey number by 2e-8.
inline constexpr double pressure_floor = 1.0;

struct FlooredPressure {
  double value;  ///< p_f = sqrt(p^2 + p0^2) [Pa], > 0
  double slope;  ///< d p_f / d p [-], 0 without load
};

/// The pressure at which mu is taken. Tables that are singular at p = 0 (contact area ~ p^a) are looked up
/// here as well: phi = phi(p_f), d phi / d p = phi'(p_f) * slope.
FlooredPressure floored(double pressure);

/// Hersey number of one contact point, and its logarithmic slopes.
struct HerseyNumber {
  double value;                     ///< Hs [-], > 0
  double dlog_dspeed;               ///< d ln Hs / d U [s/m]
  double dlog_dpressure;            ///< d ln Hs / d p [1/Pa], total: through phi as well
  double dlog_dfabric_temperature;  ///< [1/K]
  double viscosity;                 ///< eta [Pa s]
};

/// Dimensionless Hersey number with the pressure on the real contact area:
///
///     Hs = eta(U/h, T_fabric) U_f / ((p_f / phi) h),   U_f^2 = U^2 + (h g0)^2,   p_f^2 = p^2 + p0^2
///
/// Source: Gorczyca, Sherwood & Chen, Eqs 3 and 6, which divide by the force N and so carry the unit 1/m;
/// with pressure the number holds for any size of contact, and the film thickness makes it dimensionless. The
/// floors keep Hs positive with finite slopes at rest (U_f is h times the floored shear rate, so Hs = m
/// (U_f/h)^n phi / p_f) and without load.
HerseyNumber hersey_number(const PowerLawFilm& film, const Context& context);

}  // namespace heddle::friction
