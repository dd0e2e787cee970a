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

// The way back of rows_of.
template <class Matrix>
Matrix matrix_of(const Json& rows, double factor) {
  Matrix matrix;
  for (Eigen::Index i = 0; i < matrix.rows(); ++i)
    for (Eigen::Index j = 0; j < matrix.cols(); ++j)
      matrix(i, j) =
          factor * rows.at(static_cast<std::size_t>(i)).at(static_cast<std::size_t>(j)).get<double>();
  return matrix;
}

solid::Vector6 vector_of(const Json& row, double factor) {
  solid::Vector6 v;
  for (Eigen::Index i = 0; i < 6; ++i) v[i] = factor * row.at(static_cast<std::size_t>(i)).get<double>();
  return v;
}

// {N, M} of the held ply.
solid::Vector6 resultants_of(const Json& n, double factor, const Json& m) {
  solid::Vector6 held;
  for (Eigen::Index i = 0; i < 3; ++i) {
    held[i] = factor * n.at(static_cast<std::size_t>(i)).get<double>();
    held[3 + i] = m.at(static_cast<std::size_t>(i)).get<double>();
  }
  return held;
}

solid::ShearedSolid sheared_of(const Json& row) {
  solid::ShearedSolid s;
  s.shear_angle = row.at("shear_angle_deg").get<double>() * std::numbers::pi / 180.0;
  s.thickness = 1e-3 * row.at("thickness_mm").get<double>();
  s.fibre_fraction = row.at("tow_fibre_volume_fraction").get<double>();
  s.converged = row.at("converged").get<bool>();
  s.stack = matrix_of<solid::Matrix6>(row.at("C_MPa"), 1e6);
  s.plate.topLeftCorner<3, 3>() = matrix_of<Eigen::Matrix3d>(row.at("A_N_per_mm"), 1e3);
  s.plate.topRightCorner<3, 3>() = matrix_of<Eigen::Matrix3d>(row.at("B_N"), 1.0);
  s.plate.bottomLeftCorner<3, 3>() = s.plate.topRightCorner<3, 3>().transpose();
  s.plate.bottomRightCorner<3, 3>() = matrix_of<Eigen::Matrix3d>(row.at("D_N_mm"), 1e-3);
  s.plate_held[solid::expansion] =
      resultants_of(row.at("N_expansion_N_per_mm_K"), 1e3, row.at("M_expansion_N_per_K"));
  s.plate_held[solid::shrinkage] =
      resultants_of(row.at("N_shrinkage_N_per_mm"), 1e3, row.at("M_shrinkage_N"));
  s.stack_held[solid::expansion] = vector_of(row.at("stress_expansion_MPa_per_K"), 1e6);
  s.stack_held[solid::shrinkage] = vector_of(row.at("stress_shrinkage_MPa"), 1e6);
  return s;
}

}  // namespace

std::vector<solid::ShearedSolid> read_sheared_json(std::string_view text, const std::string& file) {
  std::vector<solid::ShearedSolid> sheared;
  try {
    const Json root = Json::parse(text);
    for (const Json& row : root.at("sheared")) sheared.push_back(sheared_of(row));
  } catch (const Json::exception& error) {
    throw InputError({{"stiffness.file"_rule, "sheared", "", fmt::format("cannot be read: {}", error.what()),
                       "Make the file anew: `heddle run` with `solid.shear_angles` writes it.", file}});
  }
  return sheared;
}

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
