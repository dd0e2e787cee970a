#include "mesoscale/coupon_curves.h"

#include <cmath>
#include <numbers>

namespace heddle::mesoscale {

double shear_flow(const FabricProperties& fabric, double shear_angle, double shear_rate, double temperature) {
  const double elastic = fabric.shear_stress.evaluate(std::sin(shear_angle)).y * std::cos(shear_angle);
  if (shear_rate == 0.0) return elastic;
  const ShearRate& rate = fabric.shear_rate;
  return elastic + rate.consistency_at(temperature) *
                       std::copysign(std::pow(std::abs(shear_rate), rate.index), shear_rate);
}

std::vector<CouponPoint> picture_frame(const FabricProperties& fabric, const PictureFrame& frame,
                                       const CouponPull& pull) {
  std::vector<CouponPoint> points;
  for (int k = 0; k < pull.points; ++k) {
    CouponPoint point;
    point.shear_angle = pull.highest * k / (pull.points - 1);
    const double half = 0.25 * std::numbers::pi - 0.5 * point.shear_angle;
    const double reach = frame.side * std::sin(half);  // dx/dg
    point.displacement = 2.0 * frame.side * (std::cos(half) - std::numbers::sqrt2 / 2.0);
    point.shear_rate = pull.speed / reach;
    const double flow = shear_flow(fabric, point.shear_angle, point.shear_rate, pull.temperature);
    point.force = flow * frame.fabric_side * frame.fabric_side / reach;
    point.normalised = flow / std::cos(point.shear_angle);
    points.push_back(point);
  }
  return points;
}

std::vector<CouponPoint> bias_extension(const FabricProperties& fabric, const BiasExtension& strip,
                                        const CouponPull& pull) {
  const double w = strip.width, h = strip.length, between = h - w;
  std::vector<CouponPoint> points;
  for (int k = 0; k < pull.points; ++k) {
    CouponPoint point;
    const double angle = point.shear_angle = pull.highest * k / (pull.points - 1);
    const double c = std::cos(0.5 * angle), s = std::sin(0.5 * angle);
    const double reach = 0.5 * between * (c - s);  // dx/dg
    point.displacement = between * (c + s - 1.0);
    point.shear_rate = pull.speed / reach;
    const double middle = shear_flow(fabric, angle, point.shear_rate, pull.temperature);
    const double quarters = shear_flow(fabric, 0.5 * angle, 0.5 * point.shear_rate, pull.temperature);
    point.force = (0.5 * w * (2.0 * h - 3.0 * w) * middle + 0.5 * w * w * quarters) / reach;
    point.normalised = middle / std::cos(angle);
    points.push_back(point);
  }
  return points;
}

}  // namespace heddle::mesoscale
