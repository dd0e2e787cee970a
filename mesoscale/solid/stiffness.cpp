#include "mesoscale/solid/stiffness.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <cmath>

#include "core/problem.h"

namespace heddle::mesoscale::solid {

namespace {

Vector6 mandel_weights() {
  Vector6 w;
  w << 1.0, 1.0, 1.0, std::sqrt(2.0), std::sqrt(2.0), std::sqrt(2.0);
  return w;
}

}  // namespace

Matrix6 isotropic_stiffness(double bulk, double shear) {
  Matrix6 c = Matrix6::Zero();
  c.topLeftCorner<3, 3>().setConstant(bulk - 2.0 / 3.0 * shear);
  c.diagonal().head<3>().array() += 2.0 * shear;
  c.diagonal().tail<3>().setConstant(shear);
  return c;
}

Matrix6 stiffness(const TransverseIsotropy& m) {
  Matrix6 compliance = Matrix6::Zero();
  compliance.diagonal() << 1.0 / m.axial_modulus, 1.0 / m.transverse_modulus, 1.0 / m.transverse_modulus,
      1.0 / m.transverse_shear, 1.0 / m.axial_shear, 1.0 / m.axial_shear;
  for (int t : {1, 2}) compliance(0, t) = compliance(t, 0) = -m.axial_poisson / m.axial_modulus;
  compliance(1, 2) = compliance(2, 1) = -m.transverse_poisson() / m.transverse_modulus;
  const Eigen::LLT<Matrix6> factor(compliance);
  if (factor.info() != Eigen::Success)
    throw NumericalError("micromechanics: the constants are not those of a stable material");
  const Matrix6 c = factor.solve(Matrix6::Identity());
  return 0.5 * (c + c.transpose());
}

Matrix6 strain_turn(const Eigen::Matrix3d& turn) {
  Matrix6 result;
  for (int row = 0; row < 6; ++row)
    for (int column = 0; column < 6; ++column) {
      const auto [a, b] = voigt_axes[row];
      const auto [i, j] = voigt_axes[column];
      // e'_ab = r_ai r_bj e_ij; off-diagonal strains stand twice in the sum and doubled in Voigt form.
      const double both =
          i == j ? turn(a, i) * turn(b, i) : 0.5 * (turn(a, i) * turn(b, j) + turn(a, j) * turn(b, i));
      result(row, column) = (a == b ? 1.0 : 2.0) * both;
    }
  return result;
}

Matrix6 rotated(const Matrix6& stiffness, const Eigen::Matrix3d& turn) {
  // Energy is the same for a strain and its turned image: C' = T^-T C T^-1, and T^-1 turns back.
  const Matrix6 back = strain_turn(turn.transpose());
  return back.transpose() * stiffness * back;
}

Eigen::Matrix3d turn_to(const Eigen::Vector3d& direction) {
  const Eigen::Vector3d first = direction.normalized();
  Eigen::Index least = 0;
  first.cwiseAbs().minCoeff(&least);
  const Eigen::Vector3d second = first.cross(Eigen::Vector3d::Unit(least)).normalized();
  Eigen::Matrix3d turn;
  turn << first, second, first.cross(second);
  return turn;
}

Matrix6 mandel_from_voigt(const Matrix6& voigt) {
  const Vector6 w = mandel_weights();
  return w.asDiagonal() * voigt * w.asDiagonal();
}

Matrix6 voigt_from_mandel(const Matrix6& mandel) {
  const Vector6 w = mandel_weights().cwiseInverse();
  return w.asDiagonal() * mandel * w.asDiagonal();
}

Matrix6 reordered(const Matrix6& matrix, const std::array<int, 6>& order) {
  Matrix6 result;
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) result(i, j) = matrix(order[i], order[j]);
  return result;
}

}  // namespace heddle::mesoscale::solid
