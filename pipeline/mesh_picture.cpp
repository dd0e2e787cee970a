#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <stdexcept>

#include "pipeline/colour_bar.h"
#include "pipeline/picture.h"

namespace heddle::pipeline {

namespace {

using Vector = std::array<double, 3>;

double dot(const Vector& a, const Vector& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
Vector cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
Vector difference(const Vector& a, const Vector& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

/// Directions of the picture in the frame of the body: right, up, and towards the viewer.
struct Directions {
  Vector right, up, viewer;
};

Directions frame_of(const Camera& camera) {
  const double azimuth = camera.azimuth * std::numbers::pi / 180.0;
  const double elevation = camera.elevation * std::numbers::pi / 180.0;
  Directions frame;
  frame.right = {-std::sin(azimuth), std::cos(azimuth), 0.0};
  frame.viewer = {std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
                  std::sin(elevation)};
  frame.up = cross(frame.viewer, frame.right);
  return frame;
}

/// Where a point of the body falls on the sheet, and how near to the viewer it is.
struct View {
  Directions frame;
  bool turned_over;
  double zoom;  ///< [px/m]
  Point origin;

  Vector turned(const Vector& p) const { return turned_over ? Vector{p[0], -p[1], -p[2]} : p; }
  Point pixel(const Vector& p) const {
    const Vector q = turned(p);
    return {origin.x + zoom * dot(q, frame.right), origin.y - zoom * dot(q, frame.up)};
  }
  double nearness(const Vector& p) const { return dot(turned(p), frame.viewer); }
};

struct Box {
  double left, top, right, bottom;  ///< [px]
};

/// The largest view whose points all fall inside the box, centred.
View fitted_view(const MeshPicture& picture, const Box& box) {
  View view{frame_of(picture.camera), picture.camera.turned_over, 1.0, {}};
  double left = 1e300, right = -1e300, top = 1e300, bottom = -1e300;
  const auto include = [&](const std::vector<Vector>& points) {
    for (const Vector& point : points) {
      const Point at = view.pixel(point);
      left = std::min(left, at.x), right = std::max(right, at.x);
      top = std::min(top, at.y), bottom = std::max(bottom, at.y);
    }
  };
  include(picture.points);
  for (const auto& outline : picture.outlines) include(outline);
  if (!(right > left) || !(bottom > top)) return view;
  view.zoom = std::min((box.right - box.left) / (right - left), (box.bottom - box.top) / (bottom - top));
  view.origin = {0.5 * (box.left + box.right) - 0.5 * view.zoom * (left + right),
                 0.5 * (box.top + box.bottom) - 0.5 * view.zoom * (top + bottom)};
  return view;
}

void require_valid(const MeshPicture& picture) {
  if (picture.value.size() != picture.points.size()) {
    throw std::invalid_argument(
        fmt::format("mesh picture: {} values for {} points", picture.value.size(), picture.points.size()));
  }
  for (std::size_t i = 0; i < picture.points.size(); ++i) {
    const Vector& p = picture.points[i];
    if (!std::isfinite(p[0] + p[1] + p[2] + picture.value[i])) {
      throw std::invalid_argument(
          fmt::format("mesh picture: point {} at ({}, {}, {}) with value {} is not finite", i, p[0], p[1],
                      p[2], picture.value[i]));
    }
  }
  if (!picture.threads.empty() && picture.threads.size() != picture.quads.size()) {
    throw std::invalid_argument(fmt::format("mesh picture: threads given for {} of {} quads",
                                            picture.threads.size(), picture.quads.size()));
  }
  for (const auto& quad : picture.quads) {
    for (const int corner : quad) {
      if (corner < 0 || static_cast<std::size_t>(corner) >= picture.points.size()) {
        throw std::invalid_argument(
            fmt::format("mesh picture: a quad names point {} of {}", corner, picture.points.size()));
      }
    }
  }
}

/// A little darker where the surface turns away from the light: shape shows, the colour bar still holds.
Colour shaded(Colour colour, double facing) {
  constexpr double depth = 0.28;  // of full black at grazing light; more would be read as another value
  const double share = 1.0 - depth * (1.0 - std::round(6.0 * facing) / 6.0);
  for (int& channel : colour) channel = static_cast<int>(std::lround(share * channel));
  return colour;
}

const Vector& corner(const MeshPicture& picture, std::size_t quad, std::size_t k) {
  return picture.points[static_cast<std::size_t>(picture.quads[quad][k])];
}

Vector centre_of(const MeshPicture& picture, std::size_t quad) {
  Vector centre{};
  for (std::size_t k = 0; k < 4; ++k) {
    for (std::size_t c = 0; c < 3; ++c) centre[c] += 0.25 * corner(picture, quad, k)[c];
  }
  return centre;
}

/// Cosine between the surface and the light, which stands above the viewer's left shoulder. Both faces are
/// lit.
double facing_light(const MeshPicture& picture, const View& view, std::size_t quad) {
  const Vector a = view.turned(difference(corner(picture, quad, 2), corner(picture, quad, 0)));
  const Vector b = view.turned(difference(corner(picture, quad, 3), corner(picture, quad, 1)));
  const Vector normal = cross(a, b);
  Vector light{};
  for (std::size_t c = 0; c < 3; ++c) {
    light[c] = 0.75 * view.frame.viewer[c] - 0.35 * view.frame.right[c] + 0.56 * view.frame.up[c];
  }
  const double size = std::sqrt(dot(normal, normal) * dot(light, light));
  return size > 0.0 ? std::abs(dot(normal, light)) / size : 1.0;
}

/// Corners in pixels, pushed outwards by half a pixel so that no background shines through between
/// neighbours.
std::array<Point, 4> grown(const MeshPicture& picture, const View& view, std::size_t quad) {
  const Point centre = view.pixel(centre_of(picture, quad));
  std::array<Point, 4> corners{};
  for (std::size_t k = 0; k < 4; ++k) {
    Point at = view.pixel(corner(picture, quad, k));
    const double x = at.x - centre.x, y = at.y - centre.y, size = std::hypot(x, y);
    if (size > 0.0) at = {at.x + 0.5 * x / size, at.y + 0.5 * y / size};
    corners[k] = at;
  }
  return corners;
}

std::vector<std::size_t> back_to_front(const MeshPicture& picture, const View& view) {
  std::vector<double> nearness;
  for (std::size_t quad = 0; quad < picture.quads.size(); ++quad) {
    nearness.push_back(view.nearness(centre_of(picture, quad)));
  }
  std::vector<std::size_t> order(picture.quads.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return nearness[a] < nearness[b]; });
  return order;
}

/// The threads of one quad, through its middle, where no neighbour painted later covers them.
std::string thread_path(const MeshPicture& picture, const View& view, std::size_t quad) {
  std::string path;
  for (std::size_t way = 0; way < 2; ++way) {
    if ((picture.threads[quad] >> way & 1) == 0) continue;
    const auto middle = [&](std::size_t a, std::size_t b) {
      const Point p = view.pixel(corner(picture, quad, a)), q = view.pixel(corner(picture, quad, b));
      return Point{0.5 * (p.x + q.x), 0.5 * (p.y + q.y)};
    };
    const std::array<Point, 2> thread =
        way == 0 ? std::array{middle(3, 0), middle(1, 2)} : std::array{middle(0, 1), middle(2, 3)};
    path += path_data(thread, Closure::open);
  }
  return path;
}

void paint_quads(Canvas& canvas, const MeshPicture& picture, const View& view) {
  std::string pending;
  Colour pending_colour{};
  const auto flush = [&] {
    if (!pending.empty()) canvas.coloured_path(pending, pending_colour);
    pending.clear();
  };
  const bool lit = picture.camera.elevation < 90.0;
  for (const std::size_t quad : back_to_front(picture, view)) {
    double value = 0.0;
    for (const int point : picture.quads[quad])
      value += 0.25 * picture.value[static_cast<std::size_t>(point)];
    Colour colour = colour_at(picture.colours, colour_step(picture.colours, value));
    if (lit) colour = shaded(colour, facing_light(picture, view, quad));
    if (colour != pending_colour) flush();
    pending_colour = colour;
    pending += path_data(grown(picture, view, quad), Closure::closed);
    if (!picture.threads.empty() && picture.threads[quad] != 0) {
      flush();
      canvas.path(thread_path(picture, view, quad), "thread");
    }
  }
  flush();
}

}  // namespace

Canvas draw(const MeshPicture& picture) {
  require_valid(picture);
  Canvas canvas(picture.width, picture.height, picture.label);
  const Box box{8.0, title_room, picture.width - colour_bar_room, picture.height - 34.0};
  const View view = fitted_view(picture, box);
  paint_quads(canvas, picture, view);
  for (const auto& outline : picture.outlines) {
    std::vector<Point> points;
    for (const Vector& point : outline) points.push_back(view.pixel(point));
    canvas.polyline(points, "outline");
  }
  draw_colour_bar(canvas, picture.colours, box.top, std::min(box.top + 260.0, box.bottom));
  draw_scale_bar(canvas, view.zoom, {box.left, picture.height - 10.0}, box.right - box.left);
  return canvas;
}

}  // namespace heddle::pipeline
