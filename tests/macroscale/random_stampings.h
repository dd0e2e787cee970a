#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <numbers>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "friction/model.h"
#include "macroscale/stamping.h"
#include "mesoscale/cell_spec.h"

namespace heddle::test {

/// One draw of the robustness run: a stamping that any user could ask for, and few would ask for twice.
struct RandomStamping {
  macroscale::StampingSpec spec;
  mesoscale::FabricProperties fabric;
  friction::Model friction;
  double coefficient = 0.0;     ///< mu at the rig's baseline [-]
  double speed = 0.0;           ///< of the punch [m/s]
  double tension_factor = 1.0;  ///< on the tension energy of Table 1's weave [-]
  double shear_factor = 1.0;    ///< on its shear resistance, rate-dependent part included [-]
  bool thermal = false;         ///< whether temperatures run through the thickness
};

/// Draws in [0, 1) from a generator whose output the standard fixes; its distributions are not fixed, so they
/// are written out here.
class Draw {
 public:
  explicit Draw(std::uint64_t seed) : bits_(seed) {}
  double share() { return static_cast<double>(bits_() >> 11) * 0x1p-53; }
  double even(double low, double high) { return low + (high - low) * share(); }
  double log_even(double low, double high) { return low * std::pow(high / low, share()); }

 private:
  std::mt19937_64 bits_;
};

inline constexpr int friction_laws = 11;

/// Law number `kind` with mu = `coefficient` at the rig's baseline (150 kPa, 16.7 mm/s, 180 degC); shapes as
/// their defaults, those with memory included.
inline friction::Law law_of_kind(int kind, double coefficient) {
  using namespace friction;
  const double mu = coefficient;
  switch (kind) {
    case 0:
      return Coulomb{mu};
    case 1:  // C and s of Table 4
      return HerseyPower{mu / std::pow(0.36, 0.136), 0.136};
    case 2:
      return HerseyLinear{0.84 * mu, 0.16 * mu, 0.36};
    case 3:
      return StribeckCurve{1.4 * mu, 0.02, 1.0, 0.84 * mu, 0.16 * mu, 0.36};
    case 4:
      return FilmSolid{0.84 * mu, 0.4 * mu};
    case 5:
      return hersey_table(
          {1e-3, 1e-2, 0.1, 0.36, 3.0, 30.0},
          {1.3 * mu + 1e-6, 1.1 * mu + 1e-6, 0.9 * mu + 1e-6, mu + 1e-6, 1.2 * mu + 1e-6, 1.6 * mu + 1e-6});
    case 6:
      return StaticKinetic{1.2 * mu, mu, 1e-3};
    case 7:
      return ExponentialDecay{1.2 * mu, mu, 10e-3};
    case 8:  // falls with speed, rises with pressure
      return Darmstadt{0.8 * mu, 0.0, 0.0, 2e-8 * mu, 0.0, 0.2 * mu, -20.0};
    case 9:
      return Renard{0.8 * mu, mu, 1.2 * mu, 0.8 * mu, 10e-3, 50e-3, 1.0};
    default:
      return SlipResistance{.initial = 1.2 * mu, .saturated = mu, .length = 5e-3, .rate_exponent = 0.05};
  }
}

/// Case `number` of the robustness run: mu 0 to 0.6 in every law, binder 20 N to 2.28e5 N on the 320 mm blank
/// (2.9 MPa; smaller blanks at the same pressure), punch 0.1 to 330 mm/s, tows at 0 to 90 deg, spacing 3 to
/// 12 mm, tension and shear stiffness times 0.1 to 10, at most 2000 nodes. Tools shrink with the blank. Half
/// of those whose stroke lasts under 10 s have temperatures, and half of these a binder that is free to tilt.
/// @param fabric  what the factors multiply
inline RandomStamping random_stamping(int number, const mesoscale::FabricProperties& fabric) {
  constexpr double full_size = 0.32, crush_pressure_force = 2.28e5;
  Draw draw(0x5eed0000u + static_cast<std::uint64_t>(number));
  RandomStamping c;
  const int kind = number % friction_laws;  // every law equally often
  c.coefficient = draw.even(0.0, 0.6);
  c.friction.law = law_of_kind(kind, c.coefficient);
  c.spec.contact_pressure =
      draw.share() < 0.5 ? macroscale::ContactPressure::real : macroscale::ContactPressure::nominal;

  macroscale::BlankSpec& blank = c.spec.blank;
  blank.orientation = draw.even(0.0, 0.5 * std::numbers::pi);
  blank.spacing = draw.even(3e-3, 12e-3);
  constexpr double most_cells = 43.0;  // each way: 1936 nodes, and room for a trimmed edge
  const bool round = draw.share() < 0.25;
  // A turned square needs a wider grid, of which its own area stays.
  const double largest = std::min(full_size, (round ? 1.1 : 0.96) * most_cells * blank.spacing);
  const double smallest = std::min(largest, std::max(0.12, 17.0 * blank.spacing));
  const double size = draw.even(smallest, largest);
  const double scale = size / full_size;
  if (round) {
    blank.shape = macroscale::BlankShape::circle;
    blank.radius = 0.5 * size;
  } else {
    blank.size = {size, size};
  }

  c.spec.punch.radius *= scale;
  c.spec.die.opening_radius = c.spec.punch.radius + 2e-3;  // room for the fabric whatever the scale
  c.spec.die.fillet *= scale;
  c.spec.binder.inner_radius = c.spec.die.opening_radius + c.spec.die.fillet;
  c.spec.binder.mass *= scale * scale;

  macroscale::ProcessSpec& process = c.spec.process;
  process.stroke = draw.even(40e-3, 70e-3) * scale;
  c.speed = draw.log_even(0.1e-3, 330e-3);
  process.time = process.stroke / c.speed;
  process.steps = 50;
  process.binder_force = draw.log_even(20.0, crush_pressure_force) * scale * scale;
  if (round) process.binder_force *= 0.7;  // its share of the square's area under the binder

  c.tension_factor = draw.log_even(0.1, 10.0);
  c.shear_factor = draw.log_even(0.1, 10.0);
  c.fabric = fabric;
  std::vector<double> energy = fabric.tension_energy.values();
  for (double& w : energy) w *= c.tension_factor;
  const Surface& t = fabric.tension_energy;
  c.fabric.tension_energy = Surface(t.x0(), t.dx(), t.nx(), t.y0(), t.dy(), t.ny(), std::move(energy));
  std::vector<double> shear = fabric.shear_stress.y();
  for (double& s : shear) s *= c.shear_factor;
  c.fabric.shear_stress = Curve(fabric.shear_stress.x(), std::move(shear));
  c.fabric.shear_rate.consistency *= c.shear_factor;

  c.thermal = process.time < 10.0 && draw.share() < 0.5;
  if (c.thermal) {
    c.spec.thermal.emplace();
    c.spec.binder.free_tilt = draw.share() < 0.5;
  }
  return c;
}

/// Whether a random stamping did what it must: came to its end, closed its books, stayed on its compaction
/// table.
struct RobustnessVerdict {
  bool finished = false;
  double energy_residual = 0.0;  ///< limit 1 % [-]
  double force_balance = 0.0;    ///< [-]
  double penetration = 0.0;      ///< largest nodal pressure over that at the end of the compaction table [-]
  macroscale::StampingSummary summary;
  std::string failure;
};

/// @param stop  asked between Newton iterations; a case that it ends has not finished
inline RobustnessVerdict run(const RandomStamping& c, std::function<bool()> stop = {}) {
  RobustnessVerdict verdict;
  macroscale::StampingControl control;
  control.stop = std::move(stop);
  const macroscale::StampingResult result = run_stamping(c.spec, c.fabric, c.friction, control);
  verdict.summary = result.summary;
  verdict.finished = result.summary.completed;
  verdict.energy_residual = result.summary.energy_residual_max;
  verdict.force_balance = result.summary.force_balance_residual_max;
  verdict.penetration = result.summary.crush_share;
  verdict.failure = result.summary.failure;
  return verdict;
}

}  // namespace heddle::test
