// The voxel plate against quadratic tetrahedra of gmsh that follow the tows, solved by CHOLMOD.
#include <Eigen/LU>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <iostream>
#include <map>
#include <numbers>

#include "gmsh_plate.h"
#include "mesoscale/solid/woven_solid.h"
#include "tests/mesoscale/solid/sample_cells.h"

using namespace heddle::mesoscale;
using namespace heddle::mesoscale::solid;
using namespace heddle::test;

namespace {

struct Sheet {
  WeaveMatrix weave;
  PressedFabric fabric;
  UnitCell cell() const { return unit_cell(weave, fabric.crossing); }
};
Sheet sheet(double degrees) {
  const FabricGeometry fabric = fabric_geometry(WeaveSpec{}, CellState::consolidated);
  return {fabric.weave, pressed(fabric, degrees * std::numbers::pi / 180.0)};
}

GmshCell mesh_of(const Sheet& s, int per_tow, int over_tow) {
  const UnitCell cell = s.cell();
  return gmsh_cell(cell, tet_cell(cell, s.fabric.thickness, per_tow, over_tow));
}

Matrix6 by_tetrahedra(const Sheet& s, int per_tow, int over_tow) {
  std::array<Matrix6, 3> phases{stiffness(polypropylene)};
  for (std::size_t i = 0; i < 2; ++i)
    phases[i + 1] = stiffness(chamis(glass, polypropylene, s.fabric.crossing.tow[i].fibre_fraction));
  return plate_of(mesh_of(s, per_tow, over_tow), phases);
}

PlateStiffness by_voxels(const Sheet& s, int per_pitch, int layers) {
  SolidSpec spec;
  spec.grid = {.per_pitch = per_pitch, .layers = layers};
  const WovenSolid solid = woven_solid(s.weave, s.fabric, glass.modulus, spec);
  PlateStiffness plate = plate_stiffness(elastic_cell(solid.cell, solid.stiffness), spec.solver);
  REQUIRE(plate.solver.converged);
  return plate;
}

// Faces that belong to one tetrahedron of a periodic mesh: those of floor and roof.
template <class Tetrahedron>
std::vector<std::array<int, 3>> faces_alone(const std::vector<Tetrahedron>& tetrahedra) {
  std::map<std::array<int, 3>, int> faces;
  for (const auto& tet : tetrahedra)
    for (std::size_t left_out = 0; left_out < 4; ++left_out) {
      std::array<int, 3> face{};
      for (std::size_t n = 0, k = 0; n < 4; ++n)
        if (n != left_out) face[k++] = tet.node[n];
      std::sort(face.begin(), face.end());
      ++faces[face];
    }
  std::vector<std::array<int, 3>> alone;
  for (const auto& [face, count] : faces) {
    REQUIRE(count <= 2);
    if (count == 1) alone.push_back(face);
  }
  return alone;
}

double tow_volume(const UnitCell& cell) {
  return 4.0 * area(cell.tow[0].section) * 2.0 * cell.tow[0].spacing * std::cos(cell.shear_angle);
}

}  // namespace

TEST_CASE("lines of nodes fill the repeat with tetrahedra that share every face with one neighbour",
          "[solid][tetrahedra]") {
  const Sheet s = sheet(GENERATE(0.0, 25.0));
  const TetCell mesh = tet_cell(s.cell(), s.fabric.thickness, 10, 3);
  CHECK(mesh.volume == Approx(mesh.area * mesh.height).epsilon(1e-12));
  // Floor and roof: two triangles of lines each.
  const auto alone = faces_alone(mesh.tetrahedra);
  CHECK(alone.size() == 4 * 24 * 24);
  for (const auto& face : alone) {
    const double z = mesh.nodes[static_cast<std::size_t>(face[0])].height;
    REQUIRE(std::abs(std::abs(z) - 0.5 * mesh.height) < 1e-12);
    for (const int node : face) REQUIRE(mesh.nodes[static_cast<std::size_t>(node)].height == z);
  }
}

TEST_CASE("gmsh's tetrahedra share every face across tows, gaps and periodic sides and hold the tows' volume",
          "[solid][tetrahedra]") {
  const Sheet s = sheet(GENERATE(0.0, 25.0));
  const UnitCell cell = s.cell();
  const GmshCell mesh = mesh_of(s, 10, 3);
  CHECK(mesh.volume[0] + mesh.volume[1] + mesh.volume[2] ==
        Approx(mesh.area * s.fabric.thickness).epsilon(1e-12));
  // Chords of ten columns are within the section: 1 - O(h^2).
  CHECK(mesh.volume[1] + mesh.volume[2] == Approx(tow_volume(cell)).epsilon(0.015));
  CHECK(mesh.volume[1] + mesh.volume[2] < tow_volume(cell));
  // The faces that gmsh was given on floor and roof, and no other.
  CHECK(faces_alone(mesh.tetrahedra).size() == 4 * 24 * 24);
  CHECK(mesh.regions == 5);  // four tows and the resin, in one piece round the contact faces
  CHECK(mesh.worst > 1e-4);
}

TEST_CASE("quadratic tetrahedra of one material are a plate of it, A and D exactly", "[solid][tetrahedra]") {
  const Sheet s = sheet(25.0);
  const Matrix6 resin = stiffness(polypropylene);
  const Matrix6 plate = plate_of(mesh_of(s, 6, 2), {resin, resin, resin});
  const double nu = polypropylene.poisson, e = polypropylene.modulus / (1.0 - nu * nu);
  Eigen::Matrix3d q;
  q << e, nu * e, 0.0, nu * e, e, 0.0, 0.0, 0.0, polypropylene.shear();
  CHECK(gap(plate.topLeftCorner<3, 3>(), s.fabric.thickness * q) < 1e-9);
  CHECK(gap(plate.bottomRightCorner<3, 3>(), std::pow(s.fabric.thickness, 3) / 12.0 * q) < 1e-9);
}

TEST_CASE("the sheet of Table 1 by voxels is that by gmsh's tetrahedra", "[solid][tetrahedra][slow]") {
  const double angle = GENERATE(0.0, 30.0);
  const Sheet s = sheet(angle);
  // Both are off by the square of their size, the tetrahedra by the chords of the tows' faces: two sizes of
  // each, and the rest by extrapolation.
  const Matrix6 coarse = by_tetrahedra(s, 8, 2), fine = by_tetrahedra(s, 16, 4);
  const Matrix6 limit = fine + (fine - coarse) / 3.0;
  const Matrix6 coarse_voxels = by_voxels(s, 24, 24).all, fine_voxels = by_voxels(s, 48, 48).all;
  const Matrix6 voxels = fine_voxels + (fine_voxels - coarse_voxels) / 3.0;
  for (const auto& [i, j] : {std::pair{0, 0}, {1, 1}, {0, 1}, {2, 2}, {3, 3}, {4, 4}, {3, 4}, {5, 5}}) {
    std::cout << "angle " << angle << " deg, (" << i << "," << j << "): tetrahedra " << coarse(i, j) << ", "
              << fine(i, j) << ", limit " << limit(i, j) << "; voxels " << coarse_voxels(i, j) << ", "
              << fine_voxels(i, j) << ", limit " << voxels(i, j) << "\n";
    CHECK(std::abs(limit(i, j) - voxels(i, j)) < 0.005 * std::abs(limit(i, i)));
  }
}
