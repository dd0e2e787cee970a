#include "mesoscale/path.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "mesoscale/quadrature.h"

namespace heddle::mesoscale {

namespace {

// p sin th + (2R' - h) cos th = 2R', smaller root.
double tangent_angle(double pitch, double height, double radius) {
  const double across = 2.0 * radius - height;
  const double size = std::hypot(pitch, across);
  return std::atan2(pitch, across) - std::acos(std::min(2.0 * radius / size, 1.0));
}

// A straight leg from the end of one arc to the start of the next; `bend` is the length of both arcs.
PathLength leg(double along, double up, double bend) {
  const double straight = std::hypot(along, up);
  const double c = along / straight, s = up / straight;
  return {bend + straight, c, s, s * s / straight, -s * c / straight, c * c / straight};
}

}  // namespace

double jam_radius(double pitch, double height) {
  return (pitch * pitch + height * height) / (4.0 * height);
}

ArcPath arc_path(double pitch, double height, double contact_radius) {
  if (height > 0.0 && contact_radius >= jam_radius(pitch, height))
    return {pitch, height, jam_radius(pitch, height), 2.0 * std::atan(height / pitch), true};
  return {pitch, height, contact_radius, tangent_angle(pitch, height, contact_radius), false};
}

double ArcPath::length() const {
  if (jammed) return 2.0 * radius * angle;
  return 2.0 * radius * angle + (pitch - 2.0 * radius * std::sin(angle)) / std::cos(angle);
}

double ArcPath::crimp() const {
  return length() / pitch - 1.0;
}

double ArcPath::wrap() const {
  return radius * std::sin(angle);
}

double ArcPath::drop(double u) const {
  if (u > 0.5 * pitch) return height - drop(pitch - u);
  const double edge = wrap();
  if (u <= edge) return u * u / (radius + std::sqrt(radius * radius - u * u));
  return radius * (1.0 - std::cos(angle)) + (u - edge) * std::tan(angle);
}

double ArcPath::slope(double u) const {
  if (u > 0.5 * pitch) return slope(pitch - u);
  if (u >= wrap()) return std::tan(angle);
  return u / std::sqrt(radius * radius - u * u);
}

double ArcPath::reach(double depth) const {
  if (depth <= 0.0) return 0.0;
  const double at_edge = radius * (1.0 - std::cos(angle));
  const double u = depth <= at_edge ? std::sqrt(depth * (2.0 * radius - depth))
                                    : wrap() + (depth - at_edge) / std::tan(angle);
  return std::min(u, 0.5 * pitch);
}

double ArcPath::mean_square_height() const {
  const auto square = [&](double u) {
    const double z = 0.5 * height - drop(u);
    return z * z;
  };
  const double edge = std::min(wrap(), 0.5 * pitch);
  return (integrate(0.0, edge, 4, square) + integrate(edge, 0.5 * pitch, 4, square)) / (0.5 * pitch);
}

double SinePath::length() const {
  const double steepest = std::numbers::pi * height / (2.0 * pitch);
  return integrate(0.0, pitch, 16, [&](double u) {
    const double slope = steepest * std::sin(std::numbers::pi * u / pitch);
    return std::sqrt(1.0 + slope * slope);
  });
}

double SinePath::crimp() const {
  return length() / pitch - 1.0;
}

double SinePath::angle() const {
  return std::atan(std::numbers::pi * height / (2.0 * pitch));
}

double SinePath::drop(double u) const {
  return 0.5 * height * (1.0 - std::cos(std::numbers::pi * u / pitch));
}

double SawToothPath::length() const {
  return std::hypot(pitch, height);
}

double SawToothPath::crimp() const {
  return length() / pitch - 1.0;
}

double SawToothPath::angle() const {
  return std::atan(height / pitch);
}

double drop(const Path& path, double u) {
  return std::visit([u](const auto& p) { return p.drop(u); }, path);
}

double height(const Path& path) {
  return std::visit([](const auto& p) { return p.height; }, path);
}

PathLength LengthLaw::evaluate(double pitch, double height) const {
  const double up = std::abs(height);
  PathLength result;
  if (form == PathForm::saw_tooth) {
    result = leg(pitch, up, 0.0);
  } else {
    // th <= th_s on one side of a straight line in (p, h): p sin th_s - h cos th_s = 2 R' (1 - cos th_s).
    const double sin_s = std::min(edge / contact_radius, 1.0), cos_s = std::sqrt(1.0 - sin_s * sin_s);
    const bool capped = pitch * sin_s - up * cos_s < 2.0 * contact_radius * (1.0 - cos_s);
    const double th = capped ? std::asin(sin_s) : tangent_angle(pitch, up, contact_radius);
    const double s = std::sin(th), c = std::cos(th);
    result = leg(pitch - 2.0 * contact_radius * s, up - 2.0 * contact_radius * (1.0 - c),
                 2.0 * contact_radius * th);
  }
  if (height < 0.0) {
    result.dl_dh = -result.dl_dh;
    result.d2_ph = -result.d2_ph;
  }
  return result;
}

}  // namespace heddle::mesoscale
