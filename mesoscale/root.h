#pragma once

#include <cmath>

namespace heddle::mesoscale {

/// Root of a continuous f between a and b, where f(a) <= 0 <= f(b): secant steps in which the end that stays
/// is halved (Illinois), so it converges faster than linearly and never leaves the bracket.
/// @param small  |f| at which to stop
template <class Function>
double bracketed_root(double a, double f_a, double b, double f_b, double small, const Function& f) {
  for (int k = 0; k < 200; ++k) {
    const double next = (a * f_b - b * f_a) / (f_b - f_a);
    const double value = f(next);
    if (std::abs(value) <= small || next == a || next == b) return next;
    if (value < 0.0) {
      a = next;
      f_a = value;
      f_b *= 0.5;
    } else {
      b = next;
      f_b = value;
      f_a *= 0.5;
    }
  }
  return 0.5 * (a + b);
}

}  // namespace heddle::mesoscale
