#include "macroscale/whole_blank.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace heddle::macroscale {

namespace {

/// One image of the piece: across which axes, and so in which grid directions, it is turned over.
struct Image {
  std::array<bool, 2> axis{}, direction{};
  double sign() const { return axis[0] == axis[1] ? 1.0 : -1.0; }
};

// On planes of symmetry tows run along x and y.
bool warp_runs_along_x(const BlankState& piece) {
  const auto &from = piece.reference[piece.quads.front()[0]], &to = piece.reference[piece.quads.front()[1]];
  return std::abs(to[0] - from[0]) > std::abs(to[1] - from[1]);
}

std::vector<Image> images_of(Symmetry symmetry, bool warp_along_x) {
  std::vector<Image> images;
  for (const bool x : {false, true})
    for (const bool y : {false, true}) {
      if ((x && !mirrored_across(symmetry, 0)) || (y && !mirrored_across(symmetry, 1))) continue;
      images.push_back({{x, y}, {warp_along_x ? x : y, warp_along_x ? y : x}});
    }
  return images;
}

template <std::size_t N>
std::array<double, N> image_of(std::array<double, N> vector, const Image& image) {
  for (std::size_t axis = 0; axis < 2; ++axis)
    if (image.axis[axis]) vector[axis] = -vector[axis];
  return vector;
}

/// In the grid's own coordinates, of which a direction has `count` cells (or points less one).
std::array<int, 2> image_of(std::array<int, 2> place, const Image& image, std::array<int, 2> count) {
  for (std::size_t d = 0; d < 2; ++d)
    if (image.direction[d]) place[d] = count[d] - place[d];
  return place;
}

CellPiece image_of(CellPiece piece, const Image& image, int quad) {
  piece.quad = quad;
  for (auto& corner : piece.corners)
    for (std::size_t d = 0; d < 2; ++d)
      if (image.direction[d]) corner[d] = 1.0 - corner[d];
  if (image.direction[0] != image.direction[1]) std::reverse(piece.corners.begin(), piece.corners.end());
  return piece;
}

/// Whether a point of the edge lies on a plane across which it is turned over: there once is enough.
bool is_own_image(const EdgeState& edge, const Image& image) {
  constexpr double rounding = 1e-12;  // [m]
  for (std::size_t axis = 0; axis < 2; ++axis)
    if (image.axis[axis] && std::abs(edge.reference[axis]) < rounding) return true;
  return false;
}

/// What stands at each place of a grid: the number in the piece, and the image that puts it there.
struct Source {
  int number = -1;
  const Image* image = nullptr;
};

class Places {
 public:
  Places(int rows, int columns) : columns_(columns), source_(static_cast<std::size_t>(rows) * columns) {}
  Source& at(std::array<int, 2> place) {
    return source_[static_cast<std::size_t>(place[0]) * columns_ + place[1]];
  }
  const std::vector<Source>& all() const { return source_; }
  std::array<int, 2> place(std::size_t k) const {
    return {static_cast<int>(k) / columns_, static_cast<int>(k) % columns_};
  }

 private:
  int columns_;
  std::vector<Source> source_;
};

template <class Value>
void take(const std::vector<Value>& of_piece, const std::vector<int>& node, std::vector<Value>& of_whole) {
  if (of_piece.empty()) return;
  for (const int n : node) of_whole.push_back(of_piece[static_cast<std::size_t>(n)]);
}

}  // namespace

WholeBlank whole_of(const BlankState& piece) {
  if (piece.symmetry == Symmetry::none) {
    WholeBlank same{piece, {}};
    for (std::size_t n = 0; n < piece.grid.size(); ++n) same.node.push_back(static_cast<int>(n));
    return same;
  }
  const std::vector<Image> images = images_of(piece.symmetry, warp_runs_along_x(piece));
  Places nodes(piece.nu + 1, piece.nv + 1), cells(piece.nu, piece.nv);
  // The piece itself comes first, so that nodes on a plane are its own.
  for (const Image& image : images) {
    for (std::size_t n = 0; n < piece.grid.size(); ++n)
      if (Source& s = nodes.at(image_of(piece.grid[n], image, {piece.nu, piece.nv})); s.number < 0)
        s = {static_cast<int>(n), &image};
    for (std::size_t q = 0; q < piece.quads.size(); ++q)
      cells.at(image_of(piece.grid[piece.quads[q][0]], image, {piece.nu - 1, piece.nv - 1})) = {
          static_cast<int>(q), &image};
  }

  WholeBlank whole;
  BlankState& s = whole.state;
  s.nu = piece.nu;
  s.nv = piece.nv;
  s.outline = piece.outline;
  s.time = piece.time;
  s.punch_displacement = piece.punch_displacement;
  s.binder_position = piece.binder_position;
  std::vector<int> number_at;
  for (std::size_t k = 0; k < nodes.all().size(); ++k) {
    const auto& [n, image] = nodes.all()[k];
    number_at.push_back(n < 0 ? -1 : static_cast<int>(whole.node.size()));
    if (n < 0) continue;
    whole.node.push_back(n);
    s.grid.push_back(nodes.place(k));
    s.reference.push_back(image_of(piece.reference[n], *image));
    s.position.push_back(image_of(piece.position[n], *image));
    s.velocity.push_back(image_of(piece.velocity[n], *image));
    s.shear_angle.push_back(image->sign() * piece.shear_angle[n]);  // turns its sign in a mirror
  }
  const auto node = [&](int i, int j) { return number_at[static_cast<std::size_t>(i * (s.nv + 1) + j)]; };
  std::vector<std::vector<CellPiece>> pieces(piece.quads.size());
  for (const CellPiece& p : piece.pieces) pieces[p.quad].push_back(p);
  for (std::size_t k = 0; k < cells.all().size(); ++k) {
    const auto& [q, image] = cells.all()[k];
    if (q < 0) continue;
    const auto [i, j] = cells.place(k);
    for (const CellPiece& p : pieces[q])
      s.pieces.push_back(image_of(p, *image, static_cast<int>(s.quads.size())));
    s.quads.push_back({node(i, j), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1)});
  }
  for (const Image& image : images)
    for (const EdgeState& edge : piece.edge)
      if (!is_own_image(edge, image))
        s.edge.push_back({image_of(edge.reference, image), image_of(edge.position, image), edge.draw_in});
  std::stable_sort(s.edge.begin(), s.edge.end(), [](const EdgeState& a, const EdgeState& b) {
    return std::atan2(a.reference[1], a.reference[0]) < std::atan2(b.reference[1], b.reference[0]);
  });
  take(piece.tow_strain, whole.node, s.tow_strain);
  take(piece.pressure, whole.node, s.pressure);
  take(piece.slip_speed, whole.node, s.slip_speed);
  take(piece.friction_coefficient, whole.node, s.friction_coefficient);
  take(piece.hersey, whole.node, s.hersey);
  take(piece.ply_slip, whole.node, s.ply_slip);
  take(piece.ply_pressure, whole.node, s.ply_pressure);
  take(piece.heat.bottom, whole.node, s.heat.bottom);
  take(piece.heat.top, whole.node, s.heat.top);
  take(piece.heat.mean, whole.node, s.heat.mean);
  take(piece.heat.crystallised, whole.node, s.heat.crystallised);
  return whole;
}

}  // namespace heddle::macroscale
