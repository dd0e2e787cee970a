#include "friction/calibration/robust_fit.h"

#include <catch2/catch.hpp>
#include <cmath>

using namespace heddle::friction;

namespace {

/// value - x[0], one row, subject to the loss.
ResidualBlock reading_of(double value) {
  return {.rows = 1,
          .robust = true,
          .evaluate = [value](const Eigen::VectorXd& x, Eigen::VectorXd& r, Eigen::MatrixXd* slopes) {
            r[0] = x[0] - value;
            if (slopes != nullptr) slopes->setOnes();
            return true;
          }};
}

double centre_of(const std::vector<double>& values, Loss loss, FitVariable variable = {}) {
  std::vector<ResidualBlock> blocks;
  for (const double value : values) blocks.push_back(reading_of(value));
  return robust_fit(blocks, {variable}, {.loss = loss, .loss_scale = 1.0}).x[0];
}

}  // namespace

TEST_CASE("squares give the mean, Huber's loss its closed form, Cauchy's hardly sees an outlier",
          "[friction][calibration][analytic]") {
  const std::vector<double> values{-0.5, 0.0, 0.5, 20.0};
  CHECK(centre_of(values, Loss::none) == Approx(5.0).epsilon(1e-12));
  // Three inside, one beyond: 3 x - 0 - 1 = 0.
  CHECK(centre_of(values, Loss::huber) == Approx(1.0 / 3.0).epsilon(1e-8));
  const double x = centre_of(values, Loss::cauchy);
  double stationary = 0.0;
  for (const double value : values) stationary += (x - value) / (1.0 + (x - value) * (x - value));
  CHECK(stationary == Approx(0.0).margin(1e-8));
  CHECK(std::abs(x) < 0.05);
}

TEST_CASE("a minimum beyond a bound is found at the bound, and said", "[friction][calibration]") {
  std::vector<ResidualBlock> blocks{reading_of(3.0)};
  const RobustFit held = robust_fit(blocks, {{.start = 0.5, .low = 0.0, .high = 2.0}});
  CHECK(held.x[0] == 2.0);
  CHECK(held.at_bound[0]);
  CHECK(held.summary.converged);
  const RobustFit free = robust_fit(blocks, {{.start = 0.5, .low = 0.0, .high = 4.0}});
  CHECK(free.x[0] == Approx(3.0).epsilon(1e-12));
  CHECK_FALSE(free.at_bound[0]);
}

TEST_CASE("the unit of a variable does not matter to the search", "[friction][calibration][invariant]") {
  // Rosenbrock's valley, its second variable once in thousandths.
  const auto valley = [](double unit) {
    return ResidualBlock{
        .rows = 2,
        .robust = false,
        .evaluate = [unit](const Eigen::VectorXd& x, Eigen::VectorXd& r, Eigen::MatrixXd* slopes) {
          const double b = x[1] / unit;
          r << 1.0 - x[0], 10.0 * (b - x[0] * x[0]);
          if (slopes != nullptr) *slopes << -1.0, 0.0, -20.0 * x[0], 10.0 / unit;
          return true;
        }};
  };
  const RobustFit plain = robust_fit({valley(1.0)}, {{.start = -1.2}, {.start = 1.0}});
  const RobustFit scaled = robust_fit({valley(1e-3)}, {{.start = -1.2}, {.start = 1e-3, .size = 1e-3}});
  CHECK(plain.x[0] == Approx(1.0).epsilon(1e-9));
  CHECK(plain.x[1] == Approx(1.0).epsilon(1e-9));
  CHECK(scaled.x[1] == Approx(1e-3).epsilon(1e-9));
  CHECK(scaled.summary.iterations == plain.summary.iterations);
}

TEST_CASE("a search that runs out of iterations, or cannot start, says so", "[friction][calibration]") {
  const RobustFit cut = robust_fit({reading_of(3.0), reading_of(30.0)}, {{.start = 1e3}},
                                   {.loss = Loss::cauchy, .loss_scale = 1.0, .iterations_max = 1});
  CHECK_FALSE(cut.summary.converged);
  CHECK(cut.summary.reason == "the number of iterations ran out");
  const ResidualBlock nowhere{.rows = 1,
                              .robust = false,
                              .evaluate = [](const Eigen::VectorXd&, Eigen::VectorXd& r, Eigen::MatrixXd* j) {
                                r.setZero();
                                if (j != nullptr) j->setZero();
                                return false;
                              }};
  const RobustFit none = robust_fit({nowhere}, {{.start = 1.0}});
  CHECK_FALSE(none.summary.converged);
  CHECK(none.summary.reason == "the residuals are not finite at the starting values");
  CHECK(loss_weight(Loss::huber, 2.0, 16.0) == 0.5);
  CHECK(loss_weight(Loss::cauchy, 2.0, 4.0) == 0.5);
}
