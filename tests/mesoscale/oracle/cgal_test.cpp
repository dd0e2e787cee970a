// Bodies of tows by CGAL's exact kernel, against closed forms, height fields and level sets.
#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/clip.h>
#include <CGAL/Polygon_mesh_processing/connected_components.h>
#include <CGAL/Polygon_mesh_processing/corefinement.h>
#include <CGAL/Polygon_mesh_processing/measure.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Surface_mesh.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "../table1.h"
#include "mesoscale/level_set.h"
#include "mesoscale/pictures.h"

using namespace heddle;
using namespace heddle::mesoscale;
using heddle::test::ellipse_on_sine;
using heddle::test::radians;
using heddle::test::table1;

namespace {

using Kernel = CGAL::Exact_predicates_exact_constructions_kernel;
using Body = CGAL::Surface_mesh<Kernel::Point_3>;
namespace pmp = CGAL::Polygon_mesh_processing;

// The tows of one repeat, warps first, each a closed body of flat triangles.
std::vector<Body> tow_bodies_of(const UnitCell& cell, int along, int across) {
  const TriangleMesh mesh = tow_surfaces(cell, along, across).mesh;
  Body all;
  std::vector<Body::Vertex_index> vertex;
  for (const auto& v : mesh.vertices) vertex.push_back(all.add_vertex({v[0], v[1], v[2]}));
  for (const auto& t : mesh.triangles)
    all.add_face(vertex[static_cast<std::size_t>(t[0])], vertex[static_cast<std::size_t>(t[1])],
                 vertex[static_cast<std::size_t>(t[2])]);
  std::vector<Body> tows;
  pmp::split_connected_components(all, tows);
  return tows;
}

double volume_of(const Body& body) {
  return CGAL::to_double(pmp::volume(body));
}

// Exact volume that two bodies share.
double shared_volume(Body a, Body b) {
  if (!pmp::do_intersect(a, b)) return 0.0;
  Body both;
  REQUIRE(pmp::corefine_and_compute_intersection(a, b, both));
  return volume_of(both);
}

// What warps and wefts of the repeat share. Bodies are cut at the first crossing and a repeat further on: of
// the four crossings of a plain weave one stands whole, two by half and one by a quarter.
double shared_by_crossings(const UnitCell& cell, int along, int across) {
  const std::vector<Body> tows = tow_bodies_of(cell, along, across);
  REQUIRE(tows.size() == 4);
  double shared = 0.0;
  for (std::size_t warp = 0; warp < 2; ++warp)
    for (std::size_t weft = 2; weft < 4; ++weft) shared += shared_volume(tows[warp], tows[weft]);
  return shared / 2.25;
}

}  // namespace

TEST_CASE("tows are bodies that do not cut themselves, sheared or not, by exact predicates",
          "[oracle][level_set]") {
  const UnitCell cell =
      GENERATE(unit_cell(table1(), 0.0), unit_cell(table1(), radians(40.0)), ellipse_on_sine());
  for (const Body& tow : tow_bodies_of(cell, 16, 8)) {
    CHECK(CGAL::is_closed(tow));
    CHECK_FALSE(pmp::does_self_intersect(tow));
  }
}

TEST_CASE("the exact volume of a tow tends to its closed form with the square of the facet, as do level sets",
          "[oracle][level_set]") {
  const double angle = radians(GENERATE(0.0, 25.0));
  const UnitCell cell = unit_cell(table1(), angle);
  const double closed_form = 2.0 * area(cell.tow[0].section) * cell.tow[0].spacing * std::cos(angle);
  std::vector<double> error;
  for (const int across : {8, 16, 32})
    error.push_back(1.0 - volume_of(tow_bodies_of(cell, 2 * across, across)[0]) / closed_form);
  CAPTURE(error);
  CHECK(std::log2(error[0] / error[1]) == Approx(2.0).margin(0.1));
  CHECK(std::log2(error[1] / error[2]) == Approx(2.0).margin(0.1));
  const double extrapolated = error[2] - (error[1] - error[2]) / 3.0;
  CHECK(std::abs(extrapolated) < 1e-4);
  // A body is cut elsewhere than a level set, but the repeat is the same.
  CHECK(volume(tow_level_set(cell, {TowDirection::warp, 0}, 0.05e-3)) == Approx(closed_form).epsilon(5e-3));
}

TEST_CASE("clipped at a crossing, a tow of two pitches leaves half of its volume exactly", "[oracle]") {
  const UnitCell cell = unit_cell(table1(), 0.0);
  Body tow = tow_bodies_of(cell, 16, 8)[0];
  const double whole = volume_of(tow);
  pmp::clip(tow, Kernel::Plane_3(1.0, 0.0, 0.0, -cell.tow[1].spacing), CGAL::parameters::clip_volume(true));
  CHECK(CGAL::is_closed(tow));
  CHECK(volume_of(tow) == Approx(0.5 * whole).epsilon(1e-9));
}

TEST_CASE("elliptic tows on sines share what height fields and level sets say, by exact intersection",
          "[oracle][level_set]") {
  const UnitCell cell = ellipse_on_sine();
  const double of_heights = penetration(cell, 100).volume / 4.0;  // a crossing
  const double exact = shared_by_crossings(cell, 24, 24);
  CHECK(exact == Approx(of_heights).epsilon(0.02));
  CHECK(exact == Approx(level_set_check(cell, 0.1e-3).overlap_volume / 4.0).epsilon(0.04));
}

TEST_CASE("what facets of lens tows on arcs share goes to nothing with the square of the facet",
          "[oracle][level_set]") {
  // The closed forms touch; chords of the path cut into the tow under it by their sagitta.
  const UnitCell cell = unit_cell(table1(), 0.0);
  const double tow = area(cell.tow[0].section) * cell.tow[0].spacing;
  const double coarse = shared_by_crossings(cell, 8, 8), fine = shared_by_crossings(cell, 16, 16);
  CAPTURE(coarse / tow, fine / tow);
  CHECK(coarse < 5e-3 * tow);
  CHECK(fine < 0.4 * coarse);
}
