#include "tet_cell.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <tuple>

namespace heddle::test {

namespace {

using mesoscale::UnitCell;

// Faces that cut a line, from below.
enum Face { floor_face, warp_below, warp_above, weft_below, weft_above, roof_face, faces };

// Lines over one axis of the plane: places from the middle of the first gap on, one more than there are
// lines.
std::vector<double> places(double spacing, double width, int tows, int per_tow) {
  std::vector<double> at;
  const double gap = spacing - width;
  const int per_gap = gap > 1e-9 * spacing ? std::max(2, 2 * (per_tow / 10)) : 0;
  for (int tow = 0; tow < tows; ++tow) {
    const double start = (tow - 0.5) * spacing;
    for (int k = 0; k < per_gap / 2; ++k) at.push_back(start + 0.5 * gap * k / (per_gap / 2));
    for (int k = 0; k < per_tow; ++k) at.push_back(start + 0.5 * gap + width * k / per_tow);
    for (int k = 0; k < per_gap / 2; ++k)
      at.push_back(start + 0.5 * gap + width + 0.5 * gap * k / (per_gap / 2));
  }
  at.push_back((tows - 0.5) * spacing);
  return at;
}

struct Line {
  std::array<int, faces> at{};  // place of a face in `nodes`; -1: the tow is not here
  std::vector<int> nodes;       // from below
};

class TetBuilder {
 public:
  TetBuilder(const UnitCell& cell, double thickness, int per_tow, int over_tow)
      : cell_(cell),
        thickness_(thickness),
        finest_(
            std::min(mesoscale::thickness(cell.tow[0].section), mesoscale::thickness(cell.tow[1].section)) /
            over_tow),
        xi_(places(cell.tow[1].spacing, mesoscale::width(cell.tow[1].section), cell.weave.wefts, per_tow)),
        eta_(places(cell.tow[0].spacing, mesoscale::width(cell.tow[0].section), cell.weave.warps, per_tow)) {}

  TetCell build() {
    for (int j = 0; j < ny(); ++j)
      for (int i = 0; i < nx(); ++i) add_line(i, j);
    for (int j = 0; j < ny(); ++j)
      for (int i = 0; i < nx(); ++i) {
        // Diagonals in turn, so that the mesh prefers no direction.
        if ((i + j) % 2 == 0) {
          fill({{{i, j}, {i + 1, j}, {i + 1, j + 1}}});
          fill({{{i, j}, {i + 1, j + 1}, {i, j + 1}}});
        } else {
          fill({{{i, j}, {i + 1, j}, {i, j + 1}}});
          fill({{{i + 1, j}, {i + 1, j + 1}, {i, j + 1}}});
        }
      }
    result_.area = (xi_.back() - xi_.front()) * (eta_.back() - eta_.front()) * std::cos(cell_.shear_angle);
    result_.height = thickness_;
    return std::move(result_);
  }

 private:
  using Corners = std::array<std::array<int, 2>, 3>;

  int nx() const { return static_cast<int>(xi_.size()) - 1; }
  int ny() const { return static_cast<int>(eta_.size()) - 1; }
  int line_index(int i, int j) const { return (j % ny()) * nx() + i % nx(); }

  // Signed place of a point against the middle of the nearest tow, over half its width: within 1 inside.
  static double across(double at, double spacing, double width) {
    return std::abs(at - spacing * std::round(at / spacing)) / (0.5 * width);
  }
  double across_warp(double eta) const {
    return across(eta, cell_.tow[0].spacing, mesoscale::width(cell_.tow[0].section));
  }
  double across_weft(double xi) const {
    return across(xi, cell_.tow[1].spacing, mesoscale::width(cell_.tow[1].section));
  }
  static constexpr double edge = 1e-6;  // of the half width

