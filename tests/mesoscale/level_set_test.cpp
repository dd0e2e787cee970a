#include "mesoscale/level_set.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "core/problem.h"
#include "table1.h"

using namespace heddle;
using namespace heddle::mesoscale;
using heddle::test::ellipse_on_sine;
using heddle::test::radians;
using heddle::test::table1;

namespace {

// A point of a tow's face and its outward normal, from the closed forms of section and path.
struct OnFace {
  std::array<double, 3> place;
  std::array<double, 3> normal;
};

OnFace on_face(const UnitCell& cell, const TowPiece& tow, double along, double across, double side) {
  const bool warp = tow.direction == TowDirection::warp;
  const auto height_at = [&](double u, double v) {
    const double centre = warp ? warp_centre(cell, tow.index, u) : weft_centre(cell, tow.index, u);
    return centre + (side > 0.0 ? upper_face(cell.tow[0].section, v) : lower_face(cell.tow[0].section, v));
  };
  const double side_place = tow.index * cell.tow[0].spacing + across;
  const auto xy = warp ? cell.place(along, side_place) : cell.place(side_place, along);
  const double e = 1e-8;  // [m]
  const double du = (height_at(along + e, across) - height_at(along - e, across)) / (2.0 * e);
  const double dv = (height_at(along, across + e) - height_at(along, across - e)) / (2.0 * e);
  const double d_xi = warp ? du : dv, d_eta = warp ? dv : du;
  // z_x and z_y of x = xi + eta sin g, y = eta cos g.
  const double zx = d_xi, zy = (d_eta - d_xi * std::sin(cell.shear_angle)) / std::cos(cell.shear_angle);
  const double length = std::sqrt(1.0 + zx * zx + zy * zy);
  return {{xy[0], xy[1], height_at(along, across)},
          {-side * zx / length, -side * zy / length, side / length}};
}

}  // namespace

TEST_CASE("a tow's distance is what was gone along the normal from its face", "[mesoscale][level_set]") {
  const UnitCell cell =
      GENERATE(unit_cell(table1(), 0.0), unit_cell(table1(), radians(25.0)), ellipse_on_sine());
  const TowPiece tow{GENERATE(TowDirection::warp, TowDirection::weft), 1};
  const double gone = GENERATE(-0.1e-3, 0.0, 0.05e-3, 0.15e-3);
  double worst_first_order = 0.0;
  for (double along : {-1.1e-3, 0.3e-3, 1.3e-3, 2.6e-3, 4.0e-3, 6.1e-3})
    for (double across : {-1.2e-3, 0.1e-3, 0.9e-3, 1.3e-3})
      for (double side : {-1.0, 1.0}) {
        const OnFace at = on_face(cell, tow, along, across, side);
        CAPTURE(along, across, side, gone);
        std::array<double, 3> q = at.place;
        for (std::size_t c = 0; c < 3; ++c) q[c] += gone * at.normal[c];
        CHECK(tow_distance(cell, tow, q) == Approx(gone).margin(1e-10));
        // What the gap in z times the cosine above the same place would have said.
        const bool warp = tow.direction == TowDirection::warp;
        const double eta = q[1] / std::cos(cell.shear_angle), xi = q[0] - eta * std::sin(cell.shear_angle);
        const OnFace below =
            on_face(cell, tow, warp ? xi : eta, (warp ? eta : xi) - cell.tow[0].spacing, side);
        const double first_order = side * (q[2] - below.place[2]) * std::abs(below.normal[2]);
        worst_first_order = std::max(worst_first_order, std::abs(first_order - gone));
      }
  if (gone == 0.15e-3) CHECK(worst_first_order > 3e-8);  // so the test can tell the two apart
}

