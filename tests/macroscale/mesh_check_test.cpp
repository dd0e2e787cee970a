#include <catch2/catch.hpp>
#include <random>

#include "macroscale/mesh_check.h"
#include "macroscale/mesh_distance.h"
#include "macroscale/mesh_repair.h"
#include "tests/macroscale/sample_meshes.h"

using namespace heddle;
using namespace heddle::macroscale;
using namespace heddle::test;

namespace {

const std::string key = "tools.punch";

Problems found(const TriangleMesh& mesh, TopologyRule rule = TopologyRule::closed) {
  Problems problems = check(mesh, key, "punch.stl", rule);
  INFO(format(problems));
  return problems;
}

/// One problem of this kind and no other, with these words.
void require_only(const TriangleMesh& mesh, const std::string& id, const std::vector<std::string>& words) {
  const Problems problems = found(mesh);
  INFO(format(problems));
  CHECK(problems.size() == 1);
  CHECK(names(problems, key + "." + id, words));
}

TriangleMesh without_first(TriangleMesh mesh) {
  mesh.triangles.erase(mesh.triangles.begin());
  return mesh;
}

/// Each triangle with three vertices of its own, as STL holds them.
TriangleMesh soup(const TriangleMesh& mesh, double shift = 0.0) {
  TriangleMesh result;
  for (const auto& t : mesh.triangles) {
    const int n = static_cast<int>(result.vertices.size());
    for (int vertex : t) {
      auto p = mesh.vertices[vertex];
      p[0] += shift * (n % 7 - 3);
      result.vertices.push_back(p);
    }
    result.triangles.push_back({n, n + 1, n + 2});
  }
  return result;
}

}  // namespace

TEST_CASE("sound meshes pass", "[macroscale][mesh]") {
  CHECK(found(cube(0.1)).empty());
  CHECK(found(sphere(0.07, 20, 40)).empty());
  TriangleMesh two = cube(0.1);
  CHECK(found(append(two, cube(0.1, {0.2, 0, 0}))).empty());
  TriangleMesh hollow = cube(0.1);  // a cavity is inside out by itself and right inside a solid
  CHECK(found(append(hollow, inside_out(cube(0.02, {0.04, 0.04, 0.04})))).empty());
  CHECK(found(without_first(cube(0.1)), TopologyRule::open_allowed).empty());
}

TEST_CASE("each fault of a mesh is named with its place and a way out", "[macroscale][mesh]") {
  const std::string offer = "`tools.punch.repair: on` mends it", no_offer = "No safe repair";
  CHECK(names(found({}), key + ".empty", {"none"}));

  TriangleMesh mesh = cube(0.1);
  mesh.triangles[3][1] = 8;
  require_only(mesh, "index", {"0 to 7", "8"});

  mesh = cube(0.1);
  mesh.vertices[5][2] = std::nan("");
  require_only(mesh, "finite", {"1 vertex has not", "vertex 5"});

  require_only(without_first(cube(0.1)), "closed", {"3 edges have only one triangle", "mm", no_offer});

  mesh = cube(0.1);  // a fin on the edge from vertex 1 to vertex 3
  mesh.vertices.push_back({0.2, 0.05, 0.0});
  mesh.triangles.push_back({1, 3, 8});
  CHECK(names(found(mesh), key + ".edge_manifold",
              {"1 edge has more, the first at (100, 50, 0) mm", no_offer}));

  mesh = cube(0.1);
  std::swap(mesh.triangles[4][0], mesh.triangles[4][1]);
  require_only(mesh, "oriented", {"at 3 edges", offer, "turns 1 triangle"});

  require_only(inside_out(cube(0.1)), "outward", {"1 of 1 piece is inside out", offer, "turns 12 triangles"});

  mesh = cube(0.1);  // two cubes that share vertex 7 of the first
  TriangleMesh other = cube(0.1, {0.1, 0.1, 0.1});
  append(mesh, other);
  for (auto& t : mesh.triangles) {
    for (int& vertex : t) vertex = vertex == 8 ? 7 : vertex;
  }
  require_only(mesh, "vertex_manifold", {"at 1 vertex", "(100, 100, 100) mm", no_offer});

  mesh = cube(0.1);
  require_only(append(mesh, cube(0.1, {0.05, 0.05, 0.05})), "self_intersection",
               {"pairs of triangles do", "mm", no_offer});

  mesh = cube(0.1);
  append(mesh, cube(0.1));
  require_only(mesh, "repeated",
               {"12 are there again", offer, "merges 8 vertices", "drops 12 repeated triangles"});

  mesh = cube(0.1);
  mesh.triangles.push_back({2, 2, 3});
  CHECK(names(found(mesh), key + ".degenerate",
              {"1 has none, the first at", offer, "drops 1 triangle without area"}));
}

