#include "macroscale/blank.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "macroscale/outline_cut.h"

namespace heddle::macroscale {

namespace {

using Eigen::Vector2d;

// A share or a coordinate this close to a whole number is one: rounding must not cut a cell.
constexpr double rounding = 1e-12;

int cells(double size, double spacing) {
  // 1e-9: a size that is a whole number of spacings must not gain a cell by rounding.
  return std::max(1, static_cast<int>(std::ceil(size / spacing - 1e-9)));
}

// Where the tows run along x and y: which of them each grid direction is, and whether it points that way.
struct GridAxis {
  std::size_t axis;
  bool forwards;
};
GridAxis axis_of(const std::array<double, 2>& warp, std::size_t direction) {
  const std::array<double, 2> along = direction == 0 ? warp : std::array<double, 2>{-warp[1], warp[0]};
  const std::size_t axis = std::abs(along[0]) > std::abs(along[1]) ? 0 : 1;
  return {axis, along[axis] > 0.0};
}

// Exact at right angles: a blank at 90 degrees is the one at 0, turned without rounding.
std::array<double, 2> direction_of(double orientation) {
  double c = std::cos(orientation), s = std::sin(orientation);
  if (std::abs(c) < rounding) c = 0.0, s = std::copysign(1.0, s);
  if (std::abs(s) < rounding) s = 0.0, c = std::copysign(1.0, c);
  return {c, s};
}

struct Extent {
  std::array<double, 2> low, high;
};

Extent extent_of(const Ring& ring) {
  Extent e{ring.front(), ring.front()};
  for (const Point2& p : ring)
    for (std::size_t d = 0; d < 2; ++d) {
      e.low[d] = std::min(e.low[d], p[d]);
      e.high[d] = std::max(e.high[d], p[d]);
    }
  return e;
}

// Cuts the inside of some polygons (even-odd rule) into trapezoids between the heights of their corners.
std::vector<std::array<Point2, 4>> trapezoids(const std::vector<Ring>& rings) {
  std::vector<double> heights;
  for (const Ring& ring : rings)
    for (const Point2& p : ring) heights.push_back(p[1]);
  std::sort(heights.begin(), heights.end());
  heights.erase(
      std::unique(heights.begin(), heights.end(), [](double a, double b) { return b - a < rounding; }),
      heights.end());
  std::vector<std::array<Point2, 4>> result;
  for (std::size_t h = 0; h + 1 < heights.size(); ++h) {
    const double low = heights[h], high = heights[h + 1], middle = 0.5 * (low + high);
    std::vector<std::array<double, 3>> sides;  // x in the middle, below, above
    for (const Ring& ring : rings)
      for (std::size_t k = 0; k < ring.size(); ++k) {
        const Point2 &a = ring[k], &b = ring[(k + 1) % ring.size()];
        if ((a[1] > middle) == (b[1] > middle)) continue;
        const auto x = [&](double y) { return a[0] + (y - a[1]) * (b[0] - a[0]) / (b[1] - a[1]); };
        sides.push_back({x(middle), x(low), x(high)});
      }
    std::sort(sides.begin(), sides.end());
    for (std::size_t k = 0; k + 1 < sides.size(); k += 2)
      if (sides[k + 1][0] - sides[k][0] > rounding)
        result.push_back(
            {{{sides[k][1], low}, {sides[k + 1][1], low}, {sides[k + 1][2], high}, {sides[k][2], high}}});
  }
  return result;
}

// One cell of the grid and what of the outline lies in it.
struct Cell {
  double share = 0.0;
  std::vector<std::array<Point2, 4>> pieces;  // of a cut cell, in its own coordinates
};

// The outline in units of cells: cell (i, j) is the square from (i, j) to (i + 1, j + 1).
Outline in_grid(const Outline& along_tows, const Blank& blank) {
  Outline result = along_tows;
  const auto scale = [&](Ring& ring) {
    for (Point2& p : ring) {
      p[0] = (p[0] - blank.centre[0]) / blank.spacing[0] + 0.5 * blank.nu;
      p[1] = (p[1] - blank.centre[1]) / blank.spacing[1] + 0.5 * blank.nv;
    }
  };
  scale(result.outer);
  for (Ring& hole : result.holes) scale(hole);
  return result;
}

QuadCell unit_cell_at(int i, int j) {
  const double x = i, y = j;
  return {{{x, y}, {x + 1, y}, {x + 1, y + 1}, {x, y + 1}}};
}

// @param share  exact area of the outline in the cell
Cell cut_cell(const Outline& outline, int i, int j, double share) {
  Cell cell;
  if (share <= rounding) return cell;
  // An edge that runs along the grid may miss it by rounding of its own coordinates.
  cell.share = std::abs(share - 1.0) < rounding ? 1.0 : share;
  if (cell.share == 1.0) return cell;
  std::vector<Ring> rings = clipped(outline, unit_cell_at(i, j));
  for (Ring& ring : rings)
    for (Point2& p : ring) p = {p[0] - i, p[1] - j};
  cell.pieces = trapezoids(rings);
  return cell;
}

class Trimming {
 public:
  Trimming(const Blank& blank, const Outline& along_tows) : nu_(blank.nu), nv_(blank.nv) {
    const Outline outline = in_grid(along_tows, blank);
    std::vector<QuadCell> grid;
    for (int i = 0; i < nu_; ++i)
      for (int j = 0; j < nv_; ++j) grid.push_back(unit_cell_at(i, j));
    const std::vector<double> shares = clipped_areas(outline, grid);
    for (int i = 0; i < nu_; ++i)
      for (int j = 0; j < nv_; ++j) cells_.push_back(cut_cell(outline, i, j, shares[i * nv_ + j]));
    give_slivers_away();
  }
  const Cell& at(int i, int j) const { return cells_[i * nv_ + j]; }

