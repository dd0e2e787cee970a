#include "macroscale/corner_element.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "macroscale/corner_filter.h"

namespace heddle::macroscale {

namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

// Shear rate below which the power law gives way to a Newtonian start [1/s]: for n < 1 the bare power law has
// an infinite tangent at rest. Forming rates are 0.1 to 10 1/s; the floor moves stresses there by less than
// 4e-5.
constexpr double rate_floor = 1e-3;

// |s| is kept below 1 where 1/cos(gamma) enters; a step that closes a corner beyond 89 deg is
// rejected (solve).
constexpr double sine_limit = 0.99999;

// Psi(s): the stored curve is its slope for s >= 0, odd in s.
CornerScalar table_law(const CornerLaw& law, double s) {
  const double size = std::abs(s);
  const Curve& resistance = law.fabric->shear_stress;
  const Curve::Value slope = resistance.evaluate(size);
  const CornerScalar whole{resistance.integral(size), std::copysign(slope.y, s), slope.slope};
  if (!law.memory) return whole;
  const CornerScalar rubs = tow_friction(law.friction, resistance, *law.memory, s);
  const double elastic = 1.0 - law.friction.share;
  return {elastic * whole.energy + rubs.energy, elastic * whole.first + rubs.first,
          elastic * whole.second + rubs.second};
}

CornerScalar shear_law(const CornerLaw& law, double s) {
  CornerScalar shear = table_law(law, s);
  for (double* part : {&shear.energy, &shear.first, &shear.second}) *part *= law.shear_factor;
  if (!law.locking.on()) return shear;
  const CornerScalar locks = locking_law(law.locking, s);
  return {shear.energy + locks.energy, shear.first + locks.first, shear.second + locks.second};
}

double warp_strain(const CornerLaw& law, const CornerPoint& k) {
  return k.la / law.length_warp - 1.0;
}
double weft_strain(const CornerLaw& law, const CornerPoint& k) {
  return k.lb / law.length_weft - 1.0;
}

// What tension makes of the shear of the table: c g, and that shear, P.
struct Coupled {
  Surface::Value g{0, 0, 0, 0, 0, 0};
  CornerScalar shear;
};

Coupled coupled(const CornerLaw& law, const CornerPoint& k) {
  Coupled both;
  if (!law.coupling) return both;
  both.g = law.coupling->evaluate(warp_strain(law, k), weft_strain(law, k));
  both.shear = k.shear;
  if (!law.locking.on()) return both;
  const CornerScalar locks = locking_law(law.locking, k.s);
  both.shear.energy -= locks.energy;
  both.shear.first -= locks.first;
  both.shear.second -= locks.second;
  return both;
}

// dt R = eta_t / (2 dt) (de1^2 + de2^2) per area: its slopes to both strains, and what both share.
struct TowRate {
  double warp = 0.0, weft = 0.0, tangent = 0.0, energy = 0.0;
};

TowRate tow_rate(const CornerLaw& law, const CornerPoint& k) {
  if (law.tow_viscosity == 0.0 || law.time_step == 0.0) return {};
  const double warp = warp_strain(law, k) - law.strain_before[0],
               weft = weft_strain(law, k) - law.strain_before[1];
  const double tangent = law.tow_viscosity / law.time_step;
  return {tangent * warp, tangent * weft, tangent, 0.5 * tangent * (warp * warp + weft * weft)};
}

// dt R(gdot) as a function of s, through gamma = asin(s).
CornerScalar rate_law(const CornerLaw& law, const CornerPoint& k, double angle_before) {
  if (law.rate_consistency == 0.0 || law.time_step == 0.0) return {0.0, 0.0, 0.0};
  const double n = law.rate_index;
  const double rate = (std::asin(k.s) - angle_before) / law.time_step;
  const double size2 = rate * rate + rate_floor * rate_floor;
  const double viscosity = law.rate_consistency * std::pow(size2, 0.5 * (n - 1.0));
  const double floor_energy = std::pow(rate_floor, n + 1.0);
  const double energy = law.time_step * (viscosity * size2 - law.rate_consistency * floor_energy) / (n + 1.0);
  const double torque = viscosity * rate;  // d(dt R)/d gamma
  const double tangent = viscosity * (1.0 + (n - 1.0) * rate * rate / size2) / law.time_step;  // second
  const double slope = 1.0 / k.c;               // d gamma / d s
  const double bend = k.s / (k.c * k.c * k.c);  // d2 gamma / d s2
  return {energy, torque * slope, tangent * slope * slope + torque * bend};
}

// ds/da and ds/db.
Vector3d sine_slope_a(const CornerPoint& k) {
  return (k.q - k.s * k.p) / k.la;
}
Vector3d sine_slope_b(const CornerPoint& k) {
  return (k.p - k.s * k.q) / k.lb;
}

}  // namespace

