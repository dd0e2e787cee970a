// Weaves other than the balanced plain one: any matrix, warp and weft of their own, floats.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdio>
#include <random>
#include <string>

#include "mesoscale/cell_spec.h"
#include "mesoscale/contact.h"
#include "mesoscale/forming.h"
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

CellSpec unbalanced() {
  CellSpec spec;
  spec.weave.own[0] = {3.2e-3, 0.5e-3, 0.6e-3, 1100e-6};
  spec.weave.own[1] = {5.1e-3, 1.1e-3, 0.9e-3, 2400e-6};
  spec.weave.fabric_thickness = 1.5e-3;
  return spec;
}

CellSpec exchanged(CellSpec spec) {
  std::swap(spec.weave.own[0], spec.weave.own[1]);
  return spec;
}

CellSpec of_pattern(const std::string& pattern) {
  CellSpec spec;
  spec.weave.pattern = pattern;
  return spec;
}

double mass_of_repeat(const WeaveSpec& weave, const FabricGeometry& fabric) {
  // By the way the tows go: linear density times the length of each tow in one repeat.
  double mass = 0.0;
  for (std::size_t d = 0; d < 2; ++d) {
    const WeaveMatrix& w = fabric.weave;
    const ArcPath path = fabric_geometry(weave, CellState::as_woven).crossing.tow[d].path;
    for (int i = 0; i < w.warps; ++i)
      for (int j = 0; j < w.wefts; ++j) {
        const bool changes = w.warp_over(i, j) != (d == 0 ? w.warp_over(i, j + 1) : w.warp_over(i + 1, j));
        mass += weave.tow(d).linear_density * (changes ? path.length() : path.pitch);
      }
  }
  return mass;
}

}  // namespace

TEST_CASE("two hundred random weaves of lens tows on arcs have no overlap and close their mass",
          "[weave][geometry]") {
  std::mt19937 random(20260);
  double deepest = -1.0, worst_mass = 0.0;
  for (int k = 0; k < 200; ++k) {
    const WeaveSpec weave = random_weave(random);
    const double angle = radians(uniform(random, -60.0, 60.0));
    CAPTURE(k, weave.pattern, angle);
    const FabricGeometry woven = fabric_geometry(weave, CellState::as_woven);
    const FabricGeometry solid = fabric_geometry(weave, CellState::consolidated);
    const double area = woven.crossing.area() * woven.weave.warps * woven.weave.wefts;
    for (const FabricGeometry* fabric : {&woven, &solid}) {
      const Penetration found = penetration(unit_cell(*fabric, angle), 12);
      deepest = std::max(deepest, found.depth);
      CHECK(found.depth <= 1e-16);   // rounding of heights of 1e-3 m
      CHECK(found.depth >= -1e-16);  // they do touch
      CHECK(found.volume <= 1e-22);
      // What the sections hold is what was woven in: glass, then glass and resin over the volume of the
      // sheet.
      double glass = 0.0;
      for (std::size_t d = 0; d < 2; ++d) {
        const TowGeometry& tow = fabric->crossing.tow[d];
        glass += tow.fibre_fraction * mesoscale::area(tow.section) / tow.spacing;
      }
      const double woven_in = weave.fibre_mass_fraction * mass_of_repeat(weave, woven) / area;
      worst_mass = std::max(worst_mass, std::abs(glass * weave.fibre_density / woven_in - 1.0));
    }
    const double density = 1.0 / (weave.fibre_mass_fraction / weave.fibre_density +
                                  (1.0 - weave.fibre_mass_fraction) / weave.resin_density);
    worst_mass =
        std::max({worst_mass, std::abs(woven.mass.areal_density * area / mass_of_repeat(weave, woven) - 1.0),
                  std::abs(solid.thickness * density / woven.mass.areal_density - 1.0)});
  }
  CHECK(worst_mass < 1e-12);
  std::printf("200 random weaves: deepest overlap %.1e m, mass off by %.1e\n", deepest, worst_mass);
}

TEST_CASE("the overlap check of a weave finds tows that do overlap", "[weave][geometry]") {
  WeaveSpec weave = unbalanced().weave;
  weave.pattern = "satin 5/2";
  UnitCell cell = unit_cell(fabric_geometry(weave, CellState::as_woven), 0.0);
  const auto path = std::get<ArcPath>(cell.tow[0].path);
  // The warp bends more sharply than the weft it goes round.
  cell.tow[0].path =
      arc_path(path.pitch, path.height, 0.8 * std::get<LensSection>(cell.tow[1].section.upper).radius());
  CHECK(penetration(cell, 24).depth > 1e-6);
}

