#include "macroscale/mesh_check.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <tuple>
#include <unordered_map>
#include <utility>
#include <vector>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/orientation.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Surface_mesh.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace heddle::macroscale {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Surface = CGAL::Surface_mesh<Kernel::Point_3>;
using Place = std::array<double, 3>;
using Triangle = std::array<int, 3>;
namespace pmp = CGAL::Polygon_mesh_processing;

/// More crossings than this are not counted: a mesh that overlaps itself everywhere has millions.
constexpr unsigned int most_crossings = 100000;

/// An edge as seen from one of its triangles.
struct EdgeUse {
  int low, high;  ///< vertices
  int triangle;
  bool upwards;  ///< the triangle runs from low to high
};

std::vector<EdgeUse> edge_uses(const std::vector<Triangle>& triangles) {
  std::vector<EdgeUse> uses;
  uses.reserve(3 * triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    for (int k = 0; k < 3; ++k) {
      const int a = triangles[t][k], b = triangles[t][(k + 1) % 3];
      uses.push_back({std::min(a, b), std::max(a, b), static_cast<int>(t), a < b});
    }
  }
  std::sort(uses.begin(), uses.end(), [](const EdgeUse& a, const EdgeUse& b) {
    return std::tie(a.low, a.high, a.triangle) < std::tie(b.low, b.high, b.triangle);
  });
  return uses;
}

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

Kernel::Point_3 point(const Place& p) {
  return {p[0], p[1], p[2]};
}

/// Two corners at one place, or all three on a line.
bool degenerate(const TriangleMesh& mesh, const Triangle& t) {
  return CGAL::collinear(point(mesh.vertices[t[0]]), point(mesh.vertices[t[1]]), point(mesh.vertices[t[2]]));
}

/// How many, and where the first.
struct Tally {
  std::size_t count = 0;
  Place first{};
  void add(const Place& place) {
    if (count++ == 0) first = place;
  }
};

Place middle(const Place& a, const Place& b) {
  return {0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1]), 0.5 * (a[2] + b[2])};
}

Place centroid(const TriangleMesh& mesh, const Triangle& t) {
  Place c{};
  for (int vertex : t) {
    for (int i = 0; i < 3; ++i) c[i] += mesh.vertices[vertex][i] / 3.0;
  }
  return c;
}

std::string in_mm(const Place& p) {
  // + 0.0 turns a negative zero into zero.
  return fmt::format("({:.6g}, {:.6g}, {:.6g}) mm", 1e3 * p[0] + 0.0, 1e3 * p[1] + 0.0, 1e3 * p[2] + 0.0);
}

/// "1 edge has", "3 edges have".
std::string counted(std::size_t n, const char* one, const char* many) {
  return fmt::format("{} {}", n, n == 1 ? one : many);
}

Triangle sorted_corners(Triangle t) {
  std::sort(t.begin(), t.end());
  return t;
}

/// Index of the first vertex that stands exactly where each vertex stands.
std::vector<int> first_at_same_place(const std::vector<Place>& vertices) {
  std::vector<int> order(vertices.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(),
            [&](int a, int b) { return std::tie(vertices[a], a) < std::tie(vertices[b], b); });
  std::vector<int> first(vertices.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    const bool same = i > 0 && vertices[order[i]] == vertices[order[i - 1]];
    first[order[i]] = same ? first[order[i - 1]] : order[i];
  }
  return first;
}

/// Triangles that have the corners of an earlier one, by index.
std::vector<int> repetitions(const std::vector<Triangle>& triangles) {
  std::vector<std::pair<Triangle, int>> keys;
  keys.reserve(triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t)
    keys.emplace_back(sorted_corners(triangles[t]), static_cast<int>(t));
  std::sort(keys.begin(), keys.end());
  std::vector<int> again;
  for (std::size_t i = 1; i < keys.size(); ++i) {
    if (keys[i].first == keys[i - 1].first) again.push_back(keys[i].second);
  }
  std::sort(again.begin(), again.end());
  return again;
}

