#include "friction/calibration/information.h"

#include <Eigen/QR>
#include <Eigen/SVD>
#include <cmath>

namespace heddle::friction {

namespace {

/// Lengths of the columns; 1 for an empty one, so that it can be divided by.
Eigen::VectorXd lengths_of(const Eigen::MatrixXd& rows) {
  const Eigen::VectorXd norms = rows.colwise().norm();
  return (norms.array() == 0.0).select(1.0, norms);
}

}  // namespace

void whiten(Eigen::Ref<Eigen::MatrixXd> rows, double sd, double reading) {
  const auto count = static_cast<double>(rows.rows());
  if (rows.rows() == 1) {
    rows /= sd;
    return;
  }
  // The mean of the rows has the variance sd^2 + reading^2/count, what is left of each has reading^2.
  const Eigen::RowVectorXd mean = rows.colwise().mean();
  rows.rowwise() -= mean;
  rows /= reading;
  rows.rowwise() += mean / std::sqrt(reading * reading + count * sd * sd);
}

Uncertainty uncertainty_of(const Eigen::MatrixXd& rows) {
  const Eigen::VectorXd scale = lengths_of(rows).cwiseInverse();
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(rows * scale.asDiagonal(), Eigen::ComputeFullV);
  const Eigen::VectorXd& values = svd.singularValues();
  Uncertainty result{.covariance = Eigen::MatrixXd::Zero(rows.cols(), rows.cols()),
                     .fixed = std::vector<bool>(static_cast<std::size_t>(rows.cols()), true)};
  for (Eigen::Index k = 0; k < rows.cols(); ++k) {
    const double value = k < values.size() ? values[k] : 0.0;
    const Eigen::VectorXd direction = svd.matrixV().col(k);
    if (value > 1e-7 * values[0]) {
      const Eigen::VectorXd step = scale.cwiseProduct(direction) / value;
      result.covariance += step * step.transpose();
      continue;
    }
    for (Eigen::Index j = 0; j < rows.cols(); ++j)
      if (std::abs(direction[j]) > 1e-4) result.fixed[static_cast<std::size_t>(j)] = false;
  }
  return result;
}

Eigen::Index rank_of(const Eigen::MatrixXd& rows) {
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(rows.rows(), rows.cols());
  qr.setThreshold(1e-6);
  qr.compute(rows * lengths_of(rows).cwiseInverse().asDiagonal());
  return qr.rank();
}

}  // namespace heddle::friction
