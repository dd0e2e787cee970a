#include "pipeline/export/part_mesh.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>
#include <stdexcept>
#include <utility>

#include "pipeline/export_vtu.h"

namespace heddle::pipeline {

namespace {

using macroscale::BlankState;
using macroscale::CellPiece;
using macroscale::Point2;

// In units of cells: corners this near to each other become one, and a point this near to a side lies on it.
constexpr double merge_distance = 1.0 / 30.0, on_a_side = 1e-7;
// Triangles flatter than this (area over the square of the longest side) are no elements.
constexpr double flattest = 1e-3;
// A fan from a corner does as long as its triangles are no flatter than this; else one from the middle may.
constexpr double well_shaped = 0.05;

// A material point in the flat grid: cell (i, j) is the square from (i, j) to (i + 1, j + 1).
struct FlatPoint {
  Point2 at;
  int vertex;
};

double cross(const Point2& o, const Point2& a, const Point2& b) {
  return (a[0] - o[0]) * (b[1] - o[1]) - (a[1] - o[1]) * (b[0] - o[0]);
}

double distance(const Point2& a, const Point2& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1]);
}

// Area over the square of the longest side.
double quality(const Point2& a, const Point2& b, const Point2& c) {
  const double longest = std::max({distance(a, b), distance(b, c), distance(c, a)});
  return 0.5 * cross(a, b, c) / (longest * longest);
}

class Meshing {
 public:
  explicit Meshing(const BlankState& blank) : blank_(blank) {
    for (std::size_t node = 0; node < blank.grid.size(); ++node) {
      const Point2 at{static_cast<double>(blank.grid[node][0]), static_cast<double>(blank.grid[node][1])};
      add_vertex(at, blank.position[node]);
      add_point(at, static_cast<int>(node));
    }
    add_piece_corners(true);
    add_piece_corners(false);
  }

  PartMesh mesh() {
    std::vector<char> cut(blank_.quads.size(), 0);
    for (const CellPiece& piece : blank_.pieces) cut.at(static_cast<std::size_t>(piece.quad)) = 1;
    for (std::size_t q = 0; q < blank_.quads.size(); ++q)
      if (!cut[q]) add_polygon(static_cast<int>(q), {{{0.0, 0.0}, {1.0, 0.0}, {1.0, 1.0}, {0.0, 1.0}}}, true);
    for (const CellPiece& piece : blank_.pieces) add_polygon(piece.quad, piece.corners, false);
    give_thin_rings_away();
    for (const Ring& ring : rings_)
      if (!ring.nodes.empty()) add_faces(ring);
    return compact();
  }

 private:
  // What lies inside a closed way over vertices, counter-clockwise.
  struct Ring {
    int quad = 0;
    bool whole = false;  ///< a cell that no outline cuts
    std::vector<int> nodes;
  };
  // How a ring is cut into triangles: from one of its corners, or from its middle.
  struct Fan {
    std::optional<std::size_t> corner;
    Point2 middle{};
  };

  Point2 in_grid(int quad, const Point2& local) const {
    const auto& line = blank_.grid[static_cast<std::size_t>(blank_.quads[static_cast<std::size_t>(quad)][0])];
    return {line[0] + local[0], line[1] + local[1]};
  }
  double cell_area(int quad) const {  // before forming [m^2]
    const auto& corner = blank_.quads[static_cast<std::size_t>(quad)];
    const auto x = [&](std::size_t k) { return blank_.reference[static_cast<std::size_t>(corner[k])]; };
    return std::abs(cross(x(0), x(1), x(3)));
  }

  static std::pair<int, int> bucket_of(const Point2& at) {
    return {static_cast<int>(std::floor(at[0])), static_cast<int>(std::floor(at[1]))};
  }
  // Calls with every entry of the squares that a box touches.
  template <class Buckets, class Visit>
  static void near(const Buckets& buckets, const Point2& low, const Point2& high, const Visit& visit) {
    const auto first = bucket_of(low), last = bucket_of(high);
    for (int i = first.first; i <= last.first; ++i)
      for (int j = first.second; j <= last.second; ++j)
        if (const auto found = buckets.find({i, j}); found != buckets.end())
          for (const int entry : found->second) visit(entry);
  }

