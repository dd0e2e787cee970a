#include "macroscale/mesh_repair.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <unordered_map>
#include <utility>
#include <vector>

#include "macroscale/mesh_predicates.h"
#include "macroscale/mesh_topology.h"

namespace heddle::macroscale {

namespace {

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
  if (several && !crossings(r.mesh, 1).empty()) return;
  if (bounds_a_solid(r.mesh, six, several)) return;
  std::vector<std::size_t> turned;
  if (several && !bounds_a_volume(r.mesh)) {
    turned = turned_to_bound_a_volume(r.mesh);
  } else {  // right among themselves, inside out as a whole
    turned.resize(r.mesh.triangles.size());
    std::iota(turned.begin(), turned.end(), std::size_t{0});
  }
  for (const std::size_t t : turned) turn(r.mesh.triangles[t]);
  r.turned += turned.size();
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

}  // namespace heddle::macroscale