/// Disjoint sets over 0..n-1; the representative is the smallest member.
class Sets {
 public:
  explicit Sets(std::size_t n) : parent_(n) { std::iota(parent_.begin(), parent_.end(), 0); }
  int find(int i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(int a, int b) {
    a = find(a);
    b = find(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<int> parent_;
};

/// Vertices around which the triangles form more than one fan: sheets that touch in a point.
Tally pinched_vertices(const TriangleMesh& mesh, const std::vector<EdgeUse>& uses) {
  const std::size_t n = mesh.triangles.size();
  Sets corners(3 * n);
  const auto corner = [&](int triangle, int vertex) {
    const Triangle& t = mesh.triangles[triangle];
    return 3 * triangle + (t[0] == vertex ? 0 : t[1] == vertex ? 1 : 2);
  };
  for_each_edge(uses, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first + 1; i < last; ++i) {
      for (int vertex : {uses[first].low, uses[first].high})
        corners.join(corner(uses[first].triangle, vertex), corner(uses[i].triangle, vertex));
    }
  });
  std::vector<int> fan(mesh.vertices.size(), -1);
  std::vector<char> seen(mesh.vertices.size(), 0);
  Tally tally;
  for (std::size_t t = 0; t < n; ++t) {
    for (int k = 0; k < 3; ++k) {
      const int vertex = mesh.triangles[t][k];
      const int root = corners.find(static_cast<int>(3 * t) + k);
      if (fan[vertex] < 0) fan[vertex] = root;
      if (fan[vertex] == root || seen[vertex]) continue;
      seen[vertex] = 1;
      tally.add(mesh.vertices[vertex]);
    }
  }
  return tally;
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

/// Pieces that hang together over edges: one label a triangle, the smallest index of its piece.
std::vector<int> pieces(const TriangleMesh& mesh, const std::vector<EdgeUse>& uses) {
  Sets sets(mesh.triangles.size());
  for_each_edge(uses, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first + 1; i < last; ++i) sets.join(uses[first].triangle, uses[i].triangle);
  });
  std::vector<int> label(mesh.triangles.size());
  for (std::size_t t = 0; t < label.size(); ++t) label[t] = sets.find(static_cast<int>(t));
  return label;
}

/// Six times the signed volume between a triangle and `origin`; sums to that of a closed piece [m^3].
double six_volumes(const TriangleMesh& mesh, const Triangle& t, const Place& origin) {
  std::array<Place, 3> p{};
  for (int k = 0; k < 3; ++k) {
    for (int i = 0; i < 3; ++i) p[k][i] = mesh.vertices[t[k]][i] - origin[i];
  }
  return p[0][0] * (p[1][1] * p[2][2] - p[1][2] * p[2][1]) +
         p[0][1] * (p[1][2] * p[2][0] - p[1][0] * p[2][2]) +
         p[0][2] * (p[1][0] * p[2][1] - p[1][1] * p[2][0]);
}

/// Signed volume of each piece times six, indexed by its label.
std::vector<double> volumes(const TriangleMesh& mesh, const std::vector<int>& label) {
  std::vector<double> sum(mesh.triangles.size(), 0.0);
  for (std::size_t t = 0; t < label.size(); ++t) {
    const Place& origin = mesh.vertices[mesh.triangles[label[t]][0]];
    sum[label[t]] += six_volumes(mesh, mesh.triangles[t], origin);
  }
  return sum;
}

class Findings {
 public:
  Findings(std::string key, std::string file) : key_(std::move(key)), file_(std::move(file)) {}
  void add(RuleFamily id, std::string rule, std::string way_out) {
    problems_.push_back({id.of(key_), key_ + ".file", "", std::move(rule), std::move(way_out), file_});
  }
  bool any() const { return !problems_.empty(); }
  Problems take() { return std::move(problems_); }

 private:
  std::string key_, file_;
  Problems problems_;
};

