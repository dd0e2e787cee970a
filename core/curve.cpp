#include "core/curve.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

namespace heddle {

namespace {

// Fritsch & Butland 1984: weighted harmonic mean of the neighbouring secants, zero at a turning point.
double interior_slope(double h0, double h1, double d0, double d1) {
  if (d0 * d1 <= 0.0) return 0.0;
  const double w0 = 2.0 * h1 + h0;
  const double w1 = h1 + 2.0 * h0;
  return (w0 + w1) / (w0 / d0 + w1 / d1);
}

// One-sided three-point slope, limited so that the end piece stays monotone.
double end_slope(double h0, double h1, double d0, double d1) {
  const double slope = ((2.0 * h0 + h1) * d0 - h0 * d1) / (h0 + h1);
  if (slope * d0 <= 0.0) return 0.0;
  if (d0 * d1 <= 0.0 && std::abs(slope) > 3.0 * std::abs(d0)) return 3.0 * d0;
  return slope;
}

std::vector<double> monotone_slopes(const std::vector<double>& x, const std::vector<double>& y) {
  const std::size_t n = x.size();
  std::vector<double> h(n - 1), d(n - 1), slope(n);
  for (std::size_t i = 0; i + 1 < n; ++i) {
    h[i] = x[i + 1] - x[i];
    d[i] = (y[i + 1] - y[i]) / h[i];
  }
  if (n == 2) return {d[0], d[0]};
  slope.front() = end_slope(h[0], h[1], d[0], d[1]);
  slope.back() = end_slope(h[n - 2], h[n - 3], d[n - 2], d[n - 3]);
  for (std::size_t i = 1; i + 1 < n; ++i) slope[i] = interior_slope(h[i - 1], h[i], d[i - 1], d[i]);
  return slope;
}

double evenly_spaced_inverse_step(const std::vector<double>& x) {
  const double step = (x.back() - x.front()) / static_cast<double>(x.size() - 1);
  for (std::size_t i = 0; i < x.size(); ++i)
    if (std::abs(x[i] - (x.front() + static_cast<double>(i) * step)) > 1e-9 * step) return 0.0;
  return 1.0 / step;
}

}  // namespace

Curve::Curve(std::vector<double> x, std::vector<double> y) : x_(std::move(x)), y_(std::move(y)) {
  if (x_.size() != y_.size() || x_.size() < 2)
    throw std::invalid_argument(
        fmt::format("a curve needs two or more points; got {} x and {} y", x_.size(), y_.size()));
  for (std::size_t i = 0; i < x_.size(); ++i) {
    if (!std::isfinite(x_[i]) || !std::isfinite(y_[i]))
      throw std::invalid_argument(fmt::format("curve point {} is not finite: ({}, {})", i, x_[i], y_[i]));
    if (i > 0 && !(x_[i] > x_[i - 1]))
      throw std::invalid_argument(
          fmt::format("curve x must increase; point {} has {} after {}", i, x_[i], x_[i - 1]));
  }
  slope_ = monotone_slopes(x_, y_);
  inverse_step_ = evenly_spaced_inverse_step(x_);
  integral_.assign(x_.size(), 0.0);
  for (std::size_t i = 0; i + 1 < x_.size(); ++i) {
    const double h = x_[i + 1] - x_[i];
    integral_[i + 1] =
        integral_[i] + h * (0.5 * (y_[i] + y_[i + 1]) + h * (slope_[i] - slope_[i + 1]) / 12.0);
  }
}

std::size_t Curve::interval(double x) const {
  if (inverse_step_ > 0.0) {
    const double position = (x - x_.front()) * inverse_step_;
    const double last = static_cast<double>(x_.size() - 2);
    if (!(position > 0.0)) return 0;  // a NaN as well: it must come out as NaN, not as a wild index
    return static_cast<std::size_t>(std::min(position, last));
  }
  const auto upper = std::upper_bound(x_.begin() + 1, x_.end() - 1, x);
  return static_cast<std::size_t>(upper - x_.begin()) - 1;
}

Curve::Value Curve::evaluate(double x) const {
  if (x <= x_.front()) return {y_.front() + slope_.front() * (x - x_.front()), slope_.front()};
  if (x >= x_.back()) return {y_.back() + slope_.back() * (x - x_.back()), slope_.back()};
  const std::size_t i = interval(x);
  const double h = x_[i + 1] - x_[i];
  const double t = (x - x_[i]) / h;
  const double rise = y_[i + 1] - y_[i];
  const double a = slope_[i] * h;
  const double c = a + slope_[i + 1] * h - 2.0 * rise;  // cubic coefficient
  const double b = rise - a - c;                        // quadratic coefficient
  return {y_[i] + t * (a + t * (b + t * c)), (a + t * (2.0 * b + 3.0 * t * c)) / h};
}

double Curve::integral(double x) const {
  if (x <= x_.front()) {
    const double d = x - x_.front();
    return d * (y_.front() + 0.5 * slope_.front() * d);
  }
  if (x >= x_.back()) {
    const double d = x - x_.back();
    return integral_.back() + d * (y_.back() + 0.5 * slope_.back() * d);
  }
  const std::size_t i = interval(x);
  const double h = x_[i + 1] - x_[i];
  const double t = (x - x_[i]) / h;
  const double rise = y_[i + 1] - y_[i];
  const double a = slope_[i] * h;
  const double c = a + slope_[i + 1] * h - 2.0 * rise;
  const double b = rise - a - c;
  return integral_[i] + h * t * (y_[i] + t * (a / 2.0 + t * (b / 3.0 + t * c / 4.0)));
}

std::string fault_of_monotone_table(const std::vector<double>& x, const std::vector<double>& y,
                                    const std::string& what) {
  if (x.size() != y.size() || x.size() < 2)
    return fmt::format("{} needs two or more points; got {} x and {} y", what, x.size(), y.size());
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (!std::isfinite(x[i]) || !std::isfinite(y[i]))
      return fmt::format("{}: point {} is not finite ({}, {})", what, i, x[i], y[i]);
    if (i > 0 && !(x[i] > x[i - 1]))
      return fmt::format("{}: x must increase, but point {} has {} after {}", what, i, x[i], x[i - 1]);
    if (i > 0 && y[i] < y[i - 1])
      return fmt::format("{}: y must not fall, but point {} has {} after {}", what, i, y[i], y[i - 1]);
  }
  return "";
}

