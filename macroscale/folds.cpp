#include "macroscale/folds.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <stdexcept>

#include <Eigen/Geometry>

#include "core/triangle_walk.h"
#include "macroscale/ply_state.h"

namespace heddle::macroscale {

namespace {

using Eigen::Vector3d;

struct Bounds {
  Vector3d low, high;
  bool meets(const Bounds& other) const {
    return (low.array() <= other.high.array()).all() && (other.low.array() <= high.array()).all();
  }
};

/// The sheet as nodes on grid lines and cells of two triangles.
class Sheet {
 public:
  explicit Sheet(const BlankState& blank)
      : blank_(blank),
        rows_(blank.nv + 1),
        node_(static_cast<std::size_t>((blank.nu + 1) * rows_), -1),
        spacing_{spacing_along(0), spacing_along(1)} {
    for (std::size_t n = 0; n < blank.grid.size(); ++n) {
      node_[static_cast<std::size_t>(blank.grid[n][0] * rows_ + blank.grid[n][1])] = static_cast<int>(n);
      at_.emplace_back(blank.position[n].data());
    }
    for (const auto& q : blank.quads) {
      const Vector3d &a = at(q[0]), &b = at(q[1]), &c = at(q[2]), &d = at(q[3]);
      cell_.push_back(
          {{a.cwiseMin(b).cwiseMin(c.cwiseMin(d)), a.cwiseMax(b).cwiseMax(c.cwiseMax(d))}, grid(q[0])});
    }
  }

  int nodes() const { return static_cast<int>(at_.size()); }
  int cells() const { return static_cast<int>(cell_.size()); }
  double spacing() const { return std::max(spacing_[0], spacing_[1]); }
  const Vector3d& at(int n) const { return at_[static_cast<std::size_t>(n)]; }
  const std::array<int, 2>& grid(int n) const { return blank_.grid[static_cast<std::size_t>(n)]; }
  const Bounds& box(int cell) const { return cell_[static_cast<std::size_t>(cell)].box; }

  int node(int i, int j) const {
    if (i < 0 || j < 0 || i > blank_.nu || j > blank_.nv) return -1;
    return node_[static_cast<std::size_t>(i * rows_ + j)];
  }
  std::array<std::array<int, 3>, 2> triangles(int cell) const {
    const auto& q = blank_.quads[static_cast<std::size_t>(cell)];
    return {{{q[0], q[1], q[2]}, {q[0], q[2], q[3]}}};
  }

  /// Unit normal from the chords to the neighbours; zero where there is none.
  Vector3d normal(int n) const {
    const auto [i, j] = grid(n);
    const auto chord = [&](int before, int after) -> Vector3d {
      return at(after < 0 ? n : after) - at(before < 0 ? n : before);
    };
    const Vector3d m = chord(node(i - 1, j), node(i + 1, j)).cross(chord(node(i, j - 1), node(i, j + 1)));
    const double length = m.norm();
    return length > 0.0 ? Vector3d(m / length) : Vector3d::Zero();
  }

  /// Lines of the grid between a node and a cell: none if it is the cell's own.
  std::array<int, 2> lines_between(int n, int cell) const {
    const auto [i, j] = grid(n);
    const auto [ci, cj] = cell_[static_cast<std::size_t>(cell)].grid;
    return {std::max({ci - i, i - ci - 1, 0}), std::max({cj - j, j - cj - 1, 0})};
  }
  /// Squared distance between a node and a cell in the flat sheet [m^2].
  double flat_distance2(int n, int cell) const {
    const auto [di, dj] = lines_between(n, cell);
    const double u = di * spacing_[0], v = dj * spacing_[1];
    return u * u + v * v;
  }

 private:
  // Of the first cell: grids are regular.
  double spacing_along(int direction) const {
    if (blank_.quads.empty()) return 0.0;
    const auto& q = blank_.quads.front();
    const auto& a = blank_.reference[static_cast<std::size_t>(q[0])];
    const auto& b = blank_.reference[static_cast<std::size_t>(direction == 0 ? q[1] : q[3])];
    return std::hypot(b[0] - a[0], b[1] - a[1]);
  }

