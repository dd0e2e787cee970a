// The solid of weaves other than the balanced plain one.
#include <Eigen/Eigenvalues>
#include <catch2/catch.hpp>
#include <string>

#include "../random_weave.h"
#include "mesoscale/solid/solid_cell.h"
#include "sample_cells.h"

using namespace heddle::mesoscale;
using namespace heddle::mesoscale::solid;
using heddle::test::gap;

namespace {

double smallest_over_norm(const Matrix6& m, const Matrix6& scale) {
  return Eigen::SelfAdjointEigenSolver<Matrix6>(0.5 * (m + m.transpose())).eigenvalues().minCoeff() /
         scale.norm();
}

SolidSpec coarse() {
  SolidSpec spec;
  spec.grid = {.per_pitch = 6, .layers = 5};
  spec.solver.tolerance = 1e-8;
  return spec;
}

WeaveSpec of_pattern(const std::string& pattern) {
  WeaveSpec weave;
  weave.pattern = pattern;
  return weave;
}

// 2 = 1 and 1 = 2: order 11, 22, 33, 23, 13, 12.
constexpr std::array<int, 6> turned{1, 0, 2, 4, 3, 5};

}  // namespace

TEST_CASE("the solid of random weaves lies between the bounds of Reuss and Voigt",
          "[solid][weave][bound][long]") {
  std::mt19937 random(7);
  for (int k = 0; k < 8; ++k) {
    const WeaveSpec weave = heddle::test::random_weave(random);
    CAPTURE(k, weave.pattern);
    const SolidResult result = analyse(weave, coarse());
    REQUIRE(result.stack->solver.converged);
    CHECK(smallest_over_norm(result.stack->voigt - result.stack->stiffness, result.stack->voigt) > -1e-9);
    CHECK(smallest_over_norm(result.stack->stiffness - result.stack->reuss, result.stack->voigt) > -1e-9);
    CHECK(smallest_over_norm(result.plate->upper - result.plate->all, result.plate->upper) > -1e-9);
  }
}

TEST_CASE("warp and weft exchanged, the solid is turned", "[solid][weave]") {
  WeaveSpec weave;
  weave.own[0] = {3.2e-3, 0.5e-3, 0.6e-3, 1100e-6};
  weave.own[1] = {5.1e-3, 1.1e-3, 0.9e-3, 2400e-6};
  weave.fabric_thickness = 1.5e-3;
  const SolidResult a = analyse(weave, coarse());
  std::swap(weave.own[0], weave.own[1]);
  const SolidResult b = analyse(weave, coarse());
  CHECK(gap(reordered(b.stack->stiffness, turned), a.stack->stiffness) < 1e-6);
  CHECK(gap(b.stack->stiffness, a.stack->stiffness) > 1e-2);  // the check can fail
  CHECK_FALSE(a.balanced);
  CHECK(a.balance.empty());
}

TEST_CASE("weaves whose warp and weft can be exchanged make balanced solids", "[solid][weave][long]") {
  const std::string pattern = GENERATE("twill 2/2", "twill 2/1", "satin 5/2", "crowfoot");
  CAPTURE(pattern);
  // Where both tows share a voxel the sampler rounds the warp first: 6 x 6 x 5 voxels a pitch are off by more
  // than this.
  SolidSpec spec = coarse();
  spec.grid = {.per_pitch = 12, .layers = 8};
  const SolidResult result = analyse(of_pattern(pattern), spec);
  CHECK(result.balanced);
  CHECK(result.balance.size() == 5);
  for (const BalancePair& pair : result.balance) {
    CAPTURE(pair.first_name, pair.gap());
    CHECK(pair.gap() < 1e-3);
  }
}

TEST_CASE("a rib is stiffer along the tows that do not crimp as often", "[solid][weave]") {
  const SolidResult result = analyse(of_pattern("twill 2/2 step 2"), coarse());
  CHECK(result.stack->stiffness(1, 1) > 1.002 * result.stack->stiffness(0, 0));
}
