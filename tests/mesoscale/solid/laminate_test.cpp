// Plies consolidated together, against what lone plies would make.
#include <Eigen/Eigenvalues>
#include <catch2/catch.hpp>
#include <cstdio>

#include "mesoscale/solid/solid_cell.h"
#include "mesoscale/solid/woven_solid.h"
#include "sample_cells.h"

using namespace heddle::mesoscale;
using namespace heddle::mesoscale::solid;
using heddle::test::gap;

namespace {

SolidSpec coarse(int plies) {
  SolidSpec spec;
  spec.grid = {.per_pitch = 8, .layers = 6};
  spec.solver.tolerance = 1e-8;
  spec.stack.plies = plies;
  return spec;
}

SolidSpec shifted_by_half_a_pitch() {
  SolidSpec spec = coarse(2);
  spec.stack.along_warp = spec.stack.along_weft = {0.0, 0.5 * 5.39e-3};
  return spec;
}

FabricGeometry consolidated() {
  return fabric_geometry(WeaveSpec{}, CellState::consolidated);
}

double smallest_over_norm(const Matrix6& m, const Matrix6& scale) {
  // A, B and D have units of their own; by the thickness of the ply they are one.
  Eigen::Matrix<double, 6, 1> unit;
  const double h = consolidated().thickness;
  unit << 1.0, 1.0, 1.0, 1.0 / h, 1.0 / h, 1.0 / h;
  const Matrix6 a = unit.asDiagonal() * m * unit.asDiagonal(),
                b = unit.asDiagonal() * scale * unit.asDiagonal();
  return Eigen::SelfAdjointEigenSolver<Matrix6>(0.5 * (a + a.transpose())).eigenvalues().minCoeff() /
         b.norm();
}

}  // namespace

TEST_CASE("a laminate moves the middle of each ply: A n times, D with A times the square of its distance",
          "[solid][laminate]") {
  // A homogeneous sheet, cut into plies: Q h and Q h^3 / 12 of the whole.
  Matrix6 ply = Matrix6::Zero();
  Eigen::Matrix3d q;
  q << 10.0, 3.0, 0.5, 3.0, 8.0, 0.2, 0.5, 0.2, 4.0;
  const double h = 0.3;
  ply.topLeftCorner<3, 3>() = h * q;
  ply.bottomRightCorner<3, 3>() = h * h * h / 12.0 * q;
  for (const int n : {1, 2, 5}) {
    const Matrix6 all = laminated(ply, h, n);
    const Eigen::Matrix3d a = all.topLeftCorner<3, 3>(), d = all.bottomRightCorner<3, 3>();
    CHECK((a - n * h * q).norm() < 1e-13);
    CHECK((d - std::pow(n * h, 3) / 12.0 * q).norm() < 1e-13);
  }
}

TEST_CASE("plies of one material, stacked as a weave, are classical lamination", "[solid][laminate]") {
  const StackedFabric stack = consolidated_stack(consolidated(), 0.0, {{0.0, 0.0}, {1.1e-3, 0.7e-3}});
  const VoxelCell two = sample(stack.stack, {.per_pitch = 6, .layers = 4}),
                  one = sample(unit_cell(consolidated(), 0.0), consolidated().thickness,
                               {.per_pitch = 6, .layers = 4});
  const Matrix6 resin = stiffness(IsotropicPhase{1.5e9, 0.40});
  const std::vector<Matrix6> alike_two(two.contents.size(), resin), alike_one(one.contents.size(), resin);
  const PlateStiffness together = plate_stiffness(elastic_cell(two, alike_two)),
                       lone = plate_stiffness(elastic_cell(one, alike_one));
  CHECK(gap(together.all, laminated(lone.all, consolidated().thickness, 2)) < 1e-9);
}

// Bound together, plies may move less than each by itself: their fields are among those of the lone plies,
// with the strain of their own middle. So the laminate is the stiffer one, for every load.
TEST_CASE("plies crowns on crowns are stiffer together than apart, and not by much",
          "[solid][laminate][bound]") {
  const SolidResult result = analyse(WeaveSpec{}, coarse(2));
  REQUIRE(result.laminate);
  const LaminateSolid& l = *result.laminate;
  CHECK(l.converged);
  CHECK(l.swelling == 1.0);
  CHECK(l.thickness == Approx(2.0 * consolidated().thickness).epsilon(1e-12));
  CHECK(l.tow_share == Approx(result.tow_share).epsilon(1e-3));
  // Mixed voxels at the face between plies know both sides; that is worth 1e-4 either way.
  CHECK(smallest_over_norm(l.plate - l.apart, l.apart) > -1e-4);
  CHECK(l.plate(0, 0) > 1.01 * l.apart(0, 0));
  CHECK(l.plate(0, 0) < 1.3 * l.apart(0, 0));
  // Less than in a stack without end, where both faces of every ply are held.
  const Matrix6 soft = result.stack->stiffness.inverse();
  Eigen::Matrix3d in_plane;
  constexpr std::array in{0, 1, 5};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) in_plane(i, j) = soft(in[i], in[j]);
  CHECK(l.plate(0, 0) / l.thickness < 1.001 * in_plane.inverse()(0, 0));
  std::printf("A11 of two plies: together %.1f N/mm, apart %.1f\n", 1e-3 * l.plate(0, 0),
              1e-3 * l.apart(0, 0));
}

TEST_CASE("nested plies hold their tows to the volume of the closed form", "[solid][laminate]") {
  const SolidSpec spec = shifted_by_half_a_pitch();
  const StackedFabric stack = consolidated_stack(consolidated(), 0.0, spec.stack.shifts());
  const VoxelCell cell = sample(stack.stack, {.per_pitch = 24, .layers = 20});
  const std::vector<double> shares = phase_shares(cell, 3);
  CHECK(shares[warp_phase] + shares[weft_phase] == Approx(stack.shares.tows).epsilon(3e-3));
  CHECK(cell.count[2] == 40);
  const SolidResult result = analyse(WeaveSpec{}, spec);
  CHECK(result.laminate->converged);
  CHECK(result.laminate->swelling == Approx(stack.swelling).epsilon(1e-12));
  // The upper ply's warps are not over the lower's: the two directions stay alike, up and down do not.
  CHECK(result.laminate->plate(0, 0) == Approx(result.laminate->plate(1, 1)).epsilon(2e-3));
}

TEST_CASE("one ply as a stack is sampled to the same voxels", "[solid][laminate][sampler]") {
  const FabricGeometry fabric = consolidated();
  const PlyStack alone = nested(unit_cell(fabric, 0.3), {{0.0, 0.0}});
  const VoxelCell a = sample(alone, {.per_pitch = 8, .layers = 6}),
                  b = sample(unit_cell(fabric, 0.3), 2.0 * alone.ply.crown(), {.per_pitch = 8, .layers = 6});
  CHECK(a.content == b.content);
  CHECK(a.edges == b.edges);
}
