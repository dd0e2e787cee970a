#pragma once

#include <variant>

namespace heddle::mesoscale {

// Sections of a tow as VERTICAL cuts across it: the tow volume per pitch is area times pitch, however the tow
// is crimped. The shapes are symmetric about both axes; f(y) is the half height at distance y from the
// middle. A section is made of two halves of them.

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
  double centroid() const;  ///< of the half above the middle line, over that line [m]
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
  double centroid() const;
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
  double centroid() const;
  double mean_square_height() const;

  bool operator==(const CappedLensSection&) const = default;
};
/// @param cap_share  y_c over w/2 [-], 0..1
CappedLensSection capped_lens(double width, double thickness, double cap_share);

using HalfSection = std::variant<LensSection, PowerEllipseSection, CappedLensSection>;

enum class Face { upper, lower };

/// One shape above and one below, joined at the edges of the tow (TexGen's hybrid section, by halves). Each
/// is given as the whole shape of which it is the half: as wide as the tow and twice as thick as the half, so
/// that t = (upper.thickness + lower.thickness) / 2. Heights count from the middle of the thickness: crowns
/// are at
/// +-t/2 whatever the halves, and the edges at (lower.thickness - upper.thickness) / 4. Of two equal halves
/// every number is that of the shape, bit for bit: only halves and sums of equal numbers are taken.
struct Section {
  HalfSection upper{}, lower{};

  Section() = default;
  Section(const LensSection& both) : upper(both), lower(both) {}
  Section(const PowerEllipseSection& both) : upper(both), lower(both) {}
  Section(const CappedLensSection& both) : upper(both), lower(both) {}
  Section(const HalfSection& above, const HalfSection& below) : upper(above), lower(below) {}

  const HalfSection& half(Face face) const { return face == Face::upper ? upper : lower; }
  bool operator==(const Section&) const = default;
};

/// Are upper and lower half the same.
bool faces_alike(const Section& section);
double width(const Section& section);
double thickness(const Section& section);
double area(const Section& section);
double edge_height(const Section& section);  ///< of the line where the halves meet, over the middle [m]

double upper_face(const Section& section, double y);  ///< over the middle of the thickness [m]
double lower_face(const Section& section, double y);

/// Of one face, as its shape has them: y from the middle, depth from the face's own crown [m].
double crown_radius(const Section& section, Face face);
double slope(const Section& section, Face face, double y);
double drop(const Section& section, Face face, double y);
double reach(const Section& section, Face face, double depth);

double mean_height(const Section& section);         ///< mean of z, 0 of equal halves [m]
double mean_square_height(const Section& section);  ///< mean of z^2 [m^2]

/// Of the circle through crown and edges, (w^2 + t^2) / (4 t) [m]: what the path of the crossing tow is laid
/// round, whatever the shape between them. Of a lens this is its own radius; of unlike halves that of the
/// flatter one, since the tow goes round either.
double enclosing_radius(const Section& section);

/// The same shape at another size: halves keep their shares of the thickness, the arc of a capped lens keeps
/// its share of the width.
Section resized(const Section& section, double width, double thickness);

}  // namespace heddle::mesoscale
