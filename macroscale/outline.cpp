#include "macroscale/outline.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <numeric>
#include <optional>
#include <stdexcept>
#include <tuple>
#include <utility>
#include <variant>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Exact_rational.h>
#include <CGAL/Polygon_2_algorithms.h>
#include <CGAL/intersections.h>
#include <fmt/format.h>

#include "macroscale/findings.h"

namespace heddle::macroscale {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Exact = CGAL::Exact_rational;

constexpr std::size_t most_points = 100000;

Kernel::Point_2 point(const Point2& p) {
  return {p[0], p[1]};
}

std::string in_mm(double x, double y) {
  return fmt::format("({:.6g}, {:.6g}) mm", 1e3 * x + 0.0, 1e3 * y + 0.0);
}

double signed_area(const Ring& ring) {
  double twice = 0.0;
  for (std::size_t i = 1; i + 1 < ring.size(); ++i) {
    const Point2 u{ring[i][0] - ring[0][0], ring[i][1] - ring[0][1]};
    const Point2 v{ring[i + 1][0] - ring[0][0], ring[i + 1][1] - ring[0][1]};
    twice += u[0] * v[1] - u[1] * v[0];
  }
  return 0.5 * twice;
}

// ---- check

struct Edge {
  int ring;   ///< 0 = outer, 1.. = holes
  int index;  ///< from point `index` to the next
  Point2 a, b;
  double low(int c) const { return std::min(a[c], b[c]); }
  double high(int c) const { return std::max(a[c], b[c]); }
};

std::string name_of(int ring) {
  return ring == 0 ? "the outer border" : fmt::format("hole {}", ring);
}

void examine_points(const Ring& ring, int number, Findings& f) {
  if (ring.size() < 3) {
    f.add("*.points"_family,
          fmt::format("must have at least three points a border; {} has {}", name_of(number), ring.size()),
          "Add points, or leave the border out.");
    return;
  }
  for (std::size_t i = 0; i < ring.size(); ++i) {
    if (!std::isfinite(ring[i][0]) || !std::isfinite(ring[i][1])) {
      f.add("*.finite"_family,
            fmt::format("must have finite coordinates; point {} of {} is ({}, {})", i + 1, name_of(number),
                        ring[i][0], ring[i][1]),
            "Correct the point.");
      return;
    }
    if (ring[i] == ring[(i + 1) % ring.size()]) {
      f.add("*.repeated_point"_family,
            fmt::format("must not repeat a point; point {} of {} at {} stands there again", i + 1,
                        name_of(number), in_mm(ring[i][0], ring[i][1])),
            "Leave one of them out; a ring closes by itself.");
      return;
    }
  }
}

/// Where two edges meet though they must not: neighbours only share their common point.
std::optional<Point2> meeting(const Edge& e, const Edge& g, int ring_size) {
  const bool after = e.ring == g.ring && (e.index + 1) % ring_size == g.index;
  const bool before = e.ring == g.ring && (g.index + 1) % ring_size == e.index;
  if (after || before) {
    const Point2 &from = after ? e.a : g.a, &common = after ? e.b : g.b, &to = after ? g.b : e.b;
    const bool folds_back = CGAL::collinear(point(from), point(common), point(to)) &&
                            CGAL::angle(point(from), point(common), point(to)) == CGAL::ACUTE;
    return folds_back ? std::optional(common) : std::nullopt;
  }
  const Kernel::Segment_2 s(point(e.a), point(e.b)), t(point(g.a), point(g.b));
  if (!CGAL::do_intersect(s, t)) return std::nullopt;
  const auto common = CGAL::intersection(s, t);
  if (common) {
    if (const auto* p = boost::get<Kernel::Point_2>(&*common)) return Point2{p->x(), p->y()};
    if (const auto* overlap = boost::get<Kernel::Segment_2>(&*common))
      return Point2{overlap->source().x(), overlap->source().y()};
  }
  return e.a;  // they meet, but rounding hides the point
}

/// Sweeps over x; names the first meeting of each pair of rings.
void examine_edges(const std::vector<const Ring*>& rings, Findings& f) {
  std::vector<Edge> edges;
  for (std::size_t r = 0; r < rings.size(); ++r) {
    const Ring& ring = *rings[r];
    for (std::size_t i = 0; i < ring.size(); ++i)
      edges.push_back({static_cast<int>(r), static_cast<int>(i), ring[i], ring[(i + 1) % ring.size()]});
  }
  std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) {
    return std::make_tuple(a.low(0), a.ring, a.index) < std::make_tuple(b.low(0), b.ring, b.index);
  });
  std::vector<std::pair<int, int>> named;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    for (std::size_t j = i + 1; j < edges.size() && edges[j].low(0) <= edges[i].high(0); ++j) {
      if (edges[j].low(1) > edges[i].high(1) || edges[j].high(1) < edges[i].low(1)) continue;
      const auto place = meeting(edges[i], edges[j], static_cast<int>(rings[edges[i].ring]->size()));
      if (!place) continue;
      const std::pair<int, int> pair = std::minmax(edges[i].ring, edges[j].ring);
      if (std::find(named.begin(), named.end(), pair) != named.end()) continue;
      named.push_back(pair);
      const std::string where = in_mm((*place)[0], (*place)[1]);
      if (pair.first == pair.second) {
        const auto [first, second] = std::minmax(edges[i].index, edges[j].index);
        f.add("*.simple"_family,
              fmt::format("must not cross or touch itself; {} does at {}, edges {} and {}",
                          name_of(pair.first), where, first + 1, second + 1),
              "Points stand in order around the blank: look for two that are swapped.");
      } else {
        f.add("*.apart"_family,
              fmt::format("must keep its borders apart; {} and {} meet at {}", name_of(pair.first),
                          name_of(pair.second), where),
              "Move or shrink the hole, or make the notch a part of the outer border.");
      }
    }
  }
}

