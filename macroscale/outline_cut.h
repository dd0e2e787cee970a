#pragma once

#include <array>
#include <vector>

namespace heddle::macroscale {

using Point2 = std::array<double, 2>;

/// Edge of a flat blank: one closed polygon and the holes in it [m]. Last point joins the first; either turn.
struct Outline {
  std::vector<Point2> outer;
  std::vector<std::vector<Point2>> holes;
};

/// Rectangle centred at the origin, sides along the axes.
Outline rectangle(Point2 size);

/// Regular polygon with its corners on a circle, the first one at angle 0; their number is a multiple of 8.
/// @param chord_error  largest distance between chord and circle [m]
Outline circle(double radius, double chord_error, Point2 centre = {0.0, 0.0});

/// Area of the outline, holes taken off [m^2].
double area(const Outline& outline);

/// The outline turned by an angle given by its cosine and sine: x' = c x - s y, y' = s x + c y.
Outline turned(const Outline& outline, double c, double s);

/// Smallest distance of the outer polygon's sides from the origin [m]; negative if the origin is outside.
double reach(const Outline& outline);

/// Distance from the origin to the outermost point of the outer polygon on a ray [m]; 0 where it meets none.
/// @param direction  unit
double ray_length(const Outline& outline, const Point2& direction);

/// Parts of the outline inside a convex quadrilateral (counter-clockwise): closed polygons, outer edges and
/// holes together, to be filled by the even-odd rule. Where the outline is not convex, a polygon may run
/// forth and back along a side of the quadrilateral; that encloses nothing. Sutherland & Hodgman (1974).
std::vector<std::vector<Point2>> clipped(const Outline& outline, const std::array<Point2, 4>& quad);

/// Area of the outline inside a convex quadrilateral (counter-clockwise) [m^2].
double clipped_area(const Outline& outline, const std::array<Point2, 4>& quad);

}  // namespace heddle::macroscale
