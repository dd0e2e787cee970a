#pragma once

namespace heddle::friction {

/// What one contact point knows. SI units.
struct Context {
  double slip_speed = 0.0;             ///< U = |v| relative to the tool [m/s], >= 0
  double pressure = 0.0;               ///< nominal p = N / A [Pa], >= 0
  double fabric_temperature = 453.15;  ///< [K]
  double tool_temperature = 358.15;    ///< [K]
  /// Of the film's face towards the tool [K], where heat is followed through the film; 0: effects estimate it.
  double interface_temperature = 0.0;
  double area_fraction = 1.0;          ///< phi: real over nominal contact area [-], > 0; 1 = nominal pressure
  double area_slope = 0.0;             ///< d phi / d p [1/Pa]
  /// theta: slip direction against the warp [rad]. Held (lagged) over a step: mu(theta) v/|v| has no
  /// potential, so no slope to it is given.
  double slip_angle = 0.0;
  /// gamma: trellis shear angle, > 0 where warp and weft turn towards each other on the side where theta
  /// grows from warp to weft [rad]. Held like theta.
  double shear_angle = 0.0;
  /// K_c, K_s of the film of the sheared fabric at this pressure and shear: its drag goes as
  /// 1 + K_c cos 2 theta + K_s sin 2 theta [-]. Held like theta.
  double drag_cosine = 0.0, drag_sine = 0.0;
  /// dt [s]: how long the step lasts over which the memory advances; 0 = it stays as it is.
  double time_step = 0.0;
};

/// Memory of one contact point: a value, pure until the step is accepted. Laws without memory return it
/// unchanged. Who takes the step adds slip, dwell and work; the law and its effects advance the rest.
struct ContactState {
  double slip = 0.0;              ///< s: accumulated slip [m]
  double dwell = 0.0;             ///< t: time in contact [s]
  double work_per_area = 0.0;     ///< friction work [J/m^2]
  double slip_resistance = 0.0;   ///< S - S0: change of the slip resistance since first touch [-]
  double film_temperature = 0.0;  ///< of the film at the last evaluation that computed one [K]
  double age = 0.0;               ///< time in contact that slip has not wiped out [s]
  double load_slip = 0.0;         ///< q = Int p ds [Pa m]
};

/// Slopes of mu to the memory that came into the step.
struct HistorySlopes {
  double dmu_dslip = 0.0;             ///< [1/m]
  double dmu_ddwell = 0.0;            ///< [1/s]
  double dmu_dage = 0.0;              ///< [1/s]
  double dmu_dload_slip = 0.0;        ///< [1/(Pa m)]
  double dmu_dslip_resistance = 0.0;  ///< [-]
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
  HistorySlopes history{};
};

}  // namespace heddle::friction
