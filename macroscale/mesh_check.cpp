#include "macroscale/mesh_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>
#include <utility>
#include <vector>

#include "macroscale/findings.h"
#include "macroscale/mesh_predicates.h"
#include "macroscale/mesh_repair.h"
#include "macroscale/mesh_topology.h"

namespace heddle::macroscale {

namespace {

/// More crossings than this are not counted: a mesh that overlaps itself everywhere has millions.
constexpr std::size_t most_crossings = 100000;

Place middle(const Place& a, const Place& b) {
  return {0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1]), 0.5 * (a[2] + b[2])};
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
void examine_crossings(const TriangleMesh& mesh, Findings& f) {
  const auto pairs = crossings(mesh, most_crossings);
  if (pairs.empty()) return;
  f.add("*.self_intersection"_family,
        fmt::format("must not cross itself; {}{}, the first at {}",
                    pairs.size() == most_crossings ? "at least " : "",
                    counted(pairs.size(), "pair of triangles does", "pairs of triangles do"),
                    in_mm(centroid(mesh, mesh.triangles[std::ranges::min(pairs).first]))),
        "Unite the bodies in the CAD program, or coarsen a surface that folds over itself.");
}

/// Needs sound edges and vertices, and no crossings.
void examine_sides(const TriangleMesh& mesh, const std::vector<EdgeUse>& uses, Findings& f) {
  if (!is_closed(mesh)) return;  // an open sheet says itself which side is its front
  const std::vector<int> label = pieces(mesh, uses);
  const std::vector<double> six = volumes(mesh, label);
  const std::size_t count = static_cast<std::size_t>(
      std::count_if(label.begin(), label.end(), [&, t = 0](int l) mutable { return l == t++; }));
  if (bounds_a_solid(mesh, six, count > 1)) return;
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
  Findings f(key, key + ".file", file);
  examine_numbers(mesh, f);
  if (f.any()) return f.take();
  examine_triangles(mesh, f);
  const std::vector<EdgeUse> uses = edge_uses(mesh.triangles);
  examine_edges(mesh, uses, rule, f);
  if (f.any()) return f.take();
  examine_crossings(mesh, f);
  if (!f.any()) examine_sides(mesh, uses, f);
  return f.take();
}

}  // namespace

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
