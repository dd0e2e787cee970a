#pragma once

#include <array>
#include <optional>
#include <string_view>
#include <tuple>

#include "friction/contact_point.h"
#include "friction/effects/coefficient_effects.h"
#include "friction/effects/film_effects.h"
#include "friction/term.h"

namespace heddle::friction {

/// Effect F2 (paper, section 2, "shifting term"): mu += slope (T_tool - reference), or mu *= 1 + slope (...).
/// The paper names the term and prints neither its form nor its size. The term is the same step of mu at
/// every load; the factor is the same share of mu, so it grows where mu is large (low pressure).
struct ToolTemperatureShift {
  enum class Form { term, factor };
  double slope = 0.0;         ///< [1/K]; 0 = off
  double reference = 358.15;  ///< [K]
  Form form = Form::term;
};

/// Named terms in library order; absent = off, and off restores the baseline bit for bit.
struct Effects {
  std::optional<ToolTemperatureFilm> tool_temperature_film = {};      // F1
  std::optional<ToolTemperatureShift> tool_temperature_shift = {};    // F2
  std::optional<StaticPeak> static_peak = {};                         // F3
  std::optional<SlidingEvolution> sliding_evolution = {};             // F4
  std::optional<StickSlip> stick_slip = {};                           // F5
  std::optional<PressureDependentArea> pressure_dependent_area = {};  // F6
  std::optional<Orientation> orientation = {};                        // F7
  std::optional<Adhesion> adhesion = {};                              // F8
  std::optional<FilmSqueezeOut> film_squeeze_out = {};                // F9
  std::optional<DwellAgeing> dwell_ageing = {};                       // F10
  std::optional<Solidification> solidification = {};                  // F11
  std::optional<ShearHeating> shear_heating = {};                     // F12
  std::optional<Wear> wear = {};                                      // F13
  std::optional<ViscosityPlateau> viscosity_plateau = {};             // F14
  std::optional<BoundaryLubrication> boundary_lubrication = {};       // F15
};

template <>
struct About<ToolTemperatureShift> {
  static constexpr const char* id = "tool_temperature_shift";
  static constexpr const char* equation =
      "mu += slope (T_tool - reference) | mu *= 1 + slope (T_tool - reference)";
  static constexpr const char* source = "paper, section 2; size from Table 4";
  static constexpr std::array fields{
      Field<ToolTemperatureShift>{"slope",
                                  "1/K",
                                  &ToolTemperatureShift::slope,
                                  {-0.1, 0.1, false, false},
                                  "Change of mu (or of its factor) per kelvin of tool temperature."},
      Field<ToolTemperatureShift>{"reference", "degC", &ToolTemperatureShift::reference, positive_range,
                                  "Tool temperature at which mu is unchanged."}};
};

/// Calls f with every effect (an optional) in library order.
template <class AnyEffects, class Function>
constexpr void for_each_effect(AnyEffects& effects, Function&& f) {
  f(effects.tool_temperature_film);
  f(effects.tool_temperature_shift);
  f(effects.static_peak);
  f(effects.sliding_evolution);
  f(effects.stick_slip);
  f(effects.pressure_dependent_area);
  f(effects.orientation);
  f(effects.adhesion);
  f(effects.film_squeeze_out);
  f(effects.dwell_ageing);
  f(effects.solidification);
  f(effects.shear_heating);
  f(effects.wear);
  f(effects.viscosity_plateau);
  f(effects.boundary_lubrication);
}

/// Present, and not at its off value: an amplitude of 0, which is passed over, so that off is the baseline
/// bit for bit.
template <class Effect>
bool is_on(const std::optional<Effect>& effect) {
  return effect && (*effect).*(About<Effect>::fields[0].member) != 0.0;
}

/// Which parts of the chain any effect is on in. Taken once for a batch.
struct EffectStages {
  bool film = false;         ///< F1, F6, F9, F12 or F14: the Hersey number is another
  bool coefficient = false;  ///< F3, F4, F5, F7, F8, F10, F11, F13 or F15: mu is another
};
EffectStages stages_of(const Effects& effects);

/// Changes mu and its slopes in place.
void apply(const ToolTemperatureShift& effect, const Context& context, Friction& friction);

/// All effects on mu but the tool temperature shift, in library order whatever the order in the file.
/// @param area    phi with the pressure-dependent area, for the adhesion
/// @param hersey  Hs, for the boundary branch; anything where the law has none
void apply_to_coefficient(const Effects& effects, const Inputs& inputs, const Sensitive& area,
                          const Sensitive& hersey, Friction& friction);

/// phi of the contact with F6.
Sensitive contact_area(const Effects& effects, const Inputs& inputs);

/// Film with F1, F9, F12 and F14, and the Hersey number it gives on that area.
struct FilmState {
  Sensitive temperature;  ///< of the resin that is sheared [K]
  Sensitive thickness;    ///< h [m]
  Sensitive viscosity;    ///< eta [Pa s]
  Sensitive hersey;       ///< Hs [-]
  double heating = 0.0;  ///< rise at which the film at one temperature would be as thin as the heated one [K]
};
FilmState film_state(const Effects& effects, const Rheology& rheology, const PowerLawFilm& film,
                     const Inputs& inputs, const Sensitive& area);

/// What the effects add to the memory over the step (age, load_slip): unchanged where theirs are off or the
/// step has no length.
void advance(const Effects& effects, const Context& context, ContactState& state);

/// Whether mu at rest or after a pull differs, so that a friction test must follow the pull.
/// @param conduction  the film's temperature comes from a film conduction
bool has_memory(const Effects& effects, bool conduction);

}  // namespace heddle::friction
