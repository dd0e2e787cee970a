#pragma once

#include <algorithm>
#include <array>

namespace heddle::mesoscale {

/// Six-point Gauss-Legendre rule on [-1, 1] (Abramowitz & Stegun, table 25.4): exact to degree 11.
struct GaussSix {
  static constexpr std::array<double, 6> point{-0.932469514203152027812, -0.661209386466264513661,
                                               -0.238619186083196908631, 0.238619186083196908631,
                                               0.661209386466264513661,  0.932469514203152027812};
  static constexpr std::array<double, 6> weight{0.171324492379170345040, 0.360761573048138607570,
                                                0.467913934572691047390, 0.467913934572691047390,
                                                0.360761573048138607570, 0.171324492379170345040};
};

/// Integral of f from a to b with `panels` even panels of the six-point rule.
template <class Function>
double integrate(double a, double b, int panels, const Function& f) {
  if (!(b > a)) return 0.0;
  const double step = (b - a) / panels;
  double sum = 0.0;
  for (int k = 0; k < panels; ++k)
    for (std::size_t q = 0; q < 6; ++q)
      sum += GaussSix::weight[q] * f(a + step * (k + 0.5 * (1.0 + GaussSix::point[q])));
  return 0.5 * step * sum;
}

/// The same with points drawn towards both ends by u = a + (b - a) s^2 (3 - 2 s), so that square-root ends,
/// which touching patches have, are integrated as fast as smooth ones.
template <class Function>
double integrate_clustered(double a, double b, int panels, const Function& f) {
  if (!(b > a)) return 0.0;
  return integrate(0.0, 1.0, panels, [&](double s) {
    return 6.0 * s * (1.0 - s) * (b - a) * f(a + (b - a) * s * s * (3.0 - 2.0 * s));
  });
}

}  // namespace heddle::mesoscale