/// Numbers first: nothing else can be asked of a mesh that fails here.
void examine_numbers(const TriangleMesh& mesh, Findings& f) {
  if (mesh.triangles.empty()) {
    f.add("*.empty"_family, "must hold triangles; it holds none",
          "Export the tool as triangles (STL, OBJ) or as a solid (STEP).");
    return;
  }
  const int n = static_cast<int>(mesh.vertices.size());
  for (const Triangle& t : mesh.triangles) {
    if (*std::min_element(t.begin(), t.end()) < 0 || *std::max_element(t.begin(), t.end()) >= n) {
      f.add("*.index"_family,
            fmt::format("must name vertices 0 to {}; a triangle names [{}, {}, {}]", n - 1, t[0], t[1], t[2]),
            "Write the file again.");
      return;
    }
  }
  std::size_t bad = 0, first = 0;
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    const Place& p = mesh.vertices[i];
    if (std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2])) continue;
    if (bad++ == 0) first = i;
  }
  if (bad > 0) {
    const Place& p = mesh.vertices[first];
    f.add("*.finite"_family,
          fmt::format("must have finite coordinates; {}, the first is vertex {} at ({:g}, {:g}, {:g})",
                      counted(bad, "vertex has not", "vertices have not"), first, p[0], p[1], p[2]),
          "The program that wrote it divided by zero: write the file again.");
  }
}

void examine_triangles(const TriangleMesh& mesh, Findings& f) {
  Tally flat;
  for (const Triangle& t : mesh.triangles) {
    if (degenerate(mesh, t)) flat.add(centroid(mesh, t));
  }
  if (flat.count > 0) {
    f.add("*.degenerate"_family,
          fmt::format("must have no triangle without area; {}, the first at {}",
                      counted(flat.count, "has none", "have none"), in_mm(flat.first)),
          "Such triangles have no normal.");
  }
  const std::vector<int> place = first_at_same_place(mesh.vertices);
  std::vector<Triangle> by_place = mesh.triangles;
  for (Triangle& t : by_place) {
    for (int& vertex : t) vertex = place[vertex];
  }
  const std::vector<int> again = repetitions(by_place);
  if (!again.empty()) {
    f.add("*.repeated"_family,
          fmt::format("must have each triangle once; {} there again, the first at {}",
                      counted(again.size(), "is", "are"), in_mm(centroid(mesh, mesh.triangles[again[0]]))),
          "A piece was exported twice.");
  }
}

void examine_edges(const TriangleMesh& mesh, const std::vector<EdgeUse>& uses, TopologyRule rule,
                   Findings& f) {
  Tally open, crowded, against;
  for_each_edge(uses, [&](std::size_t first, std::size_t last) {
    const Place place = middle(mesh.vertices[uses[first].low], mesh.vertices[uses[first].high]);
    if (last - first == 1) open.add(place);
    if (last - first > 2) crowded.add(place);
    if (last - first == 2 && uses[first].upwards == uses[first + 1].upwards) against.add(place);
  });
  if (open.count > 0 && rule == TopologyRule::closed) {
    f.add("*.closed"_family,
          fmt::format("must be closed; {} only one triangle, the first at {}",
                      counted(open.count, "edge has", "edges have"), in_mm(open.first)),
          "Inside and outside are undefined at a gap: close it, or write `sheet: on` beside the file for a "
          "tool drawn "
          "as a surface.");
  }
  if (crowded.count > 0) {
    f.add("*.edge_manifold"_family,
          fmt::format("must have two triangles at each edge; {} more, the first at {}",
                      counted(crowded.count, "edge has", "edges have"), in_mm(crowded.first)),
          "An inner wall or a part that only touches another ends there: export the outer skin alone.");
  }
  if (against.count > 0) {
    f.add(
        "*.oriented"_family,
        fmt::format("must be oriented as one; at {} two neighbours turn against each other, the first at {}",
                    counted(against.count, "edge", "edges"), in_mm(against.first)),
        "Normals of neighbours must point to the same side.");
  }
  const Tally pinched = pinched_vertices(mesh, uses);
  if (pinched.count > 0) {
    f.add("*.vertex_manifold"_family,
          fmt::format(
              "must have one sheet at each vertex; at {} several sheets touch in a point, the first at {}",
              counted(pinched.count, "vertex", "vertices"), in_mm(pinched.first)),
          "Part the sheets, or join them along an edge.");
  }
}