TEST_CASE("faces of an unbalanced weave are flush: crowns of both families at half the thickness",
          "[weave][geometry]") {
  const CellSpec spec = unbalanced();
  const UnitCell cell = unit_cell(fabric_geometry(spec.weave, CellState::as_woven), radians(12.0));
  for (const UnitCell::Tow& tow : cell.tow)
    CHECK(0.5 * height(tow.path) + upper_face(tow.section, 0.0) == Approx(0.75e-3).epsilon(1e-12));
  CHECK(cell.crown() == Approx(0.5 * spec.weave.fabric_thickness).epsilon(1e-12));
}

TEST_CASE("tows given to each direction but alike are the balanced weave, bit for bit", "[weave]") {
  const CellSpec common;
  CellSpec own = common;
  own.weave.own = {OwnTow{4.64e-3, 0.75e-3, 0.75e-3, 1872e-6}, OwnTow{4.64e-3, 0.75e-3, 0.75e-3, 1872e-6}};
  const CellResult a = analyse(common), b = analyse(own);
  CHECK(a.fabric.areal_density == b.fabric.areal_density);
  CHECK(a.fabric.tension_energy.values() == b.fabric.tension_energy.values());
  CHECK(a.fabric.shear_stress.y() == b.fabric.shear_stress.y());
  CHECK(a.fabric.compaction.curves().front().y() == b.fabric.compaction.curves().front().y());
}

// Warp and weft that differ by a billionth go the way of the unbalanced weave, through the roots that the
// balanced one does not need.
TEST_CASE("the unbalanced laws tend to the balanced ones where the tows become alike", "[weave]") {
  CellSpec nearly;
  nearly.weave.own[1].tow_thickness = 0.75e-3 * (1.0 + 1e-9);
  const FormingModels a = forming_models(CellSpec{}), b = forming_models(nearly);
  REQUIRE(a.fabric.crossing.balanced());
  REQUIRE_FALSE(b.fabric.crossing.balanced());
  for (const auto& strain : {std::array{0.004, 0.004}, std::array{0.012, -0.004}}) {
    const TensionModel::State sa = a.tension.relax(strain), sb = b.tension.relax(strain);
    CHECK(sb.energy == Approx(sa.energy).epsilon(1e-6));
    CHECK(sb.tension[0] == Approx(sa.tension[0]).epsilon(1e-6));
  }
  for (const double degrees : {5.0, 30.0, 50.0}) {
    const ShearFlow fa = a.shear.flow(radians(degrees)), fb = b.shear.flow(radians(degrees));
    CHECK(fb.dry == Approx(fa.dry).epsilon(1e-6));
    CHECK(fb.lateral == Approx(fa.lateral).epsilon(1e-6).margin(1e-12));
    CHECK(fb.tension == Approx(fa.tension).epsilon(1e-5).margin(1e-6));
  }
  const PlateContact pa = plate_contact(a.fabric, a.compaction, 0.0),
                     pb = plate_contact(b.fabric, b.compaction, 0.0);
  CHECK(pb.touched_fraction(0.1e-3) == Approx(pa.touched_fraction(0.1e-3)).epsilon(1e-6));
  CHECK(pb.pressure(0.3e-3) == Approx(pa.pressure(0.3e-3)).epsilon(1e-6));
  const ShearRateParts ra = shear_rate_parts(a.fabric, ResinSpec{}, 0.5),
                       rb = shear_rate_parts(b.fabric, ResinSpec{}, 0.5);
  CHECK(rb.film == Approx(ra.film).epsilon(1e-6));
  CHECK(rb.in_tow == Approx(ra.in_tow).epsilon(1e-6));
}

