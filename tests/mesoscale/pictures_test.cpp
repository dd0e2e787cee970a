#include "mesoscale/pictures.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <string>
#include <utility>

#include "table1.h"

using namespace heddle::mesoscale;
using heddle::test::radians;
using heddle::test::table1;

TEST_CASE("tow surfaces are closed: every edge is run once each way", "[pictures]") {
  const TowSurfaces surfaces = tow_surfaces(unit_cell(table1(), radians(25.0)), 8, 6);
  const heddle::TriangleMesh& mesh = surfaces.mesh;
  std::map<std::pair<int, int>, int> edges;
  for (const auto& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) ++edges[{t[k], t[(k + 1) % 3]}];
  for (const auto& [edge, count] : edges) {
    REQUIRE(count == 1);
    REQUIRE(edges.count({edge.second, edge.first}) == 1);
  }
  // Four tows, two warps first, whose triangles share no vertex.
  REQUIRE(surfaces.tow.size() == mesh.triangles.size());
  std::map<int, int> owner;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (const int v : mesh.triangles[t])
      CHECK(owner.try_emplace(v, surfaces.tow[t]).first->second == surfaces.tow[t]);
  CHECK(surfaces.tow.front() == 1);
  CHECK(surfaces.tow.back() == 4);
}

TEST_CASE("tow surfaces enclose section area times pitch and point outwards", "[pictures]") {
  const double angle = radians(GENERATE(0.0, 25.0));
  const UnitCell cell = unit_cell(table1(), angle);
  const double expected = 4.0 * 2.0 * area(cell.tow[0].section) * cell.tow[0].spacing * std::cos(angle);
  CHECK(volume(tow_surfaces(cell, 12, 60).mesh) == Approx(expected).epsilon(0.002));
}

TEST_CASE("a cut along a warp shows it as a band and every weft as a section", "[pictures]") {
  const std::vector<Outline> cut = warp_cut(unit_cell(table1(), 0.0));
  REQUIRE(cut.size() == 4);  // one warp, two wefts and the first again
  CHECK(cut[0].tow == TowDirection::warp);
  CHECK(cut[1].tow == TowDirection::weft);
  double highest = 0.0, lowest = 0.0;
  for (const Outline& outline : cut)
    for (const auto& point : outline.points) {
      highest = std::max(highest, point[1]);
      lowest = std::min(lowest, point[1]);
    }
  CHECK(highest == Approx(0.75e-3).epsilon(1e-12));
  CHECK(lowest == Approx(-0.75e-3).epsilon(1e-12));
}

TEST_CASE("voxels fill the tows' volume and stand under the right tow", "[pictures]") {
  const UnitCell cell = unit_cell(table1(), 0.0);
  const VoxelLabels voxels = tow_labels(cell, 64, 64);
  CHECK(voxels.count == std::array<int, 3>{128, 128, 64});
  CHECK(voxels.spacing[2] * voxels.count[2] == Approx(1.5e-3).epsilon(1e-12));
  const auto filled = std::count_if(voxels.labels.begin(), voxels.labels.end(), [](auto l) { return l > 0; });
  const double voxel = voxels.spacing[0] * voxels.spacing[1] * voxels.spacing[2];
  CHECK(static_cast<double>(filled) * voxel ==
        Approx(4.0 * 2.0 * area(cell.tow[0].section) * cell.tow[0].spacing).epsilon(0.005));

  const auto label = [&](int i, int j, int k) {
    return voxels.labels[static_cast<std::size_t>((k * voxels.count[1] + j) * voxels.count[0] + i)];
  };
  // The first crossing lies at the origin; the next along the weft, warp 1 over or under weft 0, at j = 64.
  const bool over = cell.weave.warp_over(0, 0);
  CHECK(label(0, 0, 63) == (over ? 1 : 3));
  CHECK(label(0, 0, 0) == (over ? 3 : 1));
  CHECK(label(0, 64, 63) == (over ? 3 : 2));
  CHECK(label(64, 0, 63) == (over ? 4 : 1));
  CHECK(label(32, 32, 32) == 0);
}
