#pragma once

#include <Eigen/Core>
#include <array>
#include <span>
#include <vector>

#include "mesoscale/solid/stiffness.h"

namespace heddle::mesoscale::solid {

/// Load cases: six strains, or three strains and three curvatures. They are solved side by side, all of them,
/// or two at a time in 0.4 of the memory.
inline constexpr int loads = 6;
inline constexpr int pair_of_loads = 2;

/// A number of each load case that is solved side by side; of two, the first two.
using CaseNumbers = std::array<double, loads>;

/// An eight-node element with 2 x 2 x 2 Gauss points and one stiffness, in the form the matrix-free product
/// wants it.
///
/// In the coordinates (xi, eta, zeta) of the voxel, each in [-1, 1], a trilinear field has eight
/// coefficients: of 1, xi, eta, zeta, xi eta, xi zeta, eta zeta, xi eta zeta. These are orthogonal over the
/// voxel, so its energy falls apart into three small quadratic forms: of the linear coefficients (9 x 9), of
/// the bilinear ones (9 x 9, weight 1/3) and of the trilinear one (3 x 3, weight 1/9). Together 171
/// multiplications a voxel and load case where the 24 x 24 matrix has 576; it is the same matrix, since the
/// 2 x 2 x 2 rule is exact for a stiffness that does not vary within the voxel.
///
/// Rows and columns: 3 M + i, displacement i; M = xi, eta, zeta in `linear`, xi eta, xi zeta, eta zeta in
/// `bilinear`. Scaled for coefficients that are plain sums over the nodes (eight times the coefficient).
struct ElementTable {
  std::array<double, 81> linear;    ///< [N/m], row-major
  std::array<double, 81> bilinear;  ///< [N/m], row-major
  std::array<double, 9> trilinear;  ///< [N/m], row-major
};

/// Edges of one voxel: columns [m]. A parallelepiped; det > 0.
using VoxelEdges = Eigen::Matrix3d;

/// C in the voxel's own coordinates times its volume: (3 M + i, 3 N + k) -> V C_ijkl dxi_M/dx_j dxi_N/dx_l [N
/// m].
Eigen::Matrix<double, 9, 9> pulled_back(const Matrix6& stiffness, const VoxelEdges& edges);

ElementTable element_table(const Matrix6& stiffness, const VoxelEdges& edges);
std::vector<ElementTable> element_tables(std::span<const Matrix6> stiffness, const VoxelEdges& edges);

/// The 24 x 24 matrix itself, by the eight Gauss points: the oracle of the tests. Node 4 c + 2 b + a stands
/// at (a, b, c) of the voxel; row 3 node + component [N/m].
Eigen::Matrix<double, 24, 24> element_matrix(const Matrix6& stiffness, const VoxelEdges& edges);

/// One layer of voxels between two planes of nodes, periodic in x and y. Node planes hold a double of each
/// load case for each of three components for each node, x fastest.
struct VoxelLayer {
  int nx, ny;
  const double* lower;  ///< displacements of the plane below
  const double* upper;  ///< and above
  double* force_lower;  ///< what the layer adds to the forces, not zeroed here
  double* force_upper;
  const std::uint16_t* material;  ///< of nx x ny voxels
  const ElementTable* tables;
  int cases = loads;  ///< or pair_of_loads
};

/// Adds K u of one layer and returns the energy product u . K u of each load case.
/// Picks AVX-512 or AVX2 at run time.
CaseNumbers apply_layer(const VoxelLayer& layer);

enum class Instructions { plain, avx2, avx512 };
Instructions best_instructions();  ///< that this processor has; asked once
CaseNumbers apply_layer(const VoxelLayer& layer, Instructions instructions);

}  // namespace heddle::mesoscale::solid
