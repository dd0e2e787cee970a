#pragma once

#include <optional>
#include <span>
#include <vector>

namespace heddle::friction {

/// A stack of layers through which heat flows in one direction, as cells of a finite-volume grid from left to
/// right. All of one size.
struct ConductionGrid {
  std::vector<double> width;          ///< of each cell [m], > 0
  std::vector<double> conductivity;   ///< [W/(m K)], > 0
  std::vector<double> heat_capacity;  ///< per volume, rho c [J/(m^3 K)], > 0
  std::vector<double>
      resistance;  ///< of contact between this cell and the next [m^2 K/W]; the last is unused

  std::size_t size() const { return width.size(); }
};

/// A layer of one material.
struct Material {
  double conductivity;   ///< k [W/(m K)]
  double heat_capacity;  ///< rho c [J/(m^3 K)]

  double diffusivity() const { return conductivity / heat_capacity; }  ///< [m^2/s]
  double effusivity() const;                                           ///< sqrt(k rho c) [W s^0.5/(m^2 K)]
};

/// Adds cells on the right.
/// @param widths      of the cells [m]
/// @param resistance  of the contact with what was there before [m^2 K/W]
void append_layer(ConductionGrid& grid, const Material& material, std::span<const double> widths,
                  double resistance = 0.0);

std::vector<double> even_widths(double thickness, int cells);
/// Widths that grow by `ratio` from `first` on and sum to the thickness (the whole set is scaled down to it).
std::vector<double> growing_widths(double thickness, double first, double ratio);
/// The same from both faces towards the middle.
std::vector<double> widths_from_both_faces(double thickness, double first, double ratio);

/// Between the middles of cell i and the next [W/(m^2 K)].
double conductance_to_next(const ConductionGrid& grid, std::size_t i);
/// Between the middle of an end cell and its face [W/(m^2 K)].
double conductance_to_face(const ConductionGrid& grid, std::size_t i);

/// What holds at the two ends: a temperature, or no flow of heat where there is none.
struct ConductionEnds {
  std::optional<double> left = {}, right = {};  ///< [K]
};

/// One time step of rho c dT/dt = d/dx (k dT/dx) + q: finite volumes, second order in space; TR-BDF2 (Bank et
/// al. 1985), second order in time and L-stable, so that the jump of a first touch does not ring.
/// @param source       q of each cell, held over the step [W/m^3]; empty = none
/// @param time_step    [s], > 0
/// @param temperature  of each cell, changed in place [K]
void conduct(const ConductionGrid& grid, const ConductionEnds& ends, std::span<const double> source,
             double time_step, std::vector<double>& temperature);

/// Flow of heat from cell i to the next [W/m^2].
double flow_to_next(const ConductionGrid& grid, std::span<const double> temperature, std::size_t i);
/// Flow of heat into the stack through its two ends [W/m^2].
double flow_through_left(const ConductionGrid& grid, const ConductionEnds& ends,
                         std::span<const double> temperature);
double flow_through_right(const ConductionGrid& grid, const ConductionEnds& ends,
                          std::span<const double> temperature);

/// Sum of rho c T over cells [first, first + count) [J/m^2].
double heat_in(const ConductionGrid& grid, std::span<const double> temperature, std::size_t first,
               std::size_t count);

}  // namespace heddle::friction
