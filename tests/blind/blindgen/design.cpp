#include "design.h"

#include <array>
#include <utility>

namespace blindgen {

namespace {

constexpr double zero_celsius = 273.15;  // [K]
constexpr double degree = 3.14159265358979323846 / 180.0;

constexpr std::array<std::pair<Design, std::string_view>, 4> names{{{Design::oat22, "oat22"},
                                                                    {Design::crossed22, "crossed22"},
                                                                    {Design::oat48, "oat48"},
                                                                    {Design::crossed48, "crossed48"}}};

void add(std::vector<Cell>& cells, double Condition::*factor, std::initializer_list<double> levels) {
  for (const double level : levels) {
    Condition condition = baseline();
    condition.*factor = level;
    cells.push_back({condition});
  }
}

void add_fabric_and_orientation(std::vector<Cell>& cells) {
  add(cells, &Condition::fabric_temperature, {160.0 + zero_celsius, 200.0 + zero_celsius});
  add(cells, &Condition::orientation, {30.0 * degree, 45.0 * degree, 60.0 * degree, 90.0 * degree});
}

std::vector<Cell> one_at_a_time() {
  std::vector<Cell> cells{{baseline()}};
  add(cells, &Condition::tool_temperature,
      {21.0 + zero_celsius, 70.0 + zero_celsius, 100.0 + zero_celsius, 120.0 + zero_celsius,
       140.0 + zero_celsius});
  add_fabric_and_orientation(cells);
  add(cells, &Condition::normal_force, {218.0, 343.0, 1000.0, 1069.0, 3000.0, 4000.0});
  add(cells, &Condition::velocity, {1.66e-3, 8.33e-3, 41.6e-3, 83.3e-3});
  return cells;
}

/// Cell (i, j, k) of tool T x N x U, each index 0..2, 1 = baseline. The dwell index (i + j + k) mod 3 makes a
/// Latin square of it: every level of dwell meets every level of each factor equally often.
Condition crossed(int i, int j, int k) {
  constexpr std::array<double, 3> tool{21.0, 85.0, 140.0}, force{343.0, 1500.0, 4000.0},
      velocity{1.66e-3, 16.6e-3, 83.3e-3}, dwell{10.0, 2.0, 60.0};
  Condition condition = baseline();
  condition.tool_temperature = tool[static_cast<std::size_t>(i)] + zero_celsius;
  condition.normal_force = force[static_cast<std::size_t>(j)];
  condition.velocity = velocity[static_cast<std::size_t>(k)];
  condition.dwell = dwell[static_cast<std::size_t>((i + j + k) % 3)];
  return condition;
}

void add_crossed(std::vector<Cell>& cells, bool corners_and_axes_only) {
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      for (int k = 0; k < 3; ++k) {
        const int changed = (i != 1) + (j != 1) + (k != 1);
        if (changed == 0 || (corners_and_axes_only && changed == 2)) continue;
        cells.push_back({crossed(i, j, k)});
      }
    }
  }
}

std::vector<Cell> crossed_at_equal_cost() {
  std::vector<Cell> cells{{baseline()}};
  add_fabric_and_orientation(cells);
  add_crossed(cells, true);                                          // 8 corners, 6 on the axes
  add(cells, &Condition::tool_temperature, {120.0 + zero_celsius});  // a step between 85 and 140 degC
  return cells;
}

/// The 21 single changes once more, and the five ends of the ranges a third time.
std::vector<Cell> repeated() {
  std::vector<Cell> cells = one_at_a_time();
  const std::vector<Cell> first = cells;
  for (std::size_t i = 1; i < first.size(); ++i) cells.push_back({first[i].condition, 1});
  add(cells, &Condition::tool_temperature, {21.0 + zero_celsius, 140.0 + zero_celsius});
  add(cells, &Condition::normal_force, {218.0, 4000.0});
  add(cells, &Condition::velocity, {83.3e-3});
  for (std::size_t i = cells.size() - 5; i < cells.size(); ++i) cells[i].round = 2;
  return cells;
}

}  // namespace

Condition baseline() {
  return {.velocity = 16.6e-3,
          .normal_force = 1500.0,
          .tool_temperature = 85.0 + zero_celsius,
          .fabric_temperature = 180.0 + zero_celsius,
          .orientation = 0.0,
          .dwell = 10.0};
}

std::optional<Design> design_named(std::string_view name) {
  for (const auto& [design, text] : names) {
    if (text == name) return design;
  }
  return std::nullopt;
}

std::string_view name_of(Design design) {
  return names[static_cast<std::size_t>(design)].second;
}

std::vector<Cell> cells_of(Design design) {
  switch (design) {
    case Design::oat22:
      return one_at_a_time();
    case Design::crossed22:
      return crossed_at_equal_cost();
    case Design::oat48:
      return repeated();
    case Design::crossed48:
      break;
  }
  std::vector<Cell> cells = one_at_a_time();
  add_crossed(cells, false);
  return cells;
}

}  // namespace blindgen
