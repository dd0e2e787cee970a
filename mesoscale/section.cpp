#include "mesoscale/section.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "mesoscale/quadrature.h"

namespace heddle::mesoscale {

double LensSection::radius() const {
  return (width * width + thickness * thickness) / (4.0 * thickness);
}

double LensSection::area() const {
  const double r = radius();
  const double a = std::asin(width / (2.0 * r));
  return r * r * (2.0 * a - std::sin(2.0 * a));
}

double LensSection::drop(double y) const {
  const double r = radius();
  const double root = std::sqrt(std::max(r * r - y * y, 0.0));
  return y * y / (r + root);  // = r - root without the cancellation near the crown
}

double LensSection::half_height(double y) const {
  if (std::abs(y) >= 0.5 * width) return 0.0;
  return 0.5 * thickness - drop(y);
}

double LensSection::slope(double y) const {
  if (std::abs(y) >= 0.5 * width) return 0.0;
  const double r = radius();
  return -y / std::sqrt(r * r - y * y);
}

double LensSection::reach(double depth) const {
  if (depth <= 0.0) return 0.0;
  if (depth >= 0.5 * thickness) return 0.5 * width;
  return std::sqrt(depth * (2.0 * radius() - depth));
}

double LensSection::mean_square_height() const {
  const double moment = integrate(0.0, 0.5 * width, 16, [&](double y) {
    const double f = half_height(y);
    return 4.0 / 3.0 * f * f * f;  // both halves, upper and lower part
  });
  return moment / area();
}

double EllipseSection::area() const {
  return 0.25 * std::numbers::pi * width * thickness;
}

double EllipseSection::half_height(double y) const {
  const double u = 2.0 * y / width;
  return 0.5 * thickness * std::sqrt(std::max(1.0 - u * u, 0.0));
}

double EllipseSection::slope(double y) const {
  const double u = 2.0 * y / width;
  if (std::abs(u) >= 1.0) return 0.0;
  return -thickness / width * u / std::sqrt(1.0 - u * u);
}

double half_height(const Section& section, double y) {
  return std::visit([y](const auto& s) { return s.half_height(y); }, section);
}

double area(const Section& section) {
  return std::visit([](const auto& s) { return s.area(); }, section);
}

double width(const Section& section) {
  return std::visit([](const auto& s) { return s.width; }, section);
}

}  // namespace heddle::mesoscale
