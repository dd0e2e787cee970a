#include "friction/calibration/information.h"

#include <Eigen/LU>
#include <catch2/catch.hpp>

using namespace heddle::friction;

TEST_CASE("readings of one sample are whitened by the inverse of their covariance",
          "[friction][calibration][analytic]") {
  const double sd = 0.05, reading = 0.02;
  for (const Eigen::Index count : {1, 2, 7}) {
    Eigen::MatrixXd root = Eigen::MatrixXd::Identity(count, count);
    whiten(root, sd, reading);
    const Eigen::MatrixXd covariance =
        count == 1 ? Eigen::MatrixXd::Constant(1, 1, sd * sd)
                   : Eigen::MatrixXd(Eigen::MatrixXd::Constant(count, count, sd * sd) +
                                     reading * reading * Eigen::MatrixXd::Identity(count, count));
    CHECK((root * covariance * root.transpose() - Eigen::MatrixXd::Identity(count, count)).norm() < 1e-12);
  }
}

TEST_CASE("the covariance is the inverse of the information, in whatever units",
          "[friction][calibration][analytic]") {
  Eigen::MatrixXd rows(4, 3);
  rows << 1.0, 2.0, 0.5, 0.3, -1.0, 2.0, 0.0, 1.5, 1.0, 2.0, 0.1, -0.7;
  const Uncertainty plain = uncertainty_of(rows);
  CHECK((plain.covariance - (rows.transpose() * rows).inverse()).norm() < 1e-12);
  CHECK(plain.fixed == std::vector<bool>(3, true));
  const Eigen::Vector3d unit(1e-6, 1.0, 1e6);
  const Uncertainty scaled = uncertainty_of(rows * unit.asDiagonal());
  CHECK((unit.asDiagonal() * scaled.covariance * unit.asDiagonal() - plain.covariance).norm() < 1e-12);
  CHECK(rank_of(rows * unit.asDiagonal()) == 3);
}

TEST_CASE("what no row fixes is said, and the rest keeps its variance", "[friction][calibration][analytic]") {
  Eigen::MatrixXd rows(4, 4);
  // The first two act alike, the third alone; nothing sees the fourth.
  rows << 1.0, 2.0, 0.0, 0.0, 1.0, 2.0, 1.0, 0.0, -1.0, -2.0, 1.0, 0.0, 0.5, 1.0, 0.0, 0.0;
  const Uncertainty alike = uncertainty_of(rows);
  CHECK(alike.fixed == std::vector<bool>{false, false, true, false});
  CHECK(alike.covariance(2, 2) == Approx(0.5).epsilon(1e-12));  // two rows of variance 1
  CHECK(rank_of(rows) == 2);
  // Fewer rows than variables leave some of them free.
  const Uncertainty few = uncertainty_of(rows.topRows(1));
  CHECK(few.fixed == std::vector<bool>{false, false, false, false});
}
