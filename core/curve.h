#pragma once

#include <string>
#include <vector>

namespace heddle {

/// Smooth curve through given points: C1, monotone wherever the points are monotone (Fritsch & Carlson 1980,
/// with the slopes of Fritsch & Butland 1984). Straight beyond both ends, with the end slope.
/// Its integral from the first point is exact, so a force curve has a consistent energy.
class Curve {
 public:
  struct Value {
    double y;
    double slope;
  };

  Curve() = default;
  /// @param x  strictly increasing, at least two, finite
  /// @param y  same size, finite
  /// @throws std::invalid_argument  naming the first point that breaks the rule
  Curve(std::vector<double> x, std::vector<double> y);

  Value evaluate(double x) const;
  double operator()(double x) const { return evaluate(x).y; }
  /// Integral of y from x().front() to x.
  double integral(double x) const;

  bool empty() const { return x_.empty(); }
  const std::vector<double>& x() const { return x_; }
  const std::vector<double>& y() const { return y_; }

 private:
  std::size_t interval(double x) const;
  std::vector<double> x_, y_, slope_, integral_;
  double inverse_step_ =
      0.0;  ///< > 0 when the points are evenly spaced: then the interval is found without a search
};

/// First fault of a table meant to be monotone, or "" if it has none. `what` names the table in the message.
std::string fault_of_monotone_table(const std::vector<double>& x, const std::vector<double>& y,
                                    const std::string& what);

/// Curves at several values of a second parameter (for instance the trellis shear angle), blended linearly
/// between them and held beyond the first and last. Value and slope are in x; the parameter enters lagged
/// quantities only.
class CurveFamily {
 public:
  CurveFamily() = default;
  CurveFamily(std::vector<double> parameter, std::vector<Curve> curves);

  Curve::Value evaluate(double x, double parameter) const;
  double integral(double x, double parameter) const;

  bool empty() const { return curves_.empty(); }
  const std::vector<double>& parameter() const { return parameter_; }
  const std::vector<Curve>& curves() const { return curves_; }

 private:
  struct Blend {
    std::size_t low;
    double share;  ///< of curve low + 1
  };
  Blend blend(double parameter) const;
  std::vector<double> parameter_;
  std::vector<Curve> curves_;
};

}  // namespace heddle