/// Needs sound edges and vertices.
void examine_crossings(const TriangleMesh& mesh, const Surface& surface, Findings& f) {
  std::vector<std::pair<Surface::Face_index, Surface::Face_index>> pairs;
  pmp::self_intersections(surface, std::back_inserter(pairs),
                          CGAL::parameters::maximum_number(most_crossings));
  if (pairs.empty()) return;
  std::pair<std::size_t, std::size_t> first{mesh.triangles.size(), 0};
  for (const auto& [a, b] : pairs) {
    const std::size_t i = a.idx(), j = b.idx();
    first = std::min(first, {std::min(i, j), std::max(i, j)});
  }
  f.add("*.self_intersection"_family,
        fmt::format("must not cross itself; {}{}, the first at {}",
                    pairs.size() == most_crossings ? "at least " : "",
                    counted(pairs.size(), "pair of triangles does", "pairs of triangles do"),
                    in_mm(centroid(mesh, mesh.triangles[first.first]))),
        "Unite the bodies in the CAD program, or coarsen a surface that folds over itself.");
}

/// Whether a closed mesh without crossings has its normals outwards. CGAL looks at how pieces lie in each
/// other and so takes the space outside for a solid too; the sum of the pieces' volumes (times six) tells
/// them apart.
bool bounds_a_solid(const Surface& surface, const std::vector<double>& six, bool several) {
  const double sum = std::accumulate(six.begin(), six.end(), 0.0);
  return sum > 0.0 && (!several || pmp::does_bound_a_volume(surface));
}

/// Needs sound edges and vertices, and no crossings.
void examine_sides(const TriangleMesh& mesh, const Surface& surface, const std::vector<EdgeUse>& uses,
                   Findings& f) {
  if (!CGAL::is_closed(surface)) return;  // an open sheet says itself which side is its front
  const std::vector<int> label = pieces(mesh, uses);
  const std::vector<double> six = volumes(mesh, label);
  const std::size_t count = static_cast<std::size_t>(
      std::count_if(label.begin(), label.end(), [&, t = 0](int l) mutable { return l == t++; }));
  if (bounds_a_solid(surface, six, count > 1)) return;
  Tally inside_out;
  for (std::size_t t = 0; t < label.size(); ++t) {
    if (label[t] == static_cast<int>(t) && six[t] < 0.0) inside_out.add(centroid(mesh, mesh.triangles[t]));
  }
  if (inside_out.count == 0) inside_out.add(centroid(mesh, mesh.triangles[0]));
  f.add("*.outward"_family,
        fmt::format("must have normals that point out of the solid; {} of {} inside out, the first with the "
                    "triangle at {}",
                    inside_out.count, counted(count, "piece is", "pieces are"), in_mm(inside_out.first)),
        "Contact would pull the blank into the tool.");
}

Problems faults(const TriangleMesh& mesh, const std::string& key, const std::string& file,
                TopologyRule rule) {
  Findings f(key, file);
  examine_numbers(mesh, f);
  if (f.any()) return f.take();
  examine_triangles(mesh, f);
  const std::vector<EdgeUse> uses = edge_uses(mesh.triangles);
  examine_edges(mesh, uses, rule, f);
  if (f.any()) return f.take();
  const Surface surface = surface_of(mesh);
  examine_crossings(mesh, surface, f);
  if (!f.any()) examine_sides(mesh, surface, uses, f);
  return f.take();
}

double diagonal(const std::vector<Place>& vertices) {
  Place low = vertices.front(), high = low;
  for (const Place& p : vertices) {
    for (int i = 0; i < 3; ++i) {
      low[i] = std::min(low[i], p[i]);
      high[i] = std::max(high[i], p[i]);
    }
  }
  return std::hypot(high[0] - low[0], high[1] - low[1], high[2] - low[2]);
}

