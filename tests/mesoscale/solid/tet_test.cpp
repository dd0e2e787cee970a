// The voxel plate against tetrahedra that follow the tows, solved by CHOLMOD.
#include <Eigen/LU>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <iostream>
#include <map>
#include <numbers>

#include "mesoscale/solid/woven_solid.h"
#include "sample_cells.h"
#include "tet_cell.h"

using namespace heddle::mesoscale;
using namespace heddle::mesoscale::solid;
using namespace heddle::test;

namespace {

struct Sheet {
  WeaveMatrix weave;
  PressedFabric fabric;
};
Sheet sheet(double angle) {
  const FabricGeometry fabric = fabric_geometry(WeaveSpec{}, CellState::consolidated);
  return {fabric.weave, pressed(fabric, angle)};
}

Matrix6 by_tets(const Sheet& s, int per_tow, int over_tow, const IsotropicPhase& resin) {
  std::array<Matrix6, 3> phases{stiffness(resin)};
  for (std::size_t i = 0; i < 2; ++i)
    phases[i + 1] = stiffness(chamis(glass, resin, s.fabric.crossing.tow[i].fibre_fraction));
  return plate_of_tets(tet_cell(unit_cell(s.weave, s.fabric.crossing), s.fabric.thickness, per_tow, over_tow),
                       phases);
}

PlateStiffness by_voxels(const Sheet& s, int per_pitch, int layers) {
  SolidSpec spec;
  spec.grid = {.per_pitch = per_pitch, .layers = layers};
  const WovenSolid solid = woven_solid(s.weave, s.fabric, glass.modulus, spec);
  PlateStiffness plate = plate_stiffness(elastic_cell(solid.cell, solid.stiffness), spec.solver);
  REQUIRE(plate.solver.converged);
  return plate;
}

}  // namespace

TEST_CASE("tetrahedra fill the repeat, share every face with one neighbour and hold the tows' volume",
          "[solid][tetrahedra]") {
  const Sheet s = sheet(GENERATE(0.0, 25.0) * std::numbers::pi / 180.0);
  const UnitCell cell = unit_cell(s.weave, s.fabric.crossing);
  const TetCell mesh = tet_cell(cell, s.fabric.thickness, 10, 3);
  CHECK(mesh.volume == Approx(mesh.area * mesh.height).epsilon(1e-12));
  std::map<std::array<int, 3>, int> faces;
  double tows = 0.0;
  for (const auto& tet : mesh.tetrahedra) {
    for (std::size_t left_out = 0; left_out < 4; ++left_out) {
      std::array<int, 3> face{};
      for (std::size_t n = 0, k = 0; n < 4; ++n)
        if (n != left_out) face[k++] = tet.node[n];
      std::sort(face.begin(), face.end());
      ++faces[face];
    }
    if (tet.phase == 0) continue;
    Eigen::Matrix3d sides;
    for (int n = 0; n < 3; ++n)
      for (int axis = 0; axis < 3; ++axis)
        sides(axis, n) = tet.place[static_cast<std::size_t>(n) + 1][static_cast<std::size_t>(axis)] -
                         tet.place[0][static_cast<std::size_t>(axis)];
    tows += std::abs(sides.determinant()) / 6.0;
  }
  // Faces with one tetrahedron lie on the floor and on the roof: two triangles of lines each.
  std::size_t alone = 0;
  for (const auto& [face, count] : faces) {
    REQUIRE(count <= 2);
    if (count == 2) continue;
    ++alone;
    const double z = mesh.nodes[static_cast<std::size_t>(face[0])].height;
    REQUIRE(std::abs(std::abs(z) - 0.5 * mesh.height) < 1e-12);
    for (const int node : face) REQUIRE(mesh.nodes[static_cast<std::size_t>(node)].height == z);
  }
  CHECK(alone == 4 * 24 * 24);
  // Chords of ten columns are within the section: 1 - O(h^2).
  const double closed_form =
      4.0 * area(cell.tow[0].section) * 2.0 * cell.tow[0].spacing * std::cos(cell.shear_angle);
  CHECK(tows == Approx(closed_form).epsilon(0.015));
}

TEST_CASE("tetrahedra of one material are a plate of it: A exactly, D from above", "[solid][tetrahedra]") {
  const Sheet s = sheet(25.0 * std::numbers::pi / 180.0);
  const Matrix6 resin = stiffness(polypropylene);
  const Matrix6 plate = plate_of_tets(
      tet_cell(unit_cell(s.weave, s.fabric.crossing), s.fabric.thickness, 10, 3), {resin, resin, resin});
  const double nu = polypropylene.poisson, e = polypropylene.modulus / (1.0 - nu * nu);
  Eigen::Matrix3d q;
  q << e, nu * e, 0.0, nu * e, e, 0.0, 0.0, 0.0, polypropylene.shear();
  CHECK(gap(plate.topLeftCorner<3, 3>(), s.fabric.thickness * q) < 1e-9);
  const Eigen::Matrix3d d = std::pow(s.fabric.thickness, 3) / 12.0 * q;
  CHECK(plate(3, 3) > d(0, 0));
  CHECK(gap(plate.bottomRightCorner<3, 3>(), d) < 0.1);
}

TEST_CASE("the sheet of Table 1 by coarse tetrahedra is a little stiffer than by voxels, and shears alike",
          "[solid][tetrahedra]") {
  const Sheet s = sheet(0.0);
  const Matrix6 tets = by_tets(s, 10, 2, polypropylene);
  const PlateStiffness voxels = by_voxels(s, 16, 12);
  CAPTURE(tets(0, 0), voxels.a(0, 0), tets(2, 2), voxels.a(2, 2), tets(3, 3), voxels.d(0, 0));
  // Linear displacements cannot bend the tow within an element: 6 % at ten columns a tow.
  CHECK(tets(0, 0) > voxels.a(0, 0));
  CHECK(tets(0, 0) < 1.07 * voxels.a(0, 0));
  CHECK(tets(2, 2) == Approx(voxels.a(2, 2)).epsilon(0.01));
  CHECK(tets(3, 3) == Approx(voxels.d(0, 0)).epsilon(0.04));
}

TEST_CASE("the sheet of Table 1 by fine voxels and by tetrahedra is the same within one percent",
          "[solid][tetrahedra][slow]") {
  const double angle = GENERATE(0.0, 30.0) * std::numbers::pi / 180.0;
  const Sheet s = sheet(angle);
  const PlateStiffness voxels = by_voxels(s, 32, 32);
  // Linear tetrahedra are too stiff by a share that falls with the square of their size: two meshes and the
  // rest by extrapolation.
  const Matrix6 coarse = by_tets(s, 14, 3, polypropylene), fine = by_tets(s, 28, 6, polypropylene);
  const Matrix6 limit = fine + (fine - coarse) / 3.0;
  for (const auto& [i, j] : {std::pair{0, 0}, {1, 1}, {0, 1}, {2, 2}, {3, 3}, {4, 4}, {5, 5}}) {
    std::cout << "angle " << angle * 180.0 / std::numbers::pi << " deg, (" << i << "," << j
              << "): tetrahedra " << coarse(i, j) << ", " << fine(i, j) << ", limit " << limit(i, j)
              << ", voxels " << voxels.all(i, j) << "\n";
    CHECK(std::abs(limit(i, j) - voxels.all(i, j)) < (i < 3 ? 0.01 : 0.02) * std::abs(limit(i, i)));
  }
}