  void add_line(int i, int j) {
    const double xi = xi_[static_cast<std::size_t>(i)], eta = eta_[static_cast<std::size_t>(j)];
    std::array<double, faces> z{};
    std::array<bool, faces> here{};
    const auto set = [&](Face below, Face above, double centre, double half) {
      z[below] = std::max(centre - half, -0.5 * thickness_);
      z[above] = std::min(centre + half, 0.5 * thickness_);
      here[below] = here[above] = true;
    };
    z[floor_face] = -0.5 * thickness_;
    z[roof_face] = 0.5 * thickness_;
    here[floor_face] = here[roof_face] = true;
    const double warp_side = across_warp(eta), weft_side = across_weft(xi);
    const int warp = static_cast<int>(std::lround(eta / cell_.tow[0].spacing));
    const int weft = static_cast<int>(std::lround(xi / cell_.tow[1].spacing));
    if (warp_side < 1.0 + edge)
      set(warp_below, warp_above, mesoscale::warp_centre(cell_, warp, xi),
          warp_side > 1.0 - edge ? 0.0 : half_of(0, warp_side));
    if (weft_side < 1.0 + edge)
      set(weft_below, weft_above, mesoscale::weft_centre(cell_, weft, eta),
          weft_side > 1.0 - edge ? 0.0 : half_of(1, weft_side));
    const bool at_edge = std::abs(warp_side - 1.0) < edge || std::abs(weft_side - 1.0) < edge;
    finish_line(line_index(i, j), z, here, at_edge);
  }

  double half_of(std::size_t tow, double side) const {
    const auto& section = cell_.tow[tow].section;
    return mesoscale::upper_face(section, 0.5 * side * mesoscale::width(section));
  }