/// For each vertex the first one within `tolerance` that was itself kept.
std::vector<int> first_nearby(const std::vector<Place>& vertices, double tolerance) {
  struct Cell {
    std::array<std::int64_t, 3> index;
    bool operator==(const Cell&) const = default;
  };
  const auto hash = [](const Cell& c) {
    std::size_t h = 0;
    for (std::int64_t i : c.index) h = (h ^ static_cast<std::size_t>(i)) * 0x9E3779B97F4A7C15ULL;
    return h;
  };
  std::unordered_map<Cell, std::vector<int>, decltype(hash)> kept(vertices.size(), hash);
  const Place& origin = vertices.front();
  std::vector<int> first(vertices.size());
  for (std::size_t v = 0; v < vertices.size(); ++v) {
    Cell home{};
    for (int i = 0; i < 3; ++i)
      home.index[i] = std::llround((vertices[v][i] - origin[i]) / (4.0 * tolerance));
    int found = -1;
    for (int n = 0; n < 27; ++n) {
      const Cell cell{{home.index[0] + n % 3 - 1, home.index[1] + n / 3 % 3 - 1, home.index[2] + n / 9 - 1}};
      const auto it = kept.find(cell);
      if (it == kept.end()) continue;
      for (int other : it->second) {
        const Place &a = vertices[v], &b = vertices[other];
        const bool near = std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]) <= tolerance;
        if (near && (found < 0 || other < found)) found = other;
      }
    }
    first[v] = found < 0 ? static_cast<int>(v) : found;
    if (found < 0) kept[home].push_back(static_cast<int>(v));
  }
  return first;
}

void merge_vertices(Repair& r) {
  const std::vector<int> first = first_nearby(r.mesh.vertices, r.tolerance);
  for (std::size_t v = 0; v < first.size(); ++v) r.merged_vertices += first[v] != static_cast<int>(v);
  for (Triangle& t : r.mesh.triangles) {
    for (int& vertex : t) vertex = first[vertex];
  }
}

void drop_degenerate(Repair& r) {
  r.dropped_degenerate += std::erase_if(
      r.mesh.triangles, [](const Triangle& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; });
}

void drop_repeated(Repair& r) {
  const std::vector<int> again = repetitions(r.mesh.triangles);
  if (again.empty()) return;
  std::vector<Triangle> kept;
  for (std::size_t t = 0; t < r.mesh.triangles.size(); ++t) {
    if (!std::binary_search(again.begin(), again.end(), static_cast<int>(t)))
      kept.push_back(r.mesh.triangles[t]);
  }
  r.mesh.triangles = std::move(kept);
  r.dropped_repeated += again.size();
}

/// The triangle at the other side of edge (a, b) of triangle t; -1 unless there is exactly one.
int across(const std::vector<EdgeUse>& uses, int t, int a, int b) {
  const auto at = std::lower_bound(uses.begin(), uses.end(), std::pair(std::min(a, b), std::max(a, b)),
                                   [](const EdgeUse& use, const std::pair<int, int>& edge) {
                                     return std::pair(use.low, use.high) < edge;
                                   });
  int found = -1;
  for (auto it = at; it != uses.end() && it->low == at->low && it->high == at->high; ++it) {
    if (it->triangle == t) continue;
    if (found >= 0) return -1;
    found = it->triangle;
  }
  return found;
}

/// Index of the corner opposite the longest edge.
int corner_at_longest_edge(const TriangleMesh& mesh, const Triangle& t) {
  int corner = 0;
  double longest = -1.0;
  for (int k = 0; k < 3; ++k) {
    const Place &a = mesh.vertices[t[(k + 1) % 3]], &b = mesh.vertices[t[(k + 2) % 3]];
    const double length = std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
    if (length > longest) {
      longest = length;
      corner = k;
    }
  }
  return corner;
}

