#pragma once

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/triangle_mesh.h"

namespace heddle::test {

using Meridian = std::vector<std::array<double, 2>>;  ///< {r, z} [m]

/// A meridian turned about z. Outward normals if its points have the solid on their left. Points with r = 0
/// become one vertex. `closed`: the last point is joined to the first.
inline TriangleMesh revolved(const Meridian& meridian, int segments, bool closed) {
  TriangleMesh mesh;
  std::vector<int> first;
  for (const auto& [r, z] : meridian) {
    first.push_back(static_cast<int>(mesh.vertices.size()));
    for (int s = 0; s < (r == 0.0 ? 1 : segments); ++s) {
      const double a = 2.0 * std::numbers::pi * s / segments;
      mesh.vertices.push_back({r * std::cos(a), r * std::sin(a), z});
    }
  }
  const int points = static_cast<int>(meridian.size());
  const auto vertex = [&](int p, int s) {
    const auto at = static_cast<std::size_t>(p % points);
    return first[at] + (meridian[at][0] == 0.0 ? 0 : s % segments);
  };
  for (int p = 0; p + 1 < points + (closed ? 1 : 0); ++p)
    for (int s = 0; s < segments; ++s) {
      const int a = vertex(p, s), b = vertex(p, s + 1), c = vertex(p + 1, s + 1), d = vertex(p + 1, s);
      if (a != b) mesh.triangles.push_back({a, b, d == c ? c : d});
      if (a == b || d != c) mesh.triangles.push_back({b, c, d});
    }
  return mesh;
}

/// Points of an arc from angle `from` to `to` (about {r, z} = centre, counter-clockwise from +r).
inline void add_arc(Meridian& meridian, std::array<double, 2> centre, double radius, double from, double to,
                    int steps) {
  for (int k = 0; k <= steps; ++k) {
    const double a = from + (to - from) * k / steps;
    double r = centre[0] + radius * std::cos(a);
    if (std::abs(r) < 1e-12) r = 0.0;
    meridian.push_back({r, centre[1] + radius * std::sin(a)});
  }
}

inline void add_line(Meridian& meridian, std::array<double, 2> to, int steps) {
  const std::array<double, 2> from = meridian.back();
  for (int k = 1; k <= steps; ++k)
    meridian.push_back({from[0] + (to[0] - from[0]) * k / steps, from[1] + (to[1] - from[1]) * k / steps});
}

/// Hemisphere with its apex at the origin, carried on by a cylinder up to `height`: HemisphereShape with an
/// end.
/// @param steps  a quarter of the meridian and a quarter of the round are cut into so many
inline TriangleMesh punch_mesh(double radius, double height, int steps) {
  Meridian meridian;
  add_arc(meridian, {0.0, radius}, radius, -0.5 * std::numbers::pi, 0.0, steps);
  const double edge = 0.5 * std::numbers::pi * radius / steps;
  add_line(meridian, {radius, height}, std::max(1, static_cast<int>((height - radius) / edge)));
  add_line(meridian, {0.0, height}, std::max(1, static_cast<int>(radius / edge)));
  return revolved(meridian, 4 * steps, false);
}

/// Die: ring plate with a rounded edge, flat face at z = 0, solid below; RingShape{0, opening, fillet, true}
/// with an end.
inline TriangleMesh die_mesh(double opening, double fillet, double outer, double depth, int steps,
                             int segments) {
  Meridian meridian{{opening, -depth}};
  add_line(meridian, {outer, -depth}, steps);
  add_line(meridian, {outer, 0.0}, steps);
  add_line(meridian, {opening + fillet, 0.0}, steps);
  meridian.pop_back();
  add_arc(meridian, {opening + fillet, -fillet}, fillet, 0.5 * std::numbers::pi, std::numbers::pi, steps);
  add_line(meridian, {opening, -depth}, steps);
  meridian.pop_back();
  return revolved(meridian, segments, true);
}

/// Box with corners low and high, two triangles a side.
inline TriangleMesh box_mesh(const std::array<double, 3>& low, const std::array<double, 3>& high) {
  TriangleMesh mesh;
  for (int n = 0; n < 8; ++n)
    mesh.vertices.push_back(
        {(n & 1) ? high[0] : low[0], (n & 2) ? high[1] : low[1], (n & 4) ? high[2] : low[2]});
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

}  // namespace heddle::test
