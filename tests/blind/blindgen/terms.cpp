#include "terms.h"

#include <algorithm>
#include <cmath>

namespace blindgen {

namespace {

constexpr double tow_pitch = 5.39e-3;  // 4.64 mm tow + 0.75 mm gap [m]
constexpr double pull_length = 60e-3;  // [m]
constexpr double zero_celsius = 273.15;

/// 1 / (1 + x^2)
double bell(double x) {
  return 1.0 / (1.0 + x * x);
}

/// x / (1 + x)
double saturating(double x) {
  return x / (1.0 + x);
}

double film_temperature(const World& world, const Condition& c) {
  const double w = world.film_temperature.weight;
  return w == 0.0 ? c.fabric_temperature : 1.0 / ((1.0 - w) / c.fabric_temperature + w / c.tool_temperature);
}

double viscosity(const World& world, double rate, double temperature) {
  const double thinning = world.melt.viscosity(rate, temperature);
  if (world.plateau.rate == 0.0) return thinning;
  // The plateau caps the viscosity at that of the crossover rate; q says how sharply.
  const double cap = world.melt.viscosity(world.plateau.rate, temperature);
  const double q = world.plateau.sharpness;
  return thinning * std::pow(1.0 + std::pow(thinning / cap, q), -1.0 / q);
}

/// Hersey number of the whole plate relative to the baseline of the plain melt.
double hersey(const World& world, const Condition& c, double load) {
  const Condition base = baseline();
  const double now = viscosity(world, c.velocity / film_thickness, film_temperature(world, c));
  const double then = world.melt.viscosity(base.velocity / film_thickness, base.fabric_temperature);
  return now / then * (c.velocity / base.velocity) * (base.normal_force / load);
}

double local_friction(const World& world, double x) {
  const double lubricated = world.curve.friction(x);
  if (world.boundary.rise == 0.0) return lubricated;
  return lubricated + world.boundary.rise * bell(x / world.boundary.hersey);
}

/// Mean over the plate of mu(p) p / mean p. The bow grows with the load; where it would pull, the plate lifts
/// off.
double plate_friction(const World& world, double x, double load) {
  const double bow = world.plate_bending.bow * load / 1500.0;
  if (bow == 0.0) return local_friction(world, x);
  constexpr int cells = 40;
  std::array<double, cells> pressure{};
  double sum = 0.0;
  for (int i = 0; i < cells; ++i) {
    const double place = (2.0 * i + 1.0) / cells - 1.0;  // -1..1 across the plate
    pressure[static_cast<std::size_t>(i)] = std::max(0.0, 1.0 + bow * (place * place - 1.0 / 3.0));
    sum += pressure[static_cast<std::size_t>(i)];
  }
  double friction = 0.0;
  for (const double p : pressure) {
    if (p > 0.0) friction += local_friction(world, x * sum / (cells * p)) * p / sum;
  }
  return friction;
}

double orientation_factor(const Orientation& o, double angle) {
  return 1.0 + o.sign * o.change * (1.0 - std::pow(std::abs(std::cos(2.0 * angle)), o.power));
}

/// Rests under load add to the grip, a power of time as in rock friction; slip undoes it.
double ageing_factor(const Ageing& a, const Instant& at) {
  const double grown = std::pow(1.0 + at.condition.dwell / a.time, a.power) - 1.0;
  const double kept = 1.0 / (1.0 + at.slip / a.length);
  return 1.0 + a.rise * grown * kept * kept;
}

/// Share of the film that is solid: melting points spread normally, growth with time saturates.
double frozen_share(const Freezing& f, const Instant& at) {
  const double cold = 0.5 * std::erfc((at.condition.tool_temperature - f.temperature) / f.width);
  return cold * saturating((at.condition.dwell + at.time) / f.time);
}

double slip_factor(const World& world, const Instant& at) {
  const double started = 1.0 / (1.0 + at.slip / world.start_peak.length);
  const SlidingEvolution& evolution = world.sliding_evolution;
  return (1.0 + world.start_peak.height * started * started) *
         (1.0 + evolution.sign * evolution.change * saturating(at.slip / evolution.length)) *
         (1.0 - world.wear.loss * saturating(at.work / world.wear.work)) *
         (1.0 + world.drainage.rise * saturating(at.impulse / world.drainage.impulse));
}

double condition_factor(const World& world, const Instant& at, double load) {
  const Condition& c = at.condition;
  const VelocityWeakening& weakening = world.velocity_weakening;
  return (1.0 + weakening.rise / (1.0 + std::pow(c.velocity / weakening.velocity, weakening.power))) *
         (1.0 + world.area_growth.rate * std::log(load / baseline().normal_force)) *
         orientation_factor(world.orientation, c.orientation) * ageing_factor(world.ageing, at) *
         (1.0 + world.freezing.rise * frozen_share(world.freezing, at)) /
         (1.0 + world.heating.softening * at.heat);
}

double walk_at(const std::vector<double>& walk, double slip) {
  const double place = std::clamp(slip / pull_length, 0.0, 1.0) * static_cast<double>(walk.size() - 1);
  const std::size_t left = std::min(static_cast<std::size_t>(place), walk.size() - 2);
  const double part = place - static_cast<double>(left);
  return (1.0 - part) * walk[left] + part * walk[left + 1];
}

double outside_factor(const Outside& o, const Instant& at) {
  const Condition& c = at.condition;
  const auto& [a, b, d] = o.shape;
  if (o.strength == 0.0) return 1.0;
  if (o.kind == "tow_pitch_ripple")
    return 1.0 + o.strength * std::sin(6.283185307179586 * at.slip / tow_pitch + a);
  if (o.kind == "normal_force_bump") return 1.0 + o.strength * bell(std::log(c.normal_force / a) / b);
  if (o.kind == "fabric_temperature_anomaly") {
    return 1.0 + o.strength * 0.5 * std::erfc((c.fabric_temperature - zero_celsius - a) / b);
  }
  if (o.kind == "orientation_valley") {
    const double away = (c.orientation - a) / b;
    return 1.0 + o.strength * away * away;
  }
  if (o.kind == "slip_random_walk") return std::exp(o.strength * walk_at(o.walk, at.slip));
  if (o.kind == "temperature_velocity_resonance") {
    const double off = std::log(c.velocity / a) - d * (c.tool_temperature - zero_celsius - 85.0);
    return 1.0 + o.strength * bell(off / b);
  }
  return 1.0 + o.strength * bell(std::log(c.dwell / a) / b);  // dwell_bump
}

/// What the rig makes of the force.
double reading(const World& world, double force, double slip) {
  const Backlash& backlash = world.backlash;
  return force * (1.0 - backlash.loss * bell(slip / backlash.length)) +
         world.cell_offset.sign * world.cell_offset.force;
}

}  // namespace

double normal_force(const World& world, const Condition& condition, double time) {
  return condition.normal_force * (1.0 - world.relaxation.loss * saturating(time / world.relaxation.time));
}

double viscous_heat(const World& world, const Condition& c) {
  const Condition base = baseline();
  const double now = viscosity(world, c.velocity / film_thickness, film_temperature(world, c));
  const double then = world.melt.viscosity(base.velocity / film_thickness, base.fabric_temperature);
  return now / then * (c.velocity / base.velocity) * (c.velocity / base.velocity);
}

double pull_force(const World& world, const Instant& at) {
  const Condition& c = at.condition;
  const double load = normal_force(world, c, c.dwell + at.time);
  const TemperatureShift& shift = world.temperature_shift;
  const double warmth = std::tanh((c.tool_temperature - baseline().tool_temperature) / shift.width);
  const double friction = plate_friction(world, hersey(world, c, load), load) - shift.drop * warmth;
  const double sliding = 2.0 * friction * load * slip_factor(world, at) * condition_factor(world, at, load) *
                         outside_factor(world.outside, at);
  const double sticking = world.adhesion.force * saturating(load / world.adhesion.half_load);
  return reading(world, sliding + sticking, at.slip);
}

}  // namespace blindgen
