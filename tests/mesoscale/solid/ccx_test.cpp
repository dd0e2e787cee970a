// The cell as a CalculiX deck: ccx runs it as it is, and finds the stiffness that ours does.
#include "mesoscale/solid/ccx_deck.h"

#include <catch2/catch.hpp>
#include <cstdio>
#include <stdexcept>

#include "core/problem.h"
#include "mesoscale/solid/sampler.h"
#include "sample_cells.h"
#include "tests/ccx_run.h"

using namespace heddle;
using namespace heddle::mesoscale;
using namespace heddle::mesoscale::solid;

namespace {

// The consolidated weave of Table 1, coarse.
SolidSpec coarse(int per_pitch, int layers) {
  SolidSpec spec;
  spec.grid = {.per_pitch = per_pitch, .layers = layers};
  spec.solver.tolerance = 1e-9;
  return spec;
}

std::size_t count(const std::string& text, const std::string& word) {
  std::size_t found = 0;
  for (auto at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) ++found;
  return found;
}

Eigen::Matrix3d edges_at(double angle) {
  const FabricGeometry fabric = fabric_geometry(WeaveSpec{}, CellState::consolidated);
  const PressedFabric at_angle = pressed(fabric, angle);
  return sample(unit_cell(fabric.weave, at_angle.crossing), at_angle.thickness, {.per_pitch = 4, .layers = 2})
      .edges;
}

}  // namespace

TEST_CASE("CalculiX runs the deck of a woven cell as it is and finds the same stiffness", "[solid][ccx]") {
  if (!heddle::test::ccx_is_there()) return;
  const double angle = GENERATE(0.0, 0.4);
  SolidSpec spec = coarse(6, 6);
  spec.shear_angles = {angle};
  const Matrix6 ours = analyse(WeaveSpec{}, spec).sheared[0].stack;
  const std::string dat = heddle::test::run_ccx(ccx_deck(WeaveSpec{}, angle, spec));
  const Matrix6 theirs = stiffness_from_ccx(dat, "case.dat", edges_at(angle));
  const double off = heddle::test::gap(theirs, ours);
  std::printf("CalculiX against our solver, %.1f rad of shear: |dC|/|C| = %.2e, C11 %.2f and %.2f MPa\n",
              angle, off, 1e-6 * theirs(0, 0), 1e-6 * ours(0, 0));
  CAPTURE(angle, ours * 1e-6, theirs * 1e-6);
  CHECK(off < 1e-5);
}

TEST_CASE("a deck ties every node of a far face once in each direction", "[solid][ccx]") {
  const std::string text = ccx_deck(WeaveSpec{}, 0.0, coarse(8, 8));
  const std::size_t nodes = 17 * 17 * 9, images = 16 * 16 * 8;
  CHECK(count(text, "*EQUATION") == 3 * (nodes - images));
  CHECK(count(text, "*SOLID SECTION") == count(text, "*ELEMENT, TYPE=C3D8"));
  CHECK(count(text, "ORIENTATION=TOW") > 4);
  CHECK(count(text, "*STEP") == 6);
}

TEST_CASE("a deck with a void or a phase without a name is refused", "[solid][ccx]") {
  VoxelCell cell;
  cell.count = {1, 1, 1};
  cell.edges = Eigen::Matrix3d::Identity();
  cell.content = {0};
  cell.contents = {{{{0, 0, 1.0}}}};
  const std::vector<Matrix6> nothing{Matrix6::Zero()};
  const std::vector<DeckPhase> resin{{"RESIN", {1e9, 1e9, 4e8, 4e8, 0.25}}};
  CHECK_THROWS_AS(ccx_deck(cell, resin, nothing), std::invalid_argument);
  CHECK_THROWS_AS(ccx_deck(cell, {}, nothing), std::invalid_argument);
}

TEST_CASE("a result of CalculiX that is cut short is refused", "[solid][ccx]") {
  try {
    stiffness_from_ccx(" displacements (vx,vy,vz) for set DRIVERS and time 1\n\n 9 1. 0. 0.\n", "cell.dat",
                       Eigen::Matrix3d::Identity());
    FAIL("a result that is cut short was read");
  } catch (const InputError& error) {
    CHECK(error.problems().front().id == "ccx.displacements");
  }
}
