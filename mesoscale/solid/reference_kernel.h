#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "mesoscale/solid/element.h"

namespace heddle::mesoscale::solid {

/// Waves along one axis, in any order, with half angle a = pi k / n: what the symbol is made of.
struct Waves {
  /// @param order  which wave k stands at each place; n of them
  explicit Waves(const std::vector<int>& order);
  std::vector<double> sine2;  ///< sin^2 a
  std::vector<double> cross;  ///< sin a cos a
  std::vector<double> even;   ///< cos^2 a + sin^2 a / 3
};

/// {00, 11, 22, 01, 02, 12} of a symmetric matrix.
inline std::array<double, 6> packed(const Eigen::Matrix3d& s) {
  return {s(0, 0), s(1, 1), s(2, 2), s(0, 1), s(0, 2), s(1, 2)};
}

/// Symbol of the periodic operator: S = sum_t weight_t(k) coefficient[t], symmetric 3 x 3, packed; t = xi xi,
/// eta eta, zeta zeta, xi eta, xi zeta, eta zeta.
struct PeriodicSymbol {
  explicit PeriodicSymbol(const Eigen::Matrix<double, 9, 9>& pulled);
  std::array<std::array<double, 6>, 6> coefficient;
};

/// Waves of a block along x at one wave of y and of z, by their places.
struct PeriodicBlock {
  int first, count;  ///< along x
  int y, z;
  int cases = loads;  ///< or pair_of_loads
};

/// values := scale S^-1 values for a block of waves; the mean wave, which stands first, gives zero.
/// @param values  count x 3 x cases
void divide_by_symbol(const PeriodicSymbol& symbol, const std::array<Waves, 3>& waves,
                      const PeriodicBlock& block, double scale, double* values);

/// Largest number of waves along x in one block.
inline constexpr int largest_block = 24;

/// One wave of the plate: real blocks of the tridiagonal system, with i u_z for u_z.
struct SlabBlocks {
  Eigen::Matrix3d bottom;  ///< the lower plane of a layer on itself
  Eigen::Matrix3d top;     ///< the upper one
  Eigen::Matrix3d up;      ///< the lower one on the upper: row lower, column upper
};
/// @param i, j  places of the wave in x and y
SlabBlocks slab_blocks(const Eigen::Matrix<double, 9, 9>& pulled, const Waves& x, const Waves& y, int i,
                       int j);

/// The columns of a block of waves, solved in place: block Thomas with the factors at hand.
struct SlabBlock {
  int count;  ///< waves
  int planes;
  std::ptrdiff_t stride;  ///< from plane to plane in the values [double]
  const double* inverse;  ///< [plane][wave][6]: inverses of the pivots, {00, 11, 22, 01, 02, 12}
  const double* up;       ///< [9][largest_block]
  double sign;            ///< +1, or -1 at the opposite wave, where u_z turns round
  double scale;
  int cases = loads;  ///< or pair_of_loads
};
void solve_slab(const SlabBlock& block, double* values);

}  // namespace heddle::mesoscale::solid
