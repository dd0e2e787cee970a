// Sections of tows other than the lens.
#include "mesoscale/section.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <string>

#include "mesoscale/cell.h"
#include "mesoscale/contact.h"
#include "mesoscale/level_set.h"
#include "table1.h"
#include "tests/derivative_check.h"

using namespace heddle;
using namespace heddle::mesoscale;
using heddle::test::derivative_gap;
using heddle::test::radians;

namespace {

constexpr double w = 4.64e-3, t = 0.75e-3;

WeaveSpec with_section(SectionShape shape) {
  WeaveSpec weave;
  weave.section = shape;
  return weave;
}

UnitCell cell_of(SectionShape shape, double angle = 0.0) {
  return unit_cell(fabric_geometry(with_section(shape), CellState::as_woven), angle);
}

}  // namespace

TEST_CASE("areas and second moments of all sections are the integrals of their outlines", "[section]") {
  const Section section =
      GENERATE(Section(LensSection{w, t}), Section(PowerEllipseSection{w, t, 1.0}),
               Section(PowerEllipseSection{w, t, 0.5}), Section(PowerEllipseSection{w, t, 2.0}),
               Section(capped_lens(w, t, 0.3)), Section(capped_lens(w, t, 0.8)));
  double sum = 0.0, moment = 0.0;
  constexpr int n = 400000;
  for (int k = 0; k < n; ++k) {
    const double f = upper_face(section, w * ((k + 0.5) / n - 0.5));
    sum += 2.0 * f * w / n;
    moment += 2.0 / 3.0 * f * f * f * w / n;
  }
  CHECK(area(section) == Approx(sum).epsilon(1e-6));
  CHECK(mean_square_height(section) == Approx(moment / sum).epsilon(1e-6));
}

TEST_CASE(
    "slopes of all sections agree with differences, drop with the fall from the crown, reach inverts it",
    "[section][derivative]") {
  const Section section =
      GENERATE(Section(PowerEllipseSection{w, t, 1.0}), Section(PowerEllipseSection{w, t, 0.5}),
               Section(PowerEllipseSection{w, t, 2.0}), Section(capped_lens(w, t, 0.4)));
  const double y = GENERATE(-1.9e-3, -0.3e-3, 0.8e-3, 2.1e-3);
  const auto outline = [&](double x) { return upper_face(section, x); };
  CHECK(derivative_gap(outline, y, 1e-4, slope(section, Face::upper, y)) < 1e-7);
  CHECK(derivative_gap(outline, y, 1e-4, 1.01 * slope(section, Face::upper, y)) > 1e-4);
  CHECK(drop(section, Face::upper, y) == Approx(0.5 * t - upper_face(section, y)).epsilon(1e-10));
  CHECK(reach(section, Face::upper, drop(section, Face::upper, y)) == Approx(std::abs(y)).epsilon(1e-10));
  CHECK(upper_face(section, 0.6 * w) == 0.0);
  CHECK(reach(section, Face::upper, t) == 0.5 * w);
  // At the crown the outline is a circle of the crown radius.
  const double near = 1e-5;
  CHECK(drop(section, Face::upper, near) ==
        Approx(near * near / (2.0 * crown_radius(section, Face::upper))).epsilon(1e-3));
}

TEST_CASE("an ellipse is the power ellipse of power one, and has its closed-form area", "[section]") {
  const PowerEllipseSection ellipse{w, t, 1.0};
  CHECK(ellipse.area() == Approx(0.25 * std::acos(-1.0) * w * t).epsilon(1e-14));
  CHECK(ellipse.mean_square_height() == Approx(t * t / 16.0).epsilon(1e-14));
  CHECK(1e6 * ellipse.area() == Approx(2.733).margin(0.001));
}

TEST_CASE("a capped lens that is all cap is the lens, and it has no corner", "[section]") {
  const CappedLensSection all = capped_lens(w, t, 1.0);
  const LensSection lens{w, t};
  CHECK(all.radius() == Approx(lens.radius()).epsilon(1e-12));
  CHECK(all.area() == Approx(lens.area()).epsilon(1e-12));
  const CappedLensSection capped = capped_lens(w, t, 0.5);
  CHECK(capped.slope(capped.cap * (1.0 - 1e-9)) ==
        Approx(capped.slope(capped.cap * (1.0 + 1e-9))).epsilon(1e-6));
  CHECK(capped.half_height(0.0) == Approx(0.5 * t));
  CHECK(capped.area() < lens.area());
}

