#include "mesoscale/tension.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include "core/problem.h"

namespace heddle::mesoscale {

namespace {

struct Trial {
  std::array<TensionTow::State, 2> tow;
  double energy;  ///< F [J]
  std::array<double, 2> slope;
  double contact_force, contact_stiffness;
};

Trial trial_at(const TensionModel& model, const std::array<double, 2>& strain,
               const std::array<double, 2>& height) {
  const auto& [warp, weft] = model.tow;
  Trial trial{{warp.evaluate(strain[0], height[0]), weft.evaluate(strain[1], height[1])}, 0.0, {}, 0.0, 0.0};
  const double approach = warp.rest_height + weft.rest_height - height[0] - height[1];
  double contact_energy = 0.0;
  if (approach > 0.0) {
    const Curve::Value force = model.crossover_force.evaluate(approach);
    trial.contact_force = force.y;
    trial.contact_stiffness = force.slope;
    contact_energy = model.crossover_force.integral(approach);
  }
  const auto stored = [](const TensionTow::State& tow) { return tow.energy + tow.bending_energy; };
  trial.energy = stored(trial.tow[0]) + stored(trial.tow[1]) + contact_energy;
  trial.slope = {trial.tow[0].lift - trial.contact_force, trial.tow[1].lift - trial.contact_force};
  return trial;
}

std::array<double, 2> newton_step(const Trial& trial) {
  const double a = trial.tow[0].lift_slope + trial.contact_stiffness;
  const double b = trial.contact_stiffness;
  const double c = trial.tow[1].lift_slope + trial.contact_stiffness;
  const double det = a * c - b * b;
  return {-(c * trial.slope[0] - b * trial.slope[1]) / det, -(a * trial.slope[1] - b * trial.slope[0]) / det};
}

TensionModel::State state_of(const TensionModel& model, const std::array<double, 2>& strain,
                             const std::array<double, 2>& height, const Trial& trial, int iterations) {
  TensionModel::State state;
  state.energy = trial.energy / model.area();
  for (std::size_t i = 0; i < 2; ++i) {
    const TowStretch::Value squash = model.tow[i].compression.evaluate(-strain[i]);
    state.energy += squash.energy;
    state.tension[i] = trial.tow[i].fabric_force / model.tow[i].spacing - squash.force;
  }
  state.height = height;
  state.crossover_force = trial.contact_force;
  state.iterations = iterations;
  return state;
}

// Values at the inner points of the cubic B-spline that has the samples as its coefficients (1 4 1 each way).
std::vector<double> b_spline_values(const std::vector<double>& sample, std::size_t n) {
  const std::size_t wide = n + 2;
  const auto along_row = [&](std::size_t k) {
    return (sample[k - 1] + 4.0 * sample[k] + sample[k + 1]) / 6.0;
  };
  std::vector<double> value(n * n);
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < n; ++j) {
      const std::size_t middle = (i + 1) * wide + j + 1;
      value[i * n + j] =
          (along_row(middle - wide) + 4.0 * along_row(middle) + along_row(middle + wide)) / 6.0;
    }
  return value;
}

}  // namespace

TowStretch::Value TowStretch::evaluate(double strain) const {
  if (strain <= 0.0) return {0.0, 0.0, 0.0};
  const double range = straightening, s = strain / range;
  if (s < 1.0) {
    const double s2 = s * s;
    return {stiffness * range * range * s2 * s2 * (0.25 - 0.1 * s),
            stiffness * range * s2 * s * (1.0 - 0.5 * s), stiffness * s2 * (3.0 - 2.0 * s)};
  }
  const double taut = strain - 0.5 * range;
  return {stiffness * (0.5 * taut * taut + 0.025 * range * range), stiffness * taut, stiffness};
}

TensionTow::State TensionTow::evaluate(double strain, double height) const {
  const double stretched = step * (1.0 + strain);
  const PathLength path = length.evaluate(stretched, height);
  const double mean = interlacing * path.length + (1.0 - interlacing) * stretched;
  const TowStretch::Value tow = stretch.evaluate(mean / rest_length - 1.0);
  const double dl_dh = interlacing * path.dl_dh;
  const double off = height - rest_height;
  return {
      rest_length * tow.energy,
      tow.force,
      tow.force * (interlacing * path.dl_dp + 1.0 - interlacing),
      tow.force * dl_dh + crimp_stiffness * off,
      tow.stiffness / rest_length * dl_dh * dl_dh + tow.force * interlacing * path.d2_hh + crimp_stiffness,
      0.5 * crimp_stiffness * off * off};
}

TensionModel::State TensionModel::relax(const std::array<double, 2>& strain) const {
  return relax(strain, {tow[0].rest_height, tow[1].rest_height});
}

