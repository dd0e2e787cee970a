// Plies on one another: how far they sink into each other, and what the stack is made of.
#include "mesoscale/nesting.h"
#include "mesoscale/contact.h"
#include "mesoscale/ply_facing.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdio>
#include <random>
#include <string>

#include "mesoscale/pictures.h"
#include "random_weave.h"
#include "table1.h"

using namespace heddle;
using namespace heddle::mesoscale;
using heddle::test::radians;
using heddle::test::random_weave;
using heddle::test::table1;
using heddle::test::uniform;

namespace {

UnitCell ply_of(const std::string& pattern, double angle = 0.0) {
  WeaveSpec weave;
  weave.pattern = pattern;
  return unit_cell(fabric_geometry(weave, CellState::as_woven), angle);
}

// The shift at which crowns of the upper ply stand over the middle of the lower one's gaps.
PlyShift half_a_pitch(const UnitCell& ply) {
  return {0.5 * ply.tow[1].spacing, 0.5 * ply.tow[0].spacing};
}

std::vector<PlyShift> random_shifts(std::mt19937& random, const UnitCell& ply, std::size_t plies) {
  const std::array<double, 2> size = ply.size();
  std::vector<PlyShift> shifts{{0.0, 0.0}};
  while (shifts.size() < plies)
    shifts.push_back({uniform(random, -1.5, 1.5) * size[0], uniform(random, -1.5, 1.5) * size[1]});
  return shifts;
}

}  // namespace

TEST_CASE("plies crowns on crowns are as thick as each by itself, whatever the weave", "[nesting]") {
  for (const char* pattern : {"plain", "twill 2/2", "satin 5/2", "matrix 110/011/101"}) {
    CAPTURE(pattern);
    const UnitCell ply = ply_of(pattern, radians(20.0));
    const double alone = 2.0 * ply.crown();
    CHECK(closest_approach(ply, {0.0, 0.0}) == Approx(alone).epsilon(1e-15));
    // A shift by the repeat is none.
    CHECK(closest_approach(ply, ply.size()) == Approx(alone).epsilon(1e-14));
    CHECK(nested(ply, std::vector<PlyShift>(3, {0.0, 0.0})).thickness == Approx(3.0 * alone).epsilon(1e-15));
  }
}

// The upper ply's crown stands over the middle between four crossings. A warp of the lower ply falls from its
// crown on a circle R', the section of the weft above it on one of R: they meet where both have the same
// slope, sin a = (p/2) / (R + R'), and so do the sections the other way.
TEST_CASE("half a pitch apart, plain plies of Table 1 come nearer by 2 (R + R') (1 - cos a)",
          "[nesting][analytic]") {
  const FabricGeometry fabric = table1();
  const UnitCell ply = unit_cell(fabric, 0.0);
  const double both = heddle::test::lens_of(fabric.crossing).radius() + fabric.crossing.tow[0].path.radius;
  const double sine = 0.5 * fabric.crossing.tow[0].spacing / both;
  const double saved = 2.0 * both * (1.0 - std::sqrt(1.0 - sine * sine));
  const double found = closest_approach(ply, half_a_pitch(ply));
  CHECK(found == Approx(1.5e-3 - saved).epsilon(1e-12));
  CHECK(found != Approx(1.5e-3 - 1.01 * saved).epsilon(1e-4));  // the check can fail
  std::printf("two plies of Table 1 half a pitch apart: %.4f mm instead of 3\n", 1e3 * (1.5e-3 + found));
}

TEST_CASE("nested plies are never thicker than apart, and alike for a shift either way", "[nesting]") {
  std::mt19937 random(31);
  for (const char* pattern : {"plain", "twill 2/2", "twill 3/1", "satin 5/2"}) {
    const UnitCell ply = ply_of(pattern, radians(uniform(random, -40.0, 40.0)));
    for (int k = 0; k < 12; ++k) {
      const PlyShift shift = random_shifts(random, ply, 2)[1];
      CAPTURE(pattern, shift[0], shift[1]);
      const double found = closest_approach(ply, shift);
      CHECK(found <= 2.0 * ply.crown() * (1.0 + 1e-15));
      CHECK(found > 0.25 * ply.crown());
      CHECK(found == Approx(closest_approach(ply, {-shift[0], -shift[1]})).epsilon(1e-11));
      CHECK(
          found ==
          Approx(closest_approach(ply, {shift[0] - ply.size()[0], shift[1] + ply.size()[1]})).epsilon(1e-11));
    }
  }
}

