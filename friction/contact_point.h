#pragma once

namespace heddle::friction {

/// What one contact point knows. SI units.
struct Context {
  double slip_speed = 0.0;             ///< U = |v| relative to the tool [m/s], >= 0
  double pressure = 0.0;               ///< nominal p = N / A [Pa], >= 0
  double fabric_temperature = 453.15;  ///< [K]
  double tool_temperature = 358.15;    ///< [K]
  double area_fraction = 1.0;          ///< phi: real over nominal contact area [-], > 0; 1 = nominal pressure
  double area_slope = 0.0;             ///< d phi / d p [1/Pa]
};

/// Memory of one contact point: a value, pure until the step is accepted. Laws without memory return it
/// unchanged.
struct ContactState {
  double slip = 0.0;              ///< accumulated slip [m]
  double dwell = 0.0;             ///< time in contact [s]
  double work_per_area = 0.0;     ///< friction work [J/m^2]
  double slip_resistance = 0.0;   ///< internal variable of rate-and-state laws [-]
  double film_temperature = 0.0;  ///< [K]
};

/// Friction coefficient of one contact point, and how it changes.
struct Friction {
  double mu = 0.0;
  double dmu_dspeed = 0.0;               ///< [s/m]
  double dmu_dpressure = 0.0;            ///< [1/Pa], total: through phi as well
  double dmu_dfabric_temperature = 0.0;  ///< [1/K]
  double dmu_dtool_temperature = 0.0;    ///< [1/K]
  double hersey = 0.0;                   ///< Hs = eta U / (p h) [-]; 0 where the law has none
  double film_viscosity = 0.0;           ///< eta [Pa s]; 0 where the law has none
  bool convex = true;                    ///< mu(U) does not fall here: the friction potential is convex
  ContactState state{};                  ///< at the end of the step
};

}  // namespace heddle::friction
