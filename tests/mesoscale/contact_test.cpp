#include "mesoscale/contact.h"
#include "mesoscale/touched_face.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <string>

#include "table1.h"
#include "tests/derivative_check.h"

using namespace heddle;
using namespace heddle::mesoscale;
using heddle::test::derivative_gap;
using heddle::test::lens_of;
using heddle::test::radians;
using heddle::test::table1;

namespace {
const CompactionLaw law{3.2e6, 5.0};

double sampled_fraction(const UnitCell& cell, double depth, int n) {
  const HeightField field = height_field(cell, n);
  double touched = 0.0;
  for (std::size_t k = 0; k < field.top.size(); ++k)
    touched += field.covered[k] && field.top[k] > 0.75e-3 - depth ? 1.0 : 0.0;
  return touched / static_cast<double>(field.top.size());
}

double touched_share(const TouchedFace& face, double pressure) {
  const auto touched =
      std::count_if(face.pressure.begin(), face.pressure.end(), [&](double p) { return p <= pressure; });
  return static_cast<double>(touched) / static_cast<double>(face.pressure.size());
}

double fraction_with_gap(double gap, double pressure) {
  WeaveSpec weave;
  weave.gap = gap;
  const PlateContact plate = plate_contact(fabric_geometry(weave, CellState::as_woven), law, 0.0);
  return plate.touched_fraction(plate.depth_at(pressure));
}
const ContactTables& table1_tables() {
  static const ContactTables tables = contact_tables(table1(), law);
  return tables;
}
}  // namespace

TEST_CASE("a plate 0.05 mm below the crowns of Table 1 touches 8.16 percent", "[contact][paper]") {
  CHECK(100.0 * plate_contact(table1(), law, 0.0).touched_fraction(0.05e-3) == Approx(8.16).margin(0.05));
}

TEST_CASE("shallow contact follows 2 pi d sqrt(R R') / p^2, and deep contact does not", "[contact]") {
  const double angle = radians(GENERATE(0.0, 20.0, 40.0));
  const PlateContact plate = plate_contact(table1(), law, angle);
  CHECK(plate.touched_fraction(1e-6) == Approx(shallow_touched_fraction(plate.crossing, 1e-6)).epsilon(1e-3));
  // Crowns have merged by 0.3 mm; once the gap is closed they fit each other and the formula holds longer.
  if (angle == 0.0)
    CHECK(plate.touched_fraction(0.3e-3) > 1.02 * shallow_touched_fraction(plate.crossing, 0.3e-3));
}

TEST_CASE("the touched fraction agrees with a sampled height field in every weave", "[contact]") {
  const std::string pattern = GENERATE("plain", "twill 2/2", "satin 5/2");
  const double angle = radians(GENERATE(0.0, 40.0));
  const double depth = GENERATE(0.1e-3, 0.3e-3, 0.5e-3);
  CAPTURE(pattern, angle, depth);
  WeaveSpec weave;
  weave.pattern = pattern;
  const FabricGeometry fabric = fabric_geometry(weave, CellState::as_woven);
  const double exact = plate_contact(fabric, law, angle).touched_fraction(depth);
  CHECK(sampled_fraction(unit_cell(fabric, angle), depth, 800) == Approx(exact).margin(3e-3));
}

TEST_CASE("plate pressure agrees with a sum over the sampled height field", "[contact]") {
  const FabricGeometry fabric = table1();
  const double depth = GENERATE(0.2e-3, 0.45e-3, 0.55e-3);
  const PlateContact plate = plate_contact(fabric, law, 0.0);
  const HeightField field = height_field(unit_cell(fabric, 0.0), 1000);
  double sum = 0.0;
  for (std::size_t k = 0; k < field.top.size(); ++k)
    if (field.covered[k]) sum += plate.squeeze[0].stress(depth - (0.75e-3 - field.top[k]));
  CHECK(plate.pressure(depth) == Approx(sum / static_cast<double>(field.top.size())).epsilon(2e-3));
}

TEST_CASE("pressure and touched area grow with depth, from nothing", "[contact]") {
  const PlateContact plate = plate_contact(table1(), law, radians(GENERATE(0.0, 30.0, 50.0)));
  CHECK(plate.pressure(0.0) == 0.0);
  double pressure = 0.0, fraction = 0.0;
  for (int k = 1; k <= 110; ++k) {
    const double depth = 5e-6 * k;
    if (depth > plate.depth_at(6e6)) break;
    CHECK(plate.pressure(depth) > pressure);
    CHECK(plate.touched_fraction(depth) > fraction);
    pressure = plate.pressure(depth);
    fraction = plate.touched_fraction(depth);
    CHECK(fraction < 1.0);
  }
}