TEST_CASE("sections slimmer than the lens stay clear of crossing tows, fuller ones do not", "[section]") {
  const double angle = radians(GENERATE(0.0, 20.0, 40.0));
  const auto found = [&](SectionShape shape) { return penetration(cell_of(shape, angle), 120); };
  CHECK(found(SectionShape::lens).depth <= 1e-16);
  CHECK(found(SectionShape::capped_lens).depth <= 1e-16);
  const Penetration ellipse = found(SectionShape::ellipse), fuller = found(SectionShape::power_ellipse);
  CHECK(ellipse.depth > 1e-5);
  CHECK(fuller.depth > ellipse.depth);
  CHECK(fuller.volume > ellipse.volume);
}

TEST_CASE("every section balances the mass by its own area", "[section]") {
  const SectionShape shape = GENERATE(SectionShape::lens, SectionShape::ellipse, SectionShape::power_ellipse,
                                      SectionShape::capped_lens);
  const FabricGeometry lens = heddle::test::table1();
  for (const CellState state : {CellState::as_woven, CellState::consolidated}) {
    const FabricGeometry fabric = fabric_geometry(with_section(shape), state);
    const TowGeometry& tow = fabric.crossing.tow[0];
    const double glass = tow.fibre_fraction * area(tow.section);
    CHECK(glass == Approx(fabric.mass.glass_area[0] * (1.0 + fabric.as_woven_crimp[0])).epsilon(1e-12));
    CHECK(fabric.mass.areal_density == lens.mass.areal_density);
    CHECK(fabric.as_woven_crimp == lens.as_woven_crimp);  // paths do not depend on the shape
  }
}

TEST_CASE("bodies of all sections have the volume of their closed form, and overlap as the height fields say",
          "[section][level_set]") {
  const SectionShape shape =
      GENERATE(SectionShape::ellipse, SectionShape::power_ellipse, SectionShape::capped_lens);
  const UnitCell cell = cell_of(shape);
  const LevelSetCheck check = level_set_check(cell, 0.1e-3);
  for (std::size_t k = 0; k < check.tows.size(); ++k)
    CHECK(check.tow_volume[k] == Approx(check.closed_form_volume[k]).epsilon(0.02));
  const Penetration sampled = penetration(cell, 100);
  CHECK(check.overlap_volume == Approx(std::max(sampled.volume, 0.0)).epsilon(0.05).margin(1e-16));
}

TEST_CASE("a plate touches all sections as a sampled height field says", "[section][contact]") {
  const SectionShape shape =
      GENERATE(SectionShape::ellipse, SectionShape::power_ellipse, SectionShape::capped_lens);
  const double angle = radians(GENERATE(0.0, 25.0)), depth = 0.15e-3;
  const FabricGeometry fabric = fabric_geometry(with_section(shape), CellState::as_woven);
  const CompactionLaw law{3.2e6, 5.0};
  const PlateContact plate = plate_contact(fabric, law, angle);
  const UnitCell cell = unit_cell(fabric, angle);
  const HeightField field = height_field(cell, 800);
  double touched = 0.0;
  for (std::size_t k = 0; k < field.top.size(); ++k)
    touched += field.covered[k] && field.top[k] > cell.crown() - depth ? 1.0 : 0.0;
  CHECK(touched / static_cast<double>(field.top.size()) ==
        Approx(plate.touched_fraction(depth)).margin(3e-3));
  CHECK(plate.touched_fraction(1e-6) == Approx(shallow_touched_fraction(plate.crossing, 1e-6)).epsilon(2e-3));
}

TEST_CASE("every section makes a fabric whose tables hold their rules", "[section]") {
  CellSpec spec;
  // The other two lie between these.
  spec.weave.section = GENERATE(SectionShape::power_ellipse, SectionShape::capped_lens);
  const CellResult result = analyse(spec);
  CHECK(result.summary.tow_section_area == area(section_of(spec.weave, 0)));
  CHECK(result.summary.locking_angle > radians(40.0));
}