CurveFamily::CurveFamily(std::vector<double> parameter, std::vector<Curve> curves)
    : parameter_(std::move(parameter)), curves_(std::move(curves)) {
  if (parameter_.size() != curves_.size() || parameter_.empty())
    throw std::invalid_argument("a curve family needs as many parameter values as curves, at least one");
  for (std::size_t i = 1; i < parameter_.size(); ++i)
    if (!(parameter_[i] > parameter_[i - 1]))
      throw std::invalid_argument(fmt::format("curve family parameter must increase; entry {} does not", i));
}

CurveFamily::Blend CurveFamily::blend(double parameter) const {
  if (parameter_.size() == 1 || parameter <= parameter_.front()) return {0, 0.0};
  if (parameter >= parameter_.back()) return {parameter_.size() - 2, 1.0};
  const auto upper = std::upper_bound(parameter_.begin(), parameter_.end(), parameter);
  const std::size_t low = static_cast<std::size_t>(upper - parameter_.begin()) - 1;
  return {low, (parameter - parameter_[low]) / (parameter_[low + 1] - parameter_[low])};
}

Curve::Value CurveFamily::evaluate(double x, double parameter) const {
  const Blend b = blend(parameter);
  const Curve::Value low = curves_[b.low].evaluate(x);
  if (b.share == 0.0) return low;
  const Curve::Value high = curves_[b.low + 1].evaluate(x);
  return {low.y + b.share * (high.y - low.y), low.slope + b.share * (high.slope - low.slope)};
}

double CurveFamily::integral(double x, double parameter) const {
  const Blend b = blend(parameter);
  const double low = curves_[b.low].integral(x);
  if (b.share == 0.0) return low;
  return low + b.share * (curves_[b.low + 1].integral(x) - low);
}

}  // namespace heddle
