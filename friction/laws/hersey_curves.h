#pragma once

#include <array>
#include <string>
#include <vector>

#include "core/curve.h"
#include "friction/laws/law_value.h"
#include "friction/term.h"

namespace heddle::friction {

/// The whole Stribeck curve with its boundary, mixed and hydrodynamic branches:
///
///     mu = mu_h + (mu_b - mu_h) exp(-(Hs/Hc)^k),   mu_h = a + b Hs/Hs0
///
/// Below Hc the solids touch and mu is mu_b; about Hc it falls (not convex: slip may localise); beyond, the
/// film carries. Table 4 shows no boundary branch, so mu_b, Hc and k are priors; a, b and Hs0 come from it.
struct StribeckCurve {
  double boundary = 0.4;     ///< mu_b [-], >= 0
  double transition = 0.02;  ///< Hc [-], > 0
  double sharpness = 1.0;    ///< k [-], > 0
  double offset = 0.236;     ///< a [-], >= 0
  double slope = 0.045;      ///< b [-], >= 0
  double reference = 0.362;  ///< Hs0 [-], > 0
};

enum class Regime { boundary, mixed, hydrodynamic };
/// Boundary where more than 9 tenths of mu_b - mu_h is left, hydrodynamic where less than 1 tenth is.
Regime regime(const StribeckCurve& law, double hersey);

/// Film and solid side by side: tau = w phi eta U_f/h + mu_s p, the film's share of the area being w of the
/// contact area phi that the mesoscale gives. With Hs = eta U_f phi / (p_f h) this is mu = mu_s + w Hs.
struct FilmSolid {
  double solid = 0.236;        ///< mu_s [-], >= 0
  double wetted_share = 0.13;  ///< w [-], 0 <= w <= 1
};

/// Measured pairs of Hs and mu, joined by a smooth monotone curve over ln Hs (core/curve.h); its log slope at
/// either end is held beyond.
struct HerseyTable {
  std::vector<double> hersey;       ///< [-], > 0, strictly rising, two at least
  std::vector<double> coefficient;  ///< mu [-], > 0, as many
  Curve curve;                      ///< mu over ln Hs; made by hersey_table
};
/// @throws InputError  if the pairs break one of the rules above, with all of them
HerseyTable hersey_table(std::vector<double> hersey, std::vector<double> coefficient);

/// Reads the columns hersey_number and friction_coefficient (any order, others passed over).
/// @throws InputError  with every problem and its line
HerseyTable read_hersey_table(const std::string& path);

/// Inside the range of each, without the calibrated box.
/// @param hersey  Hs [-], > 0
LawValue curve_value(const StribeckCurve& law, double hersey);
LawValue curve_value(const FilmSolid& law, double hersey);
LawValue curve_value(const HerseyTable& law, double hersey);

template <>
struct About<StribeckCurve> {
  static constexpr const char* id = "three_branch";
  static constexpr const char* equation = "mu = mu_h + (mu_b - mu_h) exp(-(Hs/Hc)^k), mu_h = a + b Hs/Hs0";
  static constexpr const char* source =
      "Stribeck curve in the exponential form of Bo & Pavelescu 1982 over the paper's Hersey number; a, b, "
      "Hs0 "
      "from Table 4, mu_b, Hc and k are priors";
  static constexpr std::array fields{
      Field<StribeckCurve>{"boundary",
                           "",
                           &StribeckCurve::boundary,
                           {0.0, 10.0, false, true},
                           "mu_b where the film is gone (prior)."},
      Field<StribeckCurve>{"transition", "", &StribeckCurve::transition, positive_range,
                           "Hc: Hersey number of the mixed branch (prior)."},
      Field<StribeckCurve>{"sharpness",
                           "",
                           &StribeckCurve::sharpness,
                           {0.0, 20.0, true, false},
                           "k: how steep the mixed branch is (prior)."},
      Field<StribeckCurve>{
          "offset", "", &StribeckCurve::offset, {0.0, 10.0, false, true}, "a of the hydrodynamic branch."},
      Field<StribeckCurve>{
          "slope", "", &StribeckCurve::slope, {0.0, 10.0, false, true}, "b of the hydrodynamic branch."},
      Field<StribeckCurve>{"reference_hersey", "", &StribeckCurve::reference, positive_range,
                           "Hs0 of the hydrodynamic branch."}};
};
template <>
struct About<FilmSolid> {
  static constexpr const char* id = "film_solid";
  static constexpr const char* equation = "mu = mu_s + w Hs, from tau = w phi eta U_f/h + mu_s p";
  static constexpr const char* source =
      "after ten Thije & Akkerman 2011 (film shear on the contact area of the weave); mu_s and w from Table "
      "4 at "
      "an assumed plate area";
  static constexpr std::array fields{
      Field<FilmSolid>{
          "solid", "", &FilmSolid::solid, {0.0, 10.0, false, true}, "mu_s of the solid contact."},
      Field<FilmSolid>{"wetted_share",
                       "",
                       &FilmSolid::wetted_share,
                       {0.0, 1.0, false, false},
                       "w: wetted share of the contact area."}};
};
template <>
struct About<HerseyTable> {
  static constexpr const char* id = "table";
  static constexpr const char* equation = "mu = table(ln Hs), smooth and monotone between its points";
  static constexpr const char* source = "the table's own; interpolation of Fritsch & Butland 1984";
  static constexpr std::array<Field<HerseyTable>, 0> fields{};
};

}  // namespace heddle::friction
