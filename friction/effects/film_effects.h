#pragma once

#include <array>

#include "friction/rheology/rheology.h"
#include "friction/sensitivity.h"
#include "friction/term.h"

namespace heddle::friction {

/// Effect F1: the film is sheared between fabric and tool temperature,
///     T_film = T_fabric + w S(t/t_s) (T_tool - T_fabric).
/// S is the mean over the film of its warming from a tool touched at t = 0 (half-space: mean of erfc), so a
/// slow pull sees w and a fast stroke less; t_s = h^2/alpha. t_s = 0: settled at once. With a film conduction
/// w S is w times the share of the tool at each point through the film, which holds the effusivities of tool
/// and ply (w = 1 is then the whole of it; t_s is not used), and T_film is the temperature at which an even
/// film would be as thin: one stress goes through the film, so it is sheared where it is hottest,
///     a(T_film)^(-1/n) = mean of a(T_i)^(-1/n).
struct ToolTemperatureFilm {
  double weight = 0.0;    ///< w [-], 0..1; 0 = off
  double settling = 0.0;  ///< t_s [s], >= 0
};

/// Effect F6: contact area that grows with pressure, phi *= (p_f / p_ref)^q (tow flattening).
struct PressureDependentArea {
  double exponent = 0.0;              ///< q [-]; 0 = off
  double reference_pressure = 150e3;  ///< p_ref [Pa], > 0
};

/// Effect F9: film squeezed out in contact, h = h0 (1 + B p t)^(-1/2) (Stefan, Newtonian). The thinner film
/// shears faster (through Hs), and lets fibres through to the tool: mu *= 1 + A (1 - h/h0).
struct FilmSqueezeOut {
  double rate = 0.0;     ///< B [1/(Pa s)], >= 0; 0 = off
  double contact = 0.0;  ///< A [-], > -1: growth of mu when the film is gone; 0: through Hs alone
};

/// Effect F12: the film heats itself, eta *= asinh(sqrt x)/sqrt(x (1 + x)) with x = A Na/8 and the Nahme
/// number Na = beta eta U^2/k, beta = -d ln a/dT (plane Couette flow between walls at the film's temperature;
/// Nahme 1940). A = 1: both walls held; 4: one of them adiabatic; up to 8 L/h where the heat leaves through a
/// ply of thickness L. Heat gathers as the pull goes on: A is multiplied by heated_share of s/(U t_s), t_s =
/// 0 at once. With a film conduction k is the melt's there and A is multiplied by 12 times its heating rise
/// (1/12 between held walls) after the time s/U for which the film has been sheared, so that A = 1 is the
/// whole of it.
struct ShearHeating {
  double amplitude = 0.0;      ///< A [-], >= 0; 0 = off
  double conductivity = 0.19;  ///< k [W/(m K)], > 0
  double settling = 0.0;       ///< t_s [s], >= 0: of the slowest mode, h^2/(pi^2 alpha) between held walls
};

/// Effect F14: a Newtonian plateau at low rate, 1/eta' = 1/eta + 1/(a eta0). On a power law this is Cross's
/// fluid.
struct ViscosityPlateau {
  double fluidity = 0.0;  ///< 1/eta0 at the reference temperature [1/(Pa s)], >= 0; 0 = off
};

/// Mean of erfc(z/(2 sqrt(alpha t))) over 0 <= z <= h against t alpha/h^2: how far a film has taken on the
/// temperature of the surface it touches. 0 at first touch, 1 when settled.
Sensitive settled_share(const Sensitive& time_over_settling);

/// Mean rise of a layer that is heated evenly from t = 0 on, its faces held, as share of the final one,
/// against t over the time of its slowest mode, h^2/(pi^2 alpha): 1 - 96/pi^4 sum over odd n of
/// exp(-n^2 t)/n^4. Starts with the slope 12/pi^2, all heat still in the layer. Three modes: within 5e-4,
/// the slope at 0 within 5 %.
Sensitive heated_share(const Sensitive& time_over_settling);

/// @param film  whose index n the points share
Sensitive temperature_with(const ToolTemperatureFilm& effect, const TemperatureLaw& law,
                           const PowerLawFilm& film, const Inputs& inputs);
Sensitive thickness_with(const FilmSqueezeOut& effect, double thickness, const Inputs& inputs);
/// On mu: solid contact through the thinned film.
Sensitive factor_of(const FilmSqueezeOut& effect, const Inputs& inputs);
Sensitive area_with(const PressureDependentArea& effect, const Inputs& inputs);
Sensitive viscosity_with(const ViscosityPlateau& effect, const Sensitive& viscosity,
                         const Sensitive& log_shift);
/// @param strength  A/(8 k) [m K/W]
Sensitive viscosity_with(const Sensitive& strength, const Sensitive& viscosity, const Sensitive& softening,
                         const Sensitive& speed);
/// A/(8 k) of the contact, with the film conduction where there is one.
/// @param rest_speed  at which a film at rest counts as sheared, h g0 [m/s]
Sensitive heating_strength(const ShearHeating& effect, const Inputs& inputs, double rest_speed);

template <>
struct About<ToolTemperatureFilm> {
  static constexpr const char* id = "tool_temperature_film";
  static constexpr const char* equation = "T_film = T_fabric + w S(t/t_s) (T_tool - T_fabric)";
  static constexpr const char* source =
      "interface temperature of two half-spaces, w up to 0.945 for polypropylene on steel (derived)";
  static constexpr std::array fields{
      Field<ToolTemperatureFilm>{"weight",
                                 "",
                                 &ToolTemperatureFilm::weight,
                                 {0.0, 1.0, false, false},
                                 "Share of the tool in the film temperature; 0 is off."},
      Field<ToolTemperatureFilm>{"settling", "s", &ToolTemperatureFilm::settling, not_negative,
                                 "h^2/alpha, about 0.05 s; 0 s settles at once."}};
};
template <>
struct About<PressureDependentArea> {
  static constexpr const char* id = "pressure_dependent_area";
  static constexpr const char* equation = "phi *= (p_f/p_ref)^q";
  static constexpr const char* source = "tow flattening; q 0.05 to 0.5 (prior), Table 4 alone asks for 0.31";
  static constexpr std::array fields{
      Field<PressureDependentArea>{"exponent",
                                   "",
                                   &PressureDependentArea::exponent,
                                   {-1.0, 1.0, true, true},
                                   "q of the area in the pressure; 0 is off."},
      Field<PressureDependentArea>{"reference_pressure", "Pa", &PressureDependentArea::reference_pressure,
                                   positive_range, "Pressure at which the area is unchanged."}};
};
template <>
struct About<FilmSqueezeOut> {
  static constexpr const char* id = "film_squeeze_out";
  static constexpr const char* equation = "h = h0 (1 + B p t)^(-1/2), mu *= 1 + A (1 - h/h0)";
  static constexpr const char* source = "Stefan's squeeze film; B a prior";
  static constexpr std::array fields{
      Field<FilmSqueezeOut>{"rate", "1/(Pa s)", &FilmSqueezeOut::rate, not_negative,
                            "B of the thinning under pressure; 0 1/(Pa s) is off."},
      Field<FilmSqueezeOut>{"contact",
                            "",
                            &FilmSqueezeOut::contact,
                            {-1.0, 10.0, true, false},
                            "Growth of mu by solid contact when the film is gone; 0: by the film alone."}};
};
template <>
struct About<ShearHeating> {
  static constexpr const char* id = "shear_heating";
  static constexpr const char* equation = "eta *= asinh(sqrt x)/sqrt(x (1 + x)), x = A R beta eta U^2/(8 k)";
  static constexpr const char* source =
      "Nahme 1940, plane Couette flow; k of polypropylene melt 0.17 to 0.20 (recalled)";
  static constexpr std::array fields{
      Field<ShearHeating>{"amplitude", "", &ShearHeating::amplitude, not_negative,
                          "0 is off, 1 both walls held, 4 one adiabatic."},
      Field<ShearHeating>{"conductivity", "W/(m K)", &ShearHeating::conductivity, positive_range,
                          "Of the melt."},
      Field<ShearHeating>{"settling", "s", &ShearHeating::settling, not_negative,
                          "Time of sliding over which the heat of the layer gathers; 0 s: at once."}};
};
template <>
struct About<ViscosityPlateau> {
  static constexpr const char* id = "viscosity_plateau";
  static constexpr const char* equation = "1/eta' = 1/eta + 1/(a eta0)";
  static constexpr const char* source = "Cross 1965 on the power law; eta0 1e3 to 1e4 Pa s (prior)";
  static constexpr std::array fields{Field<ViscosityPlateau>{"fluidity", "1/(Pa s)",
                                                             &ViscosityPlateau::fluidity, not_negative,
                                                             "1/eta0 of the plateau; 0 1/(Pa s) is off."}};
};

}  // namespace heddle::friction