double corner_angle(const Vector3d& a, const Vector3d& b) {
  return std::asin(std::clamp(a.dot(b) / (a.norm() * b.norm()), -1.0, 1.0));
}

CornerPoint corner_point(const CornerLaw& law, const Vector3d& a, const Vector3d& b, double angle_before) {
  CornerPoint k;
  k.la = a.norm();
  k.lb = b.norm();
  k.p = a / k.la;
  k.q = b / k.lb;
  k.s = std::clamp(k.p.dot(k.q), -sine_limit, sine_limit);
  k.c = std::sqrt(1.0 - k.s * k.s);
  k.tension = law.fabric->tension_energy.evaluate(k.la / law.length_warp - 1.0, k.lb / law.length_weft - 1.0);
  k.shear = shear_law(law, k.s);
  k.rate = rate_law(law, k, angle_before);
  return k;
}

CornerEnergy corner_energy(const CornerLaw& law, const CornerPoint& k) {
  const Coupled both = coupled(law, k);
  return {law.area * k.tension.f, law.area * (k.shear.energy + both.g.f * both.shear.energy),
          law.area * k.rate.energy, law.area * tow_rate(law, k).energy};
}

CornerEnergy corner_energy(const CornerLaw& law, const Vector3d& a, const Vector3d& b, double angle_before) {
  return corner_energy(law, corner_point(law, a, b, angle_before));
}

CornerGradient corner_gradient(const CornerLaw& law, const CornerPoint& k) {
  const Vector3d sa = law.area * sine_slope_a(k), sb = law.area * sine_slope_b(k);
  CornerGradient g{law.area * k.tension.fx / law.length_warp * k.p,
                   law.area * k.tension.fy / law.length_weft * k.q,
                   k.shear.first * sa,
                   k.shear.first * sb,
                   k.rate.first * sa,
                   k.rate.first * sb};
  if (law.coupling) {
    const auto& [c, shear] = coupled(law, k);
    g.shear_a += c.f * shear.first * sa + law.area * c.fx * shear.energy / law.length_warp * k.p;
    g.shear_b += c.f * shear.first * sb + law.area * c.fy * shear.energy / law.length_weft * k.q;
  }
  if (law.tow_viscosity > 0.0) {
    const TowRate rate = tow_rate(law, k);
    g.tow_rate_a = law.area * rate.warp / law.length_warp * k.p;
    g.tow_rate_b = law.area * rate.weft / law.length_weft * k.q;
  }
  return g;
}

CornerGradient corner_gradient(const CornerLaw& law, const Vector3d& a, const Vector3d& b,
                               double angle_before) {
  return corner_gradient(law, corner_point(law, a, b, angle_before));
}

CornerHessian corner_hessian(const CornerLaw& law, const Vector3d& a, const Vector3d& b, double angle_before,
                             Filter filter) {
  return corner_hessian(law, corner_point(law, a, b, angle_before), filter);
}

