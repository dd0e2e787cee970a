// Warps that rise further than wefts, or less: faces that are not flush.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "mesoscale/contact.h"
#include "mesoscale/forming.h"
#include "mesoscale/state.h"
#include "random_weave.h"
#include "table1.h"
#include "tests/derivative_check.h"

using namespace heddle;
using namespace heddle::mesoscale;
using heddle::test::derivative_gap;
using heddle::test::radians;
using heddle::test::random_weave;
using heddle::test::uniform;

namespace {

CellSpec split(double share) {
  CellSpec spec;
  spec.weave.warp_crimp = share;
  spec.weave.fabric_thickness = 1.5e-3 + std::abs(spec.weave.crimp_excess());
  return spec;
}

const CompactionLaw law{3.2e6, 5.0};

}  // namespace

TEST_CASE("half the crimp each is the balanced weave, bit for bit", "[crimp]") {
  const CellResult given = analyse(split(0.5)), absent = analyse(CellSpec{});
  CHECK(given.fabric.tension_energy.values() == absent.fabric.tension_energy.values());
  CHECK(given.fabric.shear_stress.y() == absent.fabric.shear_stress.y());
  CHECK(given.fabric.compaction.curves().front().y() == absent.fabric.compaction.curves().front().y());
  CHECK(given.summary.crimp == absent.summary.crimp);
}

TEST_CASE("crimp that one direction gives up the other takes, and the fabric thickens by it", "[crimp]") {
  const CellSpec spec = split(0.6);
  REQUIRE(check(spec).empty());
  const FabricGeometry fabric = fabric_geometry(spec.weave, CellState::as_woven);
  const auto& [warp, weft] = fabric.crossing.tow;
  CHECK(warp.path.height == Approx(0.9e-3).epsilon(1e-12));
  CHECK(weft.path.height == Approx(0.6e-3).epsilon(1e-12));
  const UnitCell cell = unit_cell(fabric, 0.0);
  CHECK(2.0 * cell.crown() == Approx(1.65e-3).epsilon(1e-12));
  CHECK(std::abs(penetration(cell, 24).depth) < 1e-16);
  // Each on its own arc: p sin th - h cos th = 2 R' (1 - cos th).
  for (const TowGeometry& tow : fabric.crossing.tow) {
    const double p = tow.path.pitch, h = tow.path.height, r = tow.path.radius, th = tow.path.angle;
    CHECK(p * std::sin(th) - h * std::cos(th) == Approx(2.0 * r * (1.0 - std::cos(th))).epsilon(1e-10));
    CHECK(tow.path.crimp() > SawToothPath{p, h}.crimp());
    CHECK(tow.path.crimp() < arc_path(p, h, jam_radius(p, h)).crimp());
  }
}

TEST_CASE("a straight warp has no crimp, and its wefts rise by both thicknesses", "[crimp]") {
  // Wide gaps leave the wefts room to go all the way round.
  CellSpec spec;
  spec.weave.tow_width = 3.0e-3;
  spec.weave.gap = 2.9e-3;
  spec.weave.linear_density = 1100e-6;
  spec.weave.warp_crimp = 0.0;
  spec.weave.fabric_thickness = 2.25e-3;
  REQUIRE(check(spec).empty());
  const FabricGeometry fabric = fabric_geometry(spec.weave, CellState::as_woven);
  CHECK(fabric.as_woven_crimp[0] == Approx(0.0).margin(1e-15));
  CHECK(fabric.crossing.tow[1].path.height == Approx(1.5e-3).epsilon(1e-12));
  // Pulled along, it takes the load at once: EA / p less what the straightening of fibres takes.
  const TensionModel tension = forming_models(spec).tension;
  const TensionTow& warp = tension.tow[0];
  CHECK(tension.relax({0.01, 0.0}).tension[0] ==
        Approx(warp.stretch.evaluate(0.01).force / warp.spacing).epsilon(1e-3));
}

// Only the crowns of one direction are touched at first: half of them, so half of 2 pi d sqrt(R R') / p^2.
TEST_CASE("a plate touches the higher crowns first", "[crimp][contact]") {
  const FabricGeometry fabric = fabric_geometry(split(0.55).weave, CellState::as_woven);
  const PlateContact plate = plate_contact(fabric, law, 0.0);
  const TowGeometry& warp = fabric.crossing.tow[0];
  const double d = 2e-6, p = warp.spacing;
  const double half =
      3.141592653589793 * d * std::sqrt(crown_radius(warp.section, Face::upper) * warp.path.radius) / (p * p);
  CHECK(plate.touched_fraction(d) == Approx(half).epsilon(2e-3));
  // 0.075 mm further down, where the wefts stand.
  const double below = 0.075e-3;
  CHECK(plate.touched_fraction(below + d) - plate.touched_fraction(below) > 1.7 * half);
  // By the height field, deeper.
  const UnitCell cell = unit_cell(fabric, 0.0);
  const HeightField field = height_field(cell, 600);
  const double deep = 0.15e-3;
  double touched = 0.0;
  for (std::size_t k = 0; k < field.top.size(); ++k)
    touched += field.covered[k] != 0 && field.top[k] > cell.crown() - deep ? 1.0 : 0.0;
  CHECK(plate.touched_fraction(deep) ==
        Approx(touched / static_cast<double>(field.top.size())).epsilon(2e-3));
}

