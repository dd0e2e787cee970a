#include "friction/film/conduction.h"

#include <cmath>
#include <numbers>
#include <numeric>

namespace heddle::friction {

namespace {

/// Heat that flows into each cell [W/m^2].
std::vector<double> inflow(const ConductionGrid& grid, const ConductionEnds& ends,
                           std::span<const double> source, const std::vector<double>& temperature) {
  const std::size_t n = grid.size();
  std::vector<double> in(n, 0.0);
  for (std::size_t i = 0; i < source.size(); ++i) in[i] = source[i] * grid.width[i];
  for (std::size_t i = 0; i + 1 < n; ++i) {
    const double flow = flow_to_next(grid, temperature, i);
    in[i] -= flow;
    in[i + 1] += flow;
  }
  in.front() += flow_through_left(grid, ends, temperature);
  in.back() += flow_through_right(grid, ends, temperature);
  return in;
}

/// Solves (rho c w + a K) T = b by elimination: diagonally dominant, so no pivots are needed.
std::vector<double> solve_implicit(const ConductionGrid& grid, const ConductionEnds& ends, double a,
                                   std::vector<double> b) {
  const std::size_t n = grid.size();
  std::vector<double> diagonal(n), off(n, 0.0);
  for (std::size_t i = 0; i < n; ++i) diagonal[i] = grid.heat_capacity[i] * grid.width[i];
  for (std::size_t i = 0; i + 1 < n; ++i) {
    const double c = a * conductance_to_next(grid, i);
    diagonal[i] += c;
    diagonal[i + 1] += c;
    off[i] = -c;
  }
  const auto hold = [&](std::size_t i, const std::optional<double>& held) {
    if (!held) return;
    diagonal[i] += a * conductance_to_face(grid, i);
    b[i] += a * conductance_to_face(grid, i) * *held;
  };
  hold(0, ends.left);
  hold(n - 1, ends.right);
  for (std::size_t i = 1; i < n; ++i) {
    const double factor = off[i - 1] / diagonal[i - 1];
    diagonal[i] -= factor * off[i - 1];
    b[i] -= factor * b[i - 1];
  }
  b[n - 1] /= diagonal[n - 1];
  for (std::size_t i = n - 1; i-- > 0;) b[i] = (b[i] - off[i] * b[i + 1]) / diagonal[i];
  return b;
}

}  // namespace

double conductance_to_next(const ConductionGrid& grid, std::size_t i) {
  return 1.0 / (0.5 * grid.width[i] / grid.conductivity[i] + grid.resistance[i] +
                0.5 * grid.width[i + 1] / grid.conductivity[i + 1]);
}

double conductance_to_face(const ConductionGrid& grid, std::size_t i) {
  return 2.0 * grid.conductivity[i] / grid.width[i];
}

double Material::effusivity() const {
  return std::sqrt(conductivity * heat_capacity);
}

void append_layer(ConductionGrid& grid, const Material& material, std::span<const double> widths,
                  double resistance) {
  if (!grid.resistance.empty()) grid.resistance.back() = resistance;
  grid.width.insert(grid.width.end(), widths.begin(), widths.end());
  grid.conductivity.insert(grid.conductivity.end(), widths.size(), material.conductivity);
  grid.heat_capacity.insert(grid.heat_capacity.end(), widths.size(), material.heat_capacity);
  grid.resistance.insert(grid.resistance.end(), widths.size(), 0.0);
}

std::vector<double> even_widths(double thickness, int cells) {
  return std::vector<double>(static_cast<std::size_t>(cells), thickness / cells);
}

std::vector<double> growing_widths(double thickness, double first, double ratio) {
  std::vector<double> widths;
  double sum = 0.0;
  for (double width = first; sum < thickness; width *= ratio) {
    widths.push_back(width);
    sum += width;
  }
  for (double& width : widths) width *= thickness / sum;
  return widths;
}

std::vector<double> widths_from_both_faces(double thickness, double first, double ratio) {
  const std::vector<double> half = growing_widths(0.5 * thickness, first, ratio);
  std::vector<double> widths = half;
  widths.insert(widths.end(), half.rbegin(), half.rend());
  return widths;
}

void conduct(const ConductionGrid& grid, const ConductionEnds& ends, std::span<const double> source,
             double time_step, std::vector<double>& temperature) {
  constexpr double gamma = 2.0 - std::numbers::sqrt2;  // both stages then have the same matrix
  constexpr double implicit = 0.5 * gamma;             // = (1 - gamma)/(2 - gamma)
  const double a = implicit * time_step;
  const std::size_t n = grid.size();

  // Trapezoid up to gamma dt.
  std::vector<double> b = inflow(grid, ends, source, temperature);
  for (std::size_t i = 0; i < n; ++i) {
    const double capacity = grid.heat_capacity[i] * grid.width[i];
    const double heating = i < source.size() ? source[i] * grid.width[i] : 0.0;
    b[i] = capacity * temperature[i] + a * (b[i] + heating);
  }
  const std::vector<double> middle = solve_implicit(grid, ends, a, std::move(b));

  // BDF2 through the start and that.
  constexpr double of_middle = 1.0 / (gamma * (2.0 - gamma));
  constexpr double of_start = (1.0 - gamma) * (1.0 - gamma) / (gamma * (2.0 - gamma));
  b.assign(n, 0.0);
  for (std::size_t i = 0; i < n; ++i) {
    const double capacity = grid.heat_capacity[i] * grid.width[i];
    const double heating = i < source.size() ? source[i] * grid.width[i] : 0.0;
    b[i] = capacity * (of_middle * middle[i] - of_start * temperature[i]) + a * heating;
  }
  temperature = solve_implicit(grid, ends, a, std::move(b));
}

double flow_to_next(const ConductionGrid& grid, std::span<const double> temperature, std::size_t i) {
  return conductance_to_next(grid, i) * (temperature[i] - temperature[i + 1]);
}

double flow_through_left(const ConductionGrid& grid, const ConductionEnds& ends,
                         std::span<const double> temperature) {
  return ends.left ? conductance_to_face(grid, 0) * (*ends.left - temperature.front()) : 0.0;
}

double flow_through_right(const ConductionGrid& grid, const ConductionEnds& ends,
                          std::span<const double> temperature) {
  return ends.right ? conductance_to_face(grid, grid.size() - 1) * (*ends.right - temperature.back()) : 0.0;
}

double heat_in(const ConductionGrid& grid, std::span<const double> temperature, std::size_t first,
               std::size_t count) {
  double sum = 0.0;
  for (std::size_t i = first; i < first + count; ++i)
    sum += grid.heat_capacity[i] * grid.width[i] * temperature[i];
  return sum;
}

}  // namespace heddle::friction
