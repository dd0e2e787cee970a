#include <nlohmann/json.hpp>

#include "pipeline/json_text.h"
#include "pipeline/outputs.h"

namespace heddle::pipeline {

namespace {

using Json = nlohmann::ordered_json;

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
  root["iterations"] = iterations;
  root["voxels"] = {result.voxels[0], result.voxels[1], result.voxels[2]};
  return json_text(root);
}

}  // namespace heddle::pipeline
