// Hybrid sections: one shape above, another below.
#include <catch2/catch.hpp>
#include <cmath>
#include <variant>

#include "mesoscale/bending.h"
#include "mesoscale/cell.h"
#include "mesoscale/contact.h"
#include "mesoscale/crossover.h"
#include "mesoscale/level_set.h"
#include "mesoscale/nesting.h"
#include "table1.h"
#include "tests/derivative_check.h"

using namespace heddle;
using namespace heddle::mesoscale;
using heddle::test::derivative_gap;
using heddle::test::radians;

namespace {

constexpr double w = 4.64e-3, t = 0.75e-3;

// A lens above, any shape below; s is the upper share of the thickness.
Section lens_above(const HalfSection& below_of_full_thickness, double s) {
  const Section below =
      resized(Section{below_of_full_thickness, below_of_full_thickness}, w, 2.0 * (1.0 - s) * t);
  return {LensSection{w, 2.0 * s * t}, below.lower};
}

WeaveSpec of_one_shape(SectionShape shape) {
  WeaveSpec weave;
  weave.section = shape;
  return weave;
}

WeaveSpec hybrid(SectionShape upper, SectionShape lower, double upper_share) {
  WeaveSpec weave;
  weave.section = SectionShape::hybrid;
  weave.upper.section = upper;
  weave.lower.section = lower;
  weave.upper_share = upper_share;
  return weave;
}

bool same_bits(const Section& a, const Section& b) {
  bool same = a == b && width(a) == width(b) && thickness(a) == thickness(b) && area(a) == area(b) &&
              mean_square_height(a) == mean_square_height(b) && enclosing_radius(a) == enclosing_radius(b) &&
              edge_height(a) == 0.0 && mean_height(a) == 0.0;
  for (double y = -0.55 * w; y < 0.55 * w; y += 0.013 * w)
    same = same && upper_face(a, y) == upper_face(b, y) && lower_face(a, y) == lower_face(b, y) &&
           upper_face(a, y) == -lower_face(a, y);
  return same;
}

}  // namespace

TEST_CASE("two equal halves are the section of their shape, bit for bit", "[section][hybrid]") {
  const SectionShape shape = GENERATE(SectionShape::lens, SectionShape::ellipse, SectionShape::power_ellipse,
                                      SectionShape::capped_lens);
  const WeaveSpec whole = of_one_shape(shape), halves = hybrid(shape, shape, 0.5);
  CHECK(same_bits(section_of(halves, 0), section_of(whole, 0)));
  for (const CellState state : {CellState::as_woven, CellState::consolidated})
    for (const double angle : {0.0, radians(20.0), radians(40.0)}) {
      const CrossingGeometry a = sheared(fabric_geometry(halves, state).crossing, angle);
      const CrossingGeometry b = sheared(fabric_geometry(whole, state).crossing, angle);
      CHECK(a.tow == b.tow);
      CHECK(same_bits(a.tow[1].section, b.tow[1].section));
    }
  // The shape's own numbers, not only the same way to them.
  const Section section = section_of(halves, 0);
  std::visit(
      [&](const auto& s) {
        CHECK(area(section) == s.area());
        CHECK(mean_square_height(section) == s.mean_square_height());
        CHECK(upper_face(section, 0.3 * w) == s.half_height(0.3 * w));
        CHECK(thickness(section) == t);
      },
      section.upper);
}