TEST_CASE("depth_at inverts the pressure, and says so when it cannot", "[contact]") {
  const PlateContact plate = plate_contact(table1(), law, 0.0);
  const double pressure = GENERATE(20.0, 8.6e3, 150e3, 5e6);
  CHECK(plate.pressure(plate.depth_at(pressure)) == Approx(pressure).epsilon(1e-8));
  CHECK_THROWS_AS(plate.depth_at(1e15), NumericalError);
}

TEST_CASE("contact tables start flat at zero, reach 5 MPa and follow the exact curves", "[contact]") {
  const FabricGeometry fabric = table1();
  const ContactTables& tables = table1_tables();
  CHECK(tables.grid_error < 2e-3);
  for (std::size_t k = 0; k < tables.compaction.curves().size(); ++k) {
    const Curve& curve = tables.compaction.curves()[k];
    const double angle = tables.compaction.parameter()[k];
    CAPTURE(angle);
    CHECK(curve.x().front() == 0.0);
    CHECK(curve.y().front() == 0.0);
    CHECK(curve.evaluate(0.0).slope == 0.0);
    CHECK(curve.evaluate(-1e-4).y == 0.0);
    CHECK(curve.y().back() >= 5e6);
    const PlateContact plate = plate_contact(fabric, law, angle);
    for (double p : {1e2, 8.6e3, 1e5, 1e6}) {
      const double exact = plate.touched_fraction(plate.depth_at(p));
      CHECK(tables.contact.evaluate(p, angle).fraction == Approx(exact).epsilon(2e-3));
    }
    for (double share : {0.205, 0.503, 0.807})
      CHECK(curve(share * curve.x().back()) ==
            Approx(plate.pressure(share * curve.x().back())).epsilon(5e-3));
  }
}

TEST_CASE("area slope agrees with central differences, below, inside and beyond the table",
          "[contact][derivative]") {
  const ContactArea& area = table1_tables().contact;
  const double p = GENERATE(1.0, 3e3, 1.5e5, 3e6);
  const double angle = radians(GENERATE(0.0, 23.0));
  CAPTURE(p, angle);
  const auto fraction = [&](double x) { return area.evaluate(x, angle).fraction; };
  const double slope = area.evaluate(p, angle).slope;
  CHECK(derivative_gap(fraction, p, 0.01 * p, slope) < 1e-6);
  CHECK(derivative_gap(fraction, p, 0.01 * p, 1.01 * slope) > 1e-4);
  CHECK(area.evaluate(p, -angle).fraction == area.evaluate(p, angle).fraction);
}

TEST_CASE("below the table the area goes with the root of pressure and never exceeds the plate",
          "[contact]") {
  const ContactArea& area = table1_tables().contact;
  CHECK(area.evaluate(0.04, 0.0).fraction / area.evaluate(0.01, 0.0).fraction == Approx(2.0).epsilon(0.05));
  CHECK(area.evaluate(1e30, 0.0).fraction <= 1.0);
}

TEST_CASE("a wider gap leaves less area at the same pressure, enough to move friction by one percent",
          "[contact]") {
  const double pressure = GENERATE(8.6e3, 150e3);
  const double narrow = fraction_with_gap(0.75e-3, pressure), wide = fraction_with_gap(1.5e-3, pressure);
  CAPTURE(pressure, narrow, wide);
  CHECK(wide < narrow);
  CHECK(1.0 - std::pow(wide / narrow, 0.14) > 0.01);  // mu ~ phi^0.14: slope s of the fitted Stribeck law
}

TEST_CASE("the patches of the picture are the touched fraction of the table at each pressure and angle",
          "[contact][pictures]") {
  const FabricGeometry& fabric = table1();
  const ContactTables tables =
      contact_tables(fabric, law, {.shear_angles_deg = {0, 30, 60}, .pressures = 15});
  for (const double degrees : {0.0, 30.0, -30.0}) {
    const double angle = degrees * std::acos(-1.0) / 180.0;
    const TouchedFace face = touched_face(fabric, tables.compaction, angle, 200);
    for (const double pressure : {1e2, 1e3, 1e4, 1e5, 1e6}) {
      const double fraction = tables.contact.evaluate(pressure, angle).fraction;
      CAPTURE(degrees, pressure, fraction);
      CHECK(touched_share(face, pressure) == Approx(fraction).epsilon(0.02));
      CHECK(touched_share(face, 1.2 * pressure) > fraction);
    }
    // A repeat of the sheared fabric: its edges keep their length along the warp and turn along the weft.
    CHECK(std::atan2(face.along_weft[0], face.along_weft[1]) == Approx(angle).margin(1e-12));
  }
}