  // The nearest entry that is nearer than `reach`, or -1. @param place  entry -> where it is
  template <class Buckets, class Place>
  static int nearest(const Buckets& buckets, const Point2& at, double reach, const Place& place) {
    int found = -1;
    near(buckets, {at[0] - reach, at[1] - reach}, {at[0] + reach, at[1] + reach}, [&](int entry) {
      if (const double away = distance(place(entry), at); away < reach) reach = away, found = entry;
    });
    return found;
  }

  int add_vertex(const Point2& at, const std::array<double, 3>& position) {
    flat_.push_back(at);
    position_.push_back(position);
    const int vertex = static_cast<int>(flat_.size()) - 1;
    vertices_[bucket_of(at)].push_back(vertex);
    return vertex;
  }
  void add_point(const Point2& at, int vertex) {
    points_.push_back({at, vertex});
    points_at_[bucket_of(at)].push_back(static_cast<int>(points_.size()) - 1);
  }

  // Corners in their own cell first: beyond it the cell's surface is carried on, which is off where the
  // neighbour's bends.
  void add_piece_corners(bool inside) {
    for (const CellPiece& piece : blank_.pieces)
      for (const Point2& corner : piece.corners) {
        const auto in = [](double x) { return x >= -on_a_side && x <= 1.0 + on_a_side; };
        if ((in(corner[0]) && in(corner[1])) != inside) continue;
        const Point2 at = in_grid(piece.quad, corner);
        // The same place first: what became of it must not depend on what has come since.
        const auto place = [&](int p) { return points_[static_cast<std::size_t>(p)].at; };
        if (nearest(points_at_, at, 2.0 * on_a_side, place) >= 0) continue;
        int vertex =
            nearest(vertices_, at, merge_distance, [&](int v) { return flat_[static_cast<std::size_t>(v)]; });
        if (vertex < 0)
          vertex =
              add_vertex(at, position_in(blank_, blank_.quads[static_cast<std::size_t>(piece.quad)], corner));
        add_point(at, vertex);
      }
  }

  // The vertices on the way from a to b, without that at b.
  void walk(const Point2& a, const Point2& b, std::vector<int>& ring) const {
    std::vector<std::pair<double, int>> on_side;
    const double length = distance(a, b);
    if (length < on_a_side) return;
    const Point2 low{std::min(a[0], b[0]) - on_a_side, std::min(a[1], b[1]) - on_a_side},
        high{std::max(a[0], b[0]) + on_a_side, std::max(a[1], b[1]) + on_a_side};
    near(points_at_, low, high, [&](int entry) {
      const FlatPoint& p = points_[static_cast<std::size_t>(entry)];
      const double along =
          ((p.at[0] - a[0]) * (b[0] - a[0]) + (p.at[1] - a[1]) * (b[1] - a[1])) / (length * length);
      if (std::abs(cross(a, b, p.at)) <= on_a_side * length && along > -on_a_side && along < 1.0 - on_a_side)
        on_side.emplace_back(along, p.vertex);
    });
    std::sort(on_side.begin(), on_side.end());
    for (const auto& [along, vertex] : on_side)
      if (ring.empty() || ring.back() != vertex) ring.push_back(vertex);
  }

  void add_polygon(int quad, const std::array<Point2, 4>& corners, bool whole) {
    std::vector<int> ring;
    for (std::size_t k = 0; k < 4; ++k)
      walk(in_grid(quad, corners[k]), in_grid(quad, corners[(k + 1) % 4]), ring);
    remove_spikes(ring);
    double area = 0.0;
    for (std::size_t k = 0; k < 4; ++k) area += 0.5 * cross({0.0, 0.0}, corners[k], corners[(k + 1) % 4]);
    blank_area_ += area * cell_area(quad);
    if (ring.size() >= 3) rings_.push_back({quad, whole, std::move(ring)});
  }