  struct Cell {
    Bounds box;
    std::array<int, 2> grid;  ///< of its first node
  };
  const BlankState& blank_;
  int rows_;
  std::vector<int> node_;
  std::array<double, 2> spacing_;
  std::vector<Vector3d> at_;
  std::vector<Cell> cell_;
};

/// Boxes of a uniform grid and the cells of the sheet whose own boxes reach into them.
class BoxGrid {
 public:
  BoxGrid(const Sheet& sheet, double side) : inverse_side_(1.0 / side) {
    Vector3d low = sheet.at(0), high = low;
    for (int n = 1; n < sheet.nodes(); ++n) {
      low = low.cwiseMin(sheet.at(n));
      high = high.cwiseMax(sheet.at(n));
    }
    low_ = low;
    for (int c = 0; c < 3; ++c) count_[c] = 1 + static_cast<int>((high[c] - low[c]) * inverse_side_);
    first_.assign(static_cast<std::size_t>(count_[0]) * count_[1] * count_[2] + 1, 0);
    // Counted, then filled.
    for (int cell = 0; cell < sheet.cells(); ++cell)
      each_box(sheet.box(cell), [&](std::size_t box) { ++first_[box + 1]; });
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
    cell_.resize(static_cast<std::size_t>(first_.back()));
    std::vector<int> next(first_.begin(), first_.end() - 1);
    for (int cell = 0; cell < sheet.cells(); ++cell)
      each_box(sheet.box(cell),
               [&](std::size_t box) { cell_[static_cast<std::size_t>(next[box]++)] = cell; });
  }

  /// Cells near a box; one may come more than once.
  template <class Visit>
  void each_near(const Bounds& around, const Visit& visit) const {
    each_box(around, [&](std::size_t box) {
      for (int k = first_[box]; k < first_[box + 1]; ++k) visit(cell_[static_cast<std::size_t>(k)]);
    });
  }

 private:
  template <class Visit>
  void each_box(const Bounds& box, const Visit& visit) const {
    std::array<int, 3> from, to;
    for (int c = 0; c < 3; ++c) {
      from[c] = std::clamp(static_cast<int>((box.low[c] - low_[c]) * inverse_side_), 0, count_[c] - 1);
      to[c] = std::clamp(static_cast<int>((box.high[c] - low_[c]) * inverse_side_), 0, count_[c] - 1);
    }
    for (int i = from[0]; i <= to[0]; ++i)
      for (int j = from[1]; j <= to[1]; ++j)
        for (int k = from[2]; k <= to[2]; ++k)
          visit((static_cast<std::size_t>(i) * count_[1] + j) * count_[2] + k);
  }

