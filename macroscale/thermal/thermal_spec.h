#pragma once

#include <optional>

#include "core/problem.h"
#include "macroscale/thermal/crystallisation.h"

namespace heddle::macroscale::thermal {

/// How well a tool that touches takes heat,
///     h(p) = h_0 + (h_full - h_0) (1 - exp(-p / p_ref))
/// h_0 where it barely touches, h_full pressed hard. Priors: 500 to 3000 W/(m^2 K) is the range recalled for
/// hot sheets on tools; nothing measured for this fabric was found.
struct ContactConductance {
  double light = 500.0;     ///< h_0 [W/(m^2 K)], > 0
  double full = 3000.0;     ///< h_full [W/(m^2 K)], >= light
  double pressure = 1.0e5;  ///< p_ref [Pa], > 0

  Slope at(double nominal_pressure) const;  ///< [W/(m^2 K)], [W/(m^2 K Pa)]
};

/// What a face that no tool touches sees.
struct Surroundings {
  double temperature = 298.15;  ///< [K]
  double convection = 10.0;     ///< of still air [W/(m^2 K)], >= 0; prior
  double emissivity = 0.9;      ///< of the melt [-], 0..1; prior
};

/// A layer's material. Constants: those of the melt.
struct LayerMaterial {
  double conductivity = 0.0;   ///< through the thickness [W/(m K)], > 0
  double density = 0.0;        ///< without voids [kg/m^3], > 0
  double specific_heat = 0.0;  ///< [J/(kg K)], > 0
};

/// Heat through the thickness of one ply and the resin films on its faces. All constants are recalled,
/// derived or priors (docs/theory/thermal.md).
struct ThermalSpec {
  LayerMaterial ply{0.35, 1484.0, 1600.0};
  LayerMaterial film{0.19, 760.0, 2600.0};
  double film_thickness = 0.07e-3;   ///< of each face [m], > 0
  double latent_heat = 99e3;         ///< of all crystals that form, per mass of resin [J/kg], >= 0
  double resin_mass_fraction = 0.4;  ///< of the ply [-]
  Crystallisation crystallisation;
  ContactConductance contact;
  Surroundings air;
  /// [K]; absent: the temperature all tools have
  std::optional<double> punch_temperature, die_temperature, binder_temperature;
  double freezing_temperature = 391.15;  ///< below it resin counts as solid in reports [K]
  double transfer_time = 0.0;            ///< in air, between oven and first touch of the punch [s], >= 0
  bool friction_heat = true;             ///< what friction dissipates warms the film it is sheared in
  int refinement = 1;                    ///< cells are this many times finer, >= 1
};

Problems check(const ThermalSpec& spec);
/// Whether its films fit into a blank. @param areal_density  of the blank [kg/m^2]
Problems check_films(const ThermalSpec& spec, double areal_density);

}  // namespace heddle::macroscale::thermal
