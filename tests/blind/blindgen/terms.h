#pragma once

#include <array>
#include <string_view>
#include <vector>

#include "design.h"
#include "film.h"
#include "random.h"

/// What can be hidden. Every term is a strength, zero when absent, and a shape; terms.cpp holds the formulas.
namespace blindgen {

struct FilmTemperature {
  double weight = 0;
};  ///< share of the tool in the film's inverse temperature [-]
struct TemperatureShift {
  double drop = 0, width = 100;
};  ///< of mu [-]; [K]
struct StartPeak {
  double height = 0, length = 1e-3;
};  ///< [-]; [m]
struct SlidingEvolution {
  double change = 0, sign = 1, length = 1e-2;
};  ///< [-]; [-]; [m]
struct VelocityWeakening {
  double rise = 0, velocity = 5e-3, power = 1.5;
};  ///< [-]; [m/s]; [-]
struct AreaGrowth {
  double rate = 0;
};  ///< per unit of ln N [-]
struct Orientation {
  double change = 0, sign = 1, power = 2;
};  ///< [-]
struct Adhesion {
  double force = 0, half_load = 80;
};  ///< [N]; [N]
struct Drainage {
  double rise = 0, impulse = 3e4;
};  ///< [-]; [N s]
struct Ageing {
  double rise = 0, time = 1, power = 0.25, length = 2e-3;
};  ///< [-]; [s]; [-]; [m]
struct Freezing {
  double rise = 0, temperature = 385, width = 6, time = 1;
};  ///< [-]; [K]; [K]; [s]
struct Heating {
  double softening = 0, lag = 0.03;
};  ///< per baseline of heat [-]; [s]
struct Wear {
  double loss = 0, work = 40;
};  ///< [-]; [N m]
struct Plateau {
  double rate = 0, sharpness = 1.5;
};  ///< [1/s]; [-]
struct Boundary {
  double rise = 0, hersey = 0.5;
};  ///< [-]; H / H0 [-]

struct Relaxation {
  double loss = 0, time = 10;
};  ///< of N [-]; [s]
struct CellOffset {
  double force = 0, sign = 1;
};  ///< [N]; [-]
struct Drift {
  double span = 0, sign = 1, power = 1;
};  ///< first day to last [-]; [-]; [-]
struct Backlash {
  double loss = 0, length = 1e-3;
};  ///< [-]; [m]
struct PlateBending {
  double bow = 0;
};  ///< p edge minus centre, at 1500 N [-]

/// Outside of the library of effects: `kind` is one of outside_kinds.
struct Outside {
  std::string_view kind = "";
  double strength = 0;
  std::array<double, 3> shape{};
  std::vector<double> walk = {};  ///< of the random walk, over the pull
};

/// The plain world and all that may be hidden in it.
struct World {
  Melt melt{};
  StribeckCurve curve{};
  FilmTemperature film_temperature;
  TemperatureShift temperature_shift;
  StartPeak start_peak;
  SlidingEvolution sliding_evolution;
  VelocityWeakening velocity_weakening;
  AreaGrowth area_growth;
  Orientation orientation;
  Adhesion adhesion;
  Drainage drainage;
  Ageing ageing;
  Freezing freezing;
  Heating heating;
  Wear wear;
  Plateau plateau;
  Boundary boundary;
  Relaxation relaxation;
  CellOffset cell_offset;
  Drift drift;
  Backlash backlash;
  PlateBending plate_bending;
  Outside outside;
};

/// Where a pull stands: conditions and what has accumulated.
struct Instant {
  Condition condition;  ///< as they truly are
  double slip = 0;      ///< [m]
  double time = 0;      ///< since the pull began [s]
  double impulse = 0;   ///< integral of N over time since the plates closed [N s]
  double work = 0;      ///< integral of N over slip [N m]
  double heat = 0;      ///< lagged viscous heat relative to the baseline [-]
};

/// Pull force on the cell [N], both faces, before noise. Everything but the drift from day to day.
double pull_force(const World& world, const Instant& at);

/// True normal force [N] at this time since the plates closed [s].
double normal_force(const World& world, const Condition& condition, double time);

/// Viscous heat eta U^2 relative to the baseline of a melt without plateau [-].
double viscous_heat(const World& world, const Condition& condition);

}  // namespace blindgen
