#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <tbb/parallel_for.h>

#include "mesoscale/solid/element.h"
#include "mesoscale/solid/field.h"
#include "mesoscale/solid/reference.h"

namespace heddle::mesoscale::solid {

/// A box of equal voxels, each of one stiffness: what the solver sees of a cell. x fastest.
struct ElasticCell {
  std::array<int, 3> count{};               ///< voxels along x, y, z
  Eigen::Matrix3d edges;                    ///< of the cell [m], columns; det > 0; the third along z
  std::span<const std::uint16_t> material;  ///< of each voxel, into stiffness
  std::span<const Matrix6> stiffness;       ///< [Pa]

  VoxelEdges voxel_edges() const {
    return edges * Eigen::Vector3d(1.0 / count[0], 1.0 / count[1], 1.0 / count[2]).asDiagonal();
  }
  std::size_t voxels() const { return static_cast<std::size_t>(count[0]) * count[1] * count[2]; }
};

/// Products by which the results are put together, over all nodes: row i, column j is of load case i of a and
/// j of b. Of two load cases the first two rows and columns, the others are zero.
Matrix6 gram(const Field& a, const Field& b, std::size_t plane, int cases);

struct SolverOptions {
  /// Of the residual in the norm of the preconditioner, against the first one. Stiffness is an energy, whose
  /// error is the square of this.
  double tolerance = 1e-6;
  int max_iterations = 1000;
  /// Load cases side by side: all six (loads), or two (pair_of_loads) in 0.4 of the memory and more time.
  int cases = loads;
};

struct SolverSummary {
  bool converged = false;
  std::string reason;                   ///< why it stopped
  std::array<int, loads> iterations{};  ///< of each load case
  CaseNumbers residual{};               ///< against the first one [-]
  int most_iterations() const;
};

/// Layers of voxels in groups of four or more: work(first, last) on all but the last layer of each group,
/// then on the last ones. Two groups that run at the same time then touch no plane of nodes in common.
struct LayerGroups {
  explicit LayerGroups(int of_cell) : layers(of_cell), count(of_cell < 8 ? 1 : of_cell / 4) {}
  int first(int group) const { return static_cast<int>(static_cast<long>(group) * layers / count); }
  int layers, count;
};

/// Conjugate gradients for all load cases side by side, each with its own step lengths, preconditioned by a
/// homogeneous cell. Sums run over planes in a fixed order: the same bits on any number of threads.
class CellSolver {
 public:
  /// @param reference  stiffness of the homogeneous cell [Pa]
  /// @param cases      side by side in its fields: loads or pair_of_loads
  /// @throws NumericalError  if the reference is not positive definite
  CellSolver(const ElasticCell& cell, Faces faces, const Matrix6& reference, int cases = loads);

  int cases() const { return cases_; }
  int planes() const { return planes_; }
  std::size_t plane() const { return plane_; }  ///< doubles of a node plane of a field
  Field field() const;                          ///< zeros

  /// K u. @return  u . K u of each load case
  CaseNumbers multiply(const Field& u, Field& force) const;

  /// K u = force.
  /// @param scale  an energy of each load case [J] to judge rounding by: a residual whose energy is below
  ///               1e-28 of it counts as none
  /// @param force  in: right hand side, whose sum is zero; out: what is left of it
  /// @param u      out: displacements
  /// @throws NumericalError  if an energy is not finite
  SolverSummary solve(Field& force, Field& u, const CaseNumbers& scale,
                      const SolverOptions& options = {}) const;

  std::size_t memory() const;  ///< of the four fields, tables and factors [byte]

  /// work(layer) on all layers of voxels, in parallel, but never on two that share a plane of nodes.
  /// prepare(plane) on each plane of nodes before any of its layers.
  template <class Prepare, class Work>
  void for_layers(const Prepare& prepare, const Work& work) const {
    const LayerGroups groups(cell_.count[2]);
    tbb::parallel_for(0, groups.count, [&](int g) {
      const int last = groups.first(g + 1) - 1;
      prepare(groups.first(g));
      for (int k = groups.first(g); k < last; ++k) {
        prepare(k + 1);
        work(k);
      }
      if (last + 1 == cell_.count[2] && faces_ == Faces::free) prepare(last + 1);
    });
    tbb::parallel_for(0, groups.count, [&](int g) { work(groups.first(g + 1) - 1); });
  }

 private:
  template <class Prepare>
  CaseNumbers add_product(const Field& u, Field& force, const Prepare& prepare) const;
  CaseNumbers precondition(const Field& residual, Field& z) const;

  ElasticCell cell_;
  Faces faces_;
  int cases_;
  int planes_;
  std::size_t plane_;
  std::vector<ElementTable> tables_;
  ReferenceInverse inverse_;
};

}  // namespace heddle::mesoscale::solid
