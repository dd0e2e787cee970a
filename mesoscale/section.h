#pragma once

#include <variant>

namespace heddle::mesoscale {

// Sections of a tow as VERTICAL cuts across it: the tow volume per pitch is area times pitch, however the tow
// is crimped. All are symmetric about both axes; f(y) is the half height at distance y from the middle.

/// Two equal circular arcs (a lens).
///
///     R = (w^2 + t^2) / (4 t),   f(y) = sqrt(R^2 - y^2) - (R - t/2),   |y| <= w/2
///
/// Source: lens form of Hearle & Shanahan; docs/theory/mesoscale.md.
struct LensSection {
  double width;      ///< w [m]
  double thickness;  ///< t [m], 0 < t <= w

  double radius() const;  ///< R [m]
  double crown_radius() const { return radius(); }
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

  bool operator==(const LensSection&) const = default;
};

/// f(y) = t/2 (1 - (2 y / w)^2)^(n/2): n = 1 is the ellipse, smaller is fuller (a rectangle in the limit 0),
/// 2 the parabola, which is nearly the lens. For n < 2 it is fuller than the lens of the same w and t and so
/// cuts into the tow it crosses. Source: the form TexGen offers, t/2 |sin|^n.
struct PowerEllipseSection {
  double width;      ///< w [m]
  double thickness;  ///< t [m]
  double power;      ///< n [-], > 0

  double crown_radius() const;  ///< w^2 / (2 n t) [m]
  /// w t sqrt(pi)/2 Gamma(n/2 + 1) / Gamma(n/2 + 3/2); pi/4 w t for n = 1 [m^2]
  double area() const;
  double half_height(double y) const;
  double slope(double y) const;
  double drop(double y) const;
  double reach(double depth) const;
  double mean_square_height() const;

  bool operator==(const PowerEllipseSection&) const = default;
};

/// An arc about the middle and straight flanks that go on from it without a corner:
///
///     f = t/2 - drop of a circle R for |y| <= y_c,   f = (w/2 - |y|) tan a beyond
///     y_c = R sin a,   y_c tan(a/2) + (w/2 - y_c) tan a = t/2
///
/// Slimmer than the lens of the same w and t, so that it stays clear of the tow it crosses. y_c = w/2 is the
/// lens. Source: docs/theory/mesoscale.md.
struct CappedLensSection {
  double width;      ///< w [m]
  double thickness;  ///< t [m]
  double cap;        ///< y_c, half width of the arc [m]
  double angle;      ///< a, slope angle of the flanks [rad]

  double radius() const;  ///< R [m]
  double crown_radius() const { return radius(); }
  double area() const;
  double half_height(double y) const;
  double slope(double y) const;
  double drop(double y) const;
  double reach(double depth) const;
  double mean_square_height() const;

  bool operator==(const CappedLensSection&) const = default;
};
/// @param cap_share  y_c over w/2 [-], 0..1
CappedLensSection capped_lens(double width, double thickness, double cap_share);

using Section = std::variant<LensSection, PowerEllipseSection, CappedLensSection>;

double width(const Section& section);
double thickness(const Section& section);
double crown_radius(const Section& section);
double area(const Section& section);
double half_height(const Section& section, double y);
double slope(const Section& section, double y);
double drop(const Section& section, double y);
double reach(const Section& section, double depth);
double mean_square_height(const Section& section);

/// Of the circle through crown and edges, (w^2 + t^2) / (4 t) [m]: what the path of the crossing tow is laid
/// round, whatever the shape between them. Of a lens this is its own radius.
double enclosing_radius(const Section& section);

/// The same shape at another size. The arc of a capped lens keeps its share of the width.
Section resized(const Section& section, double width, double thickness);

}  // namespace heddle::mesoscale
