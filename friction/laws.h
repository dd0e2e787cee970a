#pragma once

#include <array>
#include <concepts>
#include <variant>

#include "friction/contact_point.h"
#include "friction/laws/hersey_curves.h"
#include "friction/laws/law_value.h"
#include "friction/laws/speed_laws.h"
#include "friction/term.h"

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

using Law = std::variant<Coulomb, HerseyPower, HerseyLinear, StribeckCurve, FilmSolid, HerseyTable,
                         StaticKinetic, ExponentialDecay, Darmstadt, Renard, SlipResistance>;

/// Where the law was fitted. Outside, the log slope of the law in Hs, and through Hs in p and U, is held, and
/// reports print the share of friction work that lies outside.
struct CalibrationBox {
  double hersey_low = 0.0, hersey_high = 1e300;      ///< [-]
  double pressure_low = 0.0, pressure_high = 1e300;  ///< nominal [Pa]
  double speed_low = 0.0, speed_high = 1e300;        ///< [m/s]

  /// Edges count as inside.
  bool contains(const Context& context, double hersey) const;
};

/// @param hersey  Hs [-], > 0
LawValue law_value(const HerseyPower& law, double hersey, const CalibrationBox& box);
LawValue law_value(const HerseyLinear& law, double hersey, const CalibrationBox& box);
LawValue law_value(const StribeckCurve& law, double hersey, const CalibrationBox& box);
LawValue law_value(const FilmSolid& law, double hersey, const CalibrationBox& box);
LawValue law_value(const HerseyTable& law, double hersey, const CalibrationBox& box);

/// Whether a law sees speed, pressure and temperature through the Hersey number, so that film and contact
/// area act on it.
template <class AnyLaw>
concept HerseyLaw = requires(const AnyLaw& law, const CalibrationBox& box) {
  { law_value(law, 1.0, box) } -> std::same_as<LawValue>;
};

bool reads_hersey_number(const Law& law);
/// As in the configuration: "power", "three_branch", "coulomb", ...
const char* id_of(const Law& law);

template <>
struct About<Coulomb> {
  static constexpr const char* id = "coulomb";
  static constexpr const char* equation = "mu = constant";
  static constexpr const char* source = "Coulomb; paper, Eqs 1 and 7, which compares with 0.3";
  static constexpr std::array fields{
      Field<Coulomb>{"coefficient", "", &Coulomb::coefficient, coefficient_range, "mu of the Coulomb law."}};
};
template <>
struct About<HerseyPower> {
  static constexpr const char* id = "power";
  static constexpr const char* equation = "mu = C Hs^s";
  static constexpr const char* source = "paper, Eqs 3 to 6 and 8; C and s fitted to Table 4";
  static constexpr std::array fields{
      Field<HerseyPower>{"scale", "", &HerseyPower::scale, positive_range, "C of the power form."},
      Field<HerseyPower>{
          "exponent", "", &HerseyPower::exponent, {-1.0, 1.0, true, true}, "s of the power form."}};
};
template <>
struct About<HerseyLinear> {
  static constexpr const char* id = "linear";
  static constexpr const char* equation = "mu = a + b Hs/Hs0";
  static constexpr const char* source = "usual reading of the hydrodynamic branch; a and b fitted to Table 4";
  static constexpr std::array fields{
      Field<HerseyLinear>{"offset", "", &HerseyLinear::offset, {}, "a of the linear form."},
      Field<HerseyLinear>{"slope", "", &HerseyLinear::slope, {}, "b of the linear form."},
      Field<HerseyLinear>{"reference_hersey", "", &HerseyLinear::reference, positive_range,
                          "Hs0 of the linear form."}};
};

}  // namespace heddle::friction