TEST_CASE("unlike halves meet at the edges, keep their crowns and add up to closed-form areas",
          "[section][hybrid]") {
  const double pi = std::acos(-1.0), s = GENERATE(0.25, 0.5, 0.7);
  CAPTURE(s);
  // Half a lens and half an ellipse.
  const Section section = lens_above(PowerEllipseSection{w, t, 1.0}, s);
  const double up = s * t, down = (1.0 - s) * t;
  const double r = (0.25 * w * w + up * up) / (2.0 * up), a = std::asin(0.5 * w / r);
  const double segment = r * r * (a - 0.5 * std::sin(2.0 * a)), ellipse = 0.25 * pi * w * down;
  CHECK(thickness(section) == Approx(t).epsilon(1e-15));
  CHECK(upper_face(section, 0.0) == Approx(0.5 * t).epsilon(1e-14));
  CHECK(lower_face(section, 0.0) == Approx(-0.5 * t).epsilon(1e-14));
  CHECK(edge_height(section) == Approx(down - 0.5 * t).margin(1e-18));
  CHECK(upper_face(section, 0.5 * w) == edge_height(section));
  CHECK(lower_face(section, 0.5 * w) == edge_height(section));
  CHECK(area(section) == Approx(segment + ellipse).epsilon(1e-12));
  // Centroids of a circular segment over its chord and of half an ellipse, from the line of the edges.
  const double chord = w, over_centre = chord * chord * chord / (12.0 * segment),
               segment_centroid = over_centre - (r - up);
  const double mean = edge_height(section) +
                      (segment * segment_centroid - ellipse * 4.0 * down / (3.0 * pi)) / (segment + ellipse);
  CHECK(mean_height(section) == Approx(mean).epsilon(1e-9).margin(1e-14));
  CHECK(crown_radius(section, Face::upper) == Approx(r).epsilon(1e-14));
  CHECK(crown_radius(section, Face::lower) == Approx(0.25 * w * w / down).epsilon(1e-14));
  CHECK(enclosing_radius(section) ==
        Approx(std::max(r, (0.25 * w * w + down * down) / (2.0 * down))).epsilon(1e-14));
}

TEST_CASE("area and moments of unlike halves are the integrals between their faces", "[section][hybrid]") {
  const Section section =
      GENERATE(lens_above(PowerEllipseSection{w, t, 0.5}, 0.3), lens_above(capped_lens(w, t, 0.4), 0.6),
               Section(capped_lens(w, 1.2 * t, 0.7), PowerEllipseSection{w, 0.8 * t, 2.0}));
  double sum = 0.0, first = 0.0, second = 0.0;
  constexpr int n = 200000;
  for (int k = 0; k < n; ++k) {
    const double y = w * ((k + 0.5) / n - 0.5), dy = w / n;
    const double top = upper_face(section, y), bottom = lower_face(section, y);
    sum += (top - bottom) * dy;
    first += 0.5 * (top * top - bottom * bottom) * dy;
    second += (top * top * top - bottom * bottom * bottom) / 3.0 * dy;
  }
  CHECK(area(section) == Approx(sum).epsilon(1e-6));
  CHECK(mean_height(section) == Approx(first / sum).epsilon(1e-5));
  CHECK(mean_square_height(section) == Approx(second / sum).epsilon(1e-6));
}

TEST_CASE("each face of unlike halves has its own slope, drop and reach", "[section][hybrid][derivative]") {
  const Section section = lens_above(capped_lens(w, t, 0.4), 0.35);
  const double y = GENERATE(-1.9e-3, -0.3e-3, 0.8e-3, 2.1e-3);
  const auto check_face = [&](Face face, double side, double crown) {
    const auto outline = [&](double x) {
      return side * (face == Face::upper ? upper_face(section, x) : lower_face(section, x));
    };
    CHECK(derivative_gap(outline, y, 1e-4, slope(section, face, y)) < 1e-7);
    CHECK(derivative_gap(outline, y, 1e-4, 1.01 * slope(section, face, y)) > 1e-4);
    CHECK(drop(section, face, y) == Approx(crown - outline(y)).epsilon(1e-10));
    CHECK(reach(section, face, drop(section, face, y)) == Approx(std::abs(y)).epsilon(1e-10));
  };
  check_face(Face::upper, 1.0, 0.5 * t);
  check_face(Face::lower, -1.0, 0.5 * t);
  CHECK(drop(section, Face::upper, y) < drop(section, Face::lower, y));  // the flatter half is above
}

