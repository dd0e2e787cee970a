#pragma once

#include <variant>

#include "friction/contact_point.h"

namespace heddle::friction {

/// mu independent of everything (paper, Eqs 1 and 7).
struct Coulomb {
  double coefficient = 0.3;  ///< mu [-], >= 0
};

/// mu = C Hs^s. Its log slope is the same everywhere, so holding it outside the calibrated box needs no
/// branch.
struct HerseyPower {
  double scale = 0.0;  ///< C [-], > 0
  double exponent =
      0.0;  ///< s [-], -1 < s < 1; at s = 1 the friction force would no longer rise with the load
};

/// mu = a + b Hs / Hs0 inside the calibrated box, the usual reading of the hydrodynamic branch.
/// Outside it goes on as a power law with the log slope at the edge: fitted at 150..300 kPa, the straight
/// line gives mu of about 1 at 8 kPa and 17 mm/s and 2 at 160 mm/s, a traction that hardly falls with the
/// load any more.
struct HerseyLinear {
  double offset = 0.0;     ///< a [-]
  double slope = 0.0;      ///< b [-]
  double reference = 1.0;  ///< Hs0 [-], > 0
};

using Law = std::variant<Coulomb, HerseyPower, HerseyLinear>;

/// Where the law was fitted. Outside, the log slope of the law in Hs, and through Hs in p and U, is held, and
/// reports print the share of friction work that lies outside.
struct CalibrationBox {
  double hersey_low = 0.0, hersey_high = 1e300;      ///< [-]
  double pressure_low = 0.0, pressure_high = 1e300;  ///< nominal [Pa]
  double speed_low = 0.0, speed_high = 1e300;        ///< [m/s]

  /// Edges count as inside.
  bool contains(const Context& context, double hersey) const;
};

struct LawValue {
  double mu;               ///< [-]
  double dmu_dlog_hersey;  ///< d mu / d ln Hs [-]
};

/// @param hersey  Hs [-], > 0
LawValue law_value(const HerseyPower& law, double hersey, const CalibrationBox& box);
LawValue law_value(const HerseyLinear& law, double hersey, const CalibrationBox& box);

}  // namespace heddle::friction
