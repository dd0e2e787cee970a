#include "core/surface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

namespace heddle {

namespace {

// B-spline coefficients c[0..n+1] of the cubic spline through n values one unit apart,
//     (c[i] + 4 c[i+1] + c[i+2]) / 6 = v[i],
// with a quadratic first and last piece: third difference zero there, so parabolas are met exactly and the
// end curvature is that of the data (a natural end would lose all stiffness at the edge of the table).
// Eliminating c[0] and c[1] (and the last two alike) leaves a tridiagonal system for c[2..n-1].
void interpolate(const double* v, int n, double* c) {
  const int unknowns = n - 2;
  std::vector<double> upper(unknowns), right(unknowns);
  for (int k = 0; k < unknowns; ++k) {
    const bool first = k == 0, last = k == unknowns - 1;
    double diagonal = 4.0, rhs = 6.0 * v[k + 1];
    if (first) diagonal += 1.0, rhs += v[1] - v[0];
    if (last) diagonal += 1.0, rhs += v[n - 2] - v[n - 1];
    const double pivot = diagonal - (first ? 0.0 : upper[k - 1]);
    upper[k] = 1.0 / pivot;
    right[k] = (rhs - (first ? 0.0 : right[k - 1])) / pivot;
  }
  for (int k = unknowns - 1; k >= 0; --k)
    c[k + 2] = right[k] - (k + 1 < unknowns ? upper[k] * c[k + 3] : 0.0);
  c[1] = c[2] + v[0] - v[1];
  c[n] = c[n - 1] + v[n - 1] - v[n - 2];
  c[0] = 3.0 * c[1] - 3.0 * c[2] + c[3];
  c[n + 1] = 3.0 * c[n] - 3.0 * c[n - 1] + c[n - 2];
}

struct Weights {
  std::array<double, 4> value, first, second;
};

// Uniform cubic B-spline weights at t in [0, 1], and their derivatives in t.
Weights weights(double t) {
  const double u = 1.0 - t;
  return {{u * u * u / 6.0, (4.0 - 6.0 * t * t + 3.0 * t * t * t) / 6.0,
           (4.0 - 6.0 * u * u + 3.0 * u * u * u) / 6.0, t * t * t / 6.0},
          {-0.5 * u * u, 0.5 * t * (3.0 * t - 4.0), 0.5 * u * (4.0 - 3.0 * u), 0.5 * t * t},
          {u, 3.0 * t - 2.0, 3.0 * u - 2.0, t}};
}

// A value with its first and second derivative along one axis, in grid steps.
struct Parabola {
  double value, first, second;
};

// The same `outside` grid steps further on.
Parabola carried_on(const Parabola& p, double outside) {
  return {p.value + outside * (p.first + 0.5 * outside * p.second), p.first + outside * p.second, p.second};
}

struct Place {
  int index;
  double t;
  double outside;  ///< signed distance beyond the grid, in grid steps
};

Place place(double x, double x0, double dx, int n) {
  const double position = (x - x0) / dx;
  const double inside = std::clamp(position, 0.0, static_cast<double>(n - 1));
  // A NaN must come out as NaN, not as a wild index.
  const int index = inside > 0.0 ? std::min(static_cast<int>(inside), n - 2) : 0;
  return {index, inside - index, position - inside};
}

}  // namespace

Surface::Surface(double x0, double dx, int nx, double y0, double dy, int ny, std::vector<double> values)
    : x0_(x0), dx_(dx), y0_(y0), dy_(dy), nx_(nx), ny_(ny), values_(std::move(values)) {
  if (nx < 4 || ny < 4 || !(dx > 0.0) || !(dy > 0.0) || values_.size() != static_cast<std::size_t>(nx) * ny)
    throw std::invalid_argument(fmt::format(
        "surface: {} values for a grid of {} x {} (4 or more each way, steps > 0)", values_.size(), nx, ny));
  for (std::size_t k = 0; k < values_.size(); ++k)
    if (!std::isfinite(values_[k]))
      throw std::invalid_argument(fmt::format("surface value ({}, {}) is not finite",
                                              k / static_cast<std::size_t>(ny),
                                              k % static_cast<std::size_t>(ny)));

  const int mx = nx + 2, my = ny + 2;
  std::vector<double> rows(static_cast<std::size_t>(nx) * my);
  for (int i = 0; i < nx; ++i)
    interpolate(&values_[static_cast<std::size_t>(i) * ny], ny, &rows[static_cast<std::size_t>(i) * my]);
  coefficients_.assign(static_cast<std::size_t>(mx) * my, 0.0);
  std::vector<double> column(nx), solved(mx);
  for (int j = 0; j < my; ++j) {
    for (int i = 0; i < nx; ++i) column[i] = rows[static_cast<std::size_t>(i) * my + j];
    interpolate(column.data(), nx, solved.data());
    for (int i = 0; i < mx; ++i) coefficients_[static_cast<std::size_t>(i) * my + j] = solved[i];
  }
}

// Beyond the grid every derivative along an axis is carried on, mixed ones included, so all stay exact slopes
// of one another. Sums over coefficients come first and large distances after: extending the weights instead
// is the same surface, but at a thousand steps outside their cancellation costs eight of sixteen digits.
Surface::Value Surface::evaluate(double x, double y) const {
  const Place px = place(x, x0_, dx_, nx_), py = place(y, y0_, dy_, ny_);
  const Weights wx = weights(px.t), wy = weights(py.t);
  const int my = ny_ + 2;
  Parabola f{0, 0, 0}, fy{0, 0, 0}, fyy{0, 0, 0};  // along x
  for (int a = 0; a < 4; ++a) {
    const double* row = &coefficients_[static_cast<std::size_t>(px.index + a) * my + py.index];
    Parabola along_y{0, 0, 0};
    for (int b = 0; b < 4; ++b) {
      along_y.value += wy.value[b] * row[b];
      along_y.first += wy.first[b] * row[b];
      along_y.second += wy.second[b] * row[b];
    }
    if (py.outside != 0.0) along_y = carried_on(along_y, py.outside);
    const auto add = [&](Parabola& sum, double term) {
      sum.value += wx.value[a] * term;
      sum.first += wx.first[a] * term;
      sum.second += wx.second[a] * term;
    };
    add(f, along_y.value);
    add(fy, along_y.first);
    add(fyy, along_y.second);
  }
  if (px.outside != 0.0)
    for (Parabola* along_x : {&f, &fy, &fyy}) *along_x = carried_on(*along_x, px.outside);
  return {f.value,
          f.first / dx_,
          fy.value / dy_,
          f.second / (dx_ * dx_),
          fy.first / (dx_ * dy_),
          fyy.value / (dy_ * dy_)};
}

}  // namespace heddle