  Vector3d low_;
  double inverse_side_;
  std::array<int, 3> count_{};
  std::vector<int> first_, cell_;
};

/// Whether the way from p to q passes through a triangle (Moeller & Trumbore 1997). One that lies in its
/// plane does not.
bool passes_through(const Vector3d& p, const Vector3d& q, const Vector3d& a, const Vector3d& b,
                    const Vector3d& c) {
  const Vector3d along = q - p, ab = b - a, ac = c - a;
  const Vector3d h = along.cross(ac);
  const double volume = ab.dot(h);
  if (std::abs(volume) <= 1e-12 * along.norm() * ab.norm() * ac.norm()) return false;
  const Vector3d ap = p - a;
  const double u = ap.dot(h) / volume;
  if (u < 0.0 || u > 1.0) return false;
  const Vector3d k = ap.cross(ab);
  const double v = along.dot(k) / volume;
  if (v < 0.0 || u + v > 1.0) return false;
  const double t = ac.dot(k) / volume;
  return t >= 0.0 && t <= 1.0;
}

std::vector<double> turns(const Sheet& sheet) {
  constexpr std::array<std::array<int, 2>, 4> ways{{{1, 0}, {0, 1}, {1, 1}, {1, -1}}};
  std::vector<Vector3d> normal;
  for (int n = 0; n < sheet.nodes(); ++n) normal.push_back(sheet.normal(n));
  std::vector<double> least(normal.size(), 1.0);  // cosine
  for (int n = 0; n < sheet.nodes(); ++n) {
    const auto [i, j] = sheet.grid(n);
    for (const auto& [u, v] : ways)
      for (int k = 1; k <= fold_span; ++k) {
        const int other = sheet.node(i + k * u, j + k * v);
        if (other < 0) break;
        const double cosine =
            normal[static_cast<std::size_t>(n)].dot(normal[static_cast<std::size_t>(other)]);
        if (normal[static_cast<std::size_t>(n)].isZero(0.0) ||
            normal[static_cast<std::size_t>(other)].isZero(0.0))
          continue;  // a node with neighbours along one tow only has none
        for (const int end : {n, other})
          least[static_cast<std::size_t>(end)] = std::min(least[static_cast<std::size_t>(end)], cosine);
      }
  }
  for (double& value : least) value = std::acos(std::clamp(value, -1.0, 1.0));
  return least;
}

// Nearest cell that is no neighbour, within `reach`.
std::vector<double> distances(const Sheet& sheet, const BoxGrid& boxes, double reach) {
  const double neighbour = std::max(4.0 * sheet.spacing(), 4.0 * reach);
  std::vector<double> nearest(static_cast<std::size_t>(sheet.nodes()), reach);
  for (int n = 0; n < sheet.nodes(); ++n) {
    const Vector3d &p = sheet.at(n), span = Vector3d::Constant(reach);
    const Bounds around{p - span, p + span};
    double& best = nearest[static_cast<std::size_t>(n)];
    boxes.each_near(around, [&](int cell) {
      if (sheet.flat_distance2(n, cell) < neighbour * neighbour || !sheet.box(cell).meets(around)) return;
      for (const auto& [a, b, c] : sheet.triangles(cell))
        best = std::min(best, std::sqrt(squared_distance(sheet.at(a), sheet.at(b), sheet.at(c), p)));
    });
  }
  return nearest;
}

// Whether the segment from node n to node m passes through a cell that shares no node with it.
bool crosses_sheet(const Sheet& sheet, const BoxGrid& boxes, int n, int m) {
  const Vector3d &p = sheet.at(n), &q = sheet.at(m);
  const Bounds around{p.cwiseMin(q), p.cwiseMax(q)};
  bool crosses = false;
  boxes.each_near(around, [&](int cell) {
    if (crosses || !sheet.box(cell).meets(around)) return;
    for (const int end : {n, m})
      if (sheet.lines_between(end, cell) == std::array{0, 0}) return;
    for (const auto& [a, b, c] : sheet.triangles(cell))
      crosses |= passes_through(p, q, sheet.at(a), sheet.at(b), sheet.at(c));
  });
  return crosses;
}

// Of the segments that begin at node n, how many cross; the other end of each that does is shown.
template <class Show>
int crossings_from(const Sheet& sheet, const BoxGrid& boxes, int n, const Show& show) {
  int crossings = 0;
  const auto [i, j] = sheet.grid(n);
  for (const int m : {sheet.node(i + 1, j), sheet.node(i, j + 1)}) {
    if (m < 0 || !crosses_sheet(sheet, boxes, n, m)) continue;
    ++crossings;
    show(m);
  }
  return crossings;
}

/// Nodes that fold, are near or cross, joined where they are as close in the grid as the two sides of a fold.
std::vector<FoldPlace> places(const Sheet& sheet, const Folds& folds, const std::vector<char>& marked) {
  std::vector<FoldPlace> all;
  std::vector<char> seen(marked.size(), 0);
  for (int first = 0; first < sheet.nodes(); ++first) {
    if (!marked[static_cast<std::size_t>(first)] || seen[static_cast<std::size_t>(first)]) continue;
    FoldPlace place{.distance = folds.reach};
    Vector3d sum = Vector3d::Zero();
    std::vector<int> open{first};
    seen[static_cast<std::size_t>(first)] = 1;
    while (!open.empty()) {
      const int n = open.back();
      open.pop_back();
      ++place.nodes;
      sum += sheet.at(n);
      place.turn = std::max(place.turn, folds.turn[static_cast<std::size_t>(n)]);
      place.distance = std::min(place.distance, folds.distance[static_cast<std::size_t>(n)]);
      const auto [i, j] = sheet.grid(n);
      for (int u = -fold_span; u <= fold_span; ++u)
        for (int v = -fold_span; v <= fold_span; ++v) {
          const int next = sheet.node(i + u, j + v);
          if (next < 0 || !marked[static_cast<std::size_t>(next)] || seen[static_cast<std::size_t>(next)])
            continue;
          seen[static_cast<std::size_t>(next)] = 1;
          open.push_back(next);
        }
    }
    sum /= place.nodes;
    place.at = {sum.x(), sum.y(), sum.z()};
    all.push_back(place);
  }
  std::stable_sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.nodes > b.nodes; });
  return all;
}