TEST_CASE("random stacks of random weaves do not overlap and do touch, by samples that share nothing",
          "[nesting]") {
  std::mt19937 random(87);
  double deepest = -1.0, widest = 0.0;
  for (int k = 0; k < 25; ++k) {
    const FabricGeometry fabric = fabric_geometry(random_weave(random), CellState::as_woven);
    const UnitCell ply = unit_cell(fabric, radians(uniform(random, -50.0, 50.0)));
    const PlyStack stack = nested(ply, random_shifts(random, ply, 2 + k % 2));
    CAPTURE(k);
    const double found = sampled_overlap(stack, 24);
    CHECK(found <= 1e-15);
    deepest = std::max(deepest, found);
    // Samples miss the place of touching by half a step: what faces fall over it is left open.
    CHECK(found > -0.03 * ply.crown());
    widest = std::max(widest, -found / ply.crown());
    PlyStack lower = stack;
    lower.height.back() -= 0.05 * ply.crown();
    CHECK(sampled_overlap(lower, 24) > 0.0);  // the check can fail
  }
  std::printf("25 random stacks: sampled overlap at most %.1e m, open by at most %.2g %% of the crown\n",
              deepest, 100.0 * widest);
}

TEST_CASE("through wide gaps a ply reaches the next but one", "[nesting]") {
  WeaveSpec weave;
  weave.tow_width = 2.0e-3;
  weave.gap = 1.9e-3;
  weave.linear_density = 700e-6;
  const UnitCell ply = unit_cell(fabric_geometry(weave, CellState::as_woven), 0.0);
  // The middle ply is out of step, the outer ones are in step: crowns on crowns at two plies' distance.
  const PlyStack stack = nested(ply, {{0.0, 0.0}, half_a_pitch(ply), {0.0, 0.0}});
  CHECK(stack.height[2] >= stack.height[1] + closest_approach(ply, half_a_pitch(ply)) - 1e-15);
  CHECK(stack.height[2] >= closest_approach(ply, {0.0, 0.0}) - 1e-15);
  CHECK(sampled_overlap(stack, 40) <= 1e-15);
}

TEST_CASE("the mass of a stack closes in every state, and only a consolidated one has no voids",
          "[nesting][state]") {
  const WeaveSpec weave;
  const FabricGeometry woven = fabric_geometry(weave, CellState::as_woven),
                       pressed_flat = compacted_geometry(weave, 0.6e-3),
                       solid = fabric_geometry(weave, CellState::consolidated);
  std::mt19937 random(5);
  for (const FabricGeometry* fabric : {&woven, &pressed_flat, &solid})
    for (const std::size_t plies : {2, 4}) {
      const auto shifts = random_shifts(random, unit_cell(*fabric, 0.0), plies);
      const StackedFabric stack =
          fabric == &solid ? consolidated_stack(solid, 0.0, shifts) : stacked(*fabric, 0.0, shifts);
      CAPTURE(plies, stack.stack.thickness, stack.swelling);
      const double mass =
          (stack.shares.glass * weave.fibre_density + stack.shares.resin * weave.resin_density) *
          stack.stack.thickness;
      CHECK(mass == Approx(static_cast<double>(plies) * woven.mass.areal_density).epsilon(1e-12));
      double glass = 0.0;  // by the sections
      for (const TowGeometry& tow : stack.crossing.tow)
        glass += static_cast<double>(plies) * tow.fibre_fraction * area(tow.section) / tow.spacing;
      CHECK(glass == Approx(stack.shares.glass * stack.stack.thickness).epsilon(1e-12));
      CHECK(stack.shares.voids > -1e-12);
      CHECK(stack.shares.tows < 1.0);
      CHECK(sampled_overlap(stack.stack, 16) <= 1e-15);
      if (fabric == &solid) CHECK(std::abs(stack.shares.voids) < 1e-12);
    }
}

