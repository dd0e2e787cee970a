// Picture frame and bias extension predicted from the forming laws.
#include "mesoscale/coupon_curves.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "table1.h"
#include "tests/derivative_check.h"

using namespace heddle;
using namespace heddle::mesoscale;
using heddle::test::radians;

namespace {

// Psi'(s) = a s + b s^3 over sines, and a rate law.
FabricProperties made_up() {
  FabricProperties fabric;
  std::vector<double> s, y;
  for (int k = 0; k <= 400; ++k) {
    s.push_back(0.95 * k / 400.0);
    y.push_back(30.0 * s.back() + 200.0 * s.back() * s.back() * s.back());
  }
  fabric.shear_stress = Curve(std::move(s), std::move(y));
  fabric.shear_rate = {40.0, 0.4, 5000.0, 453.15};
  return fabric;
}

// Work of the crosshead against energy in the fabric, both up to the last point.
double work_of(const std::vector<CouponPoint>& points) {
  double work = 0.0;
  for (std::size_t k = 1; k < points.size(); ++k)
    work +=
        0.5 * (points[k].force + points[k - 1].force) * (points[k].displacement - points[k - 1].displacement);
  return work;
}

double energy(double angle) {  // Psi per area
  const double s = std::sin(angle);
  return 15.0 * s * s + 50.0 * s * s * s * s;
}

}  // namespace

TEST_CASE("the crosshead of a picture frame does the work that the fabric stores", "[coupon]") {
  const FabricProperties fabric = made_up();
  const PictureFrame frame{.side = 0.25, .fabric_side = 0.18};
  const CouponPull pull{.highest = radians(50.0), .points = 2001};
  const auto points = picture_frame(fabric, frame, pull);
  CHECK(work_of(points) == Approx(0.18 * 0.18 * energy(radians(50.0))).epsilon(1e-4));
  CHECK(points.back().shear_angle == Approx(radians(50.0)));
  CHECK(points.front().force == Approx(0.0).margin(1e-9));
}

TEST_CASE("the crosshead of a bias extension does the work that its zones store", "[coupon]") {
  const FabricProperties fabric = made_up();
  const BiasExtension strip{.length = 0.25, .width = 0.1};
  const auto points = bias_extension(fabric, strip, {.highest = radians(40.0), .points = 2001});
  const double w = strip.width, h = strip.length;
  const double middle = 0.5 * w * (2.0 * h - 3.0 * w), quarters = w * w;
  CHECK(middle + quarters + 0.5 * w * w == Approx(w * h));  // the ends do not shear
  CHECK(work_of(points) ==
        Approx(middle * energy(radians(40.0)) + quarters * energy(radians(20.0))).epsilon(1e-4));
}

TEST_CASE("a frame filled by its fabric gives the shear force by the usual reduction", "[coupon]") {
  const FabricProperties fabric = made_up();
  const PictureFrame frame{.side = 0.2, .fabric_side = 0.2};
  for (const CouponPoint& point :
       picture_frame(fabric, frame, {.speed = 1e-3, .highest = 1.0, .points = 11})) {
    const double half = 0.25 * std::numbers::pi - 0.5 * point.shear_angle;
    CHECK(point.normalised == Approx(point.force / (2.0 * 0.2 * std::cos(half))).epsilon(1e-12));
  }
}

TEST_CASE("a bias extension is undone by the recursion that labs use", "[coupon]") {
  const FabricProperties fabric = made_up();
  const BiasExtension strip{.length = 0.3, .width = 0.1};
  const CouponPull pull{.highest = 0.8, .points = 161};
  const auto points = bias_extension(fabric, strip, pull);
  for (std::size_t k = 2; k < points.size(); k += 2) {
    const CouponPoint& at = points[k];
    const double g = at.shear_angle, half_force = points[k / 2].normalised;  // F_s at g / 2
    const double h = strip.length, w = strip.width;
    const double reduced = ((h / w - 1.0) * at.force * (std::cos(0.5 * g) - std::sin(0.5 * g)) -
                            w * half_force * std::cos(0.5 * g)) /
                           ((2.0 * h - 3.0 * w) * std::cos(g));
    CHECK(reduced == Approx(at.normalised).epsilon(1e-10));
  }
}

TEST_CASE("angle and displacement of a coupon move together at the rate stated", "[coupon][derivative]") {
  const FabricProperties fabric = made_up();
  const double speed = 5e-3;
  const auto displacement = [&](bool frame, double angle) {
    const CouponPull pull{.speed = speed, .highest = angle, .points = 2};
    return frame ? picture_frame(fabric, {}, pull).back() : bias_extension(fabric, {}, pull).back();
  };
  for (const bool frame : {true, false})
    for (const double angle : {0.1, 0.5, 0.9}) {
      const double slope = speed / displacement(frame, angle).shear_rate;
      const auto x = [&](double g) { return displacement(frame, g).displacement; };
      CHECK(heddle::test::derivative_gap(x, angle, 1.0, slope) < 1e-8);
      CHECK(heddle::test::derivative_gap(x, angle, 1.0, 1.01 * slope) > 1e-3);
    }
}

TEST_CASE("a faster crosshead needs more force by the power of the melt", "[coupon]") {
  const FabricProperties fabric = made_up();
  const auto viscous = [&](double speed) {
    return picture_frame(fabric, {}, {.speed = speed, .highest = 0.5, .points = 2}).back().force -
           picture_frame(fabric, {}, {.highest = 0.5, .points = 2}).back().force;
  };
  CHECK(viscous(10e-3) / viscous(1e-3) == Approx(std::pow(10.0, 0.4)).epsilon(1e-10));
}
