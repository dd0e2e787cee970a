#include "macroscale/thermal/column.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

namespace heddle::macroscale::thermal {

namespace {

constexpr double stefan_boltzmann = 5.670374419e-8;  // [W/(m^2 K^4)]

// A column as one step sees it: conductances and capacities per unsheared area. Unknowns are the bottom face,
// the cells, the top face; a face holds no heat.
struct Ladder {
  std::vector<double> capacity;     ///< of each unknown [J/(m^2 K)]
  std::vector<double> latent;       ///< of each unknown [J/m^2]
  std::vector<double> conductance;  ///< to the next [W/(m^2 K)]
  std::vector<double> source;       ///< [W/m^2]
  double area_ratio = 1.0;

  std::size_t size() const { return capacity.size(); }
};

// Sheared by J = area ratio, a cell is w / J thick and J wide: what conducts through it grows by J^2.
Ladder ladder_of(const Column& column, const std::array<Face, 2>& faces, double area_ratio) {
  const std::size_t n = column.grid.size();
  Ladder ladder{std::vector<double>(n + 2, 0.0), std::vector<double>(n + 2, 0.0),
                std::vector<double>(n + 1, 0.0), std::vector<double>(n + 2, 0.0), area_ratio};
  for (std::size_t i = 0; i < n; ++i) {
    ladder.capacity[i + 1] = column.capacity(i);
    ladder.latent[i + 1] = column.latent(i);
    if (i + 1 < n) ladder.conductance[i + 1] = friction::conductance_to_next(column.grid, i);
  }
  ladder.conductance.front() = friction::conductance_to_face(column.grid, 0);
  ladder.conductance.back() = friction::conductance_to_face(column.grid, n - 1);
  for (double& c : ladder.conductance) c *= area_ratio * area_ratio;
  const auto heat = [&](std::size_t first, double heating) {
    double width = 0.0;
    const auto count = static_cast<std::size_t>(column.film_cells);
    for (std::size_t i = first; i < first + count; ++i) width += column.grid.width[i];
    for (std::size_t i = first; i < first + count; ++i)
      ladder.source[i + 1] = heating * column.grid.width[i] / width;
  };
  if (column.film_cells > 0) {
    heat(0, faces[bottom].heating);
    heat(n - static_cast<std::size_t>(column.film_cells), faces[top].heating);
  }
  return ladder;
}

// One implicit stage: heat(T, P) - a inflow(T) = base, P = base_progress + a K(T).
class Stage {
 public:
  Stage(const Ladder& ladder, const Crystallisation& law, const std::array<Face, 2>& faces, double weight)
      : ladder_(ladder), law_(law), faces_(faces), a_(weight) {
    const std::size_t n = ladder.size();
    below_.resize(n);
    diagonal_.resize(n);
    above_.resize(n);
    residual_.resize(n);
  }

  // Newton's method from the temperatures given; converges in the first step where nothing crystallises or
  // radiates.
  void solve(std::span<const double> base, std::span<const double> base_progress,
             std::vector<double>& temperature) {
    constexpr int limit = 60;
    constexpr double settled = 1e-9;  // [K]; the step after it is below rounding
    for (int k = 0; k < limit; ++k) {
      linearise(base, base_progress, temperature);
      eliminate();
      double largest = 0.0;
      for (std::size_t i = 0; i < residual_.size(); ++i) {
        temperature[i] -= residual_[i];
        largest = std::max(largest, std::abs(residual_[i]));
        if (!std::isfinite(residual_[i])) throw NumericalError("a temperature is not finite");
      }
      if (largest < settled) return;
    }
    throw NumericalError(fmt::format("temperatures did not settle in {} iterations", limit));
  }

 private:
  void linearise(std::span<const double> base, std::span<const double> base_progress,
                 const std::vector<double>& t) {
    const std::size_t n = ladder_.size();
    for (std::size_t i = 0; i < n; ++i) {
      const double in_below = i > 0 ? ladder_.conductance[i - 1] : 0.0;
      const double in_above = i + 1 < n ? ladder_.conductance[i] : 0.0;
      double inflow = ladder_.source[i];
      if (i > 0) inflow += in_below * (t[i - 1] - t[i]);
      if (i + 1 < n) inflow += in_above * (t[i + 1] - t[i]);
      below_[i] = -a_ * in_below;
      above_[i] = -a_ * in_above;
      diagonal_[i] = ladder_.capacity[i] + a_ * (in_below + in_above);
      residual_[i] = ladder_.capacity[i] * t[i] - a_ * inflow - base[i];
      if (ladder_.latent[i] > 0.0) {
        const Slope rate = law_.rate_at(t[i]);
        const Slope degree = law_.degree_at(base_progress[i] + a_ * rate.value);
        residual_[i] -= ladder_.latent[i] * degree.value;
        diagonal_[i] -= ladder_.latent[i] * degree.slope * a_ * rate.slope;
      }
    }
    for (const Side side : {bottom, top}) {
      const std::size_t i = side == bottom ? 0 : n - 1;
      const Slope out = faces_[side].outflow(t[i]);
      residual_[i] += a_ * ladder_.area_ratio * out.value;
      diagonal_[i] += a_ * ladder_.area_ratio * out.slope;
    }
  }

