#pragma once

#include <algorithm>
#include <vector>

#include "macroscale/stamping.h"

// Inline, for readers of results that do not link the solver.
namespace heddle::macroscale {

namespace detail {

template <class T>
std::vector<T> part(const std::vector<T>& all, int first, int end) {
  return all.empty() ? all : std::vector<T>(all.begin() + first, all.begin() + end);
}

}  // namespace detail

inline int ply_count(const BlankState& blank) {
  return std::max(1, static_cast<int>(blank.plies.size()));
}

/// One ply of a blank by itself, for whatever looks at one grid: pictures, indicators. The whole blank where
/// it has one ply. @param ply  from the bottom
inline BlankState ply_of(const BlankState& blank, int ply) {
  if (blank.plies.empty()) return blank;
  const PlyRange& range = blank.plies.at(static_cast<std::size_t>(ply));
  BlankState one;
  one.nu = range.nu;
  one.nv = range.nv;
  const auto nodal = [&](const auto& all) { return detail::part(all, range.first_node, range.end_node); };
  one.grid = nodal(blank.grid);
  one.reference = nodal(blank.reference);
  one.position = nodal(blank.position);
  one.velocity = nodal(blank.velocity);
  one.shear_angle = nodal(blank.shear_angle);
  one.tow_strain = nodal(blank.tow_strain);
  one.pressure = nodal(blank.pressure);
  one.slip_speed = nodal(blank.slip_speed);
  one.friction_coefficient = nodal(blank.friction_coefficient);
  one.hersey = nodal(blank.hersey);
  one.ply_slip = nodal(blank.ply_slip);
  one.ply_pressure = nodal(blank.ply_pressure);
  one.quads = detail::part(blank.quads, range.first_quad, range.end_quad);
  for (auto& quad : one.quads)
    for (int& node : quad) node -= range.first_node;
  for (CellPiece piece : blank.pieces)
    if (piece.quad >= range.first_quad && piece.quad < range.end_quad) {
      piece.quad -= range.first_quad;
      one.pieces.push_back(piece);
    }
  one.edge = detail::part(blank.edge, range.first_edge, range.end_edge);
  one.outline = blank.outline;
  one.time = blank.time;
  one.punch_displacement = blank.punch_displacement;
  one.binder_position = blank.binder_position;
  return one;
}

}  // namespace heddle::macroscale
