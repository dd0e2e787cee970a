#pragma once

#include <array>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "friction/hersey.h"
#include "friction/model.h"

namespace heddle::test {

/// One of each law, with numbers under which every branch of it is alive.
inline std::vector<friction::Law> every_law() {
  using namespace friction;
  return {Coulomb{0.3},
          HerseyPower{.scale = 0.325, .exponent = 0.136},
          HerseyLinear{.offset = 0.237, .slope = 0.044, .reference = 0.362},
          StribeckCurve{.boundary = 0.45, .transition = 0.1, .sharpness = 1.3},
          FilmSolid{},
          hersey_table({0.01, 0.05, 0.2, 0.5, 2.0}, {0.4, 0.31, 0.25, 0.28, 0.4}),
          StaticKinetic{},
          ExponentialDecay{},
          Darmstadt{.base = 0.3,
                    .square = 1e-13,
                    .square_rate = -2.0,
                    .linear = -2e-7,
                    .linear_rate = -1.0,
                    .constant = 0.05,
                    .constant_rate = -3.0},
          Renard{},
          SlipResistance{.rate_exponent = 0.05, .evolution = SlipResistance::Evolution::frozen},
          SlipResistance{.rate_exponent = 0.05, .evolution = SlipResistance::Evolution::inside}};
}

inline std::vector<friction::Rheology> every_rheology() {
  using namespace friction;
  std::vector<Rheology> all;
  for (const Flow& flow : {Flow{PowerLaw{}}, Flow{Bingham{}}, Flow{HerschelBulkley{}},
                           Flow{CarreauYasuda{.infinite_viscosity = 5.0, .transition = 1.3}}, Flow{Cross{}}})
    for (const TemperatureLaw& temperature : {TemperatureLaw{Arrhenius{}}, TemperatureLaw{Wlf{}}})
      all.push_back({.flow = flow, .temperature = temperature});
  return all;
}

/// An effect by itself: switched on at some amplitude (0 = its off value).
struct NamedEffect {
  std::string id;
  std::function<void(friction::Effects&, double amplitude)> set;
  double usual;  ///< an amplitude an engineer would care about
};

inline std::vector<NamedEffect> every_effect() {
  using namespace friction;
  return {
      {"tool_temperature_film",
       [](Effects& e, double a) {
         e.tool_temperature_film = {a, 0.05};
       },
       0.6},
      {"tool_temperature_shift", [](Effects& e, double a) { e.tool_temperature_shift = {.slope = a}; },
       -9e-4},
      {"static_peak", [](Effects& e, double a) { e.static_peak = {.amplitude = a}; }, 0.4},
      {"sliding_evolution", [](Effects& e, double a) { e.sliding_evolution = {.amplitude = a}; }, -0.2},
      {"stick_slip", [](Effects& e, double a) { e.stick_slip = {.amplitude = a}; }, 0.3},
      {"pressure_dependent_area", [](Effects& e, double a) { e.pressure_dependent_area = {.exponent = a}; },
       0.3},
      {"orientation", [](Effects& e, double a) { e.orientation = {.amplitude = a}; }, 0.15},
      {"adhesion", [](Effects& e, double a) { e.adhesion = {.stress = a}; }, 3e3},
      {"film_squeeze_out", [](Effects& e, double a) { e.film_squeeze_out = {.rate = a}; }, 2e-5},
      {"dwell_ageing", [](Effects& e, double a) { e.dwell_ageing = {.amplitude = a}; }, 0.1},
      {"solidification", [](Effects& e, double a) { e.solidification = {.amplitude = a}; }, 0.8},
      {"shear_heating", [](Effects& e, double a) { e.shear_heating = {.amplitude = a}; }, 1.0},
      {"wear", [](Effects& e, double a) { e.wear = {.amplitude = a}; }, 0.3},
      {"viscosity_plateau", [](Effects& e, double a) { e.viscosity_plateau = {.fluidity = a}; }, 1e-3},
      {"boundary_lubrication", [](Effects& e, double a) { e.boundary_lubrication = {.amplitude = a}; }, 0.1},
  };
}

/// A contact on a film whose area fraction follows the pressure, phi = 0.5 (p_f / 100 kPa)^0.3.
inline friction::Context contact_at(double speed, double pressure, double fabric, double tool) {
  const friction::FlooredPressure p = friction::floored(pressure);
  const double phi = 0.5 * std::pow(p.value / 1e5, 0.3);
  friction::Context context;
  context.slip_speed = speed;
  context.pressure = pressure;
  context.fabric_temperature = fabric;
  context.tool_temperature = tool;
  context.area_fraction = phi;
  context.area_slope = 0.3 * phi / p.value * p.slope;
  context.slip_angle = 0.4;
  context.time_step = 0.01;
  return context;
}

inline friction::ContactState used_contact() {
  return {.slip = 1.5e-3, .dwell = 0.07, .slip_resistance = -0.02, .age = 0.6, .load_slip = 4e3};
}

}  // namespace heddle::test
