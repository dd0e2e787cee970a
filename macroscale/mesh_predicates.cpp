#include "macroscale/mesh_predicates.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/orientation.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Surface_mesh.h>

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <numeric>

namespace heddle::macroscale {

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Surface = CGAL::Surface_mesh<Kernel::Point_3>;
namespace pmp = CGAL::Polygon_mesh_processing;

Kernel::Point_3 point(const Place& p) {
  return {p[0], p[1], p[2]};
}

Surface surface_of(const TriangleMesh& mesh) {
  Surface surface;
  const auto count = [](std::size_t n) { return static_cast<Surface::size_type>(n); };
  surface.reserve(count(mesh.vertices.size()), count(3 * mesh.triangles.size() / 2),
                  count(mesh.triangles.size()));
  for (const Place& p : mesh.vertices) surface.add_vertex(point(p));
  using Vertex = Surface::Vertex_index;
  for (const Triangle& t : mesh.triangles) {
    surface.add_face(Vertex(static_cast<std::uint32_t>(t[0])), Vertex(static_cast<std::uint32_t>(t[1])),
                     Vertex(static_cast<std::uint32_t>(t[2])));
  }
  return surface;
}

}  // namespace

bool degenerate(const TriangleMesh& mesh, const Triangle& t) {
  return CGAL::collinear(point(mesh.vertices[t[0]]), point(mesh.vertices[t[1]]), point(mesh.vertices[t[2]]));
}

std::vector<std::pair<std::size_t, std::size_t>> crossings(const TriangleMesh& mesh, std::size_t most) {
  std::vector<std::pair<Surface::Face_index, Surface::Face_index>> found;
  pmp::self_intersections(surface_of(mesh), std::back_inserter(found),
                          CGAL::parameters::maximum_number(static_cast<unsigned int>(most)));
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  for (const auto& [a, b] : found) pairs.emplace_back(std::minmax<std::size_t>(a.idx(), b.idx()));
  return pairs;
}

bool is_closed(const TriangleMesh& mesh) {
  return CGAL::is_closed(surface_of(mesh));
}

bool bounds_a_volume(const TriangleMesh& mesh) {
  return pmp::does_bound_a_volume(surface_of(mesh));
}

bool bounds_a_solid(const TriangleMesh& mesh, const std::vector<double>& six, bool several) {
  const double sum = std::accumulate(six.begin(), six.end(), 0.0);
  return sum > 0.0 && (!several || bounds_a_volume(mesh));
}

std::vector<std::size_t> turned_to_bound_a_volume(const TriangleMesh& mesh) {
  Surface surface = surface_of(mesh);
  pmp::orient_to_bound_a_volume(surface);
  std::vector<std::size_t> turned;
  for (const Surface::Face_index face : surface.faces()) {
    // The first half-edge of a face still says which way round it now runs.
    Triangle now{};
    int k = 0;
    for (const Surface::Vertex_index v : surface.vertices_around_face(surface.halfedge(face)))
      now[k++] = static_cast<int>(v.idx());
    const Triangle& t = mesh.triangles[face.idx()];
    const int at = static_cast<int>(std::find(now.begin(), now.end(), t[0]) - now.begin());
    if (now[(at + 1) % 3] != t[1]) turned.push_back(face.idx());
  }
  return turned;
}

}  // namespace heddle::macroscale