TEST_CASE("halves keep their shares of the thickness when a section is resized", "[section][hybrid]") {
  const Section section = lens_above(PowerEllipseSection{w, t, 0.5}, 0.3);
  const Section pressed = resized(section, 1.1 * w, 0.4 * t);
  CHECK(width(pressed) == 1.1 * w);
  CHECK(thickness(pressed) == Approx(0.4 * t).epsilon(1e-15));
  CHECK(edge_height(pressed) == Approx(0.4 * edge_height(section)).epsilon(1e-14));
  CHECK(std::get<PowerEllipseSection>(pressed.lower).power == 0.5);
}

TEST_CASE(
    "halves no fuller than a lens stay clear of crossing tows while the path has room for the flatter one",
    "[section][hybrid]") {
  const auto found = [](const WeaveSpec& weave, double degrees) {
    return penetration(unit_cell(fabric_geometry(weave, CellState::as_woven), radians(degrees)), 120);
  };
  // The path jams at (p^2 + h^2) / 4h = 9.87 mm: a lens a half thinner than 0.3687 t is flatter than that.
  const double p = 5.39e-3, jam = (p * p + t * t) / (4.0 * t);
  const double least = (jam - std::sqrt(jam * jam - 0.25 * w * w)) / t;
  CHECK(least == Approx(0.3687).margin(1e-4));
  for (const double share : {0.37, 0.5, 0.63}) {
    CAPTURE(share);
    CHECK(std::abs(found(hybrid(SectionShape::lens, SectionShape::lens, share), 0.0).depth) <= 1e-16);
    CHECK(found(hybrid(SectionShape::lens, SectionShape::capped_lens, share), 0.0).depth <= 1e-16);
  }
  // At equal shares the widest tows still fit, p wide; and turned over the fabric is the same.
  for (const double degrees : {20.0, 40.0})
    CHECK(found(hybrid(SectionShape::capped_lens, SectionShape::lens, 0.5), degrees).depth <= 1e-16);
  const Penetration flat = found(hybrid(SectionShape::lens, SectionShape::lens, 0.3), 0.0);
  const Penetration turned = found(hybrid(SectionShape::lens, SectionShape::lens, 0.7), 0.0);
  CHECK(flat.depth > 1e-6);
  CHECK(flat.depth == Approx(turned.depth).epsilon(1e-9));
  CHECK(flat.volume == Approx(turned.volume).epsilon(1e-9));
  // A fuller half cuts in where it meets the other tow.
  CHECK(found(hybrid(SectionShape::lens, SectionShape::ellipse, 0.5), 0.0).depth > 1e-5);
}

TEST_CASE("a hybrid section balances the mass by its own area in every state", "[section][hybrid]") {
  const WeaveSpec weave = hybrid(SectionShape::ellipse, SectionShape::capped_lens, 0.6);
  for (const CellState state : {CellState::as_woven, CellState::consolidated}) {
    const FabricGeometry fabric = fabric_geometry(weave, state);
    for (std::size_t i = 0; i < 2; ++i) {
      const TowGeometry& tow = fabric.crossing.tow[i];
      CHECK(tow.fibre_fraction * area(tow.section) ==
            Approx(fabric.mass.glass_area[i] * (1.0 + fabric.as_woven_crimp[i])).epsilon(1e-12));
      CHECK(0.5 * (thickness(tow.section) + tow.path.height) ==
            Approx(0.5 * fabric.thickness).epsilon(1e-12));
    }
  }
}

TEST_CASE("bodies of hybrid tows have the volume of their closed form, and overlap as the height fields say",
          "[section][hybrid][level_set]") {
  const WeaveSpec weave = hybrid(SectionShape::ellipse, SectionShape::power_ellipse, 0.6);
  const UnitCell cell = unit_cell(fabric_geometry(weave, CellState::as_woven), 0.0);
  const LevelSetCheck check = level_set_check(cell, 0.1e-3);
  for (std::size_t k = 0; k < check.tows.size(); ++k)
    CHECK(check.tow_volume[k] == Approx(check.closed_form_volume[k]).epsilon(0.02));
  const Penetration sampled = penetration(cell, 100);
  CHECK(1e9 * check.overlap_volume == Approx(1e9 * sampled.volume).epsilon(0.05));
  CHECK(1e9 * sampled.tow_volume == Approx(1e9 * check.closed_form_total).epsilon(2e-3));
}

