#pragma once

#include <array>
#include <span>
#include <vector>

#include "friction/film/conduction.h"
#include "macroscale/thermal/thermal_spec.h"

namespace heddle::macroscale::thermal {

/// The layers below one point of the blank, bottom first: film | ply without voids | film. Widths are those
/// of unsheared fabric and keep its mass; fine at the faces, where the heat goes.
struct Column {
  friction::ConductionGrid grid;
  std::vector<double> resin;  ///< of each cell [kg/m^3]
  double latent_heat = 0.0;   ///< of all crystals, per mass of resin [J/kg]
  int film_cells = 0;         ///< of each film
  Crystallisation crystallisation;

  std::size_t cells() const { return grid.size(); }
  double capacity(std::size_t i) const { return grid.heat_capacity[i] * grid.width[i]; }  ///< [J/(m^2 K)]
  double resin_mass(std::size_t i) const { return resin[i] * grid.width[i]; }             ///< [kg/m^2]
  double latent(std::size_t i) const { return resin_mass(i) * latent_heat; }              ///< [J/m^2]
};

/// @param areal_density  of films and ply together [kg/m^2]
Column make_column(const ThermalSpec& spec, double areal_density);

enum Side : std::size_t {
  bottom = 0,
  top = 1
};  ///< of the fabric: towards the die; towards punch and binder

/// What one face gives its heat to: q = h (T - T_h) + r (T^4 - T_r^4).
struct Face {
  double conductance = 0.0;          ///< h [W/(m^2 K)]
  double temperature = 298.15;       ///< T_h [K]
  double radiance = 0.0;             ///< r, emissivity times Stefan and Boltzmann's constant [W/(m^2 K^4)]
  double radiant_temperature = 0.0;  ///< T_r [K]
  double heating = 0.0;              ///< friction, spread over the film [W/m^2 of unsheared fabric]

  Slope outflow(double face_temperature) const;  ///< [W/m^2], [W/(m^2 K)]
};
Face air_face(const Surroundings& air);

/// Temperatures of one column; spans of `cells` numbers.
struct ColumnState {
  std::span<double> temperature;  ///< of cells [K]
  std::span<double> progress;     ///< P of crystallisation [-]
  std::span<double> face;         ///< of the faces themselves, bottom and top [K]
};

/// Heat that came in over a step [J/m^2 of unsheared fabric].
struct HeatIn {
  double bottom = 0.0, top = 0.0, friction = 0.0;
  double total() const { return bottom + top + friction; }
};

/// One step of
///     d/dt (rho c T - L x) = d/dz (k dT/dz) + s,   dP/dt = K(T)
/// Finite volumes, second order in space; Alexander's two-stage SDIRK, second order in time and L-stable,
/// solved by Newton's method. The heat through the faces is that of the scheme, so that heat content and heat
/// through the faces agree to rounding. A step may be of any length: it is divided where crystallisation
/// would run away with it, and where the jump of a first touch would carry temperatures past those of blank
/// and tools (an L-stable scheme of second order can overshoot a jump by a quarter of it).
/// @param area_ratio  area of the sheared fabric over that of the unsheared [-], > 0: a column of sheared
///                    fabric is thicker by its inverse
/// @throws NumericalError  if a number is not finite or Newton's method does not settle
HeatIn advance(const Column& column, const std::array<Face, 2>& faces, double area_ratio, double time_step,
               ColumnState state);

/// Sum of rho c T - L x over the column [J/m^2 of unsheared fabric].
double heat_content(const Column& column, std::span<const double> temperature,
                    std::span<const double> progress);
/// Mean over the column, by heat capacity [K].
double mean_temperature(const Column& column, std::span<const double> temperature);
/// Share of the crystals that has formed, mean over the resin [-].
double mean_degree(const Column& column, std::span<const double> progress);

}  // namespace heddle::macroscale::thermal