  // Corners that became one leave sides of no length, and ways there and back.
  static void remove_spikes(std::vector<int>& ring) {
    for (std::size_t k = 0; k < ring.size() && ring.size() > 1;) {
      const std::size_t n = ring.size(), next = (k + 1) % n, after = (k + 2) % n;
      if (ring[k] != ring[next] && ring[k] != ring[after]) {
        ++k;
        continue;
      }
      ring.erase(ring.begin() + static_cast<std::ptrdiff_t>(next));
      k = k > 2 ? k - 2 : 0;
    }
  }

  // The middle of a ring's area; of its corners where it has none.
  Point2 middle_of(const std::vector<int>& ring) const {
    Point2 sum{}, mean{};
    double area = 0.0;
    const Point2 origin = flat_[static_cast<std::size_t>(ring[0])];
    for (std::size_t k = 0; k < ring.size(); ++k) {
      const Point2 &a = flat_[static_cast<std::size_t>(ring[k])],
                   &b = flat_[static_cast<std::size_t>(ring[(k + 1) % ring.size()])];
      const double part = cross(origin, a, b);
      area += part;
      for (std::size_t c = 0; c < 2; ++c) {
        sum[c] += part * (a[c] + b[c] + origin[c]) / 3.0;
        mean[c] += a[c] / static_cast<double>(ring.size());
      }
    }
    return area > 0.0 ? Point2{sum[0] / area, sum[1] / area} : mean;
  }

  // The fan whose flattest triangle is the least flat; none where all are too flat.
  std::optional<Fan> fan_of(const Ring& ring) const {
    const std::size_t n = ring.nodes.size();
    const auto at = [&](std::size_t k) { return flat_[static_cast<std::size_t>(ring.nodes[k % n])]; };
    double best = 0.0;
    Fan fan;
    for (std::size_t first = 0; first < n; ++first) {
      double worst = 1.0;
      for (std::size_t k = 1; k + 1 < n; ++k)
        worst = std::min(worst, quality(at(first), at(first + k), at(first + k + 1)));
      if (worst > best) best = worst, fan.corner = first;
    }
    if (best > well_shaped) return fan;
    fan.middle = middle_of(ring.nodes);
    double of_middle = 1.0;
    for (std::size_t k = 0; k < n; ++k)
      of_middle = std::min(of_middle, quality(fan.middle, at(k), at(k + 1)));
    if (of_middle > best) best = of_middle, fan.corner.reset();
    return best > flattest ? std::optional(fan) : std::nullopt;
  }

  // A ring too thin for triangles closes along its longest side: the ring on the other side of that goes
  // through its other corners.
  void give_thin_rings_away() {
    std::map<std::array<int, 2>, std::size_t> ring_of;
    const auto list = [&](std::size_t r) {
      const std::vector<int>& nodes = rings_[r].nodes;
      for (std::size_t k = 0; k < nodes.size(); ++k) ring_of[{nodes[k], nodes[(k + 1) % nodes.size()]}] = r;
    };
    for (std::size_t r = 0; r < rings_.size(); ++r) list(r);
    for (bool changed = true; changed;) {
      changed = false;
      for (Ring& thin : rings_) {
        if (thin.nodes.empty() || fan_of(thin)) continue;
        changed = true;
        std::vector<int> way = std::move(thin.nodes);
        thin.nodes.clear();
        std::rotate(way.begin(), way.begin() + longest_side(way), way.end());
        const auto found = ring_of.find({way[1], way[0]});
        if (found == ring_of.end() || rings_[found->second].nodes.empty()) continue;
        const std::size_t other = found->second;
        std::vector<int>& nodes = rings_[other].nodes;
        const auto from = std::find(nodes.begin(), nodes.end(), way[1]);
        nodes.insert(from + 1, way.begin() + 2, way.end());
        remove_spikes(nodes);
        if (nodes.size() < 3) nodes.clear();
        list(other);
      }
    }
  }
  std::ptrdiff_t longest_side(const std::vector<int>& nodes) const {
    std::size_t longest = 0;
    double length = 0.0;
    for (std::size_t k = 0; k < nodes.size(); ++k) {
      const double side = distance(flat_[static_cast<std::size_t>(nodes[k])],
                                   flat_[static_cast<std::size_t>(nodes[(k + 1) % nodes.size()])]);
      if (side > length) length = side, longest = k;
    }
    return static_cast<std::ptrdiff_t>(longest);
  }