/// With no two edges meeting, one point of a hole says where the whole hole is.
bool inside(const Ring& ring, const Point2& p, bool border_counts) {
  std::vector<Kernel::Point_2> points;
  points.reserve(ring.size());
  for (const Point2& q : ring) points.push_back(point(q));
  const CGAL::Bounded_side side = CGAL::bounded_side_2(points.begin(), points.end(), point(p), Kernel());
  return side == CGAL::ON_BOUNDED_SIDE || (border_counts && side == CGAL::ON_BOUNDARY);
}

void examine_nesting(const Outline& outline, Findings& f) {
  for (std::size_t h = 0; h < outline.holes.size(); ++h) {
    const Point2& p = outline.holes[h].front();
    if (!inside(outline.outer, p, false)) {
      f.add("*.hole_inside"_family,
            fmt::format("must have its holes inside; hole {} lies outside, at {}", h + 1, in_mm(p[0], p[1])),
            "Move the hole, or leave it out.");
    }
    for (std::size_t other = 0; other < outline.holes.size(); ++other) {
      if (other == h || !inside(outline.holes[other], p, false)) continue;
      f.add("*.hole_in_hole"_family,
            fmt::format("must have holes apart; hole {} lies in hole {}, at {}", h + 1, other + 1,
                        in_mm(p[0], p[1])),
            "Leave the inner one out.");
    }
  }
}

// ---- clipping

struct ExactPoint {
  Exact x, y;
};
using ExactRing = std::vector<ExactPoint>;

/// What is left of an outline in some part of the plane: rings with a sign each, +1 outer, -1 hole. Rings
/// that were cut in two hang together by edges along the cut, there and back, which add no area.
struct Piece {
  ExactRing ring;
  int sign;
};
using Pieces = std::vector<Piece>;

/// Sutherland-Hodgman against the half plane where side(p) >= 0; side is affine.
template <class Side>
ExactRing clip(const ExactRing& ring, const Side& side) {
  ExactRing kept;
  if (ring.empty()) return kept;
  const ExactPoint* from = &ring.back();
  Exact side_from = side(*from);
  int sign_from = CGAL::sign(side_from);
  for (const ExactPoint& to : ring) {
    Exact side_to = side(to);
    const int sign_to = CGAL::sign(side_to);
    if (sign_from * sign_to < 0) {
      const Exact t = side_from / (side_from - side_to);
      kept.push_back({from->x + t * (to.x - from->x), from->y + t * (to.y - from->y)});
    }
    if (sign_to >= 0) kept.push_back(to);
    from = &to;
    side_from = std::move(side_to);
    sign_from = sign_to;
  }
  return kept;
}

Exact twice_area(const ExactRing& ring) {
  Exact sum = 0;
  for (std::size_t i = 1; i + 1 < ring.size(); ++i) {
    const Exact ux = ring[i].x - ring[0].x, uy = ring[i].y - ring[0].y;
    const Exact vx = ring[i + 1].x - ring[0].x, vy = ring[i + 1].y - ring[0].y;
    sum += ux * vy - uy * vx;
  }
  return sum;
}

Exact twice_area(const Pieces& pieces) {
  Exact sum = 0;
  for (const Piece& piece : pieces) {
    const Exact part = twice_area(piece.ring);
    if (piece.sign > 0) {
      sum += part;
    } else {
      sum -= part;
    }
  }
  return sum;
}

