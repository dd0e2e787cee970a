#include "macroscale/outline.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace heddle::macroscale {

namespace {

using Polygon = std::vector<Point2>;

// Twice the signed area, seen from the first point: small polygons far from the origin keep their digits.
double doubled_area(const Polygon& p) {
  double sum = 0.0;
  for (std::size_t k = 1; k + 1 < p.size(); ++k)
    sum += (p[k][0] - p[0][0]) * (p[k + 1][1] - p[0][1]) - (p[k][1] - p[0][1]) * (p[k + 1][0] - p[0][0]);
  return sum;
}

double size_of(const Polygon& p) {
  return 0.5 * std::abs(doubled_area(p));
}

// What of the polygon lies to the left of the line from a to b.
Polygon left_of(const Polygon& p, const Point2& a, const Point2& b) {
  const auto side = [&](const Point2& x) {
    return (b[0] - a[0]) * (x[1] - a[1]) - (b[1] - a[1]) * (x[0] - a[0]);
  };
  Polygon kept;
  for (std::size_t k = 0; k < p.size(); ++k) {
    const Point2 &from = p[k], &to = p[(k + 1) % p.size()];
    const double before = side(from), after = side(to);
    if (before >= 0.0) kept.push_back(from);
    if ((before > 0.0 && after < 0.0) || (before < 0.0 && after > 0.0)) {
      const double t = before / (before - after);
      kept.push_back({from[0] + t * (to[0] - from[0]), from[1] + t * (to[1] - from[1])});
    }
  }
  return kept;
}

Polygon inside(Polygon p, const std::array<Point2, 4>& quad) {
  for (std::size_t k = 0; k < 4 && !p.empty(); ++k) p = left_of(p, quad[k], quad[(k + 1) % 4]);
  return p;
}

double distance_to_side(const Point2& a, const Point2& b) {
  const double dx = b[0] - a[0], dy = b[1] - a[1], length2 = dx * dx + dy * dy;
  const double t = length2 > 0.0 ? std::clamp(-(a[0] * dx + a[1] * dy) / length2, 0.0, 1.0) : 0.0;
  return std::hypot(a[0] + t * dx, a[1] + t * dy);
}

bool holds_origin(const Polygon& p) {
  bool in = false;
  for (std::size_t k = 0; k < p.size(); ++k) {
    const Point2 &a = p[k], &b = p[(k + 1) % p.size()];
    if ((a[1] > 0.0) != (b[1] > 0.0) && a[0] - a[1] * (b[0] - a[0]) / (b[1] - a[1]) > 0.0) in = !in;
  }
  return in;
}

}  // namespace

Outline rectangle(Point2 size) {
  const double x = 0.5 * size[0], y = 0.5 * size[1];
  return {{{-x, -y}, {x, -y}, {x, y}, {-x, y}}, {}};
}

Outline circle(double radius, double chord_error, Point2 centre) {
  const double half_turn = std::acos(std::clamp(1.0 - chord_error / radius, -1.0, 1.0));
  const int eighth = std::max(1, static_cast<int>(std::ceil(std::numbers::pi / half_turn / 8.0)));
  Outline outline;
  for (int k = 0; k < 8 * eighth; ++k) {
    // From the nearest axis, so that mirror images agree to the last bit.
    const int quarter = (k + eighth) / (2 * eighth) % 4,
              rest = k - 2 * eighth * ((k + eighth) / (2 * eighth));
    const double angle = 0.25 * std::numbers::pi * rest / eighth;
    const double c = radius * std::cos(angle), s = radius * std::sin(angle);
    const std::array<Point2, 4> images = {{{c, s}, {-s, c}, {-c, -s}, {s, -c}}};
    outline.outer.push_back({centre[0] + images[quarter][0], centre[1] + images[quarter][1]});
  }
  return outline;
}

double area(const Outline& outline) {
  double sum = size_of(outline.outer);
  for (const auto& hole : outline.holes) sum -= size_of(hole);
  return sum;
}

Outline turned(const Outline& outline, double c, double s) {
  Outline result = outline;
  const auto turn = [&](Polygon& p) {
    for (Point2& x : p) x = {c * x[0] - s * x[1], s * x[0] + c * x[1]};
  };
  turn(result.outer);
  for (Polygon& hole : result.holes) turn(hole);
  return result;
}

double reach(const Outline& outline) {
  double nearest = 1e300;
  const Polygon& p = outline.outer;
  for (std::size_t k = 0; k < p.size(); ++k)
    nearest = std::min(nearest, distance_to_side(p[k], p[(k + 1) % p.size()]));
  return holds_origin(p) ? nearest : -nearest;
}

double ray_length(const Outline& outline, const Point2& direction) {
  double farthest = 0.0;
  const Polygon& p = outline.outer;
  for (std::size_t k = 0; k < p.size(); ++k) {
    const Point2 &a = p[k], &b = p[(k + 1) % p.size()];
    const double left_a = direction[0] * a[1] - direction[1] * a[0],
                 left_b = direction[0] * b[1] - direction[1] * b[0];
    if ((left_a > 0.0) == (left_b > 0.0)) continue;
    const double t = left_a / (left_a - left_b);
    farthest = std::max(
        farthest, direction[0] * (a[0] + t * (b[0] - a[0])) + direction[1] * (a[1] + t * (b[1] - a[1])));
  }
  return farthest;
}

std::vector<std::vector<Point2>> clipped(const Outline& outline, const std::array<Point2, 4>& quad) {
  std::vector<Polygon> parts{inside(outline.outer, quad)};
  if (parts.front().empty()) return {};
  for (const Polygon& hole : outline.holes) {
    Polygon part = inside(hole, quad);
    if (!part.empty()) parts.push_back(std::move(part));
  }
  return parts;
}

double clipped_area(const Outline& outline, const std::array<Point2, 4>& quad) {
  std::vector<Polygon> parts = clipped(outline, quad);
  if (parts.empty()) return 0.0;
  Outline inside_quad{std::move(parts.front()), {}};
  inside_quad.holes.assign(parts.begin() + 1, parts.end());
  return area(inside_quad);
}

}  // namespace heddle::macroscale
