#pragma once

#include <Eigen/Core>

#include "core/curve.h"
#include "friction/model.h"

namespace heddle::macroscale {

/// Normal contact of one point: the fabric's own compaction curve, a physical stiffness and no numerical
/// penalty.
struct NormalContact {
  double approach = 0.0;   ///< overlap of tool and stress-free half thickness [m]; <= 0: apart
  double energy = 0.0;     ///< per area, integral of the pressure [J/m^2]
  double pressure = 0.0;   ///< [Pa]
  double stiffness = 0.0;  ///< d pressure / d approach [Pa/m]
};

NormalContact normal_contact(const Curve& compaction, double distance, double half_thickness);
/// The same of a fabric sheared by a trellis angle (sign ignored), held: no slope to it is given.
NormalContact normal_contact(const CurveFamily& compaction, double shear_angle, double distance,
                             double half_thickness);

/// Approach of one face at which the compaction curve carries a pressure [m]: where a closing tool will come
/// to rest.
double approach_at(const Curve& compaction, double pressure);

/// Friction of one point while its load, normal and temperatures are held (lagged): a potential in slip
/// velocity,
///     D(v) = N dt Int_0^|v| g(U) dU,   g(U) = mu(U) f(U/eps),
/// with mu(U) inside, so every Newton iteration sees the current coefficient, and f the smooth ramp
/// f(y) = 2y - y^2 (y < 1), 1 (y >= 1) that makes sticking differentiable. Source of the smoothing: Li et al.
/// 2020 (IPC), lagged as there. Traction, potential and tangent are built from mu here and nowhere else.
struct FrictionPoint {
  double load = 0.0;                ///< N = p A [N]
  Eigen::Vector3d normal{0, 0, 1};  ///< unit
  friction::Context context{};      ///< slip speed is filled in at evaluation
  friction::ContactState memory{};
};

struct FrictionSettings {
  const friction::Model* model = nullptr;  ///< null = frictionless
  double smoothing = 1e-5;                 ///< eps_v [m/s]
};

/// Slip velocity: v without its part along the normal [m/s].
Eigen::Vector3d slip_velocity(const FrictionPoint& point, const Eigen::Vector3d& v);

/// The law at a slip speed.
friction::Friction law_at(const FrictionSettings& settings, const FrictionPoint& point, double speed);

/// One friction point at one velocity, its law looked up once.
struct FrictionResponse {
  Eigen::Vector3d slip{0, 0, 0};  ///< [m/s]
  double speed = 0.0;             ///< U = |slip| [m/s]
  double over_speed = 0.0;        ///< g(U) / U [s/m], finite at rest
  double slope = 0.0;             ///< dg/dU [s/m]
};
FrictionResponse friction_response(const FrictionSettings& settings, const FrictionPoint& point,
                                   const Eigen::Vector3d& v);

/// Force on the tool's counterpart that resists slip, as gradient dD/dv / dt: points along the slip [N].
inline Eigen::Vector3d friction_force(const FrictionPoint& point, const FrictionResponse& at) {
  return point.load * at.over_speed * at.slip;
}
Eigen::Vector3d friction_force(const FrictionSettings& settings, const FrictionPoint& point,
                               const Eigen::Vector3d& v);

/// How the derivative of friction is taken. `convex`: the falling branch of a law is cut to zero. `secant`: N
/// g(U)/U in every direction of slip. As D is concave in U^2 (g(U)/U falls) that quadratic lies above D and
/// touches it at U: a step along it never overshoots the kink where slip turns round.
enum class FrictionTangent { exact, convex, secant };

/// Derivative of the friction force in v [N s/m], symmetric.
Eigen::Matrix3d friction_tangent(const FrictionSettings& settings, const FrictionPoint& point,
                                 const FrictionResponse& at, FrictionTangent kind);
Eigen::Matrix3d friction_tangent(const FrictionSettings& settings, const FrictionPoint& point,
                                 const Eigen::Vector3d& v, FrictionTangent kind);

/// N Int g dU from one slip speed to another [W]; times dt this is the change of D. Where the two are near
/// each other Hermite's rule takes it from values and slopes at both ends, otherwise Gauss's from four points
/// between: the error vanishes with the distance, and a line search near the solution sees no noise.
double friction_power_difference(const FrictionSettings& settings, const FrictionPoint& point,
                                 const FrictionResponse& from, const FrictionResponse& to);

}  // namespace heddle::macroscale