TEST_CASE("a consolidated stack keeps its thickness by mass: nesting lets its tows swell",
          "[nesting][state]") {
  const FabricGeometry solid = fabric_geometry(WeaveSpec{}, CellState::consolidated);
  const UnitCell ply = unit_cell(solid, 0.0);
  const StackedFabric apart = consolidated_stack(solid, 0.0, {{0.0, 0.0}, {0.0, 0.0}}),
                      nestled = consolidated_stack(solid, 0.0, {{0.0, 0.0}, half_a_pitch(ply)});
  for (const StackedFabric* stack : {&apart, &nestled})
    CHECK(stack->stack.thickness == Approx(2.0 * solid.thickness).epsilon(1e-12));
  CHECK(apart.swelling == 1.0);
  CHECK(nestled.swelling > 1.05);
  CHECK(nestled.shares.tows > apart.shares.tows);
  CHECK(nestled.crossing.tow[0].fibre_fraction < apart.crossing.tow[0].fibre_fraction);
  std::printf("consolidated, half a pitch apart: tows %.1f %% thicker, %.3f of the volume instead of %.3f\n",
              100.0 * (nestled.swelling - 1.0), nestled.shares.tows, apart.shares.tows);
}

TEST_CASE("plies that nest closer than their glass and resin allow stand apart by these",
          "[nesting][state]") {
  // Pressed almost to the sheet without voids: there tows nest further than the melt can leave.
  const WeaveSpec weave;
  const FabricGeometry fabric =
      compacted_geometry(weave, 1.001 * fabric_geometry(weave, CellState::consolidated).thickness);
  const StackedFabric stack =
      stacked(fabric, 0.0, {{0.0, 0.0}, half_a_pitch(unit_cell(fabric, 0.0)), {0.0, 0.0}});
  CHECK(stack.stack.thickness == Approx(3.0 * fabric.mass.consolidated_thickness()).epsilon(1e-12));
  CHECK(stack.shares.voids == Approx(0.0).margin(1e-12));
  CHECK(stack.stack.height[2] - stack.stack.height[1] == Approx(stack.stack.height[1]).epsilon(1e-12));
}

TEST_CASE("the map of nesting is highest where crowns meet crowns", "[nesting]") {
  const UnitCell ply = ply_of("plain");
  const NestingMap map = nesting_map(ply, 16);
  const auto [low, high] = std::minmax_element(map.thickness.begin(), map.thickness.end());
  CHECK(map.thickness.front() == *high);
  CHECK(*high == Approx(4.0 * ply.crown()));
  CHECK(*low < 0.9 * *high);
  // A plain weave shifted by one pitch both ways is the same cloth.
  CHECK(map.thickness[8 * 16 + 8] == Approx(*high).epsilon(1e-12));
}

TEST_CASE("the cut through a stack shows every ply where it stands", "[nesting][pictures]") {
  const UnitCell ply = ply_of("plain");
  const PlyStack stack = nested(ply, {{0.0, 0.0}, half_a_pitch(ply)});
  double low = 0.0, high = 0.0;
  int warps = 0;
  for (const Outline& outline : stack_cut(stack)) {
    warps += outline.tow == TowDirection::warp ? 1 : 0;
    for (const auto& point : outline.points) {
      low = std::min(low, point[1]);
      high = std::max(high, point[1]);
    }
  }
  CHECK(warps == 1);  // the upper ply is cut between two of its warps
  CHECK(low == Approx(-ply.crown()).epsilon(1e-3));
  CHECK(high < stack.height[1] + ply.crown());
  CHECK(high > stack.height[1]);
}

namespace {

const CompactionLaw fibres{3.2e6, 5.0};

// P [Pa] at a distance of the middles [m].
double pressure_at(const PlyFacing& facing, double distance) {
  const double approach = 0.5 * (facing.rest - distance);
  return approach <= 0.0 ? 0.0 : facing.compaction(approach);
}

}  // namespace

TEST_CASE("crown on crown two plies press each other as each presses a flat plate", "[nesting][contact]") {
  const FabricGeometry fabric = table1();
  const PlyFacing facing = facing_of_shift(fabric, fibres, {0.0, 0.0});
  const PlateContact plate = plate_contact(fabric, fibres, 0.0);
  CHECK(facing.rest == Approx(2.0 * unit_cell(fabric, 0.0).crown()).epsilon(1e-14));
  for (const double approach : {0.05e-3, 0.1e-3, 0.2e-3, 0.3e-3}) {
    CAPTURE(approach);
    CHECK(facing.compaction(approach) == Approx(plate.pressure(approach)).epsilon(0.01));
  }
}

