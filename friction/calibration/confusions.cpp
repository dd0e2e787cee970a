#include "friction/calibration/confusions.h"

#include <fmt/format.h>

#include <Eigen/QR>
#include <algorithm>
#include <cmath>

namespace heddle::friction {

namespace {

/// "C and m only as C x m^0.136" of a pair of positive numbers; of more, the changes that cancel.
std::string sentence(const Confusion& confusion, bool positive) {
  if (confusion.keys.size() == 1)
    return fmt::format("No force changes with {}: the data say nothing of it.", confusion.keys[0]);
  if (confusion.keys.size() == 2 && positive) {
    const double exponent = -confusion.change[0] / confusion.change[1];
    return fmt::format("The data cannot tell {0} from {1}: only {0} x {1}^{2:.4g} is fixed.",
                       confusion.keys[0], confusion.keys[1], exponent);
  }
  std::vector<std::string> changes;
  for (std::size_t k = 0; k < confusion.keys.size(); ++k)
    changes.push_back(fmt::format("{} by {:+.3g} %", confusion.keys[k], confusion.change[k]));
  return fmt::format("The data cannot tell these apart: changing {} moves no force.",
                     fmt::join(changes, ", "));
}

}  // namespace

std::vector<Confusion> total_confusions(const Eigen::MatrixXd& slopes, const std::vector<std::string>& keys,
                                        const Eigen::VectorXd& values) {
  // Columns in relative changes, of unit length: what is left of a dependent one is rounding.
  constexpr double alike = 1e-6;
  const Eigen::Index count = slopes.cols();
  const Eigen::VectorXd size = (values.array() == 0.0).select(1.0, values.array().abs());
  Eigen::MatrixXd columns = slopes * size.asDiagonal();
  const Eigen::VectorXd norms = columns.colwise().norm();
  std::vector<Confusion> confusions;
  std::vector<Eigen::Index> seen;
  for (Eigen::Index k = 0; k < count; ++k) {
    // mu itself moves by 1 for a relative change of a plain factor: 1e-9 of that is nothing.
    if (norms[k] > 1e-9 * std::sqrt(static_cast<double>(slopes.rows()))) {
      seen.push_back(k);
      continue;
    }
    Confusion unseen{.keys = {keys[static_cast<std::size_t>(k)]}, .change = {1.0}};
    unseen.words = sentence(unseen, true);
    confusions.push_back(std::move(unseen));
  }
  if (seen.empty()) return confusions;
  Eigen::MatrixXd unit(columns.rows(), static_cast<Eigen::Index>(seen.size()));
  for (std::size_t j = 0; j < seen.size(); ++j)
    unit.col(static_cast<Eigen::Index>(j)) = columns.col(seen[j]) / norms[seen[j]];

  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(unit.rows(), unit.cols());
  qr.setThreshold(alike);
  qr.compute(unit);
  const Eigen::Index rank = qr.rank(), width = unit.cols();
  if (rank == width) return confusions;
  const Eigen::MatrixXd r = qr.matrixR().topRows(rank);
  // Each column left over is a sum of those taken: c_d = sum of share_k c_k.
  const Eigen::MatrixXd shares =
      r.leftCols(rank).triangularView<Eigen::Upper>().solve(r.rightCols(width - rank));
  const auto original = [&](Eigen::Index permuted) {
    return seen[static_cast<std::size_t>(qr.colsPermutation().indices()[permuted])];
  };
  for (Eigen::Index d = 0; d < width - rank; ++d) {
    Eigen::VectorXd change = Eigen::VectorXd::Zero(count);
    change[original(rank + d)] = 1.0 / norms[original(rank + d)];
    for (Eigen::Index k = 0; k < rank; ++k)
      if (std::abs(shares(k, d)) > 1e-4) change[original(k)] = -shares(k, d) / norms[original(k)];
    change /= change.cwiseAbs().maxCoeff();
    Confusion confusion;
    bool positive = true;
    for (Eigen::Index k = 0; k < count; ++k) {
      if (change[k] == 0.0) continue;
      confusion.keys.push_back(keys[static_cast<std::size_t>(k)]);
      confusion.change.push_back(change[k]);
      positive = positive && values[k] > 0.0;
    }
    confusion.words = sentence(confusion, positive);
    confusions.push_back(std::move(confusion));
  }
  return confusions;
}

std::vector<Confusion> high_correlations(const Eigen::MatrixXd& correlation,
                                         const std::vector<std::string>& keys) {
  std::vector<Confusion> confusions;
  for (Eigen::Index i = 0; i < correlation.rows(); ++i)
    for (Eigen::Index j = i + 1; j < correlation.cols(); ++j) {
      const double r = correlation(i, j);
      if (std::abs(r) <= 0.95) continue;
      const std::string& a = keys[static_cast<std::size_t>(i)];
      const std::string& b = keys[static_cast<std::size_t>(j)];
      confusions.push_back(
          {.keys = {a, b},
           .change = {1.0, r > 0.0 ? 1.0 : -1.0},
           .total = false,
           .words = fmt::format("The data hardly tell {} from {}: their correlation is {:.3f}.", a, b, r)});
    }
  return confusions;
}

}  // namespace heddle::friction
