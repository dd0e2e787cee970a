#pragma once

#include <array>
#include <span>
#include <variant>

#include "friction/power_law_film.h"
#include "friction/term.h"

namespace heddle::friction {

/// Rate dependence of the resin. `g` below is the floored rate sqrt(g^2 + g0^2) of PowerLawFilm, so every
/// rheology is even and smooth at rest. PowerLaw takes m and n of the film itself.
struct PowerLaw {};

/// eta = mu_p + tau_y (1 - exp(-M g)) / g, Papanastasiou's regularisation of Bingham's solid.
struct Bingham {
  double yield_stress = 500.0;  ///< tau_y [Pa], >= 0
  double viscosity = 200.0;     ///< mu_p [Pa s], > 0
  double sharpness = 100.0;     ///< M [s], > 0
};

/// eta = K g^(n-1) + tau_y (1 - exp(-M g)) / g, regularised in the same way.
struct HerschelBulkley {
  double yield_stress = 500.0;  ///< tau_y [Pa], >= 0
  double consistency = 6790.0;  ///< K [Pa s^n], > 0
  double power_index = 0.38;    ///< n [-], 0 < n <= 1
  double sharpness = 100.0;     ///< M [s], > 0
};

/// eta = eta_inf + (eta0 - eta_inf) (1 + (lambda g)^a)^((n-1)/a).
struct CarreauYasuda {
  double zero_viscosity = 3000.0;   ///< eta0 [Pa s], > 0
  double infinite_viscosity = 0.0;  ///< eta_inf [Pa s], >= 0
  double relaxation_time = 0.268;   ///< lambda [s], > 0
  double transition = 2.0;          ///< a [-], > 0; 2 = Carreau
  double power_index = 0.38;        ///< n [-], 0 < n <= 1
};

/// eta = eta0 / (1 + (lambda g)^(1-n)).
struct Cross {
  double zero_viscosity = 3000.0;  ///< eta0 [Pa s], > 0
  double relaxation_time = 0.268;  ///< lambda [s], > 0
  double power_index = 0.38;       ///< n [-], 0 < n <= 1
};

using Flow = std::variant<PowerLaw, Bingham, HerschelBulkley, CarreauYasuda, Cross>;

/// Temperature shift a(T), 1 at the film's reference temperature. Arrhenius takes E of the film:
/// ln a = E/R (1/T - 1/T_ref).
struct Arrhenius {};

/// Williams, Landel & Ferry: ln a = -c1 (T - T_ref) / (c2 + T - T_ref).
struct Wlf {
  double c1 = 5.94;   ///< [-], >= 0
  double c2 = 241.6;  ///< [K], > 0; the shift is infinite at T_ref - c2
};

using TemperatureLaw = std::variant<Arrhenius, Wlf>;

/// How the film's resin flows.
struct Rheology {
  Flow flow = {};
  TemperatureLaw temperature = {};

