#include "pipeline/shear_place.h"

#include <algorithm>
#include <cmath>

namespace heddle::pipeline {

namespace {

/// Root of a mean square.
struct Mean {
  double squares = 0.0;
  int count = 0;
  void add(double value) {
    squares += value * value;
    ++count;
  }
  double root() const { return count > 0 ? std::sqrt(squares / count) : 0.0; }
};

}  // namespace

ShearPlace shear_place(const macroscale::BlankState& blank, double stroke) {
  ShearPlace place;
  for (const double angle : blank.shear_angle) place.angle = std::max(place.angle, std::abs(angle));
  constexpr double alike = 1.0 - 1e-6;
  bool found = false;
  Mean deep, level;
  for (std::size_t n = 0; n < blank.shear_angle.size(); ++n) {
    const double angle = std::abs(blank.shear_angle[n]), depth = -blank.position[n][2];
    if (depth > 0.5 * stroke) deep.add(angle);
    if (depth < 0.02 * stroke) level.add(angle);
    const double flat = std::hypot(blank.reference[n][0], blank.reference[n][1]);
    if (angle < alike * place.angle || (found && flat >= place.flat_radius)) continue;
    found = true;
    place.flat_radius = flat;
    place.direction = std::atan2(std::abs(blank.reference[n][1]), std::abs(blank.reference[n][0]));
    place.radius = std::hypot(blank.position[n][0], blank.position[n][1]);
    place.depth = depth;
  }
  place.deep_rms = deep.root();
  place.level_rms = level.root();
  return place;
}

}  // namespace heddle::pipeline
