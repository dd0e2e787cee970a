#include "mesoscale/bending.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "table1.h"

using namespace heddle::mesoscale;

namespace {
BendingStiffness with_bonding(double chi) {
  return bending_stiffness(fabric_geometry(WeaveSpec{}, CellState::consolidated), {72.4e9, 18.5e-6, chi})[0];
}
}  // namespace

TEST_CASE("sliding fibres give 1.3e-4 N m, and bonded glass no less than the voxel cell's 5.0e-2 N m",
          "[bending]") {
  const BendingStiffness b = with_bonding(0.3);
  CHECK(b.sliding == Approx(1.3e-4).epsilon(0.03));
  CHECK(b.bonded >= 5.0e-2);
  CHECK(b.bonded < 7.0e-2);
}

TEST_CASE("bonding leads from one bound to the other, by equal factors", "[bending]") {
  CHECK(with_bonding(0.0).value == Approx(with_bonding(0.0).sliding));
  CHECK(with_bonding(1.0).value == Approx(with_bonding(0.0).bonded));
  CHECK(with_bonding(0.5).value == Approx(std::sqrt(with_bonding(0.0).sliding * with_bonding(0.0).bonded)));
}

TEST_CASE("bending does not change with temperature while nothing is measured", "[bending]") {
  const heddle::Curve curve = constant_in_temperature(7e-4);
  for (double temperature : {250.0, 300.0, 453.0, 700.0}) {
    CHECK(curve.evaluate(temperature).y == 7e-4);
    CHECK(curve.evaluate(temperature).slope == 0.0);
  }
}