TEST_CASE("a flat triangle on an edge is joined to its neighbour, not dropped", "[macroscale][mesh]") {
  TriangleMesh mesh = cube(0.1);
  mesh.vertices.push_back({0.05, 0.0, 0.0});  // in the middle of edge 0-1, which {0,3,1} and {0,1,5} share
  mesh.triangles.push_back({0, 1, 8});        // the flat one, in place of the edge's turn towards {0,1,5}
  mesh.triangles[4] = {0, 8, 5};
  mesh.triangles.push_back({8, 1, 5});
  const Problems problems = found(mesh);
  INFO(format(problems));
  CHECK(names(problems, key + ".degenerate", {"(50, 0, 0) mm", "joins 1 flat triangle"}));
  const Repair repair = repaired(mesh);
  CHECK(repair.flipped_caps == 1);
  CHECK(found(repair.mesh).empty());
  CHECK(mesh_volume(repair.mesh) == Approx(1e-3).epsilon(1e-12));
}

TEST_CASE("repairs mend what they offer and leave sound meshes alone", "[macroscale][mesh]") {
  const TriangleMesh sound = sphere(0.07, 12, 24);
  const Repair nothing = repaired(sound);
  CHECK_FALSE(nothing.changed());
  CHECK(summary(nothing) == "changes nothing");
  CHECK(nothing.mesh.triangles.size() == sound.triangles.size());

  // Unmerged, with vertices off by 1e-8 m as single precision leaves them, some triangles turned, inside out.
  TriangleMesh broken = inside_out(soup(sound, 1e-8));
  for (std::size_t t = 0; t < broken.triangles.size(); t += 5)
    std::swap(broken.triangles[t][0], broken.triangles[t][1]);
  CHECK(names(found(broken), key + ".closed",
              {"edges have only one triangle", "`tools.punch.repair: on` mends it"}));
  const Repair repair = repaired(broken);
  CHECK(found(repair.mesh).empty());
  CHECK(repair.mesh.vertices.size() == sound.vertices.size());
  CHECK(mesh_volume(repair.mesh) == Approx(mesh_volume(sound)).epsilon(1e-5));
  CHECK(summary(repair) ==
        fmt::format("merges {} vertices, turns {} triangles", repair.merged_vertices, repair.turned));

  TriangleMesh hollow = cube(0.1);  // the cavity keeps its turn, the outer skin gets it back
  append(hollow, inside_out(cube(0.02, {0.04, 0.04, 0.04})));
  CHECK(names(found(inside_out(hollow)), key + ".outward", {"`tools.punch.repair: on` mends it"}));
  const Repair turned = repaired(inside_out(hollow));
  CHECK(turned.turned == 24);
  CHECK(found(turned.mesh).empty());
  CHECK(mesh_volume(turned.mesh) == Approx(1e-3 - 8e-6));
}

TEST_CASE("distance to a mesh: a cube's is exact, a sphere's within its facets", "[macroscale][mesh]") {
  const MeshDistance box(cube(0.1));
  CHECK(box.signed_distance({0.05, 0.05, 0.12}) == Approx(0.02).epsilon(1e-12));
  CHECK(box.signed_distance({0.05, 0.05, 0.07}) == Approx(-0.03).epsilon(1e-12));
  CHECK(box.signed_distance({-0.03, -0.04, 0.05}) == Approx(0.05).epsilon(1e-12));
  CHECK((box.closest_point({0.2, 0.05, 0.05}) - Eigen::Vector3d(0.1, 0.05, 0.05)).norm() < 1e-15);

  const double radius = 0.07;
  const MeshDistance ball(sphere(radius, 60, 120));
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(-0.1, 0.1);
  double rms = 0.0, worst = 0.0;
  constexpr int n = 500;
  for (int i = 0; i < n; ++i) {
    const Eigen::Vector3d x(uniform(random), uniform(random), radius + uniform(random));
    const double gap = ball.signed_distance(x) - ((x - Eigen::Vector3d(0, 0, radius)).norm() - radius);
    rms += gap * gap / n;
    worst = std::max(worst, std::abs(gap));
    CHECK(gap > -1e-12);  // facets lie inside the sphere
  }
  // Sagitta of a cell of 3 by 3 degrees: R/8 (2 (pi/60)^2) = 48 um.
  CHECK(worst < 48e-6);
  CHECK(std::sqrt(rms) < 30e-6);
  CHECK(worst > 5e-6);  // and they are facets

  CHECK_THROWS_AS(MeshDistance(without_first(cube(0.1))), InputError);
}
