#pragma once

#include <array>
#include <string>
#include <vector>

#include "core/problem.h"

namespace heddle::macroscale {

using Point2 = std::array<double, 2>;
using Ring = std::vector<Point2>;        ///< closed polygon, the first point not repeated
using QuadCell = std::array<Point2, 4>;  ///< convex, counter-clockwise

/// Shape of a flat blank: what lies inside `outer` and inside no hole, borders included. [m]
struct Outline {
  Ring outer;  ///< counter-clockwise
  std::vector<Ring> holes;
};

/// Centred at the origin.
Outline rectangle(std::array<double, 2> size);

/// Polygon with its corners on the circle, at most `chord_error` inside it: area too
/// small by less than 2 chord_error / radius. Exactly symmetric about both axes and diagonals.
/// @throws InputError for a radius or chord error that is not positive, or one that asks for over 100000
/// points
Outline circle(double radius, double chord_error = 1e-5, Point2 centre = {0.0, 0.0});

/// Turns the outer ring counter-clockwise and holes clockwise, and drops a last point that repeats the first.
/// The result still has to pass check().
Outline polygon(Ring outer, std::vector<Ring> holes = {});

/// Rings of at least three finite points without repetition, no two edges that meet except neighbours in
/// their common point, holes inside the outer ring and outside each other, at most 100000 points. Exact
/// predicates (CGAL): borders that touch in one point are found, borders 1 nm apart pass. Problems name the
/// place in mm.
Problems check(const Outline& outline, const std::string& key);

/// Area inside the outline, exact to rounding [m^2].
double area(const Outline& outline);

/// Area of a convex cell [m^2].
double area(const QuadCell& cell);

/// Whether a point lies inside or on the border; exact.
bool contains(const Outline& outline, double x, double y);

/// Area of each cell inside the outline [m^2].
///
/// Clipping in rational numbers (CGAL, GMP), so cell edges that run along the outline or through its corners
/// need no tolerance: a cell inside gets area(cell) to the last bit, a cell outside gets 0, and the sum over
/// cells that cover the outline once is its area to rounding. The cells are halved again and again and the
/// outline is clipped with each half, so cells away from the border cost nothing.
/// @param outline  passed check()
/// @throws std::invalid_argument for a cell that is not convex and counter-clockwise
std::vector<double> clipped_areas(const Outline& outline, const std::vector<QuadCell>& cells);

}  // namespace heddle::macroscale