TEST_CASE("warp and weft exchanged, the fabric is turned by a right angle", "[weave]") {
  const FormingModels a = forming_models(unbalanced()), b = forming_models(exchanged(unbalanced()));
  CHECK(a.fabric.mass.areal_density == Approx(b.fabric.mass.areal_density).epsilon(1e-14));
  const TensionModel::State sa = a.tension.relax({0.009, 0.003}), sb = b.tension.relax({0.003, 0.009});
  CHECK(sa.energy == Approx(sb.energy).epsilon(1e-9));
  CHECK(sa.tension[0] == Approx(sb.tension[1]).epsilon(1e-8));
  CHECK(sa.tension[1] == Approx(sb.tension[0]).epsilon(1e-8));
  CHECK(a.bending[0].value == Approx(b.bending[1].value).epsilon(1e-12));
  const ShearFlow fa = a.shear.flow(radians(35.0)), fb = b.shear.flow(radians(35.0));
  CHECK(fa.total() == Approx(fb.total()).epsilon(1e-7));
  const double angle = radians(25.0), depth = 0.2e-3;
  CHECK(plate_contact(a.fabric, a.compaction, angle).pressure(depth) ==
        Approx(plate_contact(b.fabric, b.compaction, angle).pressure(depth)).epsilon(1e-8));
}

TEST_CASE("tension and shear of unbalanced and floating weaves are slopes of their energies",
          "[weave][derivative]") {
  CellSpec spec = GENERATE(unbalanced(), of_pattern("twill 2/2"), of_pattern("twill 2/2 step 2"));
  const FormingModels m = forming_models(spec);
  const double e1 = 0.009, e2 = 0.003;
  const TensionModel::State at = m.tension.relax({e1, e2});
  const auto along_warp = [&](double e) { return m.tension.relax({e, e2}).energy; };
  const auto along_weft = [&](double e) { return m.tension.relax({e1, e}).energy; };
  CHECK(derivative_gap(along_warp, e1, 1e-3, at.tension[0]) < 1e-5);
  CHECK(derivative_gap(along_weft, e2, 1e-3, at.tension[1]) < 1e-5);
  CHECK(derivative_gap(along_warp, e1, 1e-3, 1.01 * at.tension[0]) > 1e-4);
  const double angle = radians(40.0);
  const ShearFlow flow = m.shear.flow(angle);
  const auto relaxed = [&](double g) { return m.shear.loaded(g).potential; };
  CHECK(derivative_gap(relaxed, angle, 0.3, flow.tension) < 1e-5);
  CHECK(derivative_gap(relaxed, angle, 0.3, 1.01 * flow.tension) > 1e-4);
  const auto lateral = [&](double g) { return m.shear.lateral_energy(g); };
  CHECK(derivative_gap(lateral, angle, 0.02, flow.lateral) < 1e-5);
  CHECK(derivative_gap(lateral, angle, 0.02, 1.01 * flow.lateral) > 1e-4);
}

TEST_CASE("an unbalanced crossing under the reference tension carries it both ways", "[weave]") {
  const ShearModel model = forming_models(unbalanced()).shear;
  const LoadedCrossing loaded = model.loaded(0.0);
  const TensionModel::State state = model.tension.relax(loaded.strain);
  for (std::size_t i = 0; i < 2; ++i) {
    CHECK(state.tension[i] == Approx(model.reference_tension).epsilon(1e-3));
    CHECK(state.height[i] == Approx(loaded.height[i]).epsilon(1e-3));
  }
}

TEST_CASE("squeezed together, unlike tows share by equal stress; alike tows by half each",
          "[weave][derivative]") {
  const CompactionLaw law{3.2e6, 5.0};
  const TowSqueeze thin(law, 0.4e-3, 0.25), thick(law, 0.9e-3, 0.19);
  const PairSqueeze pair(thin, thick, false);
  const double squeeze = GENERATE(0.05e-3, 0.4e-3, 0.9e-3);  // beds of fibres, and packed
  const TowSqueeze::Value at = pair.evaluate(squeeze);
  CHECK(at.stress == Approx(pair.stress(squeeze)).epsilon(1e-12));
  const auto energy = [&](double x) { return pair.evaluate(x).energy; };
  const auto stress = [&](double x) { return pair.stress(x); };
  CHECK(derivative_gap(energy, squeeze, 0.1 * squeeze, at.stress) < 1e-6);
  CHECK(derivative_gap(energy, squeeze, 0.1 * squeeze, 1.01 * at.stress) > 1e-4);
  CHECK(derivative_gap(stress, squeeze, 0.1 * squeeze, at.slope) < 1e-5);
  CHECK(derivative_gap(stress, squeeze, 0.1 * squeeze, 1.01 * at.slope) > 1e-4);
  const TowSqueeze::Value by_root = PairSqueeze(thick, thick, false).evaluate(squeeze),
                          by_half = PairSqueeze(thick, thick, true).evaluate(squeeze);
  CHECK(by_root.energy == Approx(by_half.energy).epsilon(1e-12));
  CHECK(by_root.stress == Approx(by_half.stress).epsilon(1e-12));
  CHECK(by_root.slope == Approx(by_half.slope).epsilon(1e-12));
}

