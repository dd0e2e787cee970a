#pragma once

#include <span>

#include <Eigen/Core>

#include "core/sparse_solver.h"

namespace heddle::test {

/// A d of a symmetric matrix from its lower triangle.
inline Eigen::VectorXd multiply(const SymmetricPattern& pattern, std::span<const double> values,
                                const Eigen::VectorXd& d) {
  Eigen::VectorXd y = Eigen::VectorXd::Zero(d.size());
  for (int j = 0; j < pattern.size; ++j)
    for (int k = pattern.column_start[j]; k < pattern.column_start[j + 1]; ++k) {
      y[pattern.row[k]] += values[k] * d[j];
      if (pattern.row[k] != j) y[j] += values[k] * d[pattern.row[k]];
    }
  return y;
}

}  // namespace heddle::test
