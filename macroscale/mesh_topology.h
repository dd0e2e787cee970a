#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "core/triangle_mesh.h"

namespace heddle::macroscale {

using Place = std::array<double, 3>;
using Triangle = std::array<int, 3>;

/// An edge as seen from one of its triangles.
struct EdgeUse {
  int low, high;  ///< vertices
  int triangle;
  bool upwards;  ///< the triangle runs from low to high
};

/// One a triangle and edge, edge by edge.
std::vector<EdgeUse> edge_uses(const std::vector<Triangle>& triangles);

/// Calls visit(first, last) for the uses of each edge, as a range of indices into `uses`.
template <class Visit>
void for_each_edge(const std::vector<EdgeUse>& uses, Visit visit) {
  for (std::size_t first = 0; first < uses.size();) {
    std::size_t last = first + 1;
    while (last < uses.size() && uses[last].low == uses[first].low && uses[last].high == uses[first].high)
      ++last;
    visit(first, last);
    first = last;
  }
}

/// How many, and where the first.
struct Tally {
  std::size_t count = 0;
  Place first{};
  void add(const Place& place) {
    if (count++ == 0) first = place;
  }
};

/// Whether geometry can be asked of it: triangles, corners that there are, finite coordinates.
bool usable_numbers(const TriangleMesh& mesh);

Place centroid(const TriangleMesh& mesh, const Triangle& t);

/// "(1, 2, 3) mm"
std::string in_mm(const Place& p);

/// "1 edge has", "3 edges have".
std::string counted(std::size_t n, const char* one, const char* many);

/// Triangles that have the corners of an earlier one, by index.
std::vector<int> repetitions(const std::vector<Triangle>& triangles);

/// Vertices around which the triangles form more than one fan: sheets that touch in a point.
Tally pinched_vertices(const TriangleMesh& mesh, const std::vector<EdgeUse>& uses);

/// Pieces that hang together over edges: one label a triangle, the smallest index of its piece.
std::vector<int> pieces(const TriangleMesh& mesh, const std::vector<EdgeUse>& uses);

/// Signed volume of each piece times six, indexed by its label.
std::vector<double> volumes(const TriangleMesh& mesh, const std::vector<int>& label);

}  // namespace heddle::macroscale