template <class Side>
void clip_all(Pieces& pieces, const Side& side) {
  for (Piece& piece : pieces) piece.ring = clip(piece.ring, side);
  std::erase_if(pieces, [](const Piece& piece) { return piece.ring.size() < 3; });
}

struct Rectangle {
  std::array<double, 2> low{INFINITY, INFINITY}, high{-INFINITY, -INFINITY};
  void add(const Point2& p) {
    for (int c = 0; c < 2; ++c) {
      low[c] = std::min(low[c], p[c]);
      high[c] = std::max(high[c], p[c]);
    }
  }
};

void clip_to_box(Pieces& pieces, const Rectangle& box) {
  const Exact x0 = box.low[0], x1 = box.high[0], y0 = box.low[1], y1 = box.high[1];
  clip_all(pieces, [&](const ExactPoint& p) { return Exact(p.x - x0); });
  clip_all(pieces, [&](const ExactPoint& p) { return Exact(x1 - p.x); });
  clip_all(pieces, [&](const ExactPoint& p) { return Exact(p.y - y0); });
  clip_all(pieces, [&](const ExactPoint& p) { return Exact(y1 - p.y); });
}

void clip_to_cell(Pieces& pieces, const QuadCell& cell) {
  for (int k = 0; k < 4; ++k) {
    const Exact ax = cell[k][0], ay = cell[k][1];
    const Exact dx = Exact(cell[(k + 1) % 4][0]) - ax, dy = Exact(cell[(k + 1) % 4][1]) - ay;
    clip_all(pieces, [&](const ExactPoint& p) { return Exact(dx * (p.y - ay) - dy * (p.x - ax)); });
  }
}

ExactRing exact(const Ring& ring) {
  ExactRing result;
  for (const Point2& p : ring) result.push_back({Exact(p[0]), Exact(p[1])});
  return result;
}

Pieces pieces_of(const Outline& outline) {
  Pieces pieces;
  const auto add = [&](const Ring& ring, int sign) {
    ExactRing points = exact(ring);
    if (CGAL::sign(twice_area(points)) < 0) std::reverse(points.begin(), points.end());
    pieces.push_back({std::move(points), sign});
  };
  add(outline.outer, 1);
  for (const Ring& hole : outline.holes) add(hole, -1);
  return pieces;
}

class Clipper {
 public:
  explicit Clipper(const std::vector<QuadCell>& cells) : cells_(cells), areas_(cells.size(), 0.0) {}

  /// Fills in the areas of cells[first..last) of `order`.
  void divide(Pieces pieces, std::vector<int>::iterator first, std::vector<int>::iterator last) {
    Rectangle box;
    for (auto it = first; it != last; ++it) {
      for (const Point2& p : cells_[*it]) box.add(p);
    }
    clip_to_box(pieces, box);
    const Exact inside = twice_area(pieces);
    if (CGAL::is_zero(inside)) return;
    const Exact whole =
        Exact(2) * (Exact(box.high[0]) - Exact(box.low[0])) * (Exact(box.high[1]) - Exact(box.low[1]));
    if (inside == whole) {
      for (auto it = first; it != last; ++it) areas_[*it] = area(cells_[*it]);
      return;
    }
    if (last - first == 1) {
      areas_[*first] = clipped(std::move(pieces), cells_[*first]);
      return;
    }
    const int axis = box.high[0] - box.low[0] >= box.high[1] - box.low[1] ? 0 : 1;
    const auto middle = first + (last - first) / 2;
    std::nth_element(first, middle, last, [&](int a, int b) {
      return std::make_pair(centre(a, axis), a) < std::make_pair(centre(b, axis), b);
    });
    divide(pieces, first, middle);
    divide(std::move(pieces), middle, last);
  }

  std::vector<double> take() { return std::move(areas_); }

 private:
  double centre(int cell, int axis) const {
    double sum = 0.0;
    for (const Point2& p : cells_[cell]) sum += p[axis];
    return sum;
  }

  static double clipped(Pieces pieces, const QuadCell& cell) {
    clip_to_cell(pieces, cell);
    const Exact twice = twice_area(pieces);
    if (twice == twice_area(exact(Ring(cell.begin(), cell.end())))) return area(cell);
    return 0.5 * CGAL::to_double(twice);
  }

  const std::vector<QuadCell>& cells_;
  std::vector<double> areas_;
};

void require_convex(const std::vector<QuadCell>& cells) {
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const QuadCell& cell = cells[i];
    for (int k = 0; k < 4; ++k) {
      if (CGAL::orientation(point(cell[k]), point(cell[(k + 1) % 4]), point(cell[(k + 2) % 4])) !=
          CGAL::LEFT_TURN)
        throw std::invalid_argument(
            fmt::format("cell {} is not convex and counter-clockwise at corner {}", i, (k + 1) % 4));
    }
  }
}

