#pragma once

#include <array>
#include <memory>

#include "mesoscale/solid/element.h"

namespace heddle::mesoscale::solid {

/// The faces of the cell across z; x and y are periodic always.
enum class Faces {
  periodic,  ///< a stack without end
  free       ///< a plate
};

/// Node planes of a cell of nz layers of voxels.
inline int planes_of(int layers, Faces faces) {
  return faces == Faces::periodic ? layers : layers + 1;
}

/// The finite element operator of a homogeneous cell, inverted exactly: the preconditioner.
///
/// In x and y by Fourier transforms. Two load cases make one complex signal: the symbol of a voxel is the
/// same after a turn by 180 degrees, so it is real, and acts on real and imaginary parts alike. Across z
/// - periodic: Fourier too, and a 3 x 3 inverse a wave;
/// - free: a block-tridiagonal system of 3 x 3 blocks a wave, factored once (block Thomas). With i u_z in
/// place
///   of u_z its blocks are real, if the reference has z = 0 as a plane of mirror symmetry.
/// Translations, which the operator does not see, are left out.
///
/// The three steps are apart so that a solver can do its own work on a plane while it is in cache. A field
/// holds node planes one after the other, a plane [node of y][node of x][component][load case].
class ReferenceInverse {
 public:
  /// @param count  voxels along x, y, z
  /// @param stiffness  [Pa], positive definite; free: parts odd in z are dropped
  /// @param cases      load cases side by side: loads or pair_of_loads
  /// @throws NumericalError  if it is not positive definite
  ReferenceInverse(std::array<int, 3> count, const VoxelEdges& edges, const Matrix6& stiffness, Faces faces,
                   int cases = loads);
  ~ReferenceInverse();
  ReferenceInverse(ReferenceInverse&&) noexcept;

  void forward(double* plane) const;  ///< transforms of one plane along x and y
  void columns(
      double* field) const;  ///< all waves of all planes, in parallel; same bits on any number of threads
  void backward(double* plane) const;  ///< back to the nodes

  std::size_t memory() const;  ///< of the factors [byte]

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

/// C with its parts odd in z set to zero: what a mirror at z = 0 leaves.
Matrix6 mirrored_in_z(const Matrix6& stiffness);

}  // namespace heddle::mesoscale::solid
