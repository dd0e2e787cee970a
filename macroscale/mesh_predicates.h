#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "macroscale/mesh_topology.h"

/// What is asked of a triangulation exactly (CGAL): no answer depends on a tolerance.
namespace heddle::macroscale {

/// Two corners at one place, or all three on a line.
bool degenerate(const TriangleMesh& mesh, const Triangle& t);

/// Pairs of triangles that cross, at most `most`. Needs sound edges and vertices, as all below.
std::vector<std::pair<std::size_t, std::size_t>> crossings(const TriangleMesh& mesh, std::size_t most);

/// Whether every edge has two triangles.
bool is_closed(const TriangleMesh& mesh);

/// Whether the pieces of a closed mesh without crossings have sides that agree: each inside of one is the
/// outside of those within it. The space outside counts as a solid too.
bool bounds_a_volume(const TriangleMesh& mesh);

/// Whether such a mesh has its normals outwards: the sum of its pieces' volumes tells a solid from the space
/// around one.
/// @param six      volumes of the pieces, times six (volumes() of mesh_topology.h)
/// @param several  whether there is more than one piece
bool bounds_a_solid(const TriangleMesh& mesh, const std::vector<double>& six, bool several);

/// Index of each triangle that must be turned for the mesh to bound a volume.
std::vector<std::size_t> turned_to_bound_a_volume(const TriangleMesh& mesh);

}  // namespace heddle::macroscale