  /// Leaves the half of the cells that lies forwards (or backwards) in one grid direction.
  void keep_half(std::size_t direction, bool forwards) {
    for (int i = 0; i < nu_; ++i)
      for (int j = 0; j < nv_; ++j) {
        const bool ahead = direction == 0 ? 2 * i >= nu_ : 2 * j >= nv_;
        if (ahead != forwards) cells_[i * nv_ + j] = Cell{};
      }
  }

 private:
  // To the neighbour across a side that holds most; where none is kept, the sliver stays. Equal neighbours
  // share: mirror images must stay alike, so equal means up to rounding.
  void give_slivers_away() {
    constexpr double alike = 1e-9;
    const std::vector<Cell> before = cells_;
    constexpr std::array<std::array<int, 2>, 4> sides = {{{-1, 0}, {1, 0}, {0, -1}, {0, 1}}};
    const auto share = [&](int i, int j) {
      return i < 0 || j < 0 || i >= nu_ || j >= nv_ ? 0.0 : before[i * nv_ + j].share;
    };
    for (int i = 0; i < nu_; ++i)
      for (int j = 0; j < nv_; ++j) {
        if (share(i, j) == 0.0 || share(i, j) >= smallest_share) continue;
        double most = smallest_share;
        for (const auto& side : sides) most = std::max(most, share(i + side[0], j + side[1]));
        std::vector<std::array<int, 2>> takers;
        for (const auto& side : sides)
          if (share(i + side[0], j + side[1]) >= most - alike) takers.push_back(side);
        if (!takers.empty()) give(i, j, takers);
      }
  }
  void give(int i, int j, const std::vector<std::array<int, 2>>& takers) {
    Cell& giver = cells_[i * nv_ + j];
    for (const auto& side : takers)
      cells_[(i + side[0]) * nv_ + j + side[1]].share += giver.share / static_cast<double>(takers.size());
    // Pieces are for pictures and lie where they lie: one taker draws them.
    const auto& side = takers.front();
    Cell& taker = cells_[(i + side[0]) * nv_ + j + side[1]];
    if (taker.pieces.empty()) taker.pieces = {{{{0.0, 0.0}, {1.0, 0.0}, {1.0, 1.0}, {0.0, 1.0}}}};
    for (auto piece : giver.pieces) {
      for (Point2& p : piece) p = {p[0] - side[0], p[1] - side[1]};
      taker.pieces.push_back(piece);
    }
    giver = Cell{};
  }
  int nu_, nv_;
  std::vector<Cell> cells_;
};

void number_nodes(Blank& blank, const Trimming& trimming, double z) {
  const auto kept = [&](int i, int j) {
    return i >= 0 && j >= 0 && i < blank.nu && j < blank.nv && trimming.at(i, j).share > 0.0;
  };
  const auto [c, s] = blank.warp;
  for (int i = 0; i <= blank.nu; ++i)
    for (int j = 0; j <= blank.nv; ++j) {
      const bool used = kept(i - 1, j - 1) || kept(i - 1, j) || kept(i, j - 1) || kept(i, j);
      blank.node_at.push_back(used ? blank.nodes() : -1);
      if (!used) continue;
      // Written so that opposite nodes are exact mirror images: the symmetric part must not be tilted by
      // rounding.
      const double u = blank.centre[0] + (i - 0.5 * blank.nu) * blank.spacing[0];
      const double v = blank.centre[1] + (j - 0.5 * blank.nv) * blank.spacing[1];
      blank.reference.emplace_back(c * u - s * v, s * u + c * v, z);
      blank.grid.push_back({i, j});
    }
}

void add_quads(Blank& blank, const Trimming& trimming) {
  blank.node_area.assign(blank.reference.size(), 0.0);
  for (int i = 0; i < blank.nu; ++i)
    for (int j = 0; j < blank.nv; ++j) {
      const Cell& cell = trimming.at(i, j);
      const int quad = static_cast<int>(blank.quads.size());
      blank.quad_at.push_back(cell.share > 0.0 ? quad : -1);
      if (cell.share == 0.0) continue;
      blank.quads.push_back(
          {blank.node(i, j), blank.node(i + 1, j), blank.node(i + 1, j + 1), blank.node(i, j + 1)});
      blank.share.push_back(cell.share);
      for (int node : blank.quads.back()) blank.node_area[node] += cell.share * blank.corner_area();
      for (const auto& piece : cell.pieces) blank.pieces.push_back({quad, piece});
    }
}

// Segments are the sides of quads; a triple is two segments of one tow line, as wide as the quads around its
// middle node hold material.
void add_tow_lines(Blank& blank) {
  const auto share = [&](int i, int j) { return blank.quad(i, j) < 0 ? 0.0 : blank.share[blank.quad(i, j)]; };
  const auto along_warp = [&](int i, int j) { return blank.quad(i, j - 1) >= 0 || blank.quad(i, j) >= 0; };
  const auto along_weft = [&](int i, int j) { return blank.quad(i - 1, j) >= 0 || blank.quad(i, j) >= 0; };
  for (int i = 0; i <= blank.nu; ++i)
    for (int j = 0; j <= blank.nv; ++j) {
      const int middle = blank.node(i, j);
      if (middle < 0) continue;
      const double around = 0.25 * (share(i - 1, j - 1) + share(i - 1, j) + share(i, j - 1) + share(i, j));
      if (along_warp(i, j)) blank.segments.push_back({middle, blank.node(i + 1, j), 0});
      if (along_weft(i, j)) blank.segments.push_back({middle, blank.node(i, j + 1), 1});
      // Half of each segment lies around the middle node, so a full blank's edge counts half its width.
      if (along_warp(i - 1, j) && along_warp(i, j))
        blank.triples.push_back(
            {blank.node(i - 1, j), middle, blank.node(i + 1, j), around * blank.spacing[1], 0});
      if (along_weft(i, j - 1) && along_weft(i, j))
        blank.triples.push_back(
            {blank.node(i, j - 1), middle, blank.node(i, j + 1), around * blank.spacing[0], 1});
    }
}

// ---- the edge

struct Side {
  Vector2d from, along, inward;
  double length;
};

std::vector<Side> sides_of(const Ring& ring) {
  double doubled_area = 0.0;
  for (std::size_t k = 0; k < ring.size(); ++k) {
    const Point2 &a = ring[k], &b = ring[(k + 1) % ring.size()];
    doubled_area += a[0] * b[1] - a[1] * b[0];
  }
  const double turn = doubled_area > 0.0 ? 1.0 : -1.0;
  std::vector<Side> sides;
  for (std::size_t k = 0; k < ring.size(); ++k) {
    const Vector2d a(ring[k][0], ring[k][1]);
    const Vector2d b(ring[(k + 1) % ring.size()][0], ring[(k + 1) % ring.size()][1]);
    const double length = (b - a).norm();
    if (length == 0.0) continue;
    const Vector2d along = (b - a) / length;
    sides.push_back({a, along, turn * Vector2d(-along.y(), along.x()), length});
  }
  return sides;
}

bool in_piece(const Blank& blank, const Vector2d& x) {
  for (std::size_t axis = 0; axis < 2; ++axis)
    if (mirrored_across(blank.symmetry, axis) &&
        x[static_cast<Eigen::Index>(axis)] < -1e-9 * blank.spacing[0])
      return false;
  return true;
}

// Points at equal steps along each stretch between two corners (of more than 30 degrees); an edge without
// corners is one closed stretch. Corners have no normal and are left out.
void add_edge(Blank& blank, Outline outline) {
  blank.outline = std::move(outline);
  const std::vector<Side> sides = sides_of(blank.outline.outer);
  const std::size_t n = sides.size();
  // Along a tow the steps are those of the grid.
  const auto pitch = [&](const Side& side) {
    const double along = std::abs(side.along.x() * blank.warp[0] + side.along.y() * blank.warp[1]);
    return along * along > 0.5 ? blank.spacing[0] : blank.spacing[1];
  };
  const auto corner_before = [&](std::size_t k) {
    return sides[(k + n - 1) % n].along.dot(sides[k].along) < std::cos(std::acos(-1.0) / 6.0);
  };
  std::size_t first = 0;
  while (first < n && !corner_before(first)) ++first;
  const bool closed = first == n;
  for (std::size_t begin = closed ? 0 : first, done = 0; done < n;) {
    std::size_t count = 1;
    double length = sides[begin].length;
    for (; done + count < n && (closed || !corner_before((begin + count) % n)); ++count)
      length += sides[(begin + count) % n].length;
    const int steps = cells(length, pitch(sides[begin]));
    std::size_t k = 0;
    double passed = 0.0;
    for (int step = closed ? 0 : 1; step < steps; ++step) {
      const double at = length * step / steps;
      while (k + 1 < count && passed + sides[(begin + k) % n].length <= at)
        passed += sides[(begin + k++) % n].length;
      const Side& side = sides[(begin + k) % n];
      const Vector2d x = side.from + (at - passed) * side.along;
      if (in_piece(blank, x)) blank.edge.push_back({blank.locate(x), x, side.inward});
    }
    done += count;
    begin = (begin + count) % n;
  }
}

// Tow lines that cross a plane of symmetry begin there: of their first triple one half lies in the piece.
void add_mirrored(Blank& blank) {
  for (std::size_t direction = 0; direction < 2; ++direction) {
    const GridAxis to = axis_of(blank.warp, direction);
    if (!mirrored_across(blank.symmetry, to.axis)) continue;
    const int step = to.forwards ? 1 : -1;
    const int line = (direction == 0 ? blank.nu : blank.nv) / 2,
              across = direction == 0 ? blank.nv : blank.nu;
    const auto node = [&](int k, int n) { return direction == 0 ? blank.node(k, n) : blank.node(n, k); };
    const auto share = [&](int n) {
      const int cell = to.forwards ? line : line - 1;
      const int quad = direction == 0 ? blank.quad(cell, n) : blank.quad(n, cell);
      return quad < 0 ? 0.0 : blank.share[quad];
    };
    for (int n = 0; n <= across; ++n) {
      const double width = 0.25 * (share(n - 1) + share(n)) * blank.spacing[1 - direction];
      if (width > 0.0)
        blank.mirrored.push_back({node(line, n), node(line + step, n), width, static_cast<int>(direction),
                                  static_cast<int>(to.axis)});
    }
  }
}

Blank trimmed_blank(const Outline& along_tows, double spacing, std::array<double, 2> warp, double z,
                    Symmetry symmetry) {
  Blank blank;
  const Extent extent = extent_of(along_tows.outer);
  std::array<int, 2> count{};
  for (std::size_t d = 0; d < 2; ++d) {
    const double size = extent.high[d] - extent.low[d];
    const bool halved = mirrored_across(symmetry, axis_of(warp, d).axis);
    count[d] = halved ? 2 * cells(0.5 * size, spacing) : cells(size, spacing);
    blank.spacing[d] = size / count[d];
    blank.centre[d] = halved ? 0.0 : 0.5 * (extent.low[d] + extent.high[d]);
  }
  blank.nu = count[0];
  blank.nv = count[1];
  blank.warp = warp;
  blank.symmetry = symmetry;
  Trimming trimming(blank, along_tows);
  for (std::size_t d = 0; d < 2; ++d)
    if (const GridAxis to = axis_of(warp, d); mirrored_across(symmetry, to.axis))
      trimming.keep_half(d, to.forwards);
  number_nodes(blank, trimming, z);
  add_quads(blank, trimming);
  add_tow_lines(blank);
  add_mirrored(blank);
  blank.end_node = blank.nodes();
  blank.end_quad = static_cast<int>(blank.quads.size());
  return blank;
}

}  // namespace

std::array<Corner, 4> corners_of(const std::array<int, 4>& quad) {
  return {{{quad[0], quad[1], quad[3], +1},
           {quad[1], quad[0], quad[2], -1},
           {quad[2], quad[3], quad[1], +1},
           {quad[3], quad[2], quad[0], -1}}};
}

MaterialPoint Ply::locate(const Vector2d& x) const {
  const auto [c, s] = warp;
  std::array<double, 2> at = {(c * x.x() + s * x.y() - centre[0]) / spacing[0] + 0.5 * nu,
                              (c * x.y() - s * x.x() - centre[1]) / spacing[1] + 0.5 * nv};
  for (double& a : at)
    if (std::abs(a - std::round(a)) < 1e-9) a = std::round(a);
  const int i0 = static_cast<int>(std::floor(at[0])), j0 = static_cast<int>(std::floor(at[1]));
  int found = -1;
  double nearest = std::numeric_limits<double>::max();
  std::array<double, 2> local{};
  for (int ring = 1; found < 0 && ring <= nu + nv; ++ring)
    for (int i = i0 - ring; i <= i0 + ring; ++i)
      for (int j = j0 - ring; j <= j0 + ring; ++j) {
        if (quad(i, j) < 0) continue;
        const double u = at[0] - i, v = at[1] - j;
        const double outside = std::max({0.0, -u, u - 1.0}) + std::max({0.0, -v, v - 1.0});
        if (outside >= nearest) continue;
        nearest = outside;
        found = quad(i, j);
        local = {u, v};
      }
  const auto [u, v] = local;
  return {found, {(1.0 - u) * (1.0 - v), u * (1.0 - v), u * v, (1.0 - u) * v}};
}

Blank make_blank(const Outline& outline, double spacing, double orientation, double z, Symmetry symmetry) {
  const std::array<double, 2> warp = direction_of(orientation);
  Blank blank = trimmed_blank(turned(outline, warp[0], -warp[1]), spacing, warp, z, symmetry);
  add_edge(blank, outline);
  return blank;
}

Blank make_blank(std::array<double, 2> size, double spacing, double orientation, double z) {
  const std::array<double, 2> warp = direction_of(orientation);
  Blank blank = trimmed_blank(rectangle(size), spacing, warp, z, Symmetry::none);
  add_edge(blank, turned(rectangle(size), warp[0], warp[1]));
  return blank;
}

namespace {

template <class List>
void append(List& list, const List& more) {
  list.insert(list.end(), more.begin(), more.end());
}

// The same ply with the numbers it has behind so many nodes and quads.
void renumber(Blank& ply, int nodes, int quads) {
  const auto shift = [](int& number, int by) {
    if (number >= 0) number += by;
  };
  for (int& node : ply.node_at) shift(node, nodes);
  for (int& quad : ply.quad_at) shift(quad, quads);
  for (auto& quad : ply.quads)
    for (int& node : quad) node += nodes;
  for (TowSegment& s : ply.segments) s.from += nodes, s.to += nodes;
  for (TowTriple& t : ply.triples) t.before += nodes, t.middle += nodes, t.after += nodes;
  for (CellPiece& piece : ply.pieces) piece.quad += quads;
  for (EdgePoint& edge : ply.edge) edge.point.quad += quads;
  ply.first_node += nodes, ply.end_node += nodes;
  ply.first_quad += quads, ply.end_quad += quads;
}

}  // namespace

Blank turned(Blank blank, double angle) {
  if (angle == 0.0) return blank;
  const std::array<double, 2> way = direction_of(angle);
  const double c = way[0], s = way[1];
  const auto turn = [c, s](const Vector2d& x) {
    return Vector2d(c * x.x() - s * x.y(), s * x.x() + c * x.y());
  };
  const auto turn_ply = [&](Ply& ply) {
    ply.warp = {c * ply.warp[0] - s * ply.warp[1], s * ply.warp[0] + c * ply.warp[1]};
    ply.outline = turned(ply.outline, c, s);
    for (EdgePoint& edge : ply.edge) {
      edge.reference = turn(edge.reference);
      edge.inward = turn(edge.inward);
    }
  };
  turn_ply(blank);
  for (Ply& ply : blank.above) turn_ply(ply);
  for (Eigen::Vector3d& x : blank.reference) x.head<2>() = turn(x.head<2>());
  return blank;
}

Blank stacked(std::vector<Blank> plies) {
  Blank all = std::move(plies.at(0));
  for (std::size_t k = 1; k < plies.size(); ++k) {
    Blank& ply = plies[k];
    renumber(ply, all.nodes(), static_cast<int>(all.quads.size()));
    append(all.reference, ply.reference);
    append(all.grid, ply.grid);
    append(all.quads, ply.quads);
    append(all.share, ply.share);
    append(all.segments, ply.segments);
    append(all.triples, ply.triples);
    append(all.node_area, ply.node_area);
    append(all.pieces, ply.pieces);
    all.above.push_back(std::move(static_cast<Ply&>(ply)));
  }
  return all;
}

}  // namespace heddle::macroscale
