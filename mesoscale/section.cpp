#include "mesoscale/section.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "mesoscale/quadrature.h"
#include "mesoscale/root.h"

namespace heddle::mesoscale {

namespace {

// Fall of a circle from its crown; = R - sqrt(R^2 - y^2) without the cancellation near the crown.
double circle_drop(double r, double y) {
  const double root = std::sqrt(std::max(r * r - y * y, 0.0));
  return y * y / (r + root);
}

// Integral of (1 - x^2)^(n/2) over [0, 1].
double power_integral(double n) {
  return 0.5 * std::sqrt(std::numbers::pi) *
         std::exp(std::lgamma(0.5 * n + 1.0) - std::lgamma(0.5 * n + 1.5));
}

// Of x in [0, 1], for half heights that are a power of it.
double beyond(double x) {
  return std::max(1.0 - x * x, 0.0);
}

}  // namespace

double LensSection::radius() const {
  return (width * width + thickness * thickness) / (4.0 * thickness);
}

double LensSection::area() const {
  const double r = radius();
  const double a = std::asin(width / (2.0 * r));
  return r * r * (2.0 * a - std::sin(2.0 * a));
}

double LensSection::drop(double y) const {
  return circle_drop(radius(), y);
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

double LensSection::centroid() const {
  return 2.0 / area() * integrate(0.0, 0.5 * width, 16, [&](double y) {
           const double f = half_height(y);
           return f * f;
         });
}

double LensSection::mean_square_height() const {
  const double moment = integrate(0.0, 0.5 * width, 16, [&](double y) {
    const double f = half_height(y);
    return 4.0 / 3.0 * f * f * f;  // both halves, upper and lower part
  });
  return moment / area();
}

double PowerEllipseSection::crown_radius() const {
  return width * width / (2.0 * power * thickness);
}

double PowerEllipseSection::area() const {
  return width * thickness * power_integral(power);
}

double PowerEllipseSection::half_height(double y) const {
  return 0.5 * thickness * std::pow(beyond(2.0 * y / width), 0.5 * power);
}

double PowerEllipseSection::slope(double y) const {
  const double x = 2.0 * y / width;
  if (std::abs(x) >= 1.0) return 0.0;
  return -thickness / width * power * x * std::pow(beyond(x), 0.5 * power - 1.0);
}

double PowerEllipseSection::drop(double y) const {
  const double x = 2.0 * y / width;
  if (std::abs(x) >= 1.0) return 0.5 * thickness;
  return -0.5 * thickness * std::expm1(0.5 * power * std::log1p(-x * x));  // no cancellation near the crown
}

double PowerEllipseSection::reach(double depth) const {
  if (depth <= 0.0) return 0.0;
  if (depth >= 0.5 * thickness) return 0.5 * width;
  return 0.5 * width * std::sqrt(-std::expm1(2.0 / power * std::log1p(-2.0 * depth / thickness)));
}

double PowerEllipseSection::centroid() const {
  return 0.25 * thickness * power_integral(2.0 * power) / power_integral(power);
}

double PowerEllipseSection::mean_square_height() const {
  return thickness * thickness / 12.0 * power_integral(3.0 * power) / power_integral(power);
}

CappedLensSection capped_lens(double width, double thickness, double cap_share) {
  const double cap = 0.5 * width * cap_share, flank = 0.5 * width - cap;
  const auto excess = [&](double a) {
    return cap * std::tan(0.5 * a) + flank * std::tan(a) - 0.5 * thickness;
  };
  // Between the straight flank of a rhombus and the edge of the lens.
  const double low = std::atan(thickness / width), high = 2.0 * low;
  const double at_low = std::min(excess(low), 0.0), at_high = std::max(excess(high), 0.0);
  return {width, thickness, cap, bracketed_root(low, at_low, high, at_high, 1e-16 * thickness, excess)};
}

double CappedLensSection::radius() const {
  return cap / std::sin(angle);
}

double CappedLensSection::drop(double y) const {
  const double from_middle = std::abs(y);
  if (from_middle <= cap && cap > 0.0) return circle_drop(radius(), y);
  return 0.5 * thickness - std::max(0.5 * width - from_middle, 0.0) * std::tan(angle);
}

double CappedLensSection::half_height(double y) const {
  if (std::abs(y) >= 0.5 * width) return 0.0;
  return 0.5 * thickness - drop(y);
}

double CappedLensSection::slope(double y) const {
  if (std::abs(y) >= 0.5 * width) return 0.0;
  if (std::abs(y) > cap) return y > 0.0 ? -std::tan(angle) : std::tan(angle);
  const double r = radius();
  return -y / std::sqrt(r * r - y * y);
}

double CappedLensSection::reach(double depth) const {
  if (depth <= 0.0) return 0.0;
  if (depth >= 0.5 * thickness) return 0.5 * width;
  if (depth <= cap * std::tan(0.5 * angle)) return std::sqrt(depth * (2.0 * radius() - depth));
  return 0.5 * width - (0.5 * thickness - depth) / std::tan(angle);
}

double CappedLensSection::area() const {
  const double r = radius(), flank = 0.5 * width - cap;
  // Segment of the circle above its chord, the rectangle below the chord, the two triangles; twice.
  const double segment = r * r * (angle - 0.5 * std::sin(2.0 * angle));
  const double chord = flank * std::tan(angle);
  return 2.0 * (segment + 2.0 * cap * chord + flank * chord);
}

double CappedLensSection::centroid() const {
  const auto square = [&](double y) {
    const double f = half_height(y);
    return f * f;
  };
  return 2.0 / area() * (integrate(0.0, cap, 8, square) + integrate(cap, 0.5 * width, 2, square));
}

double CappedLensSection::mean_square_height() const {
  const auto cube = [&](double y) {
    const double f = half_height(y);
    return 4.0 / 3.0 * f * f * f;
  };
  return (integrate(0.0, cap, 8, cube) + integrate(cap, 0.5 * width, 2, cube)) / area();
}

namespace {

double whole_thickness(const HalfSection& half) {
  return std::visit([](const auto& s) { return s.thickness; }, half);
}

double whole_area(const HalfSection& half) {
  return std::visit([](const auto& s) { return s.area(); }, half);
}

double height_of(const HalfSection& half, double y) {
  return std::visit([y](const auto& s) { return s.half_height(y); }, half);
}

// First and second moment of a half about its middle line, over its area.
struct HalfMoments {
  double share;  ///< of the section's area [-]
  double mean;   ///< [m]
  double mean_square;
};
HalfMoments moments(const Section& section, Face face) {
  const HalfSection& half = section.half(face);
  return std::visit(
      [&](const auto& s) {
        return HalfMoments{0.5 * s.area() / area(section), s.centroid(), s.mean_square_height()};
      },
      half);
}

HalfSection resized(const HalfSection& half, double width, double thickness) {
  if (const auto* power = std::get_if<PowerEllipseSection>(&half))
    return PowerEllipseSection{width, thickness, power->power};
  if (const auto* capped = std::get_if<CappedLensSection>(&half))
    return capped_lens(width, thickness, capped->cap / (0.5 * capped->width));
  return LensSection{width, thickness};
}

}  // namespace

bool faces_alike(const Section& section) {
  return section.upper == section.lower;
}

double width(const Section& section) {
  return std::visit([](const auto& s) { return s.width; }, section.upper);
}

double thickness(const Section& section) {
  return 0.5 * (whole_thickness(section.upper) + whole_thickness(section.lower));
}

double area(const Section& section) {
  return 0.5 * (whole_area(section.upper) + whole_area(section.lower));
}

double edge_height(const Section& section) {
  return 0.25 * (whole_thickness(section.lower) - whole_thickness(section.upper));
}

double upper_face(const Section& section, double y) {
  return edge_height(section) + height_of(section.upper, y);
}

double lower_face(const Section& section, double y) {
  return edge_height(section) - height_of(section.lower, y);
}

double crown_radius(const Section& section, Face face) {
  return std::visit([](const auto& s) { return s.crown_radius(); }, section.half(face));
}

double slope(const Section& section, Face face, double y) {
  return std::visit([y](const auto& s) { return s.slope(y); }, section.half(face));
}

double drop(const Section& section, Face face, double y) {
  return std::visit([y](const auto& s) { return s.drop(y); }, section.half(face));
}

double reach(const Section& section, Face face, double depth) {
  return std::visit([depth](const auto& s) { return s.reach(depth); }, section.half(face));
}

double mean_height(const Section& section) {
  const HalfMoments above = moments(section, Face::upper), below = moments(section, Face::lower);
  return edge_height(section) + (above.share * above.mean - below.share * below.mean);
}

double mean_square_height(const Section& section) {
  const HalfMoments above = moments(section, Face::upper), below = moments(section, Face::lower);
  const double e = edge_height(section);
  return above.share * (e * (e + 2.0 * above.mean) + above.mean_square) +
         below.share * (e * (e - 2.0 * below.mean) + below.mean_square);
}

double enclosing_radius(const Section& section) {
  const auto radius = [&](const HalfSection& half) {
    return LensSection{width(section), whole_thickness(half)}.radius();
  };
  return std::max(radius(section.upper), radius(section.lower));
}

Section resized(const Section& section, double width, double thickness) {
  const double above = whole_thickness(section.upper), below = whole_thickness(section.lower);
  return {resized(section.upper, width, 2.0 * thickness * (above / (above + below))),
          resized(section.lower, width, 2.0 * thickness * (below / (above + below)))};
}

}  // namespace heddle::mesoscale
