#pragma once

#include <vector>

#include "macroscale/outline.h"

namespace heddle::macroscale {

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
std::vector<Ring> clipped(const Outline& outline, const QuadCell& quad);

}  // namespace heddle::macroscale
