#include "mesoscale/film_flow.h"

#include <array>
#include <cmath>

#include <fmt/format.h>
#include <Eigen/LU>

#include "core/problem.h"

namespace heddle::mesoscale {

namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;

// Gauss-Legendre through the film, eight points: the stress changes sign inside, where |tau|^(1/n) has a
// kink in a high derivative only; the flow of a plane power-law film is met to 1e-3 at worst (test).
constexpr std::array<double, 8> points{-0.960289856497536232, -0.796666477413626740, -0.525532409916328986,
                                       -0.183434642495649805, 0.183434642495649805,  0.525532409916328986,
                                       0.796666477413626740,  0.960289856497536232};
constexpr std::array<double, 8> weights{0.101228536290376259, 0.222381034453374471, 0.313706645877887287,
                                        0.362683783378361983, 0.362683783378361983, 0.313706645877887287,
                                        0.222381034453374471, 0.101228536290376259};

// g = f(|tau|^2) tau with f = c (|tau|^2 + floor^2)^e.
struct Fluidity {
  explicit Fluidity(const FilmFluid& fluid)
      : exponent(0.5 * (1.0 / fluid.index - 1.0)),
        factor(std::pow(fluid.consistency, -1.0 / fluid.index)),
        floor(std::pow(fluid.consistency * std::pow(fluid.rate_floor, fluid.index), 2)) {}
  double exponent, factor, floor;
};

// Sums over the film's height.
struct Through {
  double work = 0.0;  // int W
  Vector2d rate = Vector2d::Zero(), moment = Vector2d::Zero();
  Matrix2d slope = Matrix2d::Zero(), slope_moment = Matrix2d::Zero(), slope_square = Matrix2d::Zero();
};

Through through(const Fluidity& law, double gap, const Vector2d& middle, const Vector2d& gradient) {
  Through sum;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const double s = 0.5 * gap * points[k], w = 0.5 * gap * weights[k];
    const Vector2d tau = middle + s * gradient;
    const double square = tau.squaredNorm() + law.floor;
    const double f = law.exponent == 0.0 ? law.factor : law.factor * std::pow(square, law.exponent);
    const Matrix2d df = f * (Matrix2d::Identity() + (2.0 * law.exponent / square) * (tau * tau.transpose()));
    sum.work += w * f * square / (2.0 * law.exponent + 2.0);
    sum.rate += w * f * tau;
    sum.moment += (w * s * f) * tau;
    sum.slope += w * df;
    sum.slope_moment += (w * s) * df;
    sum.slope_square += (w * s * s) * df;
  }
  return sum;
}

}  // namespace

double FilmFluid::viscosity(double rate) const {
  return consistency * std::pow(std::max(std::abs(rate), rate_floor), index - 1.0);
}

Vector2d drag_stress(const FilmFluid& fluid, double gap, const Vector2d& sliding) {
  return fluid.viscosity(sliding.norm() / gap) / gap * sliding;
}

FilmFlow film_flow(const FilmFluid& fluid, double gap, const Vector2d& sliding, const Vector2d& gradient,
                   const Vector2d& start) {
  const Fluidity law(fluid);
  Vector2d middle = start;
  Through now = through(law, gap, middle, gradient);
  const double small = 1e-12 * (sliding.norm() + now.rate.norm() + fluid.rate_floor * gap);
  for (int iteration = 0; iteration < 100; ++iteration) {
    const Vector2d excess = now.rate - sliding;
    if (excess.norm() <= small) break;
    const Vector2d step = -(now.slope.inverse() * excess);
    const double value = now.work - middle.dot(sliding), descent = excess.dot(step);
    // L is convex, so Newton's step goes down; it is halved until it does so by a part of what the slope
    // says. Near the minimum the gain drowns in rounding, and a smaller excess is the better sign.
    double share = 1.0;
    for (; share > 1e-15; share *= 0.5) {
      const Vector2d trial = middle + share * step;
      const Through next = through(law, gap, trial, gradient);
      const bool down = next.work - trial.dot(sliding) - value <= 1e-4 * share * descent;
      if (!down && (next.rate - sliding).norm() >= 0.5 * excess.norm()) continue;
      middle = trial;
      now = next;
      break;
    }
    if (share <= 1e-15) break;
  }
  // Rounding may leave the last digits unsettled; an excess this small shows in no result.
  if (!((now.rate - sliding).norm() <= 1e3 * small))
    throw NumericalError(fmt::format(
        "film: no shear stress found for a gap of {:.4g} m, sliding at {:.4g} m/s, pressure gradient {:.4g} "
        "Pa/m",
        gap, sliding.norm(), gradient.norm()));
  const Matrix2d lifted = now.slope.inverse() * now.slope_moment;
  return {now.work - middle.dot(sliding), middle, now.moment, now.slope_square - now.slope_moment * lifted};
}

}  // namespace heddle::mesoscale