// Each ply by itself: what lies on one another in a stack is meant to.
Folds folds_of_plies(const BlankState& blank, double thickness) {
  Folds all;
  all.reach = thickness;
  for (int k = 0; k < ply_count(blank); ++k) {
    const Folds one = find_folds(ply_of(blank, k), thickness);
    all.turn.insert(all.turn.end(), one.turn.begin(), one.turn.end());
    all.distance.insert(all.distance.end(), one.distance.begin(), one.distance.end());
    all.place.insert(all.place.end(), one.place.begin(), one.place.end());
    all.folded += one.folded;
    all.near += one.near;
    all.crossings += one.crossings;
  }
  std::stable_sort(all.place.begin(), all.place.end(),
                   [](const auto& a, const auto& b) { return a.nodes > b.nodes; });
  return all;
}

}  // namespace

Folds find_folds(const BlankState& blank, double thickness) {
  if (blank.position.size() != blank.grid.size() || blank.reference.size() != blank.grid.size())
    throw std::invalid_argument("find_folds: one place in the grid, flat and formed, a node");
  if (!blank.plies.empty()) return folds_of_plies(blank, thickness);
  Folds folds;
  folds.reach = thickness;
  if (blank.quads.empty()) return folds;
  const Sheet sheet(blank);
  const BoxGrid boxes(sheet, std::max(1.5 * sheet.spacing(), thickness));
  folds.turn = turns(sheet);
  folds.distance = distances(sheet, boxes, thickness);
  std::vector<char> marked(folds.turn.size(), 0);
  for (int n = 0; n < sheet.nodes(); ++n) {
    const auto at = static_cast<std::size_t>(n);
    folds.folded += folds.turn[at] > fold_turn;
    folds.near += folds.distance[at] < thickness;
    marked[at] = folds.turn[at] > fold_turn || folds.distance[at] < thickness;
    folds.crossings +=
        crossings_from(sheet, boxes, n, [&](int m) { marked[at] = marked[static_cast<std::size_t>(m)] = 1; });
  }
  folds.place = places(sheet, folds, marked);
  return folds;
}

int count_crossings(const Blank& blank, const Eigen::VectorXd& x) {
  int crossings = 0;
  for (int k = 0; k < blank.plies(); ++k) {
    const Ply& ply = blank.ply(k);
    BlankState shape;
    shape.nu = ply.nu;
    shape.nv = ply.nv;
    for (int n = ply.first_node; n < ply.end_node; ++n) {
      shape.grid.push_back(blank.grid[n]);
      shape.reference.push_back({blank.reference[n].x(), blank.reference[n].y()});
      shape.position.push_back({x[3 * n], x[3 * n + 1], x[3 * n + 2]});
    }
    for (int q = ply.first_quad; q < ply.end_quad; ++q) {
      std::array<int, 4>& quad = shape.quads.emplace_back(blank.quads[q]);
      for (int& node : quad) node -= ply.first_node;
    }
    if (shape.quads.empty()) continue;
    const Sheet sheet(shape);
    const BoxGrid boxes(sheet, 1.5 * sheet.spacing());
    for (int n = 0; n < sheet.nodes(); ++n) crossings += crossings_from(sheet, boxes, n, [](int) {});
  }
  return crossings;
}

}  // namespace heddle::macroscale
