#include "mesoscale/film_direction.h"

#include <cmath>
#include <numbers>
#include <vector>

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include "core/problem.h"
#include "mesoscale/film.h"

namespace heddle::mesoscale {

namespace {

constexpr double degree = std::numbers::pi / 180.0;

// Where the table is taken: nominal pressures [Pa] and trellis angles [rad].
const std::vector<double> film_pressures{5e3, 20e3, 50e3, 100e3, 150e3, 200e3, 300e3};
const std::vector<double> film_angles{0.0, 10.0 * degree, 20.0 * degree, 30.0 * degree, 40.0 * degree};

FilmSpec film_of(const FabricGeometry& fabric, const ResinSpec& resin, const FilmDirectionSpec& spec) {
  constexpr double gas_constant = 8.31446261815324;  // [J/(mol K)]
  FilmSpec film;
  film.fluid.consistency =
      resin.consistency * std::exp(resin.activation_energy / gas_constant *
                                   (1.0 / spec.temperature - 1.0 / resin.reference_temperature));
  film.fluid.index = resin.power_index;
  film.fill = spec.fill.value_or(even_fill(fabric));
  film.roughness = spec.roughness;
  film.boundary_friction = spec.boundary_friction;
  film.samples = spec.samples;
  return film;
}

double friction_at(const FilmBearing& bearing, double pressure, double speed, double direction,
                   double shear) {
  const FilmState state = bearing.state(pressure, speed, direction);
  if (!state.converged)
    throw NumericalError(
        fmt::format("film: none is found at {:g} kPa, sheared by {:g} deg, sliding at {:g} deg "
                    "to the warp: {}",
                    1e-3 * pressure, shear / degree, direction / degree, state.reason));
  return state.friction();
}

}  // namespace

DragDirection drag_direction(const FabricGeometry& fabric, const CompactionLaw& law, const ResinSpec& resin,
                             const FilmDirectionSpec& spec) {
  const std::vector<double>& pressures = film_pressures;
  const FilmSpec film = film_of(fabric, resin, spec);
  std::vector<double> log_pressure;
  for (const double pressure : pressures) log_pressure.push_back(std::log(pressure));
  std::vector<Curve> cosine, sine;
  for (const double angle : film_angles) {
    std::vector<double> k_cosine(pressures.size(), 0.0), k_sine(pressures.size(), 0.0);
    if (angle > 0.0) {
      const FilmBearing bearing(fabric, law, angle, film);
      const double diagonal = 0.5 * (90.0 * degree - angle);
      tbb::parallel_for(std::size_t{0}, pressures.size(), [&](std::size_t p) {
        const auto mu = [&](double direction) {
          return friction_at(bearing, pressures[p], spec.speed, direction, angle);
        };
        const double along = mu(diagonal), across = mu(diagonal + 90.0 * degree),
                     between = mu(diagonal + 45.0 * degree);  // and on the other side, by the mirror
        const double share = 2.0 * (along - across) / (along + across + 2.0 * between);
        k_cosine[p] = share * std::sin(angle);
        k_sine[p] = share * std::cos(angle);
      });
    }
    cosine.emplace_back(log_pressure, std::move(k_cosine));
    sine.emplace_back(log_pressure, std::move(k_sine));
  }
  return {CurveFamily(film_angles, std::move(cosine)), CurveFamily(film_angles, std::move(sine))};
}

}  // namespace heddle::mesoscale
