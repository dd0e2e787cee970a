// Any weave of any tows at any angle, in any state: what must hold for all of them.
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdio>

#include <fmt/format.h>

#include "../random_weave.h"
#include "../table1.h"
#include "mesoscale/contact.h"
#include "mesoscale/forming.h"
#include "mesoscale/solid/homogenise.h"
#include "mesoscale/solid/sampler.h"
#include "mesoscale/state.h"

using namespace heddle;
using namespace heddle::mesoscale;
using heddle::test::radians;
using heddle::test::random_weave;
using heddle::test::uniform;
using heddle::test::whole;
using heddle::test::with_random_halves;
using heddle::test::with_slim_halves;

namespace {

struct Worst {
  double overlap = -1.0;  // [m]
  double mass = 0.0;      // relative
  double bound = 1.0;     // smallest eigenvalue over the norm of the upper bound
  void print(int weaves) const {
    std::printf(
        "%d random weaves: deepest overlap %.1e m, mass off by %.1e, stiffness inside its bounds by %.1e\n",
        weaves, overlap, mass, bound);
  }
};

double smallest(const solid::Matrix6& m, const solid::Matrix6& scale) {
  return Eigen::SelfAdjointEigenSolver<solid::Matrix6>(0.5 * (m + m.transpose())).eigenvalues().minCoeff() /
         scale.norm();
}

// Glass and resin of the sections against what the densities of the tows bring in.
double mass_gap(const WeaveSpec& weave, const FabricGeometry& fabric) {
  double held = 0.0, brought = 0.0;
  for (std::size_t d = 0; d < 2; ++d) {
    const TowGeometry& tow = fabric.crossing.tow[d];
    held += tow.fibre_fraction * area(tow.section) / tow.spacing * weave.fibre_density;
    brought += weave.tow(d).linear_density * weave.fibre_mass_fraction * (1.0 + fabric.as_woven_crimp[d]) /
               tow.spacing;
  }
  // And of the sheet as a whole, by its shares: nothing is in it but glass, resin and voids.
  const SheetShares shares = sheet_shares(fabric);
  CHECK(shares.voids > -1e-12);
  const double sheet =
      (shares.glass * weave.fibre_density + shares.resin * weave.resin_density) * fabric.thickness;
  return std::max(std::abs(held / brought - 1.0),
                  std::abs(weave.fibre_mass_fraction * sheet / brought - 1.0));
}

// One of the three states; the compacted one anywhere between the others.
CellSpec in_some_state(const WeaveSpec& weave, std::mt19937& random) {
  CellSpec cell;
  cell.weave = weave;
  cell.state = std::array{CellState::as_woven, CellState::compacted, CellState::consolidated}[random() % 3];
  const double least = fabric_geometry(weave, CellState::consolidated).thickness;
  const double way = uniform(random, 0.0, 1.0);
  if (cell.state == CellState::compacted)
    cell.compacted_thickness = (1.0 - way) * weave.fabric_thickness + way * least;
  return cell;
}

void check_geometry(const CellSpec& cell, double angle, Worst& worst) {
  const FabricGeometry fabric = fabric_geometry(cell);
  const Penetration found = penetration(unit_cell(fabric, angle), 12);
  CHECK(found.depth <= 1e-16);   // rounding of heights of 1e-3 m
  CHECK(found.depth >= -1e-16);  // they do touch
  CHECK(found.volume <= 1e-22);
  worst.overlap = std::max(worst.overlap, found.depth);
  worst.mass = std::max(worst.mass, mass_gap(cell.weave, fabric));
}

void check_stiffness(const WeaveSpec& weave, double angle, Worst& worst) {
  const FabricGeometry fabric = fabric_geometry(weave, CellState::consolidated);
  const PressedFabric at_angle = pressed(fabric, angle);
  const auto& [warp, weft] = at_angle.crossing.tow;
  const solid::IsotropicPhase glass{weave.fibre_modulus, 0.22}, resin{1.5e9, 0.40};
  const solid::VoxelCell cell = solid::sample(unit_cell(fabric.weave, at_angle.crossing), at_angle.thickness,
                                              {.per_pitch = 4, .layers = 4});
  const std::array phases{solid::stiffness(resin),
                          stiffness(solid::chamis(glass, resin, warp.fibre_fraction)),
                          stiffness(solid::chamis(glass, resin, weft.fibre_fraction))};
  const std::vector<solid::Matrix6> contents = solid::content_stiffness(cell, phases);
  const solid::PeriodicStiffness stack = solid::periodic_stiffness(solid::elastic_cell(cell, contents));
  REQUIRE(stack.solver.converged);
  worst.bound = std::min({worst.bound, smallest(stack.voigt - stack.stiffness, stack.voigt),
                          smallest(stack.stiffness - stack.reuss, stack.voigt)});
}

// The laws themselves at one state each: their tables take a hundred times as long.
void check_forming_laws(const CellSpec& cell, double angle) {
  if (!check(cell).empty()) return;  // as woven it is sound; pressed flat its glass may find no room
  const FormingModels models = forming_models(cell);
  const TensionModel::State tension = models.tension.relax({0.004, 0.002});
  CHECK(tension.energy > 0.0);
  CHECK(tension.tension[0] > 0.0);
  CHECK(std::isfinite(tension.tension[1]));
  const ShearFlow flow = models.shear.flow(std::abs(angle));
  CHECK(std::isfinite(flow.total()));
  CHECK(flow.dry >= 0.0);
  CHECK(flow.lateral >= -1e-12 * std::abs(flow.total()));  // w - w_o cos g is zero but for rounding
  const PlateContact plate = plate_contact(models.fabric, models.compaction, angle);
  const double depth = plate.depth_at(10e3);
  CHECK(depth > 0.0);
  CHECK(2.0 * depth < models.fabric.thickness);
  CHECK(plate.touched_fraction(depth) > 0.0);
  CHECK(plate.touched_fraction(depth) <= 1.0);
  for (const BendingStiffness& bending : models.bending) {
    CHECK(bending.sliding <= bending.value);
    CHECK(bending.value <= bending.bonded);
  }
}

void check_weaves(int count, unsigned seed) {
  std::mt19937 random(seed);
  Worst worst;
  for (int k = 0; k < count; ++k) {
    const WeaveSpec weave = random_weave(random);
    const double angle = radians(uniform(random, -55.0, 55.0));
    const CellSpec cell = in_some_state(weave, random);
    CAPTURE(k, weave.pattern, angle, static_cast<int>(cell.state));
    check_geometry(cell, angle, worst);
    check_stiffness(weave, angle, worst);
    check_forming_laws(cell, angle);
  }
  CHECK(worst.mass < 1e-12);
  CHECK(worst.bound > -1e-9);
  worst.print(count);
}

// Hybrid tows of the random weaves: slim halves of one thickness overlap no more than lenses, any halves hold
// their mass and leave every law finite.
void check_hybrids(int count, unsigned seed) {
  std::mt19937 random(seed);
  Worst worst;
  double mass = 0.0;
  for (int k = 0; k < count; ++k) {
    const WeaveSpec weave = random_weave(random);
    const double angle = radians(uniform(random, -55.0, 55.0));
    CellSpec slim = in_some_state(with_slim_halves(weave, random), random);
    CellSpec any = in_some_state(with_random_halves(weave, random), random);
    CAPTURE(k, weave.pattern, angle, static_cast<int>(any.state), any.weave.upper_share);
    check_geometry(slim, angle, worst);
    mass = std::max(mass, mass_gap(any.weave, fabric_geometry(any)));
    check_forming_laws(any, angle);
  }
  CHECK(worst.mass < 1e-12);
  CHECK(mass < 1e-12);
  std::printf("%d random weaves of hybrid tows: slim halves overlap by %.1e m, mass off by %.1e\n", count,
              worst.overlap, std::max(mass, worst.mass));
}

// One number pushed against another. Returns the number it clashes with, as messages show it.
std::string spoil(CellSpec& cell, std::mt19937& random) {
  WeaveSpec& w = cell.weave;
  switch (whole(random, 0, 5)) {
    case 0:
      w.gap = w.tow_width * uniform(random, 1.01, 3.0);
      return fmt::format("{:.6g} mm", 1e3 * w.tow_width);
    case 1:
      w.tow_width = w.tow_thickness * uniform(random, 0.3, 1.9);
      return fmt::format("{:.6g} mm", 1e3 * w.tow_thickness);
    case 2:
      w.tow_width = w.tow_thickness * uniform(random, 41.0, 60.0);
      return fmt::format("{:.6g} mm", 1e3 * w.tow_thickness);
    case 3:
      w.fabric_thickness *= random() % 2 == 0 ? uniform(random, 0.3, 0.98) : uniform(random, 1.02, 3.0);
      return fmt::format("{:.6g} mm", 2e3 * w.tow_thickness);
    case 4:
      w.own[1].tow_thickness = w.tow_thickness / uniform(random, 4.1, 6.0);
      w.own[1].linear_density = 0.1 * w.linear_density;
      w.fabric_thickness = w.tow_thickness + *w.own[1].tow_thickness;
      return fmt::format("{:.6g} mm", 1e3 * *w.own[1].tow_thickness);
    default:
      break;
  }
  w.linear_density *= uniform(random, 2.5, 6.0);  // more than the tow has room for
  return "";
}

void check_spoilt(int count, unsigned seed) {
  std::mt19937 random(seed);
  for (int k = 0; k < count; ++k) {
    CellSpec cell;
    const std::string clash = spoil(cell, random);
    const Problems problems = check(cell);
    CAPTURE(k, clash, format(problems));
    REQUIRE_FALSE(problems.empty());
    const bool names_both = std::any_of(problems.begin(), problems.end(), [&](const Problem& p) {
      return !p.value.empty() && !p.others.empty() && p.rule.find(clash) != std::string::npos &&
             p.rule.find_first_of("0123456789") != std::string::npos;
    });
    CHECK(names_both);
    CHECK_THROWS_AS(analyse(cell), InputError);
  }
}

}  // namespace

TEST_CASE("twenty random weaves: no overlap, mass closed, stiffness between Reuss and Voigt, laws finite",
          "[weave][solid][bound]") {
  check_weaves(20, 61);
}

TEST_CASE(
    "five hundred random weaves: no overlap, mass closed, stiffness between Reuss and Voigt, laws finite",
    "[weave][solid][bound][slow]") {
  check_weaves(500, 62);
}

TEST_CASE("twenty random weaves of hybrid tows: slim halves stay apart, mass closed, laws finite",
          "[weave][hybrid][bound][long]") {
  check_hybrids(20, 64);
}

TEST_CASE("two hundred weaves that cannot be: each message names the two numbers that clash", "[weave]") {
  check_spoilt(200, 63);
}
