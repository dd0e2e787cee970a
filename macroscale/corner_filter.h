#pragma once

#include <Eigen/Core>

namespace heddle::macroscale {

/// A symmetric 2 x 2 [N/m].
struct Symmetric2 {
  double xx = 0.0, xy = 0.0, yy = 0.0;
};

/// In-plane second derivatives of an energy of |a|, |b| and the angle between a and b, in components along
/// and across each edge [N/m]. Each is coupled with two others only, in a ring
///
///     a along --turn_a-- a across --across-- b across --turn_b-- b along --along-- a along,
///
/// provided that the energy is a function of the lengths plus a function of the angle.
struct CornerRing {
  double along_a = 0.0, across_a = 0.0, along_b = 0.0, across_b = 0.0;  ///< diagonal
  double turn_a = 0.0, turn_b = 0.0, along = 0.0, across = 0.0;
};

/// The matrix itself, in the order a along, a across, b along, b across.
Eigen::Matrix4d matrix_of(const CornerRing& ring);

/// Nearest positive semi-definite matrix (Frobenius): negative eigenvalues set to zero. Closed form.
Symmetric2 positive_part(Symmetric2 m);

/// The same of a ring. Two plane rotations make it tridiagonal; the signs of its pivots tell whether there is
/// anything to do, and only then are eigenvalues and vectors taken, by implicit QL.
/// @return  order as in matrix_of; exact to rounding of the largest entry
/// @source  QL: Bowdler, Martin, Reinsch & Wilkinson 1968 (tql2)
Eigen::Matrix4d positive_part(const CornerRing& ring);

/// The same of any symmetric matrix, by its eigenvalues: for an energy that couples lengths with the angle.
Eigen::Matrix4d positive_part(const Eigen::Matrix4d& m);

}  // namespace heddle::macroscale
