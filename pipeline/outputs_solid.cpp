#include <array>
#include <numbers>
#include <tuple>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "pipeline/json_text.h"
#include "pipeline/outputs.h"

namespace heddle::pipeline {

namespace {

using Json = nlohmann::ordered_json;
namespace solid = mesoscale::solid;

template <class Matrix>
Json rows_of(const Matrix& matrix, double factor) {
  Json rows = Json::array();
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    Json row = Json::array();
    for (Eigen::Index j = 0; j < matrix.cols(); ++j) row.push_back(factor * matrix(i, j));
    rows.push_back(row);
  }
  return rows;
}

/// Three of six numbers in another unit.
Json three(const solid::Vector6& v, Eigen::Index first, double factor) {
  return {factor * v[first], factor * v[first + 1], factor * v[first + 2]};
}

Json six(const solid::Vector6& v, double factor) {
  Json row = Json::array();
  for (const double value : v) row.push_back(factor * value);
  return row;
}

/// Resultants of the held ply and stresses of the held stack, by cause, and how the free ply expands.
template <class PlateHeld, class StackHeld>
void add_held(Json& to, const solid::Matrix6& stiffness, const PlateHeld& plate, const StackHeld& stack) {
  const solid::Vector6 free = solid::free_strain(stiffness, plate[solid::expansion]);
  to["ply_expansion_1_per_K"] = three(free, 0, 1.0);
  to["ply_curvature_1_per_mm_K"] = three(free, 3, 1e-3);
  to["N_expansion_N_per_mm_K"] = three(plate[solid::expansion], 0, 1e-3);
  to["M_expansion_N_per_K"] = three(plate[solid::expansion], 3, 1.0);
  to["N_shrinkage_N_per_mm"] = three(plate[solid::shrinkage], 0, 1e-3);
  to["M_shrinkage_N"] = three(plate[solid::shrinkage], 3, 1.0);
  to["stress_expansion_MPa_per_K"] = six(stack[solid::expansion], 1e-6);
  to["stress_shrinkage_MPa"] = six(stack[solid::shrinkage], 1e-6);
}

Json sheared_json(const solid::ShearedSolid& s) {
  Json row{{"shear_angle_deg", s.shear_angle * 180.0 / std::numbers::pi},
           {"thickness_mm", 1e3 * s.thickness},
           {"tow_fibre_volume_fraction", s.fibre_fraction},
           {"converged", s.converged},
           {"C_MPa", rows_of(s.stack, 1e-6)},
           {"A_N_per_mm", rows_of(s.plate.topLeftCorner<3, 3>(), 1e-3)},
           {"B_N", rows_of(s.plate.topRightCorner<3, 3>(), 1.0)},
           {"D_N_mm", rows_of(s.plate.bottomRightCorner<3, 3>(), 1e3)}};
  add_held(row, s.plate, s.plate_held, s.stack_held);
  return row;
}

}  // namespace

std::string stiffness_json(const mesoscale::solid::SolidResult& result) {
  Json root{{"order", {"11", "22", "33", "23", "13", "12"}}, {"scaling", "voigt"}};
  Json iterations = Json::array();
  if (result.stack) {
    root["C_MPa"] = rows_of(result.stack->stiffness, 1e-6);
    for (const int n : result.stack->solver.iterations) iterations.push_back(n);
  }
  if (result.plate) {
    root["A_N_per_mm"] = rows_of(result.plate->a, 1e-3);
    root["B_N"] = rows_of(result.plate->b, 1.0);
    root["D_N_mm"] = rows_of(result.plate->d, 1e3);
    for (const int n : result.plate->solver.iterations) iterations.push_back(n);
  }
  if (result.plate && result.plate->held.size() == solid::held_causes)
    add_held(root, result.plate->all, result.plate->held, result.stack->held);
  if (result.laminate) {
    const solid::LaminateSolid& l = *result.laminate;
    const auto parts = [](const solid::Matrix6& all) {
      return Json{{"A_N_per_mm", rows_of(all.topLeftCorner<3, 3>(), 1e-3)},
                  {"B_N", rows_of(all.topRightCorner<3, 3>(), 1.0)},
                  {"D_N_mm", rows_of(all.bottomRightCorner<3, 3>(), 1e3)}};
    };
    root["laminate"] = {{"plies", l.plies},
                        {"thickness_mm", 1e3 * l.thickness},
                        {"tow_fibre_volume_fraction", l.fibre_fraction},
                        {"tow_share", l.tow_share},
                        {"converged", l.converged},
                        {"together", parts(l.plate)},
                        {"apart", parts(l.apart)}};
  }
  root["iterations"] = iterations;
  root["voxels"] = {result.voxels[0], result.voxels[1], result.voxels[2]};
  for (const solid::ShearedSolid& sheared : result.sheared) root["sheared"].push_back(sheared_json(sheared));
  return json_text(root);
}

std::string sheared_csv(const std::vector<mesoscale::solid::ShearedSolid>& sheared) {
  // Upper halves; 1, 2, 6 are 11, 22, 12. A stack whose tows lie in its plane has no more than these of C.
  constexpr std::array<std::array<int, 2>, 6> of_plate{{{0, 0}, {0, 1}, {0, 2}, {1, 1}, {1, 2}, {2, 2}}};
  constexpr std::array<const char*, 6> names{"11", "12", "16", "22", "26", "66"};
  std::string text = "shear_angle_deg,thickness_mm,tow_fibre_volume_fraction";
  for (const auto& [part, unit] : {std::pair{"A", "N_per_mm"}, {"B", "N"}, {"D", "N_mm"}})
    for (const char* name : names) text += fmt::format(",{}{}_{}", part, name, unit);
  for (const char* cause : {"expansion", "shrinkage"})
    for (const auto& [part, unit] : {std::pair{"N", "N_per_mm"}, {"M", "N"}})
      for (const char* name : {"11", "22", "12"})
        text += fmt::format(",{}{}_{}_{}{}", part, name, cause, unit, cause[0] == 'e' ? "_K" : "");
  text += '\n';
  for (const auto& s : sheared) {
    text += fmt::format("{},{},{}", s.shear_angle * 180.0 / std::numbers::pi, 1e3 * s.thickness,
                        s.fibre_fraction);
    for (const auto& [row, column, factor] : {std::tuple{0, 0, 1e-3}, {0, 3, 1.0}, {3, 3, 1e3}})
      for (const auto& [i, j] : of_plate) text += fmt::format(",{}", factor * s.plate(row + i, column + j));
    for (const mesoscale::solid::Vector6& held : s.plate_held)
      for (int i = 0; i < 6; ++i) text += fmt::format(",{}", (i < 3 ? 1e-3 : 1.0) * held[i]);
    text += '\n';
  }
  return text;
}

}  // namespace heddle::pipeline