// Second derivatives in polar components: along and across each edge in the plane of both, and out of it.
// Energies that depend on |a|, |b| and the angle between them couple these in a ring
// (macroscale/corner_filter.h).
CornerHessian corner_hessian(const CornerLaw& law, const CornerPoint& k, Filter filter) {
  Surface::Value w = k.tension;
  double f1 = k.shear.first + k.rate.first, f2 = k.shear.second + k.rate.second;
  // Slopes of the shear stress to the lengths of the edges: 0 unless tension stiffens shear.
  double f1_a = 0.0, f1_b = 0.0;
  if (law.coupling) {
    const auto& [c, shear] = coupled(law, k);
    f1 += c.f * shear.first;
    f2 += c.f * shear.second;
    f1_a = c.fx * shear.first / law.length_warp;
    f1_b = c.fy * shear.first / law.length_weft;
    w.fx += c.fx * shear.energy;
    w.fy += c.fy * shear.energy;
    w.fxx += c.fxx * shear.energy;
    w.fxy += c.fxy * shear.energy;
    w.fyy += c.fyy * shear.energy;
  }
  if (law.tow_viscosity > 0.0) {
    const TowRate rate = tow_rate(law, k);
    w.fx += rate.warp;
    w.fy += rate.weft;
    w.fxx += rate.tangent;
    w.fyy += rate.tangent;
  }
  const double n1 = w.fx / law.length_warp, n2 = w.fy / law.length_weft;  // tension per length of edge
  const double ia = 1.0 / k.la, ib = 1.0 / k.lb;
  // With s = cos(phi), phi the angle between the edges: -d/d phi and d2/d phi2 of the shear terms.
  const double torque = f1 * k.c, turning = f2 * k.c * k.c - f1 * k.s;

  CornerRing ring;
  ring.along_a = law.area * w.fxx / (law.length_warp * law.length_warp);
  ring.along_b = law.area * w.fyy / (law.length_weft * law.length_weft);
  ring.across_a = law.area * (n1 * ia + turning * ia * ia);
  ring.across_b = law.area * (n2 * ib + turning * ib * ib);
  ring.along = law.area * w.fxy / (law.length_warp * law.length_weft);
  ring.across = -law.area * turning * ia * ib;
  ring.turn_a = -law.area * torque * ia * ia;
  ring.turn_b = law.area * torque * ib * ib;
  // ds/da = c ia across a, ds/db = -c ib across b: with the slopes above two couplings join the ring.
  if (law.coupling) {
    ring.turn_a += law.area * f1_a * k.c * ia;
    ring.turn_b -= law.area * f1_b * k.c * ib;
  }
  const double a_with_across_b = -law.area * f1_a * k.c * ib, b_with_across_a = law.area * f1_b * k.c * ia;
  Symmetric2 normal{law.area * (n1 * ia - f1 * k.s * ia * ia), law.area * f1 * ia * ib,
                    law.area * (n2 * ib - f1 * k.s * ib * ib)};

  const Vector3d pt = (k.q - k.s * k.p) / k.c,
                 qt = (k.s * k.q - k.p) / k.c;  // across p and q, in their plane
  const Vector3d n = k.p.cross(pt);
  if (filter == Filter::none) {
    const Matrix3d nn = n * n.transpose();
    const Vector3d pa = ring.along_a * k.p + ring.turn_a * pt, ta = ring.turn_a * k.p + ring.across_a * pt;
    const Vector3d qb = ring.along_b * k.q + ring.turn_b * qt, tb = ring.turn_b * k.q + ring.across_b * qt;
    Matrix3d ab = ring.along * k.p * k.q.transpose() + ring.across * pt * qt.transpose() + normal.xy * nn;
    if (law.coupling) ab += a_with_across_b * k.p * qt.transpose() + b_with_across_a * pt * k.q.transpose();
    return {pa * k.p.transpose() + ta * pt.transpose() + normal.xx * nn, ab,
            qb * k.q.transpose() + tb * qt.transpose() + normal.yy * nn};
  }
  normal = positive_part(normal);
  Eigen::Matrix4d plane;  // a along, a across, b along, b across
  if (law.coupling) {
    plane = matrix_of(ring);
    plane(0, 3) = plane(3, 0) = a_with_across_b;
    plane(1, 2) = plane(2, 1) = b_with_across_a;
    plane = positive_part(plane);
  } else {
    plane = positive_part(ring);
  }
  Eigen::Matrix<double, 3, 2> at, bt;
  at << k.p, pt;
  bt << k.q, qt;
  const Matrix3d nn = n * n.transpose();
  return {at * plane.topLeftCorner<2, 2>() * at.transpose() + normal.xx * nn,
          at * plane.topRightCorner<2, 2>() * bt.transpose() + normal.xy * nn,
          bt * plane.bottomRightCorner<2, 2>() * bt.transpose() + normal.yy * nn};
}

}  // namespace heddle::macroscale
