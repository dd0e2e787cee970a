#pragma once

#include <numbers>
#include <vector>

#include "friction/test_design.h"
#include "pipeline/discover/planned.h"
#include "pipeline/discover_command.h"
#include "tests/source_dir.h"

namespace heddle::test {

/// What configs/discover/friction.yaml asks.
inline discover::CouponQuestion shipped_question() {
  const pipeline::Case a_case = pipeline::read_friction_part(
      {.file = std::filesystem::path(source_dir) / "configs/discover/friction.yaml"});
  discover::CouponRig rig;
  rig.rig = a_case.friction->rig;
  Problems problems;
  discover::CouponQuestion question = pipeline::question_of(a_case, rig, {}, problems);
  if (!problems.empty()) throw InputError(std::move(problems));
  return question;
}

/// One condition; temperatures in degC, speed in mm/s.
inline discover::CouponCell cell_at(double tool, double load, double speed, double fabric = 180.0,
                                    double degrees = 0.0, double dwell = 10.0) {
  discover::CouponCell cell;
  cell.pull = {.name = "",
               .velocity = 1e-3 * speed,
               .normal_force = load,
               .tool_temperature = tool + 273.15,
               .fabric_temperature = fabric + 273.15,
               .orientation = degrees * std::numbers::pi / 180.0,
               .measured_force = {},
               .paper_model_force = {}};
  cell.dwell = dwell;
  cell.samples = 5;
  return cell;
}

/// Cells on four days in turn, each a condition of its own.
inline std::vector<discover::CouponCell> numbered(std::vector<discover::CouponCell> cells) {
  for (std::size_t k = 0; k < cells.size(); ++k) {
    cells[k].condition = k;
    cells[k].day = k % 4;
    cells[k].pull.name = "c" + std::to_string(k + 1);
  }
  return cells;
}

/// The 22 cells of the paper's Table 2, one factor at a time.
inline std::vector<discover::CouponCell> paper_cells() {
  std::vector<discover::CouponCell> cells;
  for (const friction::FrictionTestRow& row : friction::one_at_a_time(
           friction::read_test_design(std::string(source_dir) + "/configs/data/friction_table2.csv"))) {
    cells.push_back({.pull = row, .dwell = 10.0, .samples = 5, .points = {}});
  }
  return numbered(std::move(cells));
}

/// As many, of which fifteen cross tool temperature, load and speed.
inline std::vector<discover::CouponCell> crossed_cells() {
  std::vector<discover::CouponCell> cells{cell_at(85, 1500, 16.6)};
  for (const double fabric : {160.0, 200.0}) cells.push_back(cell_at(85, 1500, 16.6, fabric));
  for (const double degrees : {30.0, 45.0, 60.0, 90.0})
    cells.push_back(cell_at(85, 1500, 16.6, 180.0, degrees));
  for (const double tool : {21.0, 85.0, 140.0})
    for (const auto& [load, speed] : {std::pair{343.0, 1.66}, std::pair{343.0, 83.3}, std::pair{4000.0, 1.66},
                                      std::pair{4000.0, 83.3}, std::pair{1500.0, 16.6}})
      cells.push_back(cell_at(tool, load, speed));
  return numbered(std::move(cells));
}

}  // namespace heddle::test