TensionModel::State TensionModel::relax(const std::array<double, 2>& strain,
                                        std::array<double, 2> height) const {
  Trial now = trial_at(*this, strain, height);
  // A straight tow has no height of its own to measure by.
  const double thinner = std::max(std::min(tow[0].rest_height, tow[1].rest_height),
                                  0.1 * (tow[0].rest_height + tow[1].rest_height));
  constexpr int most = 200;  // convex, so Newton with a line search ends; the table needs 6 on average
  for (int iteration = 0; iteration < most; ++iteration) {
    const std::array<double, 2> step = newton_step(now);
    const double descent = now.slope[0] * step[0] + now.slope[1] * step[1];
    // The energy errs by the square of this step; rounding in EA eps moves h by 1e-11 of the thickness.
    if (std::max(std::abs(step[0]), std::abs(step[1])) < 1e-9 * thinner)
      return state_of(*this, strain, height, now, iteration);
    double size = 1.0;
    for (;; size *= 0.5) {
      const std::array<double, 2> next{height[0] + size * step[0], height[1] + size * step[1]};
      const Trial tried = trial_at(*this, strain, next);
      // A length is known to 1e-16 of itself, its energy to 1e-16 / strain.
      const double rounding = 1e-12 * (std::abs(now.energy) + std::abs(tried.energy));
      if (tried.energy <= now.energy + 1e-4 * size * descent + rounding || size < 1e-12) {
        height = next;
        now = tried;
        break;
      }
    }
    if (!std::isfinite(now.energy)) break;
  }
  throw NumericalError(
      fmt::format("tension: crimp heights not found at strains ({:.6g}, {:.6g})", strain[0], strain[1]));
}

LengthLaw length_law(const TowGeometry& own, const TowGeometry& other, PathForm form) {
  // The edge stays 5 % short of p/2, where the straight leg of a gapless weave would vanish.
  return {form, enclosing_radius(other.section) + 0.5 * thickness(own.section),
          std::min(0.5 * width(other.section), 0.475 * other.spacing)};
}

TensionModel tension_model(const FabricGeometry& fabric, const CompactionLaw& law,
                           const TensionOptions& options) {
  TensionModel model;
  for (std::size_t i = 0; i < 2; ++i) {
    const TowGeometry &own = fabric.crossing.tow[i], &other = fabric.crossing.tow[1 - i];
    const double axial = options.fibre_modulus * fabric.mass.glass_area[i];
    TensionTow& tow = model.tow[i];
    tow.spacing = own.spacing;
    tow.step = other.spacing;
    tow.rest_height = own.path.height;
    tow.interlacing = fabric.interlacing[i];
    tow.length = length_law(own, other, options.form);
    tow.rest_length = tow.interlacing * tow.length.evaluate(tow.step, tow.rest_height).length +
                      (1.0 - tow.interlacing) * tow.step;
    tow.stretch.stiffness = axial;
    tow.compression.stiffness = options.compression_ratio * axial / tow.spacing;
    // A cosine of amplitude h/2 and half wave p, bending stiffness B times the spacing: energy
    // B spacing (pi/p)^4 (h/2)^2 p / 4.
    tow.crimp_stiffness = options.bending_stiffness[i] * std::pow(std::numbers::pi, 4) /
                          (8.0 * tow.step * tow.step) * (tow.spacing / tow.step);
  }

  const CrossoverContact contact(fabric.crossing, 0.0, law, fabric.quarters);
  const double deepest = contact.approach_at(0.85);  // beyond, the curve goes on straight, at some 1e8 N/m
  constexpr int points = 600;
  std::vector<double> approach(points), force(points);
  for (int k = 0; k < points; ++k) {
    approach[k] = deepest * k / (points - 1);
    force[k] = contact.force(approach[k]);
  }
  model.crossover_force = Curve(std::move(approach), std::move(force));
  return model;
}

Surface tabulate(const TensionModel& model, const StrainGrid& grid) {
  const double step = (grid.high - grid.low) / (grid.points - 1);
  const auto n = static_cast<std::size_t>(grid.points), wide = n + 2;  // one more all round, for the weights
  const auto strain_at = [&](std::size_t i) { return grid.low + step * (static_cast<double>(i) - 1.0); };
  std::vector<double> energy(wide * wide);
  tbb::parallel_for(std::size_t{0}, wide, [&](std::size_t i) {
    // Each row starts afresh, so the bytes do not depend on which thread took it.
    std::array<double, 2> height{model.tow[0].rest_height, model.tow[1].rest_height};
    for (std::size_t j = 0; j < wide; ++j) {
      const TensionModel::State state = model.relax({strain_at(i), strain_at(j)}, height);
      energy[i * wide + j] = state.energy;
      height = state.height;
    }
  });
  return Surface(grid.low, step, grid.points, grid.low, step, grid.points, b_spline_values(energy, n));
}

}  // namespace heddle::mesoscale
