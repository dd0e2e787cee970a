#include "macroscale/mesh_distance.h"

#include <cmath>
#include <cstdint>

#include <CGAL/AABB_face_graph_triangle_primitive.h>
#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Side_of_triangle_mesh.h>
#include <CGAL/Surface_mesh.h>

#include "core/problem.h"
#include "macroscale/mesh_check.h"

namespace heddle::macroscale {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Surface = CGAL::Surface_mesh<Kernel::Point_3>;
using Tree = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, CGAL::AABB_face_graph_triangle_primitive<Surface>>>;
using Side = CGAL::Side_of_triangle_mesh<Surface, Kernel>;

Surface closed_surface(const TriangleMesh& mesh) {
  if (Problems problems = check(mesh, "mesh", "", TopologyRule::closed); !problems.empty())
    throw InputError(std::move(problems));
  Surface surface;
  for (const auto& p : mesh.vertices) surface.add_vertex({p[0], p[1], p[2]});
  const auto vertex = [](int i) { return Surface::Vertex_index(static_cast<std::uint32_t>(i)); };
  for (const auto& t : mesh.triangles) surface.add_face(vertex(t[0]), vertex(t[1]), vertex(t[2]));
  return surface;
}

Kernel::Point_3 point(const Eigen::Vector3d& x) {
  return {x[0], x[1], x[2]};
}

}  // namespace

struct MeshDistance::Trees {
  Surface surface;
  Tree tree;
  Side side;

  explicit Trees(const TriangleMesh& mesh)
      : surface(closed_surface(mesh)),
        tree(faces(surface).first, faces(surface).second, surface),
        side(tree) {
    // Both at once, so that no query builds anything: queries then only read.
    tree.build();
    tree.accelerate_distance_queries();
    side(*surface.points().begin());
  }
};

MeshDistance::MeshDistance(const TriangleMesh& mesh) : trees_(std::make_unique<Trees>(mesh)) {}
MeshDistance::~MeshDistance() = default;
MeshDistance::MeshDistance(MeshDistance&&) noexcept = default;
MeshDistance& MeshDistance::operator=(MeshDistance&&) noexcept = default;

double MeshDistance::signed_distance(const Eigen::Vector3d& x) const {
  const double distance = std::sqrt(trees_->tree.squared_distance(point(x)));
  return trees_->side(point(x)) == CGAL::ON_BOUNDED_SIDE ? -distance : distance;
}

Eigen::Vector3d MeshDistance::closest_point(const Eigen::Vector3d& x) const {
  const Kernel::Point_3 p = trees_->tree.closest_point(point(x));
  return {p.x(), p.y(), p.z()};
}

}  // namespace heddle::macroscale
