#pragma once

#include <variant>

namespace heddle::mesoscale {

/// Tow section bounded by two equal circular arcs (a lens), as a VERTICAL cut across the tow: the tow volume
/// per pitch is area times pitch, however the tow is crimped.
///
///     R = (w^2 + t^2) / (4 t),   half height f(y) = sqrt(R^2 - y^2) - (R - t/2),   |y| <= w/2
///
/// Source: lens form of Hearle & Shanahan; docs/theory/mesoscale.md.
struct LensSection {
  double width;      ///< w [m]
  double thickness;  ///< t [m], 0 < t <= w

  double radius() const;  ///< R [m]
  /// R^2 (2 a - sin 2 a), a = asin(w / 2R) [m^2]
  double area() const;
  double half_height(double y) const;  ///< f [m]; 0 beyond the edges
  double slope(double y) const;        ///< df/dy [-]; 0 beyond the edges
  /// How far the upper face has fallen from its crown: t/2 - f(y) [m].
  double drop(double y) const;
  /// y >= 0 at which the upper face has fallen by `depth` [m]; the edge w/2 for depth >= t/2.
  double reach(double depth) const;
  /// Mean of z^2 over the section about its mid-plane, I / A [m^2].
  double mean_square_height() const;
};

/// Elliptic section: fuller than the lens. On a sine path it cuts into the crossing tow; kept as the
/// comparison that shows the penetration check at work.
struct EllipseSection {
  double width;      ///< w [m]
  double thickness;  ///< t [m]

  double area() const;
  double half_height(double y) const;
  double slope(double y) const;
};

using Section = std::variant<LensSection, EllipseSection>;

double half_height(const Section& section, double y);
double area(const Section& section);
double width(const Section& section);

}  // namespace heddle::mesoscale