TEST_CASE("the distance to a hybrid tow vanishes on both faces, and is height over its crowns",
          "[section][hybrid][level_set]") {
  const WeaveSpec weave = hybrid(SectionShape::ellipse, SectionShape::capped_lens, 0.6);
  const UnitCell cell = unit_cell(fabric_geometry(weave, CellState::as_woven), 0.0);
  const TowPiece warp{TowDirection::warp, 0};
  const double middle = warp_centre(cell, 0, 0.0), crown = middle + 0.5 * t, foot = middle - 0.5 * t;
  CHECK(tow_distance(cell, warp, {0.0, 0.0, crown + 0.1e-3}) == Approx(0.1e-3).epsilon(1e-9));
  CHECK(tow_distance(cell, warp, {0.0, 0.0, foot - 0.1e-3}) == Approx(0.1e-3).epsilon(1e-9));
  CHECK(tow_distance(cell, warp, {0.0, 0.0, crown - 0.1e-3}) == Approx(-0.1e-3).epsilon(1e-9));
  const Section& section = cell.tow[0].section;
  for (const double y : {-1.8e-3, 0.4e-3, 2.1e-3})
    for (const double face : {upper_face(section, y), lower_face(section, y)}) {
      const double z = warp_centre(cell, 0, 0.7e-3) + face;
      CHECK(std::abs(tow_distance(cell, warp, {0.7e-3, y, z})) < 1e-9);
      CHECK(tow_distance(cell, warp, {0.7e-3, y, z + (face > edge_height(section) ? 1e-5 : -1e-5)}) > 0.0);
      CHECK(tow_distance(cell, warp, {0.7e-3, y, z - (face > edge_height(section) ? 1e-5 : -1e-5)}) < 0.0);
    }
}

TEST_CASE("the plate meets the upper face of a hybrid section, and its crown in closed form",
          "[section][hybrid][contact]") {
  const WeaveSpec weave = hybrid(SectionShape::ellipse, SectionShape::lens, 0.4);
  const FabricGeometry fabric = fabric_geometry(weave, CellState::as_woven);
  const double angle = radians(GENERATE(0.0, 25.0)), depth = 0.12e-3;
  const PlateContact plate = plate_contact(fabric, CompactionLaw{3.2e6, 5.0}, angle);
  const UnitCell cell = unit_cell(fabric, angle);
  const HeightField field = height_field(cell, 800);
  double touched = 0.0;
  for (std::size_t k = 0; k < field.top.size(); ++k)
    touched += field.covered[k] && field.top[k] > cell.crown() - depth ? 1.0 : 0.0;
  CHECK(touched / static_cast<double>(field.top.size()) ==
        Approx(plate.touched_fraction(depth)).margin(3e-3));
  // Half an ellipse of 0.4 t and the path's arc: phi = 2 pi d sqrt(R R') / p^2.
  const TowGeometry& tow = plate.crossing.tow[0];
  const double crown = 0.25 * width(tow.section) * width(tow.section) / (0.4 * t);
  CHECK(plate.touched_fraction(1e-6) ==
        Approx(2.0 * std::acos(-1.0) * 1e-6 * std::sqrt(crown * tow.path.radius) / (5.39e-3 * 5.39e-3))
            .epsilon(2e-3));
  // How wide a crown is touched across the tow.
  CHECK(reach(tow.section, Face::upper, depth) ==
        Approx(0.5 * width(tow.section) * std::sqrt(1.0 - std::pow(1.0 - depth / (0.4 * t), 2)))
            .epsilon(1e-12));
}

