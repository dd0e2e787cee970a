#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

namespace heddle::test {

/// Smallest relative gap between a slope and central differences over four step sizes: truncation and
/// rounding pull in opposite directions, so the best of four tells whether the slope is right. A wrong slope
/// stays wrong at all.
/// @param f      smooth function of one number
/// @param x      where
/// @param scale  length over which f changes
template <class Function>
double derivative_gap(const Function& f, double x, double scale, double slope) {
  double best = std::numeric_limits<double>::infinity();
  for (double step : {1e-3, 1e-4, 1e-5, 1e-6}) {
    const double h = step * scale;
    const double difference = (f(x + h) - f(x - h)) / (2.0 * h);
    const double size = std::max({std::abs(slope), std::abs(difference), 1e-300});
    best = std::min(best, std::abs(difference - slope) / size);
  }
  return best;
}

}  // namespace heddle::test