  // Diagonally dominant: no pivots are needed. The solution takes the residual's place.
  void eliminate() {
    const std::size_t n = residual_.size();
    for (std::size_t i = 1; i < n; ++i) {
      const double factor = below_[i] / diagonal_[i - 1];
      diagonal_[i] -= factor * above_[i - 1];
      residual_[i] -= factor * residual_[i - 1];
    }
    residual_[n - 1] /= diagonal_[n - 1];
    for (std::size_t i = n - 1; i-- > 0;)
      residual_[i] = (residual_[i] - above_[i] * residual_[i + 1]) / diagonal_[i];
  }

  const Ladder& ladder_;
  const Crystallisation& law_;
  const std::array<Face, 2>& faces_;
  double a_;
  std::vector<double> below_, diagonal_, above_, residual_;
};

double heat_of(const Ladder& ladder, const Crystallisation& law, std::size_t i, double temperature,
               double progress) {
  const double freed = ladder.latent[i] > 0.0 ? ladder.latent[i] * law.degree_at(progress).value : 0.0;
  return ladder.capacity[i] * temperature - freed;
}

// Alexander's SDIRK2: both stages have the weight gamma, the second ends the step.
HeatIn one_step(const Ladder& ladder, const Crystallisation& law, const std::array<Face, 2>& faces, double dt,
                std::vector<double>& temperature, std::vector<double>& progress) {
  constexpr double gamma = 1.0 - 0.5 * std::numbers::sqrt2;
  constexpr double again = (1.0 - gamma) / gamma;
  const std::size_t n = ladder.size();
  const double a = gamma * dt;
  HeatIn in;
  const auto count = [&](double weight) {
    in.bottom -= weight * ladder.area_ratio * faces[bottom].outflow(temperature.front()).value;
    in.top -= weight * ladder.area_ratio * faces[top].outflow(temperature.back()).value;
  };
  const auto order = [&](std::span<const double> before) {
    for (std::size_t i = 1; i + 1 < n; ++i) progress[i] = before[i] + a * law.rate_at(temperature[i]).value;
  };
  std::vector<double> base(n), base_progress = progress;
  for (std::size_t i = 0; i < n; ++i) base[i] = heat_of(ladder, law, i, temperature[i], progress[i]);
  Stage stage(ladder, law, faces, a);
  stage.solve(base, base_progress, temperature);
  count((1.0 - gamma) * dt);
  order(base_progress);
  for (std::size_t i = 0; i < n; ++i) {
    base[i] += again * (heat_of(ladder, law, i, temperature[i], progress[i]) - base[i]);
    base_progress[i] += again * (progress[i] - base_progress[i]);
  }
  base.front() = base.back() = 0.0;  // faces hold no heat
  stage.solve(base, base_progress, temperature);
  count(gamma * dt);
  order(base_progress);
  for (double s : ladder.source) in.friction += dt * s;
  return in;
}

// Where crystallisation speeds up as the melt cools its heat works against the step; half of what would undo
// it is the most that one step takes on.
double longest_step(const Column& column) {
  double ratio = 0.0;  // [K]
  for (std::size_t i = 0; i < column.grid.size(); ++i)
    ratio = std::max(ratio, column.latent(i) / column.capacity(i));
  const double growth =
      1.2 * column.crystallisation.exponent / 3.0 * ratio * column.crystallisation.steepest();
  return growth > 0.0 ? 0.5 / (0.293 * growth) : 1e300;  // [s]; 0.293: gamma
}

// What no temperature may leave: those there were, and those that the faces lead to, warmed by friction and
// crystals.
struct Range {
  double low, high;
};

Range range_of(const std::vector<double>& temperature, const std::array<Face, 2>& faces) {
  const auto [low, high] = std::minmax_element(temperature.begin(), temperature.end());
  Range range{*low, *high};
  for (const Face& face : faces) {
    if (face.conductance > 0.0) {
      range.low = std::min(range.low, face.temperature);
      range.high = std::max(range.high, face.temperature);
    }
    if (face.radiance > 0.0) {
      range.low = std::min(range.low, face.radiant_temperature);
      range.high = std::max(range.high, face.radiant_temperature);
    }
  }
  return range;
}

// Sources only warm, so a fall below the range is always the scheme's; a rise above it only where there are
// none.
bool leaves(const Range& range, const Ladder& ladder, const std::vector<double>& temperature) {
  constexpr double allowed = 0.5;  // [K]
  const auto [low, high] = std::minmax_element(temperature.begin(), temperature.end());
  const auto zero = [](double x) { return x == 0.0; };
  const bool passive = std::all_of(ladder.latent.begin(), ladder.latent.end(), zero) &&
                       std::all_of(ladder.source.begin(), ladder.source.end(), zero);
  return *low < range.low - allowed || (passive && *high > range.high + allowed);
}

}  // namespace

Slope Face::outflow(double face_temperature) const {
  const double cube = face_temperature * face_temperature * face_temperature;
  const double there = radiant_temperature * radiant_temperature;
  return {
      conductance * (face_temperature - temperature) + radiance * (cube * face_temperature - there * there),
      conductance + 4.0 * radiance * cube};
}

Face air_face(const Surroundings& air) {
  return {air.convection, air.temperature, air.emissivity * stefan_boltzmann, air.temperature, 0.0};
}

Column make_column(const ThermalSpec& spec, double areal_density) {
  constexpr int film_cells = 4;
  constexpr double first = 20e-6, growth = 1.4;  // of the ply's cells [m], [-]; the film's are 17.5e-6 m
  const double ply_thickness =
      (areal_density - 2.0 * spec.film_thickness * spec.film.density) / spec.ply.density;
  const auto material = [](const LayerMaterial& m) {
    return friction::Material{m.conductivity, m.density * m.specific_heat};
  };
  Column column;
  column.crystallisation = spec.crystallisation;
  column.film_cells = film_cells * spec.refinement;
  const auto film = friction::even_widths(spec.film_thickness, column.film_cells);
  // Finer means every cell divided evenly, so that the order of the error can be seen.
  std::vector<double> ply;
  for (const double width : friction::widths_from_both_faces(ply_thickness, first, growth))
    ply.insert(ply.end(), static_cast<std::size_t>(spec.refinement), width / spec.refinement);
  friction::append_layer(column.grid, material(spec.film), film);
  friction::append_layer(column.grid, material(spec.ply), ply);
  friction::append_layer(column.grid, material(spec.film), film);
  column.latent_heat = spec.latent_heat;
  column.resin.assign(film.size(), spec.film.density);
  column.resin.insert(column.resin.end(), ply.size(), spec.ply.density * spec.resin_mass_fraction);
  column.resin.insert(column.resin.end(), film.size(), spec.film.density);
  return column;
}

HeatIn advance(const Column& column, const std::array<Face, 2>& faces, double area_ratio, double time_step,
               ColumnState state) {
  const Ladder ladder = ladder_of(column, faces, area_ratio);
  const std::size_t n = column.grid.size();
  std::vector<double> temperature(n + 2), progress(n + 2, 0.0);
  temperature.front() = state.face[bottom];
  temperature.back() = state.face[top];
  std::copy(state.temperature.begin(), state.temperature.end(), temperature.begin() + 1);
  std::copy(state.progress.begin(), state.progress.end(), progress.begin() + 1);
  HeatIn in;
  const double longest = longest_step(column);
  double left = time_step, step = std::min(left, longest);
  while (left > 0.0) {
    const std::vector<double> before = temperature, progress_before = progress;
    const HeatIn part = one_step(ladder, column.crystallisation, faces, step, temperature, progress);
    if (step > 1e-9 * time_step && leaves(range_of(before, faces), ladder, temperature)) {
      temperature = before;
      progress = progress_before;
      step *= 0.5;
      continue;
    }
    in.bottom += part.bottom;
    in.top += part.top;
    in.friction += part.friction;
    left = step < left ? left - step : 0.0;
    step = std::min({left, 2.0 * step, longest});
  }
  state.face[bottom] = temperature.front();
  state.face[top] = temperature.back();
  std::copy_n(temperature.begin() + 1, n, state.temperature.begin());
  std::copy_n(progress.begin() + 1, n, state.progress.begin());
  return in;
}

double heat_content(const Column& column, std::span<const double> temperature,
                    std::span<const double> progress) {
  double sum = 0.0;
  for (std::size_t i = 0; i < column.grid.size(); ++i)
    sum += column.capacity(i) * temperature[i] -
           column.latent(i) * column.crystallisation.degree_at(progress[i]).value;
  return sum;
}

double mean_temperature(const Column& column, std::span<const double> temperature) {
  double heat = 0.0, capacity = 0.0;
  for (std::size_t i = 0; i < column.grid.size(); ++i) {
    heat += column.capacity(i) * temperature[i];
    capacity += column.capacity(i);
  }
  return heat / capacity;
}

double mean_degree(const Column& column, std::span<const double> progress) {
  double formed = 0.0, resin = 0.0;
  for (std::size_t i = 0; i < column.grid.size(); ++i) {
    formed += column.resin_mass(i) * column.crystallisation.degree_at(progress[i]).value;
    resin += column.resin_mass(i);
  }
  return resin > 0.0 ? formed / resin : 0.0;
}

}  // namespace heddle::macroscale::thermal