TEST_CASE("a tow's distance beyond its edges and cuts is that to the nearest of many points of its surface",
          "[mesoscale][level_set]") {
  const UnitCell cell = GENERATE(unit_cell(table1(), radians(20.0)), ellipse_on_sine());
  const TowPiece tow{TowDirection::warp, 0};
  const double half = 0.5 * width(cell.tow[0].section), cut = -0.5 * cell.tow[0].spacing;
  std::vector<OnFace> face;  // near the places asked for: an edge and the first cut
  for (int i = 0; i <= 200; ++i)
    for (int j = 0; j <= 400; ++j)
      for (double side : {-1.0, 1.0}) {
        const double angle = std::acos(-1.0) * (j / 400.0 - 0.5);
        face.push_back(on_face(cell, tow, cut + i * 0.005e-3, half * std::sin(angle), side));
      }
  const auto nearest = [&](const std::array<double, 3>& q) {
    double best = 1e300;
    for (const OnFace& p : face)
      best = std::min(best, std::hypot(p.place[0] - q[0], p.place[1] - q[1], p.place[2] - q[2]));
    return best;
  };
  const auto at = [&](double along, double across, double up) {
    const auto xy = cell.place(along, across);
    return std::array<double, 3>{xy[0], xy[1], warp_centre(cell, 0, along) + up};
  };
  for (const auto& q : {at(cut + 0.5e-3, half + 0.1e-3, 0.02e-3), at(cut + 0.5e-3, -half - 0.05e-3, -0.1e-3),
                        at(cut - 0.1e-3, half + 0.05e-3, 0.0), at(cut - 0.05e-3, 0.2e-3, 0.45e-3)})
    CHECK(tow_distance(cell, tow, q) == Approx(nearest(q)).margin(1.5e-6));
  // Straight out of the cut, and just inside it.
  const double across_cut = std::cos(cell.shear_angle);
  CHECK(tow_distance(cell, tow, at(cut - 0.1e-3, 0.0, 0.0)) == Approx(0.1e-3 * across_cut));
  CHECK(tow_distance(cell, tow, at(cut + 0.1e-3, 0.0, 0.0)) == Approx(-0.1e-3 * across_cut));
}

TEST_CASE("tows as level sets have the volume of their closed form", "[mesoscale][level_set]") {
  const double angle = radians(GENERATE(0.0, 25.0));
  const UnitCell cell = unit_cell(table1(), angle);
  const LevelSetCheck check = level_set_check(cell, 0.1e-3);
  REQUIRE(check.tow_volume.size() == 4);
  CHECK(check.closed_form_volume[0] ==
        Approx(2.0 * area(cell.tow[0].section) * cell.tow[0].spacing * std::cos(angle)));
  CHECK(check.closed_form_total == Approx(4.0 * check.closed_form_volume[0]));
  // Sharp edges and cuts are rounded over a voxel.
  for (double v : check.tow_volume) CHECK(v == Approx(check.closed_form_volume[0]).epsilon(0.015));
  const double fine = volume(tow_level_set(cell, {TowDirection::weft, 1}, 0.05e-3));
  CHECK(fine == Approx(check.closed_form_volume[0]).epsilon(0.005));
}

TEST_CASE("lens tows on arcs share no voxel; the height fields share nothing either",
          "[mesoscale][level_set]") {
  const double angle = radians(GENERATE(0.0, 25.0));
  const UnitCell cell = unit_cell(table1(), angle);
  const LevelSetCheck check = level_set_check(cell, 0.1e-3);
  CHECK(check.overlap_share <= 1e-4);
  CHECK(check.overlap_volume == 0.0);
  CHECK(check.largest_depth <= 1e-9);
  CHECK(check.largest_depth > -0.1e-3);  // they do meet
  CHECK(penetration(cell, 100).volume == Approx(0.0).margin(1e-20));
}

TEST_CASE("elliptic tows on sines share 7 percent of a tow, by height fields and by level sets alike",
          "[mesoscale][level_set]") {
  const UnitCell cell = ellipse_on_sine();
  const LevelSetCheck check = level_set_check(cell, 0.1e-3);
  const double tow_per_pitch = area(cell.tow[0].section) * cell.tow[0].spacing;
  CHECK(check.overlap_volume / 4.0 / tow_per_pitch == Approx(0.07).margin(0.01));
  CHECK(check.overlap_volume == Approx(penetration(cell, 100).volume).epsilon(0.03));
  CHECK(check.overlap_share == Approx(check.overlap_volume / check.closed_form_total));
  CHECK(check.largest_depth > 1e-5);
}

TEST_CASE("a voxel that cannot hold a tow is refused", "[mesoscale][level_set]") {
  for (const double voxel : {0.2e-3, 0.0}) {
    try {
      level_set_check(unit_cell(table1(), 0.0), voxel);
      FAIL("was accepted");
    } catch (const InputError& error) {
      CHECK(error.problems().front().id == "level_set.voxel.range");
    }
  }
}