/// A triangle with its three corners on a line lies along the edge between the outer two. Dropping it would
/// leave a corner on the neighbour's edge; instead the edge between the two triangles is turned: the
/// neighbour's far corner is tied to the middle one. Rows of such triangles take one pass a triangle; eight
/// passes mend what CAD programs write.
void flip_caps(Repair& r) {
  TriangleMesh& mesh = r.mesh;
  std::vector<int> caps;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (degenerate(mesh, mesh.triangles[t])) caps.push_back(static_cast<int>(t));
  }
  for (int pass = 0; pass < 8 && !caps.empty(); ++pass) {
    const std::vector<EdgeUse> uses = edge_uses(mesh.triangles);
    std::vector<char> touched(mesh.triangles.size(), 0);
    std::vector<int> left;
    for (int t : caps) {
      const Triangle cap = mesh.triangles[t];
      const int m = corner_at_longest_edge(mesh, cap);
      const int centre = cap[m], a = cap[(m + 1) % 3], b = cap[(m + 2) % 3];
      const int neighbour = across(uses, t, a, b);
      const bool usable = neighbour >= 0 && !touched[t] && !touched[neighbour] &&
                          !degenerate(mesh, mesh.triangles[neighbour]);
      if (!usable) {
        left.push_back(t);
        continue;
      }
      Triangle first = mesh.triangles[neighbour], second = first;
      std::replace(first.begin(), first.end(), b, centre);  // keeps the neighbour's orientation
      std::replace(second.begin(), second.end(), a, centre);
      mesh.triangles[neighbour] = first;
      mesh.triangles[t] = second;
      touched[t] = touched[neighbour] = 1;
      ++r.flipped_caps;
    }
    if (left.size() == caps.size()) return;
    caps = std::move(left);
  }
}

void turn(Triangle& t) {
  std::swap(t[1], t[2]);
}

/// Makes neighbours agree over every edge with two triangles, piece by piece, following the majority.
void orient(Repair& r) {
  std::vector<Triangle>& triangles = r.mesh.triangles;
  const std::vector<EdgeUse> uses = edge_uses(triangles);
  struct Neighbour {
    int triangle;
    bool agrees;
  };
  std::vector<std::vector<Neighbour>> neighbours(triangles.size());
  for_each_edge(uses, [&](std::size_t first, std::size_t last) {
    if (last - first != 2) return;
    const EdgeUse &a = uses[first], &b = uses[first + 1];
    const bool agrees = a.upwards != b.upwards;
    neighbours[a.triangle].push_back({b.triangle, agrees});
    neighbours[b.triangle].push_back({a.triangle, agrees});
  });
  std::vector<signed char> sign(triangles.size(), 0);
  for (std::size_t seed = 0; seed < triangles.size(); ++seed) {
    if (sign[seed] != 0) continue;
    std::vector<int> piece{static_cast<int>(seed)};
    sign[seed] = 1;
    std::size_t reversed = 0;
    for (std::size_t i = 0; i < piece.size(); ++i) {
      for (const Neighbour& next : neighbours[piece[i]]) {
        if (sign[next.triangle] != 0) continue;  // a one-sided surface stays so: check() says where
        sign[next.triangle] = static_cast<signed char>(next.agrees ? sign[piece[i]] : -sign[piece[i]]);
        reversed += sign[next.triangle] < 0;
        piece.push_back(next.triangle);
      }
    }
    const signed char keep = 2 * reversed > piece.size() ? -1 : 1;
    for (int t : piece) {
      if (sign[t] == keep) continue;
      turn(triangles[t]);
      ++r.turned;
    }
  }
}

