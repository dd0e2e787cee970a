#pragma once

#include <vector>

namespace heddle {

/// Twice differentiable surface through values on an even grid: tensor-product cubic spline with quadratic
/// end pieces. Beyond the grid it goes on quadratically, so stiffness is held there.
class Surface {
 public:
  struct Value {
    double f, fx, fy, fxx, fxy, fyy;
  };

  Surface() = default;
  /// @param values  f(x_i, y_j), row-major with j fastest: values[i * ny + j]; nx, ny >= 4
  /// @throws std::invalid_argument  if sizes disagree or a value is not finite
  Surface(double x0, double dx, int nx, double y0, double dy, int ny, std::vector<double> values);

  Value evaluate(double x, double y) const;

  bool empty() const { return values_.empty(); }
  double x0() const { return x0_; }
  double dx() const { return dx_; }
  double y0() const { return y0_; }
  double dy() const { return dy_; }
  int nx() const { return nx_; }
  int ny() const { return ny_; }
  const std::vector<double>& values() const { return values_; }

 private:
  double x0_ = 0, dx_ = 1, y0_ = 0, dy_ = 1;
  int nx_ = 0, ny_ = 0;
  std::vector<double> values_;
  std::vector<double> coefficients_;  ///< B-spline coefficients, (nx + 2) x (ny + 2)
};

}  // namespace heddle