void drop_repeated_end(Ring& ring) {
  if (ring.size() > 1 && ring.front() == ring.back()) ring.pop_back();
}

}  // namespace

Outline rectangle(std::array<double, 2> size) {
  const double x = 0.5 * size[0], y = 0.5 * size[1];
  return {{{-x, -y}, {x, -y}, {x, y}, {-x, y}}, {}};
}

Outline circle(double radius, double chord_error, Point2 centre) {
  const double cosine = 1.0 - chord_error / radius;
  const double wanted = cosine > 0.0 ? std::numbers::pi / std::acos(cosine) : 4.0;
  if (!(radius > 0.0) || !(chord_error > 0.0) || !(wanted <= static_cast<double>(most_points))) {
    throw InputError(
        {{"blank.outline.circle.range"_rule, "blank.outline", fmt::format("radius {:g} mm", 1e3 * radius),
          fmt::format("must have a positive radius and a chord error that {} points reach", most_points),
          "0.01 mm suits a blank of 0.3 m."}});
  }
  const int eighth = std::max(1, static_cast<int>(std::ceil(wanted / 8.0)));
  const int n = 8 * eighth;
  Outline outline;
  // One octant is computed, the rest mirrored, so that symmetric cells get equal areas.
  for (int i = 0; i < n; ++i) {
    const int quarter = i / (2 * eighth), rest = i % (2 * eighth);
    const int k = rest <= eighth ? rest : 2 * eighth - rest;
    const double angle = 2.0 * std::numbers::pi * k / n;
    double c = radius * std::cos(angle), s = radius * std::sin(angle);
    if (k == eighth) s = c;
    if (rest > eighth) std::swap(c, s);
    const std::array<Point2, 4> turned{{{c, s}, {-s, c}, {-c, -s}, {s, -c}}};
    outline.outer.push_back({centre[0] + turned[quarter][0], centre[1] + turned[quarter][1]});
  }
  return outline;
}

Outline polygon(Ring outer, std::vector<Ring> holes) {
  drop_repeated_end(outer);
  if (signed_area(outer) < 0.0) std::reverse(outer.begin(), outer.end());
  for (Ring& hole : holes) {
    drop_repeated_end(hole);
    if (signed_area(hole) > 0.0) std::reverse(hole.begin(), hole.end());
  }
  return {std::move(outer), std::move(holes)};
}

Problems check(const Outline& outline, const std::string& key) {
  Findings f(key, key, "");
  std::vector<const Ring*> rings{&outline.outer};
  for (const Ring& hole : outline.holes) rings.push_back(&hole);
  std::size_t points = 0;
  for (std::size_t r = 0; r < rings.size(); ++r) {
    points += rings[r]->size();
    examine_points(*rings[r], static_cast<int>(r), f);
  }
  if (points > most_points) {
    f.add("*.size"_family, fmt::format("must have at most {} points; it has {}", most_points, points),
          "Draw it coarser.");
  }
  if (f.any()) return f.take();
  examine_edges(rings, f);
  if (f.any()) return f.take();
  const ExactRing outer = exact(outline.outer);
  if (CGAL::sign(twice_area(outer)) <= 0)
    f.add("*.orientation"_family, "must run counter-clockwise around a positive area",
          "Give the points in reverse order.");
  examine_nesting(outline, f);
  return f.take();
}

double area(const Outline& outline) {
  return 0.5 * CGAL::to_double(twice_area(pieces_of(outline)));
}

double area(const QuadCell& cell) {
  return 0.5 * ((cell[2][0] - cell[0][0]) * (cell[3][1] - cell[1][1]) -
                (cell[2][1] - cell[0][1]) * (cell[3][0] - cell[1][0]));
}

bool contains(const Outline& outline, double x, double y) {
  const Point2 p{x, y};
  if (!inside(outline.outer, p, true)) return false;
  return std::none_of(outline.holes.begin(), outline.holes.end(),
                      [&](const Ring& hole) { return inside(hole, p, false); });
}

std::vector<double> clipped_areas(const Outline& outline, const std::vector<QuadCell>& cells) {
  require_convex(cells);
  if (cells.empty()) return {};
  std::vector<int> order(cells.size());
  std::iota(order.begin(), order.end(), 0);
  Clipper clipper(cells);
  clipper.divide(pieces_of(outline), order.begin(), order.end());
  return clipper.take();
}

}  // namespace heddle::macroscale