TEST_CASE("turning a plain hybrid fabric over changes neither what its crossings carry nor how it bends",
          "[section][hybrid]") {
  const WeaveSpec weave = hybrid(SectionShape::lens, SectionShape::capped_lens, 0.45);
  const WeaveSpec turned = hybrid(SectionShape::capped_lens, SectionShape::lens, 0.55);
  const FabricGeometry a = fabric_geometry(weave, CellState::as_woven);
  const FabricGeometry b = fabric_geometry(turned, CellState::as_woven);
  const CompactionLaw law{3.2e6, 5.0};
  const CrossoverContact one(a.crossing, 0.3, law, a.quarters), other(b.crossing, 0.3, law, b.quarters);
  CHECK(one.force(0.05e-3) == Approx(other.force(0.05e-3)).epsilon(1e-9));
  CHECK(one.arm(0.05e-3) == Approx(other.arm(0.05e-3)).epsilon(1e-9));
  CHECK(mean_square_height(a.crossing.tow[0].section) ==
        Approx(mean_square_height(b.crossing.tow[0].section)).epsilon(1e-12));
  CHECK(mean_height(a.crossing.tow[0].section) ==
        Approx(-mean_height(b.crossing.tow[0].section)).epsilon(1e-9));
}

TEST_CASE("plies of hybrid tows nest without overlap", "[section][hybrid][nest]") {
  const WeaveSpec weave = hybrid(SectionShape::lens, SectionShape::capped_lens, 0.45);
  const UnitCell ply = unit_cell(fabric_geometry(weave, CellState::as_woven), 0.0);
  CHECK(closest_approach(ply, {0.0, 0.0}) == Approx(2.0 * ply.crown()).epsilon(1e-12));
  const PlyStack stack = nested(ply, {{0.0, 0.0}, {2.1e-3, 1.3e-3}, {0.9e-3, 4.0e-3}});
  const double overlap = sampled_overlap(stack, 60);
  CHECK(overlap <= 1e-12);
  CHECK(overlap > -0.05e-3);
}

TEST_CASE("a satin of hybrid tows bends by its heights over the mid-plane", "[section][hybrid]") {
  WeaveSpec weave = hybrid(SectionShape::lens, SectionShape::ellipse, 0.3);
  weave.pattern = "satin 5/2";
  const FabricGeometry fabric = fabric_geometry(weave, CellState::consolidated);
  const UnitCell cell = unit_cell(fabric, 0.0);
  const BendingInput input{weave.fibre_modulus, weave.fibre_diameter, 0.5};
  const std::array<BendingStiffness, 2> bending = bending_stiffness(fabric, input);
  // z^2 over the tow volume of one warp and one weft, sampled.
  const auto square = [&](std::size_t family) {
    const UnitCell::Tow& tow = cell.tow[family];
    double sum = 0.0, volume = 0.0;
    for (int i = 0; i < 1000; ++i)
      for (int j = 0; j < 400; ++j) {
        const double along = 5.0 * cell.tow[1 - family].spacing * (i + 0.5) / 1000.0;
        const double y = width(tow.section) * ((j + 0.5) / 400.0 - 0.5);
        const double z = family == 0 ? warp_centre(cell, 0, along) : weft_centre(cell, 0, along);
        const double top = z + upper_face(tow.section, y), bottom = z + lower_face(tow.section, y);
        sum += (top * top * top - bottom * bottom * bottom) / 3.0;
        volume += top - bottom;
      }
    return sum / volume;
  };
  for (const std::size_t i : {std::size_t{0}, std::size_t{1}}) {
    const double axial = fabric.mass.glass_area[i] * input.fibre_modulus / fabric.crossing.tow[i].spacing;
    CHECK(bending[i].bonded == Approx(axial * square(i)).epsilon(1e-3));
  }
  CHECK(std::abs(bending[0].bonded / bending[1].bonded - 1.0) > 1e-3);  // its faces are not alike
}
