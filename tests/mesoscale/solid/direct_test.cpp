// The third opinion on the cell problem: the same eight-node voxels put together as one sparse matrix by a
// code of its own, and factorised. No transform, no void layer, no iteration.
#include <Eigen/LU>
#include <Eigen/SparseCholesky>
#include <catch2/catch.hpp>
#include <cmath>

#include "sample_cells.h"

using namespace heddle::mesoscale::solid;
using heddle::test::gap;
using heddle::test::random_cell;
using heddle::test::SampleCell;
using heddle::test::tow_and_resin;

namespace {

using Strains = Eigen::Matrix<double, 6, 24>;

// Strains (11, 22, 33, 23, 13, 12; shears doubled) at a point of the unit voxel, node 4 c + 2 b + a at (a, b,
// c).
Strains strains_at(const Eigen::Vector3d& point, const Eigen::Vector3d& edge) {
  Strains b = Strains::Zero();
  for (int node = 0; node < 8; ++node) {
    const std::array<int, 3> corner{node & 1, node >> 1 & 1, node >> 2};
    Eigen::Vector3d gradient;
    for (int d = 0; d < 3; ++d) {
      double value = corner[d] == 1 ? 1.0 / edge[d] : -1.0 / edge[d];
      for (int other = 0; other < 3; ++other)
        if (other != d) value *= corner[other] == 1 ? point[other] : 1.0 - point[other];
      gradient[d] = value;
    }
    const int u = 3 * node;
    for (int d = 0; d < 3; ++d) b(d, u + d) = gradient[d];
    b(3, u + 1) = b(4, u) = gradient[2];
    b(3, u + 2) = b(5, u) = gradient[1];
    b(4, u + 2) = b(5, u + 1) = gradient[0];
  }
  return b;
}

// Six strains, or the strains 11, 22, 12 and these times the height above the middle of the plate.
Matrix6 load_at(Faces faces, double z) {
  if (faces == Faces::periodic) return Matrix6::Identity();
  Matrix6 load = Matrix6::Zero();
  constexpr std::array in_plane{0, 1, 5};
  for (int k = 0; k < 3; ++k) {
    load(in_plane[k], k) = 1.0;
    load(in_plane[k], 3 + k) = z;
  }
  return load;
}

class DirectCell {
 public:
  DirectCell(const SampleCell& cell, Faces faces) : cell_(cell), faces_(faces) {
    for (int d = 0; d < 3; ++d) edge_[d] = cell.edges(d, d) / cell.count[d];
  }

  // Integral of strain : C : strain over the whole fields, load case by load case.
  Matrix6 energies() const {
    const int planes = faces_ == Faces::free ? cell_.count[2] + 1 : cell_.count[2];
    const int unknowns = 3 * cell_.count[0] * cell_.count[1] * planes;
    std::vector<Eigen::Triplet<double>> entries;
    Eigen::MatrixXd force = Eigen::MatrixXd::Zero(unknowns, 6);
    Matrix6 own = Matrix6::Zero();  // of the loads alone
    for_each_point(
        [&](const std::array<int, 24>& at, const Strains& b, const Matrix6& c, const Matrix6& load) {
          const Eigen::Matrix<double, 24, 24> k = b.transpose() * c * b;
          const Eigen::Matrix<double, 24, 6> f = b.transpose() * c * load;
          for (int r = 0; r < 24; ++r) {
            force.row(at[r]) -= f.row(r);
            for (int s = 0; s < 24; ++s) entries.emplace_back(at[r], at[s], k(r, s));
          }
          own += load.transpose() * c * load;
        });
    // The first node stays where it is.
    for (int d = 0; d < 3; ++d) entries.emplace_back(d, d, 1e3 * entries.front().value());
    Eigen::SparseMatrix<double> matrix(unknowns, unknowns);
    matrix.setFromTriplets(entries.begin(), entries.end());
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factors(matrix);
    REQUIRE(factors.info() == Eigen::Success);
    const Eigen::MatrixXd u = factors.solve(force);
    return own - force.transpose() * u;
  }

 private:
  template <class Add>
  void for_each_point(const Add& add) const {
    const auto [nx, ny, nz] = cell_.count;
    const double weight = edge_.prod() / 8.0, off = 0.5 / std::sqrt(3.0);
    std::size_t voxel = 0;
    for (int k = 0; k < nz; ++k)
      for (int j = 0; j < ny; ++j)
        for (int i = 0; i < nx; ++i) {
          const Matrix6 c = weight * cell_.stiffness[cell_.material[voxel++]];
          std::array<int, 24> at{};
          for (int node = 0; node < 8; ++node) {
            const int x = (i + (node & 1)) % nx, y = (j + (node >> 1 & 1)) % ny, up = k + (node >> 2);
            const int z = faces_ == Faces::free ? up : up % nz;
            for (int d = 0; d < 3; ++d) at[3 * node + d] = 3 * ((z * ny + y) * nx + x) + d;
          }
          for (int gauss = 0; gauss < 8; ++gauss) {
            const Eigen::Vector3d point(0.5 + (gauss & 1 ? off : -off), 0.5 + (gauss >> 1 & 1 ? off : -off),
                                        0.5 + (gauss >> 2 ? off : -off));
            const double height = (k + point[2] - 0.5 * nz) * edge_[2];
            add(at, strains_at(point, edge_), c, load_at(faces_, height));
          }
        }
  }

  const SampleCell& cell_;
  Faces faces_;
  Eigen::Vector3d edge_;
};

}  // namespace

TEST_CASE("free faces by elimination are free faces by one factorisation of the whole cell",
          "[solid][plate][direct]") {
  const unsigned seed = GENERATE(1U, 2U, 3U);
  const SampleCell cell = random_cell({6, 5, 4}, tow_and_resin(), seed);
  const PlateStiffness plate = plate_stiffness(cell.view(), {.tolerance = 1e-10});
  const double area = cell.edges(0, 0) * cell.edges(1, 1);
  const Matrix6 direct = DirectCell(cell, Faces::free).energies() / area;
  CHECK(gap(plate.a, direct.topLeftCorner<3, 3>()) < 1e-10);
  CHECK(gap(plate.d, direct.bottomRightCorner<3, 3>()) < 1e-10);
  CHECK(gap(plate.b, direct.topRightCorner<3, 3>()) < 1e-9);
  CHECK(gap(1.01 * plate.a, direct.topLeftCorner<3, 3>()) > 1e-3);  // the check can fail
}

TEST_CASE("a periodic cell by transforms is that by one factorisation", "[solid][periodic][direct]") {
  const SampleCell cell = random_cell({5, 6, 4}, tow_and_resin(), 8);
  const PeriodicStiffness stack = periodic_stiffness(cell.view(), {.tolerance = 1e-10});
  const double volume = cell.edges.determinant();
  CHECK(gap(stack.stiffness, DirectCell(cell, Faces::periodic).energies() / volume) < 1e-10);
}
