// As woven, compacted, consolidated: three thicknesses of one balance of mass.
#include "mesoscale/state.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "mesoscale/contact.h"
#include "mesoscale/forming.h"
#include "random_weave.h"
#include "table1.h"

using namespace heddle;
using namespace heddle::mesoscale;
using heddle::test::radians;
using heddle::test::random_weave;
using heddle::test::uniform;

namespace {

CellSpec compacted(double thickness) {
  CellSpec spec;
  spec.state = CellState::compacted;
  spec.compacted_thickness = thickness;
  return spec;
}

CellSpec pressed_by(double pressure) {
  CellSpec spec;
  spec.state = CellState::compacted;
  spec.compacted_pressure = pressure;
  return spec;
}

bool same(const FabricGeometry& a, const FabricGeometry& b, double relative) {
  bool all = std::abs(a.thickness / b.thickness - 1.0) <= relative;
  for (std::size_t i = 0; i < 2; ++i) {
    const TowGeometry &p = a.crossing.tow[i], &q = b.crossing.tow[i];
    all = all && std::abs(thickness(p.section) / thickness(q.section) - 1.0) <= relative &&
          std::abs(p.fibre_fraction / q.fibre_fraction - 1.0) <= relative &&
          std::abs(p.path.angle / q.path.angle - 1.0) <= relative;
  }
  return all;
}

// What the sections hold, against what the tows brought in: glass per area of sheet [kg/m^2].
double glass_in_sections(const WeaveSpec& weave, const FabricGeometry& fabric) {
  double glass = 0.0;
  for (const TowGeometry& tow : fabric.crossing.tow)
    glass += tow.fibre_fraction * area(tow.section) / tow.spacing * weave.fibre_density;
  return glass;
}

}  // namespace

TEST_CASE("the compacted fabric goes from the as-woven one to the consolidated one", "[state][geometry]") {
  const WeaveSpec weave;
  const FabricGeometry woven = fabric_geometry(weave, CellState::as_woven),
                       solid = fabric_geometry(weave, CellState::consolidated);
  CHECK(same(compacted_geometry(weave, woven.thickness), woven, 1e-14));
  CHECK(same(compacted_geometry(weave, solid.thickness), solid, 1e-14));
  double fibres = woven.crossing.tow[0].fibre_fraction;
  for (const double thickness : {1.3e-3, 1.0e-3, 0.7e-3, 0.5e-3}) {
    const FabricGeometry fabric = compacted_geometry(weave, thickness);
    CHECK(unit_cell(fabric, 0.0).crown() == Approx(0.5 * thickness).epsilon(1e-14));
    CHECK(fabric.crossing.tow[0].fibre_fraction > fibres);
    fibres = fabric.crossing.tow[0].fibre_fraction;
  }
}

// A_t is linear in t to second order for a lens: with w fixed the glass fraction goes as 1 / t.
TEST_CASE("the glass of a compacted tow fills its section by its own area", "[state]") {
  const WeaveSpec weave;
  const FabricGeometry fabric = compacted_geometry(weave, 0.9e-3);
  const double t = thickness(fabric.crossing.tow[0].section);
  const double area_of_lens = area(LensSection{4.64e-3, t});
  CHECK(t == Approx(0.45e-3).epsilon(1e-12));
  CHECK(fabric.crossing.tow[0].fibre_fraction ==
        Approx(1872e-6 * 0.6 / 2550.0 * (1.0 + fabric.as_woven_crimp[0]) / area_of_lens).epsilon(1e-12));
}