/// Turns closed pieces so that together they bound a solid; pieces inside another become cavities only where
/// they were given as such.
void turn_outward(Repair& r) {
  const std::vector<EdgeUse> uses = edge_uses(r.mesh.triangles);
  bool closed = true, sound = true;
  for_each_edge(uses, [&](std::size_t first, std::size_t last) {
    closed = closed && last - first == 2;
    sound = sound && (last - first != 2 || uses[first].upwards != uses[first + 1].upwards);
  });
  if (!closed || !sound || pinched_vertices(r.mesh, uses).count > 0) return;
  const std::vector<int> label = pieces(r.mesh, uses);
  const std::vector<double> six = volumes(r.mesh, label);
  const bool several = std::any_of(label.begin(), label.end(), [&](int l) { return l != label[0]; });
  Surface surface = surface_of(r.mesh);
  if (several && pmp::does_self_intersect(surface)) return;
  if (bounds_a_solid(surface, six, several)) return;
  if (!several || pmp::does_bound_a_volume(surface)) {  // right among themselves, inside out as a whole
    for (Triangle& t : r.mesh.triangles) turn(t);
    r.turned += r.mesh.triangles.size();
    return;
  }
  pmp::orient_to_bound_a_volume(surface);
  for (const Surface::Face_index face : surface.faces()) {
    // The first half-edge of a face still says which way round it now runs.
    Triangle now{};
    int k = 0;
    for (const Surface::Vertex_index v : surface.vertices_around_face(surface.halfedge(face)))
      now[k++] = static_cast<int>(v.idx());
    Triangle& t = r.mesh.triangles[face.idx()];
    const int at = static_cast<int>(std::find(now.begin(), now.end(), t[0]) - now.begin());
    if (now[(at + 1) % 3] == t[1]) continue;
    turn(t);
    ++r.turned;
  }
}

void drop_unused_vertices(TriangleMesh& mesh) {
  std::vector<int> number(mesh.vertices.size(), -1);
  std::vector<Place> kept;
  for (Triangle& t : mesh.triangles) {
    for (int& vertex : t) {
      if (number[vertex] < 0) {
        number[vertex] = static_cast<int>(kept.size());
        kept.push_back(mesh.vertices[vertex]);
      }
      vertex = number[vertex];
    }
  }
  mesh.vertices = std::move(kept);
}

bool usable_numbers(const TriangleMesh& mesh) {
  Findings f("", "");
  examine_numbers(mesh, f);
  return !f.any();
}

}  // namespace

Repair repaired(const TriangleMesh& mesh) {
  Repair r;
  r.mesh = mesh;
  if (!usable_numbers(mesh)) return r;
  r.tolerance = 1e-6 * diagonal(mesh.vertices);
  if (r.tolerance == 0.0) return r;
  merge_vertices(r);
  drop_degenerate(r);
  drop_repeated(r);
  flip_caps(r);
  orient(r);
  turn_outward(r);
  drop_unused_vertices(r.mesh);
  return r;
}

std::string summary(const Repair& repair) {
  std::vector<std::string> parts;
  const auto add = [&](const char* verb, std::size_t n, const char* one, const char* many) {
    if (n > 0) parts.push_back(fmt::format("{} {}", verb, counted(n, one, many)));
  };
  add("merges", repair.merged_vertices, "vertex", "vertices");
  add("drops", repair.dropped_degenerate, "triangle without area", "triangles without area");
  add("drops", repair.dropped_repeated, "repeated triangle", "repeated triangles");
  add("joins", repair.flipped_caps, "flat triangle to its neighbour", "flat triangles to their neighbours");
  add("turns", repair.turned, "triangle", "triangles");
  return parts.empty() ? "changes nothing" : fmt::format("{}", fmt::join(parts, ", "));
}

Problems check(const TriangleMesh& mesh, const std::string& key, const std::string& file, TopologyRule rule) {
  Problems problems = faults(mesh, key, file, rule);
  if (problems.empty() || !usable_numbers(mesh)) return problems;
  const Repair repair = repaired(mesh);
  const bool mends = repair.changed() && faults(repair.mesh, key, file, rule).empty();
  const std::string offer = mends ? fmt::format("`{}.repair: on` mends it: it {}.", key, summary(repair))
                                  : "No safe repair is known here: mend it in the program that wrote it.";
  for (Problem& problem : problems) problem.way_out += " " + offer;
  return problems;
}

}  // namespace heddle::macroscale
