#pragma once

#include <array>
#include <vector>

#include "friction/model.h"
#include "macroscale/thermal/field.h"
#include "macroscale/thermal/thermal_spec.h"
#include "mesoscale/fabric_properties.h"

namespace heddle::macroscale {

struct ContactPoint;
struct Scene;
struct State;
class System;

/// The heat of a blank as a scene holds it: what does not change while the clock runs.
struct HeatModel {
  thermal::ThermalSpec spec;
  thermal::Column column;
  thermal::Field start;  ///< of one node, when the punch touches
};
HeatModel heat_model(const thermal::ThermalSpec& spec, double areal_density, double blank_temperature);

/// The heat of a blank at one instant, and what the mechanics take from it. Empty: one temperature a run.
struct BlankHeat {
  thermal::Field field;
  /// Temperature of an even film as thin as that of each face, bottom and top; what friction sees [K].
  std::vector<std::array<double, 2>> film;
  /// Per quad: consistency of the rate-dependent shear resistance, mean over the ply's thickness, over that
  /// at the blank's temperature [-].
  std::vector<double> rate_factor;
  /// Per quad: factor on the rate-free shear resistance, mean over the ply's thickness; empty: it does not
  /// soften [-].
  std::vector<double> shear_factor;

  bool empty() const { return field.empty(); }
};

BlankHeat initial_heat(const Scene& scene);

/// What stands in history.csv of heat. Heats are of the whole blank, cumulative since the punch touched.
struct HeatRow {
  double time = 0.0;                                                  ///< [s]
  double mean_temperature = 0.0;                                      ///< by heat capacity [K]
  double coldest_face = 0.0;                                          ///< [K]
  double through_bottom = 0.0, through_top = 0.0, of_friction = 0.0;  ///< that came in [J]
  double crystallised = 0.0;    ///< share of the crystals that form in the end [-]
  double frozen_faces = 0.0;    ///< share of the blank's area with a face below the freezing temperature [-]
  double frozen_through = 0.0;  ///< the same with no melt left [-]
  double residual = 0.0;        ///< change of heat content less what came in [J]
};
/// Temperatures of a blank for pictures and files, a number a node; all empty where the run has one
/// temperature.
struct HeatFields {
  std::vector<double> bottom, top;   ///< of the faces [K]
  std::vector<double> mean;          ///< through the thickness, by heat capacity [K]
  std::vector<double> crystallised;  ///< share of the crystals that form in the end [-]
};
HeatFields heat_fields(const Scene& scene, const BlankHeat& heat);

HeatRow heat_row(const Scene& scene, const BlankHeat& heat, double time);

/// Temperature of a tool's surface [K].
double tool_temperature(const Scene& scene, int tool);
/// What friction takes for the fabric's temperature at a contact point against a tool [K].
double fabric_temperature(const Scene& scene, const State& state, int tool, const ContactPoint& point);

/// Of the film's face at a contact point against a tool [K]; 0 where the run has one temperature.
double face_temperature(const Scene& scene, const State& state, int tool, const ContactPoint& point);

/// The heat of `end` over the step that led there from `start`: contacts as they are at the end of it,
/// friction as it was dissipated. What it says of viscosities holds for the next step (explicit coupling,
/// first order in the step). @throws NumericalError
void advance_heat(const System& system, const State& start, State& end);
/// The same with everything standing still for a time [s].
void hold_heat(const System& system, double time, State& state);

}  // namespace heddle::macroscale
