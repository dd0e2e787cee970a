#pragma once

#include <array>

#include "friction/sensitivity.h"
#include "friction/term.h"

namespace heddle::friction {

/// Coulomb's law with a static coefficient: mu_s until the contact has slipped, mu_k from slip s0 on, a
/// smooth step between. It reads the slip at the start of the step, so the potential of a step is Coulomb's.
struct StaticKinetic {
  double static_coefficient = 0.36;  ///< mu_s [-], >= 0
  double kinetic_coefficient = 0.3;  ///< mu_k [-], >= 0
  double breakaway_slip = 1e-3;      ///< s0 [m], > 0
};

/// mu = mu_k + (mu_s - mu_k) exp(-U/Uc). Falls with speed where mu_s > mu_k, and is flagged there.
struct ExponentialDecay {
  double static_coefficient = 0.36;  ///< mu_s [-], >= 0
  double kinetic_coefficient = 0.3;  ///< mu_k [-], >= 0
  double decay_speed = 10e-3;        ///< Uc [m/s], > 0
};

/// mu = mu0 + c1 exp(c2 U) p^2 + c3 exp(c4 U) p + c5 exp(c6 U).
struct Darmstadt {
  double base = 0.3;           ///< mu0 [-], >= 0
  double square = 0.0;         ///< c1 [1/Pa^2]
  double square_rate = 0.0;    ///< c2 [s/m]
  double linear = -2.0e-7;     ///< c3 [1/Pa]
  double linear_rate = 0.0;    ///< c4 [s/m]
  double constant = 0.0;       ///< c5 [-]
  double constant_rate = 0.0;  ///< c6 [s/m]
};

/// A rise from mu_s to mu_max at U1, a smooth fall to mu_min at U2, and a recovery towards mu_d:
///     U <= U1:  mu_s + (mu_max - mu_s) x (2 - x),              x = U/U1
///     U <= U2:  mu_max + (mu_min - mu_max) y^2 (3 - 2 y),      y = (U - U1)/(U2 - U1)
///     beyond:   mu_d - d / (1 + d z^2),  d = mu_d - mu_min,    z = (U - U2)/Ur
struct Renard {
  double static_coefficient = 0.25;  ///< mu_s [-], >= 0
  double dynamic_coefficient = 0.3;  ///< mu_d [-], >= 0
  double maximum = 0.35;             ///< mu_max [-], >= 0
  double minimum = 0.25;             ///< mu_min [-], >= 0
  double first_speed = 10e-3;        ///< U1 [m/s], > 0
  double second_speed = 50e-3;       ///< U2 [m/s], > U1
  double recovery_speed = 1.0;       ///< Ur [m/s], > 0; 1 m/s is the published form in SI
};

/// Slip resistance S that hardens or softens with slip (Gearing, Moon & Anand), the contact's own state:
///     mu = S (sqrt(U^2 + U_rest^2)/U0)^m,   dS/ds = (S* - S)/L
/// `frozen` takes S at the start of the step: the step's potential is convex for m >= 0, and S lags by one
/// step, so slip per step must stay below L/5. `inside` takes S after the slip U dt of this very step,
/// exactly integrated: no lag, and where S softens faster than m hardens mu falls with U and is flagged.
struct SlipResistance {
  enum class Evolution { frozen, inside };
  double initial = 0.3;               ///< S0 [-], >= 0
  double saturated = 0.24;            ///< S* [-], >= 0
  double length = 5e-3;               ///< L [m], > 0
  double rate_exponent = 0.0;         ///< m [-], 0 <= m < 1
  double reference_speed = 16.67e-3;  ///< U0 [m/s], > 0
  Evolution evolution = Evolution::frozen;
};
/// U_rest [m/s]: below it the rate factor of SlipResistance levels out, so that its slope is finite at rest.
inline constexpr double rest_speed = 1e-5;

Sensitive coefficient(const StaticKinetic& law, const Inputs& inputs);
Sensitive coefficient(const ExponentialDecay& law, const Inputs& inputs);
Sensitive coefficient(const Darmstadt& law, const Inputs& inputs);
Sensitive coefficient(const Renard& law, const Inputs& inputs);
Sensitive coefficient(const SlipResistance& law, const Inputs& inputs);

/// S - S0 after the step.
double slip_resistance_after(const SlipResistance& law, const Context& context, const ContactState& state);

inline constexpr Bounds coefficient_range{.low = 0.0, .high = 10.0, .low_open = false};

template <>
struct About<StaticKinetic> {
  static constexpr const char* id = "static_kinetic";
  static constexpr const char* equation = "mu = mu_k + (mu_s - mu_k) (1 - t^2 (3 - 2 t)), t = min(s/s0, 1)";
  static constexpr const char* source = "Coulomb; peak over steady 1.1 to 2.0 within 1 to 10 mm (recalled)";
  static constexpr std::array fields{
      Field<StaticKinetic>{"static_coefficient", "", &StaticKinetic::static_coefficient, coefficient_range,
                           "mu_s before slip."},
      Field<StaticKinetic>{"kinetic_coefficient", "", &StaticKinetic::kinetic_coefficient, coefficient_range,
                           "mu_k once slipping."},
      Field<StaticKinetic>{"breakaway_slip", "m", &StaticKinetic::breakaway_slip, positive_range,
                           "s0: slip at which mu is mu_k (prior)."}};
};
template <>
struct About<ExponentialDecay> {
  static constexpr const char* id = "exponential_decay";
  static constexpr const char* equation = "mu = mu_k + (mu_s - mu_k) exp(-U/Uc)";
  static constexpr const char* source = "the exponential decay law of commercial codes; numbers are priors";
  static constexpr std::array fields{
      Field<ExponentialDecay>{"static_coefficient", "", &ExponentialDecay::static_coefficient,
                              coefficient_range, "mu_s at rest."},
      Field<ExponentialDecay>{"kinetic_coefficient", "", &ExponentialDecay::kinetic_coefficient,
                              coefficient_range, "mu_k at speed."},
      Field<ExponentialDecay>{"decay_speed", "m/s", &ExponentialDecay::decay_speed, positive_range,
                              "Uc: speed over which mu decays (prior)."}};
};
template <>
struct About<Darmstadt> {
  static constexpr const char* id = "darmstadt";
  static constexpr const char* equation = "mu = mu0 + c1 exp(c2 U) p^2 + c3 exp(c4 U) p + c5 exp(c6 U)";
  static constexpr const char* source =
      "friction law 2 of the Radioss contact interfaces; numbers are priors";
  static constexpr std::array fields{
      Field<Darmstadt>{"base", "", &Darmstadt::base, coefficient_range, "mu0."},
      Field<Darmstadt>{"square", "1/Pa^2", &Darmstadt::square, {}, "c1 of p^2."},
      Field<Darmstadt>{"square_rate", "s/m", &Darmstadt::square_rate, {}, "c2 of its speed factor."},
      Field<Darmstadt>{"linear", "1/Pa", &Darmstadt::linear, {}, "c3 of p."},
      Field<Darmstadt>{"linear_rate", "s/m", &Darmstadt::linear_rate, {}, "c4 of its speed factor."},
      Field<Darmstadt>{"constant", "", &Darmstadt::constant, {}, "c5."},
      Field<Darmstadt>{"constant_rate", "s/m", &Darmstadt::constant_rate, {}, "c6 of its speed factor."}};
};
template <>
struct About<Renard> {
  static constexpr const char* id = "renard";
  static constexpr const char* equation =
      "mu_s + (mu_max - mu_s) x (2 - x) | mu_max + (mu_min - mu_max) y^2 (3 - 2 y) | mu_d - d / (1 + d z^2)";
  static constexpr const char* source =
      "friction law 3 of the Radioss contact interfaces; numbers are priors";
  static constexpr std::array fields{
      Field<Renard>{"static_coefficient", "", &Renard::static_coefficient, coefficient_range,
                    "mu_s at rest."},
      Field<Renard>{"dynamic_coefficient", "", &Renard::dynamic_coefficient, coefficient_range,
                    "mu_d at high speed."},
      Field<Renard>{"maximum", "", &Renard::maximum, coefficient_range, "mu_max at the first speed."},
      Field<Renard>{"minimum", "", &Renard::minimum, coefficient_range, "mu_min at the second speed."},
      Field<Renard>{"first_speed", "m/s", &Renard::first_speed, positive_range, "U1."},
      Field<Renard>{"second_speed", "m/s", &Renard::second_speed, positive_range, "U2, above U1."},
      Field<Renard>{"recovery_speed", "m/s", &Renard::recovery_speed, positive_range,
                    "Ur; 1 m/s is the published form in SI."}};
};
template <>
struct About<SlipResistance> {
  static constexpr const char* id = "slip_resistance";
  static constexpr const char* equation = "mu = S (U_f/U0)^m, dS/ds = (S* - S)/L";
  static constexpr const char* source =
      "Gearing, Moon & Anand 2001 (isothermal, isotropic part), as the paper cites it; L 1 to 10 mm (prior)";
  static constexpr std::array fields{
      Field<SlipResistance>{"initial", "", &SlipResistance::initial, coefficient_range, "S0 at first touch."},
      Field<SlipResistance>{"saturated", "", &SlipResistance::saturated, coefficient_range,
                            "S* after much slip."},
      Field<SlipResistance>{"length", "m", &SlipResistance::length, positive_range,
                            "L: slip over which S saturates (prior)."},
      Field<SlipResistance>{"rate_exponent",
                            "",
                            &SlipResistance::rate_exponent,
                            {0.0, 1.0, false, true},
                            "m of the slip rate; 0 = rate-free."},
      Field<SlipResistance>{"reference_speed", "m/s", &SlipResistance::reference_speed, positive_range,
                            "U0 at which mu is S."}};
};

}  // namespace heddle::friction