  void add_faces(const Ring& ring) {
    const std::vector<int>& nodes = ring.nodes;
    const std::size_t n = nodes.size();
    if (ring.whole && n == 4) return add_face(ring.quad, {nodes[0], nodes[1], nodes[2], nodes[3]}, 4);
    const Fan fan = fan_of(ring).value();
    if (fan.corner) {
      for (std::size_t k = 1; k + 1 < n; ++k) {
        const int last = nodes[(*fan.corner + k + 1) % n];
        add_face(ring.quad, {nodes[*fan.corner], nodes[(*fan.corner + k) % n], last, last}, 3);
      }
      return;
    }
    const Point2 origin = in_grid(ring.quad, {0.0, 0.0});
    const int centre =
        add_vertex(fan.middle, position_in(blank_, blank_.quads[static_cast<std::size_t>(ring.quad)],
                                           {fan.middle[0] - origin[0], fan.middle[1] - origin[1]}));
    for (std::size_t k = 0; k < n; ++k)
      add_face(ring.quad, {nodes[k], nodes[(k + 1) % n], centre, centre}, 3);
  }

  void add_face(int quad, const std::array<int, 4>& corners, int count) {
    PartFace face{quad, corners, count, 0.0};
    for (std::size_t k = 1; k + 1 < static_cast<std::size_t>(count); ++k)
      face.flat_area +=
          0.5 * cell_area(quad) *
          cross(flat_[static_cast<std::size_t>(corners[0])], flat_[static_cast<std::size_t>(corners[k])],
                flat_[static_cast<std::size_t>(corners[k + 1])]);
    faces_.push_back(face);
  }

  // Without the vertices that no face has.
  PartMesh compact() {
    std::vector<int> number(position_.size(), -1);
    for (const PartFace& face : faces_)
      for (const int corner : face.corners) number[static_cast<std::size_t>(corner)] = 0;
    PartMesh mesh;
    for (std::size_t v = 0; v < number.size(); ++v) {
      if (number[v] < 0) continue;
      number[v] = static_cast<int>(mesh.position.size());
      mesh.position.push_back(position_[v]);
    }
    for (PartFace& face : faces_) {
      for (int& corner : face.corners) corner = number[static_cast<std::size_t>(corner)];
      mesh.flat_area += face.flat_area;
    }
    mesh.faces = std::move(faces_);
    mesh.blank_area = blank_area_;
    return mesh;
  }

  const BlankState& blank_;
  std::vector<Point2> flat_;
  std::vector<std::array<double, 3>> position_;
  std::vector<FlatPoint> points_;
  std::map<std::pair<int, int>, std::vector<int>> vertices_, points_at_;
  std::vector<Ring> rings_;
  std::vector<PartFace> faces_;
  double blank_area_ = 0.0;
};

}  // namespace

PartMesh part_mesh(const BlankState& blank) {
  if (!blank.plies.empty()) throw std::invalid_argument("a part of several plies has no one middle surface");
  return Meshing(blank).mesh();
}

std::vector<std::array<int, 2>> free_sides(const PartMesh& mesh) {
  std::map<std::array<int, 2>, int> uses;
  for (const PartFace& face : mesh.faces)
    for (int k = 0; k < face.count; ++k) {
      const int a = face.corners[static_cast<std::size_t>(k)],
                b = face.corners[static_cast<std::size_t>((k + 1) % face.count)];
      ++uses[{std::min(a, b), std::max(a, b)}];
    }
  std::vector<std::array<int, 2>> sides;
  for (const auto& [side, count] : uses)
    if (count == 1) sides.push_back(side);
  return sides;
}

}  // namespace heddle::pipeline