  /// The film's own power law with its activation energy: the paper's.
  bool of_the_film() const {
    return std::holds_alternative<PowerLaw>(flow) && std::holds_alternative<Arrhenius>(temperature);
  }
};

/// ln a(T), and its slopes.
struct TemperatureShift {
  double log;
  double slope;  ///< d ln a / d T [1/K]
  double curve;  ///< d^2 ln a / d T^2 [1/K^2]
};
/// @param temperature  [K], > 0
TemperatureShift temperature_shift(const TemperatureLaw& law, const PowerLawFilm& film, double temperature);

/// The temperature that has this ln a: the inverse of the shift, by Newton's method.
/// @param start  where to begin, and the answer where heat does not thin the resin [K]
double temperature_at_shift(const TemperatureLaw& law, const PowerLawFilm& film, double log_shift,
                            double start);
/// Temperature of an even film as thin as one with these temperatures through it. One stress goes through a
/// film, so it is sheared where it is hottest: a(T)^(-1/n) is the mean of that of its layers.
/// @param temperature, thickness  of the layers, equal in number [K], [m]
double temperature_as_thin_as(const TemperatureLaw& law, const PowerLawFilm& film,
                              std::span<const double> temperature, std::span<const double> thickness);

/// Viscosity of the film. The shift multiplies the viscous part of PowerLaw, Bingham and HerschelBulkley (a
/// yield stress is held); CarreauYasuda and Cross follow time-temperature superposition, eta = a F(a g).
/// With `Rheology{}` these are the bits of PowerLawFilm::evaluate.
/// @param rate         g [1/s], any sign
/// @param temperature  of the film [K], > 0
PowerLawFilm::Value viscosity(const Rheology& rheology, const PowerLawFilm& film, double rate,
                              double temperature);

template <>
struct About<PowerLaw> {
  static constexpr const char* id = "power_law";
  static constexpr const char* equation = "eta = m a g^(n-1)";
  static constexpr const char* source = "Ostwald-de Waele; paper, Eq. 4";
  static constexpr std::array<Field<PowerLaw>, 0> fields{};
};
template <>
struct About<Bingham> {
  static constexpr const char* id = "bingham";
  static constexpr const char* equation = "eta = mu_p a + tau_y (1 - exp(-M g)) / g";
  static constexpr const char* source = "Bingham 1922, regularised as Papanastasiou 1987; numbers are priors";
  static constexpr std::array fields{
      Field<Bingham>{"yield_stress", "Pa", &Bingham::yield_stress, not_negative,
                     "tau_y of the melt (prior)."},
      Field<Bingham>{"viscosity", "Pa s", &Bingham::viscosity, positive_range, "Plastic viscosity (prior)."},
      Field<Bingham>{"sharpness", "s", &Bingham::sharpness, positive_range,
                     "M: how sharply the melt yields."}};
};
template <>
struct About<HerschelBulkley> {
  static constexpr const char* id = "herschel_bulkley";
  static constexpr const char* equation = "eta = K a g^(n-1) + tau_y (1 - exp(-M g)) / g";
  static constexpr const char* source =
      "Herschel & Bulkley 1926, regularised as Papanastasiou 1987; K and n of polypropylene, yield a prior";
  static constexpr std::array fields{
      Field<HerschelBulkley>{"yield_stress", "Pa", &HerschelBulkley::yield_stress, not_negative,
                             "tau_y of the melt (prior)."},
      Field<HerschelBulkley>{"consistency", "Pa s^n", &HerschelBulkley::consistency, positive_range,
                             "K at the reference temperature; polypropylene at 180 degC: 6790 Pa s^n."},
      Field<HerschelBulkley>{"power_index",
                             "",
                             &HerschelBulkley::power_index,
                             {.low = 0.0, .high = 1.0, .high_open = false},
                             "n; polypropylene: 0.37 to 0.41."},
      Field<HerschelBulkley>{"sharpness", "s", &HerschelBulkley::sharpness, positive_range,
                             "M: how sharply the melt yields."}};
};
template <>
struct About<CarreauYasuda> {
  static constexpr const char* id = "carreau_yasuda";
  static constexpr const char* equation =
      "eta = a (eta_inf + (eta0 - eta_inf) (1 + (lambda a g)^b)^((n-1)/b))";
  static constexpr const char* source =
      "Carreau 1972, Yasuda 1981; plateau a prior, tail that of polypropylene (m, n at 180 degC)";
  static constexpr std::array fields{
      Field<CarreauYasuda>{"zero_viscosity", "Pa s", &CarreauYasuda::zero_viscosity, positive_range,
                           "eta0 at the reference temperature (prior)."},
      Field<CarreauYasuda>{"infinite_viscosity", "Pa s", &CarreauYasuda::infinite_viscosity, not_negative,
                           "eta_inf, below eta0; 0 Pa s for melts."},
      Field<CarreauYasuda>{"relaxation_time", "s", &CarreauYasuda::relaxation_time, positive_range,
                           "lambda: thinning starts at 1 / lambda."},
      Field<CarreauYasuda>{"transition", "", &CarreauYasuda::transition, positive_range,
                           "Width of the bend; 2 is Carreau's."},
      Field<CarreauYasuda>{"power_index",
                           "",
                           &CarreauYasuda::power_index,
                           {.low = 0.0, .high = 1.0, .high_open = false},
                           "n; polypropylene: 0.37 to 0.41."}};
};
template <>
struct About<Cross> {
  static constexpr const char* id = "cross";
  static constexpr const char* equation = "eta = a eta0 / (1 + (lambda a g)^(1-n))";
  static constexpr const char* source =
      "Cross 1965; plateau a prior, tail that of polypropylene (m, n at 180 degC)";
  static constexpr std::array fields{
      Field<Cross>{"zero_viscosity", "Pa s", &Cross::zero_viscosity, positive_range,
                   "eta0 at the reference temperature (prior)."},
      Field<Cross>{"relaxation_time", "s", &Cross::relaxation_time, positive_range,
                   "lambda: thinning starts at 1 / lambda."},
      Field<Cross>{"power_index",
                   "",
                   &Cross::power_index,
                   {.low = 0.0, .high = 1.0, .high_open = false},
                   "n; polypropylene: 0.37 to 0.41."}};
};
template <>
struct About<Arrhenius> {
  static constexpr const char* id = "arrhenius";
  static constexpr const char* equation = "ln a = E/R (1/T - 1/T_ref)";
  static constexpr const char* source = "Arrhenius; E of polypropylene melts 38 to 46 kJ/mol (recalled)";
  static constexpr std::array<Field<Arrhenius>, 0> fields{};
};
template <>
struct About<Wlf> {
  static constexpr const char* id = "wlf";
  static constexpr const char* equation = "ln a = -c1 (T - T_ref) / (c2 + T - T_ref)";
  static constexpr const char* source =
      "Williams, Landel & Ferry 1955; shape of a public polypropylene data sheet carried over to 180 degC "
      "(its viscosity level is not used)";
  static constexpr std::array fields{Field<Wlf>{"c1", "", &Wlf::c1, not_negative,
                                                "c1 of the natural logarithm at the reference temperature."},
                                     Field<Wlf>{"c2", "K", &Wlf::c2, positive_range,
                                                "c2: the shift is infinite this far below the reference."}};
};

}  // namespace heddle::friction
