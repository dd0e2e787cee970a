#include "mesoscale/solid/sampler.h"

#include <Eigen/LU>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "mesoscale/solid/solid_cell.h"
#include "sample_cells.h"

using namespace heddle::mesoscale;
using namespace heddle::mesoscale::solid;
using namespace heddle::test;

namespace {

FabricGeometry consolidated() {
  return fabric_geometry(WeaveSpec{}, CellState::consolidated);
}

double degrees(double angle) {
  return angle * std::numbers::pi / 180.0;
}

SolidSpec coarse() {
  SolidSpec spec;
  spec.grid = {.per_pitch = 8, .layers = 6};
  return spec;
}

}  // namespace

TEST_CASE("sampled tows fill the volume of their closed form, sheared or not", "[solid][sampler]") {
  const FabricGeometry fabric = consolidated();
  const double angle = degrees(GENERATE(0.0, 20.0, -20.0));
  const UnitCell cell = unit_cell(fabric, angle);
  const VoxelCell voxels = sample(cell, fabric.thickness, {.per_pitch = 32, .layers = 24});
  const double expected = 2.0 * area(cell.tow[0].section) / (cell.tow[0].spacing * fabric.thickness);
  const std::vector<double> shares = phase_shares(voxels, 3);
  CHECK(shares[warp_phase] + shares[weft_phase] == Approx(expected).epsilon(2e-3));
  CHECK(voxels.edges.determinant() ==
        Approx(4.0 * cell.tow[0].spacing * cell.tow[0].spacing * std::cos(angle) * fabric.thickness)
            .epsilon(1e-12));
}

TEST_CASE("the portions of every voxel make one voxel, and tows point along their paths",
          "[solid][sampler]") {
  const FabricGeometry fabric = consolidated();
  const double angle = degrees(15.0);
  const VoxelCell voxels =
      sample(unit_cell(fabric, angle), fabric.thickness, {.per_pitch = 16, .layers = 12});
  const double steepest = std::tan(fabric.crossing.tow[0].path.angle);
  for (const VoxelContent& content : voxels.contents) {
    double sum = 0.0;
    for (const Portion& portion : content.portions) sum += portion.share;
    CHECK(sum == Approx(1.0).epsilon(1e-15));
    CHECK(content.normal.norm() == Approx(1.0));
  }
  for (std::size_t d = 1; d < voxels.directions.size(); ++d) {
    const Eigen::Vector3d& along = voxels.directions[d];
    const bool warp = std::abs(along.y()) < 1e-12;
    const double off = warp ? 0.0 : std::atan2(along.x(), along.y()) - angle;  // wefts turn with the shear
    CHECK(std::abs(off) < 1e-12);
    CHECK(std::abs(along.z()) <= 1.1 * steepest + std::tan(degrees(0.5)));
  }
}

TEST_CASE("plain voxels hold one phase each", "[solid][sampler]") {
  const FabricGeometry fabric = consolidated();
  const VoxelCell voxels = sample(unit_cell(fabric, 0.0), fabric.thickness,
                                  {.per_pitch = 16, .layers = 12, .mixing = Mixing::dominant});
  for (const VoxelContent& content : voxels.contents) CHECK(content.portions.size() == 1);
}

TEST_CASE("the solid part of Table 1 is balanced by name, and lies below its upper bounds", "[solid][cell]") {
  const SolidResult result = analyse(WeaveSpec{}, coarse());
  REQUIRE(result.plate->solver.converged);
  REQUIRE(result.stack->solver.converged);
  CHECK(result.balance.size() == 5);
  CHECK(imbalances(result).empty());
  for (const BalancePair& pair : result.balance) CHECK(pair.gap() < 1e-9);
  // Mirrors of the plain weave: no coupling of stretch with shear.
  CHECK(std::abs(result.plate->a(0, 2)) < 1e-6 * result.plate->a(0, 0));
  CHECK(std::abs(result.plate->a(1, 2)) < 1e-6 * result.plate->a(0, 0));
  CHECK(result.plate->a(0, 0) < result.plate->upper(0, 0));
  CHECK(result.stack->stiffness(0, 0) < result.stack->voigt(0, 0));
  CHECK(result.stack->stiffness(0, 0) > result.stack->reuss(0, 0));
}

TEST_CASE("a cell that is not balanced is found, with the numbers", "[solid][cell]") {
  SolidResult result = analyse(WeaveSpec{}, coarse());
  result.balance.push_back({"C11", "C22", 7.0e9, 7.5e9, "MPa", 1e-6});
  const std::vector<BalancePair> found = imbalances(result);
  REQUIRE(found.size() == 1);
  CHECK(found[0].gap() == Approx(0.5 / 7.5));
  result.balance.back().second = std::nan("");
  CHECK(imbalances(result).size() == 1);
}

TEST_CASE("a weave of resin tows is the resin", "[solid][cell]") {
  WeaveSpec weave;
  weave.fibre_modulus = polypropylene.modulus;
  SolidSpec spec = coarse();
  spec.fibre_poisson = spec.resin.poisson = polypropylene.poisson;
  const SolidResult result = analyse(weave, spec);
  CHECK(gap(result.stack->stiffness, stiffness(polypropylene)) < 1e-12);
}

TEST_CASE("the tows of Chamis and of Hashin stretch alike in the sheet within 3 %", "[solid][cell]") {
  SolidSpec spec = coarse();
  const double of_chamis = analyse(WeaveSpec{}, spec).plate->a(0, 0);
  spec.tow_model = TowModel::hashin;
  CHECK(analyse(WeaveSpec{}, spec).plate->a(0, 0) == Approx(of_chamis).epsilon(0.03));
}

TEST_CASE("every wrong number of the solid is named at once", "[solid][cell]") {
  SolidSpec spec;
  spec.grid = {.per_pitch = 2, .layers = 1000};
  spec.fibre_poisson = 0.5;
  spec.resin = {-1.0, std::nan("")};
  CHECK(check(spec).size() == 5);
  CHECK(check(SolidSpec{}).empty());
}
