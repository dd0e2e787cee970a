#include "pipeline/part_stiffness.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>

#include <fmt/format.h>
#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/curve.h"
#include "pipeline/outputs.h"

namespace heddle::pipeline {

namespace {

using Eigen::Vector3d;
using mesoscale::solid::expansion;
using mesoscale::solid::ShearedSolid;

// Each number of the table as a smooth curve over the trellis angle.
class Table {
 public:
  explicit Table(std::vector<ShearedSolid> rows) {
    std::stable_sort(rows.begin(), rows.end(),
                     [](const auto& a, const auto& b) { return a.shear_angle < b.shear_angle; });
    rows.erase(std::unique(rows.begin(), rows.end(),
                           [](const auto& a, const auto& b) { return a.shear_angle == b.shear_angle; }),
               rows.end());
    low_ = rows.front().shear_angle;
    high_ = rows.back().shear_angle;
    const auto curve = [&](const std::function<double(const ShearedSolid&)>& number) {
      std::vector<double> x, y;
      for (const ShearedSolid& row : rows) {
        x.push_back(row.shear_angle);
        y.push_back(number(row));
      }
      return Curve(x, y);
    };
    thickness_ = curve([](const ShearedSolid& row) { return row.thickness; });
    fibre_fraction_ = curve([](const ShearedSolid& row) { return row.fibre_fraction; });
    for (int i = 0; i < 6; ++i) {
      const auto k = static_cast<std::size_t>(i);
      for (int j = 0; j < 6; ++j) {
        plate_[6 * k + static_cast<std::size_t>(j)] =
            curve([&](const ShearedSolid& row) { return row.plate(i, j); });
        stack_[6 * k + static_cast<std::size_t>(j)] =
            curve([&](const ShearedSolid& row) { return row.stack(i, j); });
      }
      held_[k] = curve([&](const ShearedSolid& row) { return row.plate_held[expansion][i]; });
      stack_held_[k] = curve([&](const ShearedSolid& row) { return row.stack_held[expansion][i]; });
    }
  }

  void look_up(CellStiffness& cell) const {
    const bool mirrored = low_ >= 0.0 && cell.shear_angle < 0.0;
    const double wanted = mirrored ? -cell.shear_angle : cell.shear_angle;
    const double angle = std::clamp(wanted, low_, high_);
    cell.beyond_table = wanted != angle;
    cell.thickness = thickness_(angle);
    cell.tow_fibre_fraction = fibre_fraction_(angle);
    // 16, 26 and what stands for them in B and D are odd in a mirror; of a solid whatever has one axis 2.
    const auto sign = [&](int i, int j) { return mirrored && (i % 3 == 2) != (j % 3 == 2) ? -1.0 : 1.0; };
    const auto odd = [](int i) { return i == 3 || i == 5; };
    const auto solid_sign = [&](int i, int j) { return mirrored && odd(i) != odd(j) ? -1.0 : 1.0; };
    for (int i = 0; i < 6; ++i) {
      const auto k = static_cast<std::size_t>(i);
      for (int j = 0; j < 6; ++j) {
        cell.plate(i, j) = sign(i, j) * plate_[6 * k + static_cast<std::size_t>(j)](angle);
        cell.stack(i, j) = solid_sign(i, j) * stack_[6 * k + static_cast<std::size_t>(j)](angle);
      }
      cell.expansion[i] = sign(i, 0) * held_[k](angle);
      cell.stack_held[i] = solid_sign(i, 0) * stack_held_[k](angle);
    }
  }

 private:
  double low_ = 0.0, high_ = 0.0;
  Curve thickness_, fibre_fraction_;
  std::array<Curve, 36> plate_, stack_;
  std::array<Curve, 6> held_, stack_held_;
};

std::array<double, 3> array_of(const Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}

// Place, axes and trellis angle, from the middles of the cell's sides.
CellStiffness cell_of(const macroscale::BlankState& blank, const std::array<int, 4>& quad) {
  std::array<Vector3d, 4> p;
  CellStiffness cell;
  for (std::size_t k = 0; k < 4; ++k) {
    const auto node = static_cast<std::size_t>(quad[k]);
    p[k] = {blank.position[node][0], blank.position[node][1], blank.position[node][2]};
    if (!blank.heat.crystallised.empty()) cell.crystallised += 0.25 * blank.heat.crystallised[node];
  }
  const Vector3d warp = (p[1] + p[2] - p[0] - p[3]).normalized();
  const Vector3d weft = (p[2] + p[3] - p[0] - p[1]).normalized();
  cell.cell = blank.grid[static_cast<std::size_t>(quad[0])];
  cell.centre = array_of(0.25 * (p[0] + p[1] + p[2] + p[3]));
  cell.warp = array_of(warp);
  cell.weft = array_of(weft);
  cell.normal = array_of(warp.cross(weft).normalized());
  cell.shear_angle = std::asin(std::clamp(warp.dot(weft), -1.0, 1.0));
  return cell;
}

}  // namespace

std::vector<CellStiffness> part_stiffness(const macroscale::BlankState& blank,
                                          const std::vector<ShearedSolid>& table) {
  const Table of(table);
  std::vector<CellStiffness> cells;
  for (const auto& quad : blank.quads) {
    cells.push_back(cell_of(blank, quad));
    of.look_up(cells.back());
  }
  return cells;
}

std::string part_stiffness_csv(const std::vector<CellStiffness>& cells) {
  constexpr std::array<std::array<int, 2>, 6> upper{{{0, 0}, {0, 1}, {0, 2}, {1, 1}, {1, 2}, {2, 2}}};
  constexpr std::array<const char*, 6> names{"11", "12", "16", "22", "26", "66"};
  std::string out =
      "cell_warp,cell_weft,x_mm,y_mm,z_mm,warp_x,warp_y,warp_z,normal_x,normal_y,normal_z,shear_angle_deg,"
      "beyond_table,thickness_mm,crystallised_share,weft_x,weft_y,weft_z,tow_fibre_volume_fraction";
  for (const auto& [part, unit] : {std::pair{"A", "N_per_mm"}, {"B", "N"}, {"D", "N_mm"}})
    for (const char* name : names) out += fmt::format(",{}{}_{}", part, name, unit);
  for (const auto& [part, unit] : {std::pair{"N", "N_per_mm_K"}, {"M", "N_K"}})
    for (const char* name : {"11", "22", "12"}) out += fmt::format(",{}{}_expansion_{}", part, name, unit);
  out += '\n';
  for (const CellStiffness& c : cells) {
    out += fmt::format("{},{}", c.cell[0], c.cell[1]);
    const auto add = [&](double value) { out += "," + shortest(value); };
    for (const double x : c.centre) add(1e3 * x);
    for (const auto* axis : {&c.warp, &c.normal})
      for (const double x : *axis) add(x);
    add(180.0 / std::numbers::pi * c.shear_angle);
    out += c.beyond_table ? ",1" : ",0";
    add(1e3 * c.thickness);
    add(c.crystallised);
    for (const double x : c.weft) add(x);
    add(c.tow_fibre_fraction);
    for (const auto& [row, column, factor] : {std::tuple{0, 0, 1e-3}, {0, 3, 1.0}, {3, 3, 1e3}})
      for (const auto& [i, j] : upper) add(factor * c.plate(row + i, column + j));
    for (int i = 0; i < 6; ++i) add((i < 3 ? 1e-3 : 1.0) * c.expansion[i]);
    out += '\n';
  }
  return out;
}

}  // namespace heddle::pipeline