TEST_CASE("pressure is the slope of nothing less than the squeeze: it grows from the first touch",
          "[crimp][contact]") {
  const PlateContact plate =
      plate_contact(fabric_geometry(split(0.45).weave, CellState::as_woven), law, radians(20.0));
  double before = 0.0;
  for (const double depth : {0.02e-3, 0.08e-3, 0.15e-3, 0.3e-3}) {
    CHECK(plate.pressure(depth) > before);
    before = plate.pressure(depth);
  }
}

TEST_CASE("warp and weft exchanged, an uneven crimp is turned by a right angle", "[crimp]") {
  const FormingModels a = forming_models(split(0.58)), b = forming_models(split(0.42));
  const TensionModel::State sa = a.tension.relax({0.009, 0.003}), sb = b.tension.relax({0.003, 0.009});
  CHECK(sa.energy == Approx(sb.energy).epsilon(1e-9));
  CHECK(sa.tension[0] == Approx(sb.tension[1]).epsilon(1e-8));
  // The one with more crimp is softer at first.
  CHECK(a.tension.relax({0.009, 0.009}).tension[0] < a.tension.relax({0.009, 0.009}).tension[1]);
  const ShearFlow fa = a.shear.flow(radians(30.0)), fb = b.shear.flow(radians(30.0));
  CHECK(fa.total() == Approx(fb.total()).epsilon(1e-7));
  CHECK(plate_contact(a.fabric, law, radians(25.0)).pressure(0.2e-3) ==
        Approx(plate_contact(b.fabric, law, radians(25.0)).pressure(0.2e-3)).epsilon(1e-8));
}

TEST_CASE("tension of an uneven crimp is the slope of its energy", "[crimp][derivative]") {
  const FormingModels m = forming_models(split(0.6));
  const double e1 = 0.009, e2 = 0.003;
  const TensionModel::State at = m.tension.relax({e1, e2});
  const auto along_warp = [&](double e) { return m.tension.relax({e, e2}).energy; };
  CHECK(derivative_gap(along_warp, e1, 1e-3, at.tension[0]) < 1e-5);
  CHECK(derivative_gap(along_warp, e1, 1e-3, 1.01 * at.tension[0]) > 1e-4);
}

TEST_CASE("random uneven weaves do not overlap at any angle: closing gaps make their faces flush",
          "[crimp][geometry]") {
  std::mt19937 random(314);
  int uneven = 0;
  for (int k = 0; k < 150; ++k) {
    CellSpec spec;
    spec.weave = random_weave(random);
    const double both = spec.weave.tow(0).thickness + spec.weave.tow(1).thickness;
    spec.weave.warp_crimp = uniform(random, 0.2, 0.8);
    spec.weave.fabric_thickness = both + std::abs(spec.weave.crimp_excess());
    if (!check(spec).empty()) continue;
    ++uneven;
    const FabricGeometry woven = fabric_geometry(spec.weave, CellState::as_woven);
    const double angle = radians(uniform(random, -60.0, 60.0));
    CAPTURE(k, spec.weave.pattern, angle, *spec.weave.warp_crimp);
    const Penetration found = penetration(unit_cell(woven, angle), 12);
    CHECK(found.depth <= 1e-15);
    CHECK(found.volume <= 1e-21);
    const FabricGeometry solid = fabric_geometry(spec.weave, CellState::consolidated);
    CHECK(solid.crossing.tow[0].path.height == thickness(solid.crossing.tow[1].section));
    CHECK(2.0 * unit_cell(solid, 0.0).crown() == Approx(solid.thickness).epsilon(1e-12));
  }
  CHECK(uneven > 30);
  // Where gaps have closed, there is no room left but for flush faces.
  const CrossingGeometry jammed =
      sheared(fabric_geometry(split(0.6).weave, CellState::as_woven).crossing, radians(50.0));
  CHECK(jammed.tow[0].path.height == Approx(0.75e-3).epsilon(1e-9));
}

TEST_CASE("a share of crimp that the sections leave no room for is refused with both shares", "[crimp]") {
  const Problems problems = check(split(0.75));
  REQUIRE(problems.size() == 1);
  CHECK(problems[0].id.text() == "weave.warp_crimp.room");
  CHECK(problems[0].value == "75 %");
  CHECK(problems[0].rule.find("at most 68.1") != std::string::npos);
  CHECK(check(split(0.31)).front().rule.find("at least 31.8") != std::string::npos);
  CHECK(check(split(0.68)).empty());
  CHECK(check(split(1.5)).front().id.text() == "weave.warp_crimp.range");
  CellSpec thin = split(0.6);
  thin.weave.fabric_thickness = 1.5e-3;
  CHECK(check(thin).front().id.text() == "weave.fabric_thickness.consistent");
}
