#pragma once

#include <Eigen/Core>
#include <array>

namespace heddle::mesoscale::solid {

/// Linear elastic stiffness [Pa] in Voigt form: rows and columns 11, 22, 33, 23, 13, 12, stresses against
/// engineering shear strains. Symmetric; the zero matrix is a void.
using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Vector6 = Eigen::Matrix<double, 6, 1>;

/// Which two axes a Voigt index stands for: 0..5 -> 11, 22, 33, 23, 13, 12.
inline constexpr std::array<std::array<int, 2>, 6> voigt_axes{
    {{{0, 0}}, {{1, 1}}, {{2, 2}}, {{1, 2}}, {{0, 2}}, {{0, 1}}}};
/// The way back: voigt_index[i][j].
inline constexpr std::array<std::array<int, 3>, 3> voigt_index{{{{0, 5, 4}}, {{5, 1, 3}}, {{4, 3, 2}}}};

/// @param bulk, shear  moduli [Pa]
Matrix6 isotropic_stiffness(double bulk, double shear);

/// Engineering constants of a material with one axis of rotation (index L), 2 = 3 = T across it.
struct TransverseIsotropy {
  double axial_modulus;       ///< E_L [Pa]
  double transverse_modulus;  ///< E_T [Pa]
  double axial_shear;         ///< G_LT [Pa]
  double transverse_shear;    ///< G_TT [Pa]
  double axial_poisson;       ///< nu_LT [-]: contraction across under load along

  double transverse_poisson() const { return 0.5 * transverse_modulus / transverse_shear - 1.0; }
};

/// Stiffness with the axis of rotation along 1.
/// @throws NumericalError  if the constants are not those of a stable material (compliance not positive
///         definite)
Matrix6 stiffness(const TransverseIsotropy& material);

/// The same body turned: C'_abcd = R_ai R_bj R_ck R_dl C_ijkl.
/// @param turn  rotation or reflection; its columns are the images of the axes 1, 2, 3
Matrix6 rotated(const Matrix6& stiffness, const Eigen::Matrix3d& turn);

/// Strains (Voigt form, engineering shears) of the same body turned, from those of the body at rest.
Matrix6 strain_turn(const Eigen::Matrix3d& turn);

/// A rotation that takes axis 1 to a direction.
/// @param direction  of any length > 0
Eigen::Matrix3d turn_to(const Eigen::Vector3d& direction);

/// Mandel form: stresses and strains carry sqrt 2 on their shear parts, so that the matrix is a tensor of
/// second rank in six dimensions. FANS and others print it.
Matrix6 mandel_from_voigt(const Matrix6& voigt);
Matrix6 voigt_from_mandel(const Matrix6& mandel);

/// Rows and columns in another order: result(i, j) = matrix(order[i], order[j]).
Matrix6 reordered(const Matrix6& matrix, const std::array<int, 6>& order);

/// C_ijkl by its four axes.
inline double component(const Matrix6& c, int i, int j, int k, int l) {
  return c(voigt_index[i][j], voigt_index[k][l]);
}

}  // namespace heddle::mesoscale::solid