TEST_CASE("two hundred random weaves hold the same mass in all states, without overlap at any angle",
          "[state][weave]") {
  std::mt19937 random(771);
  double worst = 0.0, deepest = -1.0;
  for (int k = 0; k < 200; ++k) {
    const WeaveSpec weave = random_weave(random);
    const FabricGeometry woven = fabric_geometry(weave, CellState::as_woven),
                         solid = fabric_geometry(weave, CellState::consolidated);
    const double way = uniform(random, 0.0, 1.0);
    const FabricGeometry between =
        compacted_geometry(weave, (1.0 - way) * woven.thickness + way * solid.thickness);
    const double angle = radians(uniform(random, -60.0, 60.0));
    CAPTURE(k, weave.pattern, way, angle);
    double before = -1.0;
    for (const FabricGeometry* fabric : {&woven, &between, &solid}) {
      const SheetShares shares = sheet_shares(*fabric);
      CHECK(shares.voids > -1e-12);
      CHECK(shares.glass >= before);  // pressed further, the same glass fills more
      before = shares.glass;
      const double mass =
          (shares.glass * weave.fibre_density + shares.resin * weave.resin_density) * fabric->thickness;
      worst = std::max({worst, std::abs(mass / woven.mass.areal_density - 1.0),
                        std::abs(glass_in_sections(weave, *fabric) /
                                     (weave.fibre_mass_fraction * woven.mass.areal_density) -
                                 1.0)});
      const Penetration found = penetration(unit_cell(*fabric, angle), 12);
      deepest = std::max(deepest, found.depth);
      CHECK(found.volume <= 1e-22);
    }
    CHECK(std::abs(sheet_shares(solid).voids) < 1e-12);
  }
  CHECK(worst < 1e-12);
  CHECK(deepest <= 1e-16);
}

TEST_CASE("the thickness under a pressure is that of the fabric's own compaction table", "[state][contact]") {
  for (const double pressure : {1e3, 5e3, 20e3}) {
    const CellSpec spec = pressed_by(pressure);
    REQUIRE(check(spec).empty());
    const FabricGeometry fabric = fabric_geometry(spec);
    const PlateContact plate =
        plate_contact(fabric_geometry(spec.weave, CellState::as_woven), compaction_law(spec.forming), 0.0);
    CHECK(plate.pressure(0.5 * (spec.weave.fabric_thickness - fabric.thickness)) ==
          Approx(pressure).epsilon(1e-9));
    CHECK(same(fabric, fabric_geometry(compacted(fabric.thickness)), 0.0));
  }
  CHECK(thickness_under(CellSpec{}, 1e3) > thickness_under(CellSpec{}, 20e3));
}

TEST_CASE("the laws of a compacted fabric lie between those of its ends", "[state]") {
  const FormingModels woven = forming_models(CellSpec{}), pressed = forming_models(compacted(1.0e-3));
  CHECK(pressed.tension.tow[0].rest_height < woven.tension.tow[0].rest_height);
  // Less crimp to pull out: stiffer at the same stretch.
  CHECK(pressed.tension.relax({0.006, 0.006}).tension[0] > woven.tension.relax({0.006, 0.006}).tension[0]);
  CHECK(specification_hash(compacted(1.0e-3)) != specification_hash(compacted(1.1e-3)));
  CHECK(specification_hash(CellSpec{}) != specification_hash(pressed_by(1e3)));
}

TEST_CASE("a compacted state that cannot be is refused with the two numbers that clash", "[state]") {
  const auto rule = [](const CellSpec& spec) {
    const Problems problems = check(spec);
    REQUIRE(problems.size() == 1);
    return std::pair(problems[0].id.text(), problems[0].value + " " + problems[0].rule);
  };
  const auto [thin, thin_words] = rule(compacted(0.4e-3));
  CHECK(thin == "cell.thickness.room");
  CHECK(thin_words.find("0.4 mm") == 0);
  CHECK(thin_words.find("0.475") != std::string::npos);
  CHECK(rule(compacted(1.6e-3)).first == "cell.thickness.room");
  const auto [hard, hard_words] = rule(pressed_by(1e8));
  CHECK(hard == "cell.pressure.room");
  CHECK(hard_words.find("100000 kPa") == 0);
  CHECK(rule(pressed_by(-1.0)).first == "cell.pressure.range");
  CellSpec both = compacted(1e-3), neither = compacted(1e-3);
  both.compacted_pressure = 1e3;
  neither.compacted_thickness.reset();
  CHECK(rule(both).first == "cell.state.compacted");
  CHECK(rule(neither).first == "cell.state.compacted");
  // Fibres that are packed too closely before the voids are gone.
  CellSpec dense = compacted(0.5e-3);
  dense.weave.fibre_mass_fraction = 1.0;
  CHECK_FALSE(check(dense).empty());
}
