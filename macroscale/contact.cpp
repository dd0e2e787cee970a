#include "macroscale/contact.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace heddle::macroscale {

namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

struct Ramp {
  double value, slope;  ///< f, df/dy
};

Ramp ramp(double y) {
  return y < 1.0 ? Ramp{y * (2.0 - y), 2.0 * (1.0 - y)} : Ramp{1.0, 0.0};
}

struct Resistance {
  double over_speed;  ///< g(U) / U [s/m], finite at rest
  double slope;       ///< dg/dU [s/m]
};

Resistance resistance(const FrictionSettings& settings, const FrictionPoint& point, double speed) {
  const double y = speed / settings.smoothing;
  const auto law = law_at(settings, point, speed);
  const Ramp f = ramp(y);
  const double over_speed = y < 1.0 ? law.mu * (2.0 - y) / settings.smoothing : law.mu / speed;
  return {over_speed, law.dmu_dspeed * f.value + law.mu * f.slope / settings.smoothing};
}

double smoothed_coefficient(const FrictionSettings& settings, const FrictionPoint& point, double speed) {
  return law_at(settings, point, speed).mu * ramp(speed / settings.smoothing).value;
}

// Gauss-Legendre on [-1, 1].
constexpr std::array<double, 4> gauss_point = {-0.8611363115940526, -0.3399810435848563, 0.3399810435848563,
                                               0.8611363115940526};
constexpr std::array<double, 4> gauss_weight = {0.3478548451374538, 0.6521451548625461, 0.6521451548625461,
                                                0.3478548451374538};

double integral_of_coefficient(const FrictionSettings& settings, const FrictionPoint& point, double from,
                               double to) {
  const double middle = 0.5 * (from + to), half = 0.5 * (to - from);
  double sum = 0.0;
  for (std::size_t k = 0; k < gauss_point.size(); ++k)
    sum += gauss_weight[k] * smoothed_coefficient(settings, point, middle + half * gauss_point[k]);
  return half * sum;
}

}  // namespace

NormalContact normal_contact(const Curve& compaction, double distance, double half_thickness) {
  NormalContact contact;
  contact.approach = half_thickness - distance;
  if (contact.approach <= 0.0) return contact;
  const Curve::Value p = compaction.evaluate(contact.approach);
  contact.energy = compaction.integral(contact.approach);
  contact.pressure = p.y;
  contact.stiffness = p.slope;
  return contact;
}

NormalContact normal_contact(const CurveFamily& compaction, double shear_angle, double distance,
                             double half_thickness) {
  NormalContact contact;
  contact.approach = half_thickness - distance;
  if (contact.approach <= 0.0) return contact;
  const double angle = std::abs(shear_angle);
  const Curve::Value p = compaction.evaluate(contact.approach, angle);
  contact.energy = compaction.integral(contact.approach, angle);
  contact.pressure = p.y;
  contact.stiffness = p.slope;
  return contact;
}

double approach_at(const Curve& compaction, double pressure) {
  double low = 0.0, high = compaction.x().back();
  while (high - low > 1e-15) {
    const double middle = 0.5 * (low + high);
    if (middle == low || middle == high) break;
    (compaction(middle) < pressure ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

Vector3d slip_velocity(const FrictionPoint& point, const Vector3d& v) {
  return v - point.normal.dot(v) * point.normal;
}

friction::Friction law_at(const FrictionSettings& settings, const FrictionPoint& point, double speed) {
  friction::Context context = point.context;
  context.slip_speed = speed;
  return friction::evaluate(*settings.model, context, point.memory);
}

FrictionResponse friction_response(const FrictionSettings& settings, const FrictionPoint& point,
                                   const Vector3d& v) {
  FrictionResponse at;
  at.slip = slip_velocity(point, v);
  at.speed = at.slip.norm();
  const Resistance r = resistance(settings, point, at.speed);
  at.over_speed = r.over_speed;
  at.slope = r.slope;
  return at;
}

Vector3d friction_force(const FrictionSettings& settings, const FrictionPoint& point, const Vector3d& v) {
  return friction_force(point, friction_response(settings, point, v));
}

Matrix3d friction_tangent(const FrictionSettings& settings, const FrictionPoint& point,
                          const FrictionResponse& at, FrictionTangent kind) {
  const double slope = kind == FrictionTangent::exact ? at.slope : std::max(at.slope, 0.0);
  const Matrix3d tangent_plane = Matrix3d::Identity() - point.normal * point.normal.transpose();
  if (at.speed < 1e-9 * settings.smoothing || kind == FrictionTangent::secant)
    return point.load * at.over_speed * tangent_plane;
  const Vector3d direction = at.slip / at.speed;
  return point.load *
         (at.over_speed * tangent_plane + (slope - at.over_speed) * direction * direction.transpose());
}

Matrix3d friction_tangent(const FrictionSettings& settings, const FrictionPoint& point, const Vector3d& v,
                          FrictionTangent kind) {
  return friction_tangent(settings, point, friction_response(settings, point, v), kind);
}

double friction_power_difference(const FrictionSettings& settings, const FrictionPoint& point,
                                 const FrictionResponse& from, const FrictionResponse& to) {
  const double way = to.speed - from.speed;
  // The ramp's end is the only kink: integrate on each side of it.
  const double knee =
      std::clamp(settings.smoothing, std::min(from.speed, to.speed), std::max(from.speed, to.speed));
  // Laws vary over their own slip speed: this near, ends alone leave 1e-7 of the change.
  constexpr double near = 0.1;
  const bool crosses = knee != from.speed && knee != to.speed;
  if (!crosses && std::abs(way) <= near * std::max(from.speed, to.speed))
    return point.load * (0.5 * way * (from.over_speed * from.speed + to.over_speed * to.speed) +
                         way * way / 12.0 * (from.slope - to.slope));
  double sum = 0.0;
  if (knee != from.speed) sum += integral_of_coefficient(settings, point, from.speed, knee);
  if (knee != to.speed) sum += integral_of_coefficient(settings, point, knee, to.speed);
  return point.load * sum;
}

}  // namespace heddle::macroscale
