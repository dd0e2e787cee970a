#include "macroscale/indicators.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <Eigen/Geometry>

#include "macroscale/ply_state.h"

namespace heddle::macroscale {

namespace {

using Eigen::Vector3d;

// Nodes of the trimmed grid by their lines; -1 where there is none.
class GridIndex {
 public:
  explicit GridIndex(const BlankState& blank)
      : nu_(blank.nu), nv_(blank.nv), node_(static_cast<std::size_t>((nu_ + 1) * (nv_ + 1)), -1) {
    for (std::size_t n = 0; n < blank.grid.size(); ++n) {
      const auto [i, j] = blank.grid[n];
      node_[static_cast<std::size_t>(i * (nv_ + 1) + j)] = static_cast<int>(n);
    }
  }
  int at(int i, int j) const {
    if (i < 0 || j < 0 || i > nu_ || j > nv_) return -1;
    return node_[static_cast<std::size_t>(i * (nv_ + 1) + j)];
  }
  // `steps` along warp (0) or weft (1).
  int along(const std::array<int, 2>& from, int direction, int steps) const {
    return direction == 0 ? at(from[0] + steps, from[1]) : at(from[0], from[1] + steps);
  }

 private:
  int nu_, nv_;
  std::vector<int> node_;
};

Vector3d position(const BlankState& blank, int node) {
  return Vector3d(blank.position[static_cast<std::size_t>(node)].data());
}

// Chord from the neighbour before to the one behind, one-sided at an edge; zero where there is neither.
Vector3d chord(const BlankState& blank, const GridIndex& index, std::size_t node, int direction) {
  const int before = index.along(blank.grid[node], direction, -1),
            after = index.along(blank.grid[node], direction, 1);
  const int here = static_cast<int>(node);
  return position(blank, after < 0 ? here : after) - position(blank, before < 0 ? here : before);
}

double wave(const BlankState& blank, const GridIndex& index, std::size_t node, int direction, int step,
            const Vector3d& normal) {
  constexpr std::array<double, 5> weight{1.0, -4.0, 6.0, -4.0, 1.0};
  Vector3d difference = Vector3d::Zero();
  for (int k = -2; k <= 2; ++k) {
    const int n = index.along(blank.grid[node], direction, k * step);
    if (n < 0) return 0.0;
    difference += weight[static_cast<std::size_t>(k + 2)] * position(blank, n);
  }
  return std::abs(normal.dot(difference)) / 16.0;
}

double wrinkle_height(const BlankState& blank, const GridIndex& index, std::size_t node) {
  const Vector3d normal = chord(blank, index, node, 0).cross(chord(blank, index, node, 1));
  const double length = normal.norm();
  if (!(length > 0.0)) return 0.0;
  double height = 0.0;
  for (const int direction : {0, 1})
    for (const int step : {1, 2})
      height = std::max(height, wave(blank, index, node, direction, step, normal / length));
  return height;
}

// d n_i / d e_i at the end of the table, where tows are straight [N/m].
std::array<double, 2> straight_stiffness(const Surface& energy) {
  const double x = energy.x0() + (energy.nx() - 1) * energy.dx(),
               y = energy.y0() + (energy.ny() - 1) * energy.dy();
  return {energy.evaluate(x, 0.0).fxx, energy.evaluate(0.0, y).fyy};
}

template <class T>
void append(std::vector<T>& list, const std::vector<T>& more) {
  list.insert(list.end(), more.begin(), more.end());
}

Indicators indicators_of_plies(const BlankState& blank, const mesoscale::FabricProperties& fabric) {
  Indicators all;
  for (int k = 0; k < ply_count(blank); ++k) {
    const Indicators one = indicators(ply_of(blank, k), fabric);
    append(all.tow_load, one.tow_load);
    append(all.gap_opening, one.gap_opening);
    append(all.wrinkle_height, one.wrinkle_height);
    append(all.thickening, one.thickening);
  }
  return all;
}

}  // namespace

Indicators indicators(const BlankState& blank, const mesoscale::FabricProperties& fabric) {
  const std::size_t nodes = blank.position.size();
  if (blank.grid.size() != nodes || blank.tow_strain.size() != nodes || blank.shear_angle.size() != nodes)
    throw std::invalid_argument("indicators: one grid place, tow strain and shear angle a node");
  if (!blank.plies.empty()) return indicators_of_plies(blank, fabric);
  const GridIndex index(blank);
  const std::array<double, 2> stiffness = straight_stiffness(fabric.tension_energy);
  Indicators all;
  for (std::size_t n = 0; n < nodes; ++n) {
    const auto& e = blank.tow_strain[n];
    const double cosine = std::cos(blank.shear_angle[n]);
    const Surface::Value tension = fabric.tension_energy.evaluate(e[0], e[1]);
    all.tow_load.push_back({std::max(tension.fx, 0.0) / (stiffness[0] * glass_breaking_strain),
                            std::max(tension.fy, 0.0) / (stiffness[1] * glass_breaking_strain)});
    all.gap_opening.push_back(
        {fabric.pitch[0] * ((1.0 + e[1]) * cosine - 1.0), fabric.pitch[1] * ((1.0 + e[0]) * cosine - 1.0)});
    all.wrinkle_height.push_back(wrinkle_height(blank, index, n));
    all.thickening.push_back(1.0 / ((1.0 + e[0]) * (1.0 + e[1]) * cosine));
  }
  return all;
}

std::vector<LargestIndicator> largest(const Indicators& of, const BlankState& blank) {
  std::vector<LargestIndicator> found;
  const auto add = [&](const std::string& name, const std::string& unit, double per_si, double sign,
                       const auto& value) {
    if (blank.position.empty()) return;
    std::size_t best = 0;
    for (std::size_t n = 1; n < blank.position.size(); ++n)
      if (sign * value(n) > sign * value(best)) best = n;
    found.push_back({name, per_si * value(best), unit, blank.position[best]});
  };
  const auto larger = [](const std::array<double, 2>& pair) { return std::max(pair[0], pair[1]); };
  add("tow_load_max", "", 1.0, 1.0, [&](std::size_t n) { return larger(of.tow_load[n]); });
  add("tow_compression_max", "", 1.0, 1.0, [&](std::size_t n) {
    return std::max(0.0, -std::min(blank.tow_strain[n][0], blank.tow_strain[n][1]));
  });
  add("gap_opening_max", "mm", 1e3, 1.0, [&](std::size_t n) { return larger(of.gap_opening[n]); });
  add("wrinkle_height_max", "mm", 1e3, 1.0, [&](std::size_t n) { return of.wrinkle_height[n]; });
  add("thickening_max", "", 1.0, 1.0, [&](std::size_t n) { return of.thickening[n]; });
  add("thickening_min", "", 1.0, -1.0, [&](std::size_t n) { return of.thickening[n]; });
  return found;
}

double wrinkle_floor(double spacing, double fillet, double thickness) {
  return std::max(spacing * spacing / (3.0 * fillet), 0.1 * thickness);
}

}  // namespace heddle::macroscale