TEST_CASE(
    "shifted plies rest where their tows touch, begin softer there, and press alike however one looks at "
    "them",
    "[nesting][contact]") {
  const FabricGeometry fabric = table1();
  const UnitCell ply = unit_cell(fabric, 0.0);
  const PlyFacing crowns = facing_of_shift(fabric, fibres, {0.0, 0.0});
  const double p = ply.tow[0].spacing;
  for (const PlyShift& shift :
       {PlyShift{0.5 * p, 0.5 * p}, PlyShift{0.3 * p, 0.0}, PlyShift{0.1 * p, 0.4 * p}}) {
    CAPTURE(shift[0] / p, shift[1] / p);
    const PlyFacing facing = facing_of_shift(fabric, fibres, shift);
    CHECK(facing.rest == closest_approach(ply, shift));
    CHECK(facing.rest < crowns.rest);
    CHECK(facing.compaction.y().front() == 0.0);
    // The other ply's view, warp and weft exchanged, and a shift by a repeat.
    for (const PlyShift& same : {PlyShift{-shift[0], -shift[1]}, PlyShift{shift[1], shift[0]},
                                 PlyShift{shift[0] + 2.0 * p, shift[1] - 2.0 * p}}) {
      const PlyFacing other = facing_of_shift(fabric, fibres, same);
      CHECK(other.rest == Approx(facing.rest).epsilon(1e-9));
      for (const double distance : {0.8 * facing.rest, 0.6 * facing.rest})
        CHECK(pressure_at(other, distance) == Approx(pressure_at(facing, distance)).epsilon(0.01));
    }
    // At one pressure the stack is thinner than crown on crown.
    const auto distance_at = [](const PlyFacing& f, double pressure) {
      double near = 0.0, far = f.rest;
      for (int k = 0; k < 60; ++k) {
        const double middle = 0.5 * (near + far);
        (pressure_at(f, middle) > pressure ? near : far) = middle;
      }
      return near;
    };
    for (const double pressure : {1e3, 1e4, 1e5})
      CHECK(distance_at(facing, pressure) < distance_at(crowns, pressure));
  }
}

TEST_CASE(
    "no stack of plies carries less than an even layer of its glass, and one half a pitch apart no more",
    "[nesting][contact]") {
  const FabricGeometry fabric = table1();
  const double p = unit_cell(fabric, 0.0).tow[0].spacing, v0 = fabric.crossing.tow[0].fibre_fraction,
               glass = sheet_shares(fabric).glass * fabric.thickness;
  const auto layer = [&](double distance) {
    return std::max(0.0, fibres.modulus * (std::pow(glass / distance, 5.0) - std::pow(v0, 5.0)));
  };
  const PlyFacing half = facing_of_shift(fabric, fibres, {0.5 * p, 0.5 * p}),
                  crowns = facing_of_shift(fabric, fibres, {0.0, 0.0}),
                  mean = facing_of_all_shifts(fabric, fibres);
  for (const double distance : {0.9e-3, 0.7e-3, 0.5e-3, 0.33e-3, 0.28e-3}) {
    CAPTURE(distance, layer(distance));
    for (const PlyFacing* facing : {&half, &crowns, &mean})
      CHECK(pressure_at(*facing, distance) > 0.995 * layer(distance));
  }
  // There the facing tows alone would carry a quarter of it.
  CHECK(pressure_at(half, 0.516e-3) == Approx(layer(0.516e-3)).epsilon(0.01));
  CHECK(pressure_at(half, 0.33e-3) == Approx(layer(0.33e-3)).epsilon(0.01));
}

TEST_CASE("plies that lie anyhow press each other by the mean over all shifts", "[nesting][contact]") {
  const FabricGeometry fabric = table1();
  const PlyFacing mean = facing_of_all_shifts(fabric, fibres);
  const UnitCell ply = unit_cell(fabric, 0.0);
  const std::array<double, 2> size = ply.size();
  CHECK(mean.rest == Approx(2.0 * ply.crown()).epsilon(1e-14));
  constexpr int n = 89, step = 55;  // another lattice than the table's
  std::vector<PlyFacing> shifted;
  for (int k = 0; k < n; ++k)
    shifted.push_back(
        facing_of_shift(fabric, fibres, {(k + 0.2) / n * size[0], (k * step % n + 0.7) / n * size[1]}));
  for (const double distance : {0.334e-3, 0.516e-3, 0.8e-3, 1.0e-3, 1.2e-3}) {
    double sum = 0.0;
    for (const PlyFacing& facing : shifted) sum += pressure_at(facing, distance) / n;
    CAPTURE(distance);
    CHECK(pressure_at(mean, distance) == Approx(sum).epsilon(0.03));
  }
}
