#pragma once

#include <variant>

namespace heddle::mesoscale {

/// Centreline of a tow between two neighbouring crossings where it changes sides: circular arcs of radius R'
/// over the crossing tows, joined by a common tangent.
///
///     p sin th - h cos th = 2 R' (1 - cos th),   l = 2 R' th + (p - 2 R' sin th) / cos th
///
/// R' = R + t/2 with R the radius of the lens section. Any R' >= R keeps two lens tows apart (both are
/// vertical cuts: the local gap is the sum over x and y of lens drop minus path drop). When R' reaches R_jam
/// = (p^2 + h^2) / (4 h) no straight part is left; from there the path is held on R_jam, which is still >= R
/// as long as the tow is no wider than the pitch.
/// Source: Peirce 1937, Hearle & Shanahan (lens form); docs/theory/mesoscale.md.
struct ArcPath {
  double pitch;   ///< p [m]
  double height;  ///< h, crown to crown of the centreline [m], >= 0
  double radius;  ///< R' as used [m]
  double angle;   ///< th, steepest slope angle [rad]
  bool jammed;    ///< no straight part is left

  double length() const;              ///< l of one pitch [m]
  double crimp() const;               ///< l / p - 1 [-]
  double wrap() const;                ///< half length of the contact arc along the fabric, R' sin th [m]
  double drop(double u) const;        ///< fall from the crown at distance u in [0, p] along the fabric [m]
  double slope(double u) const;       ///< d drop / du [-]
  double reach(double depth) const;   ///< u in [0, p/2] at which the path has fallen by depth in [0, h/2] [m]
  double mean_square_height() const;  ///< mean of z^2 along the fabric about the mid-plane [m^2]

  bool operator==(const ArcPath&) const = default;
};

/// Radius at which the arcs meet without a straight part [m].
double jam_radius(double pitch, double height);
ArcPath arc_path(double pitch, double height, double contact_radius);

/// z = (h/2) cos(pi u / p): upper comparison, and half of the geometry that does interpenetrate.
struct SinePath {
  double pitch, height;  ///< [m]
  double length() const;
  double crimp() const;
  double angle() const;  ///< at the steepest point [rad]
  double drop(double u) const;
};

/// Straight from crown to crown (Kawabata): the shortest path, lower bound of the crimp.
struct SawToothPath {
  double pitch, height;  ///< [m]
  double length() const;
  double crimp() const;
  double angle() const;
};

using Path = std::variant<ArcPath, SinePath>;
double drop(const Path& path, double u);
double height(const Path& path);

/// Length of a tow as its pitch and crimp height change, with slopes: what tension needs. Symmetric in h.
struct PathLength {
  double length;               ///< l [m]
  double dl_dp, dl_dh;         ///< [-]
  double d2_pp, d2_ph, d2_hh;  ///< [1/m]
};

enum class PathForm { arc, saw_tooth };

/// Length law l(p, h) at a given contact radius, jointly convex and twice continuously differentiable.
///
/// arc: a taut string round two circles, dl/dp = cos th, dl/dh = sin th and Hessian n n^T / S, with
/// n = (-sin th, cos th) and S the straight length. The wrap may grow until the contact reaches the edge of
/// the crossing tow, sin th_s = y_edge / R'; beyond, the wrap stays and the straight leg turns about its ends
/// (the capped lens: round up to the edge, straight outside). Value, slope and curvature agree at the change.
/// saw_tooth: l = sqrt(p^2 + h^2).
struct LengthLaw {
  PathForm form = PathForm::arc;
  double contact_radius = 0.0;  ///< R' [m]
  double edge = 0.0;            ///< y_edge, largest half length of the contact [m]; below p/2

  PathLength evaluate(double pitch, double height) const;
};

}  // namespace heddle::mesoscale