TEST_CASE("with longer floats a twill tends to two layers of straight tows", "[weave]") {
  const FormingModels plain = forming_models(CellSpec{});
  double crimp_before = 1.0, gap_before = 1.0;
  for (const int n : {1, 2, 4, 8, 16}) {
    const FormingModels m =
        forming_models(of_pattern("twill " + std::to_string(n) + "/" + std::to_string(n)));
    // Crimp falls with the changes of side: exactly one in n steps.
    const double crimp = m.fabric.as_woven_crimp[0];
    CHECK(crimp == Approx(plain.fabric.as_woven_crimp[0] / n).epsilon(1e-12));
    CHECK(crimp < crimp_before);
    crimp_before = crimp;
    // Straight tows carry EA / p times what a tow does at this strain, from the first stretch on.
    const TensionTow& tow = m.tension.tow[0];
    const double strain = 0.01, straight = tow.stretch.evaluate(strain).force / tow.spacing;
    const double gap = 1.0 - m.tension.relax({strain, strain}).tension[0] / straight;
    CHECK(gap > 0.0);
    CHECK(gap < gap_before);
    // What is missing is at most the stretch that the crimp takes.
    CHECK(gap < crimp / (strain - 0.5 * tow.stretch.straightening));
    gap_before = gap;
  }
}

TEST_CASE("a satin of long floats touches a plate along its crowns, 2 sqrt(2 R d) wide a pitch",
          "[weave][contact]") {
  const CompactionLaw law{3.2e6, 5.0};
  const double depth = 0.02e-3;
  double before = 1.0;
  for (const auto& pattern : {"satin 5/2", "satin 11/3", "satin 31/7"}) {
    const FabricGeometry fabric = fabric_geometry(of_pattern(pattern).weave, CellState::as_woven);
    const Section& section = fabric.crossing.tow[0].section;
    const double straight = 2.0 * reach(section, Face::upper, depth) / fabric.crossing.tow[0].spacing;
    const double gap = 1.0 - plate_contact(fabric, law, 0.0).touched_fraction(depth) / straight;
    CHECK(gap > 0.0);
    CHECK(gap < before);
    before = gap;
  }
  CHECK(before < 0.06);
}

TEST_CASE("fibres bonded in a float lie at its crown height", "[weave]") {
  const BendingInput input{72.4e9, 18.5e-6, 1.0};
  const FabricGeometry satin = fabric_geometry(of_pattern("satin 31/7").weave, CellState::consolidated);
  const TowGeometry& tow = satin.crossing.tow[0];
  const double half = 0.5 * tow.path.height;
  const double straight =
      satin.mass.glass_area[0] * 72.4e9 / tow.spacing * (half * half + mean_square_height(tow.section));
  const double bonded = bending_stiffness(satin, input)[0].bonded;
  CHECK(bonded < straight);
  CHECK(bonded == Approx(straight).epsilon(0.05));
}

namespace {
void check_tables(const std::string& pattern) {
  CAPTURE(pattern);
  const CellResult result = analyse(of_pattern(pattern));  // throws where a table is not convex or falls
  CHECK(result.summary.contact_area_fraction > 0.08);
  CHECK(result.summary.crimp[0] < 0.0116);
  CHECK(result.summary.locking_angle < radians(50.0));
}
}  // namespace

TEST_CASE("a twill makes a fabric whose tables hold their rules", "[weave]") {
  check_tables("twill 2/2");
}

TEST_CASE("every pattern makes a fabric whose tables hold their rules", "[weave][slow]") {
  for (const char* pattern : {"twill 3/1", "twill 2/2 step 2", "crowfoot", "satin 8/3"})
    check_tables(pattern);
}

TEST_CASE("an unbalanced weave makes a fabric whose tables hold their rules", "[weave][slow]") {
  const CellResult result = analyse(unbalanced());
  CHECK(result.fabric.pitch[0] == Approx(3.7e-3));
  CHECK(result.fabric.pitch[1] == Approx(6.2e-3));
  // Wefts rise less, but over warps that stand closer.
  CHECK(result.summary.crimp[1] > result.summary.crimp[0]);
  CHECK(result.fabric.tension_energy.evaluate(0.02, 0.0).fx !=
        Approx(result.fabric.tension_energy.evaluate(0.0, 0.02).fy));
}