  void finish_line(int index, const std::array<double, faces>& z, const std::array<bool, faces>& here,
                   bool at_edge) {
    std::vector<std::pair<double, Face>> cuts;
    for (int f = 0; f < faces; ++f)
      if (here[static_cast<std::size_t>(f)])
        cuts.push_back({z[static_cast<std::size_t>(f)], static_cast<Face>(f)});
    std::stable_sort(cuts.begin(), cuts.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    Line line;
    line.at.fill(-1);
    for (const auto& [height, face] : cuts) {
      const double last = line.nodes.empty() ? -1.0 : result_.nodes.back().height;
      // What touches shares a node.
      if (line.nodes.empty() || height - last > 1e-5 * thickness_) {
        // At an edge the layers on its two sides are not the same ones: no node but those of the faces.
        const int steps =
            line.nodes.empty() || at_edge ? 1 : static_cast<int>(std::ceil((height - last) / finest_ - 1e-9));
        for (int k = 1; k <= steps; ++k) {
          line.nodes.push_back(static_cast<int>(result_.nodes.size()));
          result_.nodes.push_back({index, steps == 1 ? height : last + (height - last) * k / steps, 0});
        }
      }
      if (face == roof_face) result_.nodes.back().height = height;  // crowns end there but for rounding
      line.at[face] = static_cast<int>(line.nodes.size()) - 1;
    }
    // On one side of a tow's edge the edge bounds a layer, on the other it lies inside one: ranked by it,
    // both sides lift in the same order.
    for (const auto& [below, above] : {std::pair{warp_below, warp_above}, {weft_below, weft_above}})
      if (line.at[below] >= 0 && line.at[below] == line.at[above])
        for (std::size_t k = static_cast<std::size_t>(line.at[below]) + 1; k < line.nodes.size(); ++k)
          ++result_.nodes[static_cast<std::size_t>(line.nodes[k])].rank;
    lines_.push_back(std::move(line));
  }

  const Line& line(const std::array<int, 2>& corner) const {
    return lines_[static_cast<std::size_t>(line_index(corner[0], corner[1]))];
  }
  const TetCell::Node& node_of(const Line& line, int k) const {
    return result_.nodes[static_cast<std::size_t>(line.nodes[static_cast<std::size_t>(k)])];
  }

  // The faces that bound layers over a triangle, and what fills the layers between them.
  struct Layering {
    std::vector<Face> face;
    std::vector<int> phase;
  };
  Layering layering(const Corners& corners) const {
    double xi = 0.0, eta = 0.0;
    for (const auto& [i, j] : corners) {
      xi += xi_[static_cast<std::size_t>(i)] / 3.0;
      eta += eta_[static_cast<std::size_t>(j)] / 3.0;
    }
    const bool warp = across_warp(eta) < 1.0, weft = across_weft(xi) < 1.0;
    Layering out{{floor_face}, {}};
    const auto add = [&](Face below, Face above, int phase) {
      out.phase.insert(out.phase.end(), {0, phase});
      out.face.insert(out.face.end(), {below, above});
    };
    const bool warp_first = warp && weft &&
                            !cell_.weave.warp_over(static_cast<int>(std::lround(eta / cell_.tow[0].spacing)),
                                                   static_cast<int>(std::lround(xi / cell_.tow[1].spacing)));
    if (warp && (!weft || warp_first)) add(warp_below, warp_above, 1);
    if (weft) add(weft_below, weft_above, 2);
    if (warp && weft && !warp_first) add(warp_below, warp_above, 1);
    out.phase.push_back(0);
    out.face.push_back(roof_face);
    return out;
  }

  void fill(const Corners& corners) {
    const Layering layers = layering(corners);
    std::array<int, 3> front{0, 0, 0};
    for (std::size_t layer = 0; layer < layers.phase.size(); ++layer) {
      std::array<int, 3> last{};
      for (std::size_t c = 0; c < 3; ++c) last[c] = line(corners[c]).at[layers.face[layer + 1]];
      while (true) {
        // The lowest next node, of the lower line where two are level: the same choice from either side.
        int lift = -1;
        std::tuple<int, double, int> lowest{1000, 0.0, 0};
        for (std::size_t c = 0; c < 3; ++c) {
          if (front[c] >= last[c]) continue;
          const TetCell::Node& node = node_of(line(corners[c]), front[c] + 1);
          const std::tuple<int, double, int> next{node.rank, node.height, node.line};
          if (next < lowest) {
            lowest = next;
            lift = static_cast<int>(c);
          }
        }
        if (lift < 0) break;
        add_tetrahedron(corners, front, static_cast<std::size_t>(lift), layers.phase[layer]);
        ++front[static_cast<std::size_t>(lift)];
      }
    }
  }

  void add_tetrahedron(const Corners& corners, const std::array<int, 3>& front, std::size_t lift, int phase) {
    TetCell::Tetrahedron tet{};
    tet.phase = phase;
    for (std::size_t n = 0; n < 4; ++n) {
      const std::size_t c = n < 3 ? n : lift;
      const int k = n < 3 ? front[c] : front[c] + 1;
      const double u = xi_[static_cast<std::size_t>(corners[c][0])],
                   v = eta_[static_cast<std::size_t>(corners[c][1])];
      const std::array<double, 2> place = cell_.place(u, v);
      tet.node[n] = line(corners[c]).nodes[static_cast<std::size_t>(k)];
      tet.place[n] = {place[0], place[1], node_of(line(corners[c]), k).height};
    }
    result_.volume += volume(tet);
    result_.tetrahedra.push_back(tet);
  }

  static double volume(const TetCell::Tetrahedron& tet) {
    Eigen::Matrix3d sides;
    for (int n = 0; n < 3; ++n)
      for (int axis = 0; axis < 3; ++axis)
        sides(axis, n) = tet.place[static_cast<std::size_t>(n) + 1][static_cast<std::size_t>(axis)] -
                         tet.place[0][static_cast<std::size_t>(axis)];
    return std::abs(sides.determinant()) / 6.0;
  }

  const UnitCell& cell_;
  double thickness_, finest_;
  std::vector<double> xi_, eta_;
  std::vector<Line> lines_;
  TetCell result_;
};

}  // namespace

std::array<double, 3> fibre_direction(const UnitCell& cell, int phase, const std::array<double, 3>& place) {
  if (phase == 0) return {1.0, 0.0, 0.0};
  const auto along_xi = cell.place(1.0, 0.0), along_eta = cell.place(0.0, 1.0);
  Eigen::Matrix2d lattice;
  lattice << along_xi[0], along_eta[0], along_xi[1], along_eta[1];
  const Eigen::Vector2d at = lattice.inverse() * Eigen::Vector2d(place[0], place[1]);
  const double xi = at[0], eta = at[1], h = 1e-4 * cell.tow[0].spacing;
  if (phase == 1) {
    const int warp = static_cast<int>(std::lround(eta / cell.tow[0].spacing));
    return {1.0, 0.0,
            (mesoscale::warp_centre(cell, warp, xi + h) - mesoscale::warp_centre(cell, warp, xi - h)) /
                (2.0 * h)};
  }
  const int weft = static_cast<int>(std::lround(xi / cell.tow[1].spacing));
  return {along_eta[0], along_eta[1],
          (mesoscale::weft_centre(cell, weft, eta + h) - mesoscale::weft_centre(cell, weft, eta - h)) /
              (2.0 * h)};
}

TetCell tet_cell(const UnitCell& cell, double thickness, int per_tow, int over_tow) {
  return TetBuilder(cell, thickness, per_tow, over_tow).build();
}

}  // namespace heddle::test
