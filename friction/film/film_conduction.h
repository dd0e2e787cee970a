#pragma once

#include <array>

#include "core/curve.h"
#include "friction/film/conduction.h"
#include "friction/sensitivity.h"
#include "friction/term.h"

namespace heddle::friction {

/// What lies on either side of the resin film, as heat sees it: a tool without end, a contact that may
/// resist, the film, and the ply down to where no heat flows (its middle if tools touch both faces, the next
/// ply if that is as warm).
struct FilmConductionSpec {
  double film_conductivity = 0.19;     ///< of the melt [W/(m K)], > 0
  double film_heat_capacity = 1.98e6;  ///< rho c of the melt [J/(m^3 K)], > 0
  double tool_conductivity = 30.0;     ///< [W/(m K)], > 0
  double tool_heat_capacity = 3.74e6;  ///< [J/(m^3 K)], > 0
  double ply_conductivity = 0.35;      ///< through the thickness [W/(m K)], > 0
  double ply_heat_capacity = 2.37e6;   ///< [J/(m^3 K)], > 0
  double ply_thickness = 0.475e-3;     ///< as dense composite [m], > 0
  double contact_resistance = 0.0;     ///< between tool and film [m^2 K/W], >= 0; 0 = perfect contact
};

/// Gauss points through the film, from the tool's face on: where its temperature is known, so that the shear
/// may go where it is hottest.
inline constexpr std::size_t film_points = 5;
inline constexpr std::array<double, film_points> film_point_place{
    0.046910077030668004, 0.23076534494715845, 0.5, 0.76923465505284155, 0.953089922969332};
inline constexpr std::array<double, film_points> film_point_weight{
    0.11846344252809454, 0.23931433524968324, 0.28444444444444444, 0.23931433524968324, 0.11846344252809454};

/// How a film answers to heat, from first touch on. The conduction is linear, so a few numbers that depend on
/// time alone say all that the effects F1, F11 and F12 ask for; they are computed once with the grid of
/// film/conduction.h and kept as smooth curves over ln t.
///
///     share_i(t)  of the tool in the temperature of point i, tool and fabric brought together at t = 0
///     face(t)     the same of the film's face towards the tool
///     rise(t)     k dT/(q h): rise of the film's mean temperature when q [W/m^2] has been dissipated in it
///     evenly
///                 since t = 0. 1/12 between walls that are held, 1/3 with one of them adiabatic.
///
/// The error of the curves against a grid and time steps four times as fine is measured by a test.
struct FilmConduction {
  FilmConductionSpec spec;
  double film_thickness = 0.07e-3;  ///< h [m]
  std::array<Curve, film_points>
      share;  ///< over ln(t / 1 s); all held before the first and beyond the last point
  Curve face, rise;

  double settling() const;  ///< h^2/alpha [s]
};

/// How finely the curves are computed. The defaults are what the program uses; finer ones are for tests.
struct FilmConductionOptions {
  double first_time = 1e-6;   ///< [h^2/alpha]
  double last_time = 3600.0;  ///< [s]
  int points_per_fold = 8;    ///< of the curves, an e-fold of time
  int steps_per_point = 2;    ///< time steps between two points
  double first_width = 1e-4;  ///< of the cells at both faces of the film [h]
  double growth = 1.1;        ///< of the cells away from the faces
};

/// @param spec            within the ranges of its description
/// @param film_thickness  h [m], > 0
FilmConduction film_conduction(const FilmConductionSpec& spec, double film_thickness,
                               const FilmConductionOptions& options = {});

/// The curves with their slopes. At t = 0, where they start as sqrt(t) with no slope, contact counts as one
/// millionth of h^2/alpha old.
Sensitive point_share(const FilmConduction& film, std::size_t point, const Sensitive& time);
Sensitive face_share(const FilmConduction& film, const Sensitive& time);
Sensitive heating_rise(const FilmConduction& film, const Sensitive& time);

/// Wide about every solid and melt, so that a number in the wrong unit is caught before the grid drowns in
/// it.
inline constexpr Bounds conductivity_range{.low = 1e-3, .high = 1e4, .low_open = false, .high_open = false};
inline constexpr Bounds heat_capacity_range{.low = 1e3, .high = 1e9, .low_open = false, .high_open = false};

template <>
struct About<FilmConductionSpec> {
  static constexpr const char* id = "conduction";
  static constexpr const char* equation = "rho c dT/dt = d/dx (k dT/dx) + q";
  static constexpr const char* source =
      "constants of polypropylene, composite and steel as recalled; Carslaw & Jaeger 1959";
  static constexpr std::array fields{
      Field<FilmConductionSpec>{"film_conductivity", "W/(m K)", &FilmConductionSpec::film_conductivity,
                                conductivity_range,
                                "Of the melt; polypropylene 0.17 to 0.20 W/(m K) (recalled)."},
      Field<FilmConductionSpec>{"film_heat_capacity", "J/(m^3 K)", &FilmConductionSpec::film_heat_capacity,
                                heat_capacity_range, "Density times specific heat of the melt (recalled)."},
      Field<FilmConductionSpec>{"tool_conductivity", "W/(m K)", &FilmConductionSpec::tool_conductivity,
                                conductivity_range, "Of the tool; steel 25 to 45 W/(m K) (recalled)."},
      Field<FilmConductionSpec>{"tool_heat_capacity", "J/(m^3 K)", &FilmConductionSpec::tool_heat_capacity,
                                heat_capacity_range, "Density times specific heat of the tool (recalled)."},
      Field<FilmConductionSpec>{"ply_conductivity", "W/(m K)", &FilmConductionSpec::ply_conductivity,
                                conductivity_range, "Through the ply, 0.3 to 0.4 W/(m K) (derived)."},
      Field<FilmConductionSpec>{"ply_heat_capacity", "J/(m^3 K)", &FilmConductionSpec::ply_heat_capacity,
                                heat_capacity_range, "Density times specific heat of the ply (derived)."},
      Field<FilmConductionSpec>{
          "ply_thickness",
          "m",
          &FilmConductionSpec::ply_thickness,
          {1e-6, 1.0, false, false},
          "Down to where no heat flows: one dense ply, or half of one cooled from both faces."},
      Field<FilmConductionSpec>{
          "contact_resistance",
          "m^2 K/W",
          &FilmConductionSpec::contact_resistance,
          {0.0, 1.0, false, false},
          "Between tool and film; 0 m^2 K/W is perfect, 3e-4 to 2e-3 m^2 K/W a prior."}};
};

}  // namespace heddle::friction
