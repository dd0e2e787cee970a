#pragma once

#include <array>
#include <string_view>
#include <vector>

#include "design.h"
#include "film.h"
#include "random.h"

/// What can be hidden. Every term is a strength, zero when absent, and a shape; terms.cpp holds the formulas.
namespace blindgen {

/// F1: 1 / T_film = (1 - w) / T_fabric + w / T_tool
struct FilmTemperature {
  double weight = 0;  ///< w [-], 0..1
};

/// F2: mu - drop tanh((T_tool - 85 degC) / width)
struct TemperatureShift {
  double drop = 0;     ///< [-]
  double width = 100;  ///< [K]
};

/// F3: 1 + height / (1 + s / length)^2
struct StartPeak {
  double height = 0;     ///< [-]
  double length = 1e-3;  ///< [m]
};

/// F4: 1 + sign change x / (1 + x), x = s / length
struct SlidingEvolution {
  double change = 0;     ///< [-], >= 0
  double sign = 1;       ///< hardens or softens
  double length = 1e-2;  ///< [m]
};

/// F5: 1 + rise / (1 + (U / velocity)^power)
struct VelocityWeakening {
  double rise = 0;         ///< [-]
  double velocity = 5e-3;  ///< [m/s]
  double power = 1.5;      ///< [-]
};

/// F6: 1 + rate ln(N / 1500 N)
struct AreaGrowth {
  double rate = 0;  ///< [-]
};

/// F7: 1 + sign change (1 - |cos 2 theta|^power)
struct Orientation {
  double change = 0;  ///< [-], >= 0
  double sign = 1;    ///< more or less at 45 deg
  double power = 2;   ///< [-]
};

/// F8: + force x / (1 + x), x = N / half_load
struct Adhesion {
  double force = 0;       ///< both faces [N]
  double half_load = 80;  ///< [N]
};

/// F9: 1 + rise x / (1 + x), x = integral of N dt / impulse
struct Drainage {
  double rise = 0;       ///< [-]
  double impulse = 3e4;  ///< [N s]
};

/// F10: 1 + rise ((1 + dwell / time)^power - 1) / (1 + s / length)^2
struct Ageing {
  double rise = 0;       ///< [-]
  double time = 1;       ///< [s]
  double power = 0.25;   ///< [-]
  double length = 2e-3;  ///< of slip that undoes it [m]
};

/// F11: 1 + rise erfc((T_tool - temperature) / width) / 2 x / (1 + x), x = (dwell + t) / time
struct Freezing {
  double rise = 0;           ///< [-]
  double temperature = 385;  ///< [K]
  double width = 6;          ///< [K]
  double time = 1;           ///< [s]
};

/// F12: 1 / (1 + softening q), q following eta U^2 over that of the baseline
struct Heating {
  double softening = 0;  ///< [-]
  double lag = 0.03;     ///< of q behind its source [s]
};

/// F13: 1 - loss x / (1 + x), x = integral of N ds / work
struct Wear {
  double loss = 0;   ///< [-]
  double work = 40;  ///< [N m]
};

/// F14: eta (1 + (eta(g) / eta(rate))^q)^(-1/q)
struct Plateau {
  double rate = 0;         ///< where the plateau begins [1/s]
  double sharpness = 1.5;  ///< q [-]
};

/// F15: mu + rise / (1 + (x / hersey)^2), x = H over that of the baseline
struct Boundary {
  double rise = 0;      ///< [-]
  double hersey = 0.5;  ///< [-]
};

/// R1: N (1 - loss x / (1 + x)), x = time since the plates closed / time
struct Relaxation {
  double loss = 0;   ///< [-]
  double time = 10;  ///< [s]
};

/// R2: + sign force
struct CellOffset {
  double force = 0;  ///< [N], >= 0
  double sign = 1;   ///< -1 or 1
};

/// R3: gain exp(sign span (d^power - 1/2)), d = 0 on the first day, 1 on the last
struct Drift {
  double span = 0;   ///< of ln gain [-], >= 0
  double sign = 1;   ///< -1 or 1
  double power = 1;  ///< [-]
};

/// R4: 1 - loss / (1 + (s / length)^2)
struct Backlash {
  double loss = 0;       ///< [-]
  double length = 1e-3;  ///< [m]
};

/// R5: p = mean p (1 + bow N / 1500 N (x^2 - 1/3)), x = -1..1 across the plate, never below 0
struct PlateBending {
  double bow = 0;  ///< [-]
};

/// One of the terms that no library of effects lists: `kind` is its id in the catalogue, the formulas stand
/// in terms.cpp.
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
