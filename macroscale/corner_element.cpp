#include "macroscale/corner_element.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

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
CornerScalar shear_law(const CornerLaw& law, double s) {
  const double size = std::abs(s);
  const Curve::Value slope = law.fabric->shear_stress.evaluate(size);
  return {law.fabric->shear_stress.integral(size), std::copysign(slope.y, s), slope.slope};
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

// Nearest positive semi-definite matrix of a symmetric 2 x 2, closed form.
void make_positive(double& xx, double& xy, double& yy) {
  const double mean = 0.5 * (xx + yy), half = 0.5 * (xx - yy);
  const double radius = std::hypot(half, xy);
  const double low = mean - radius, high = mean + radius;
  if (low >= 0.0) return;
  if (high <= 0.0) {
    xx = xy = yy = 0.0;
    return;
  }
  // Projector on the upper eigenvector, times its eigenvalue.
  const double cos2 = half / radius, sin2 = xy / radius;
  xx = 0.5 * high * (1.0 + cos2);
  yy = 0.5 * high * (1.0 - cos2);
  xy = 0.5 * high * sin2;
}

// One rotation of Jacobi's method: annihilates m(i, j), collects the rotation in v.
void rotate(Eigen::Matrix4d& m, Eigen::Matrix4d& v, int i, int j) {
  if (m(i, j) == 0.0) return;
  const double theta = (m(j, j) - m(i, i)) / (2.0 * m(i, j));
  const double t = std::copysign(1.0, theta) / (std::abs(theta) + std::sqrt(theta * theta + 1.0));
  const double c = 1.0 / std::sqrt(t * t + 1.0), s = t * c;
  for (int k = 0; k < 4; ++k) {
    const double ki = m(k, i), kj = m(k, j);
    m(k, i) = c * ki - s * kj;
    m(k, j) = s * ki + c * kj;
  }
  for (int k = 0; k < 4; ++k) {
    const double ik = m(i, k), jk = m(j, k);
    m(i, k) = c * ik - s * jk;
    m(j, k) = s * ik + c * jk;
    const double vi = v(k, i), vj = v(k, j);
    v(k, i) = c * vi - s * vj;
    v(k, j) = s * vi + c * vj;
  }
}

// Nearest positive semi-definite matrix of a symmetric 4 x 4, by Jacobi's method.
void make_positive(Eigen::Matrix4d& m) {
  // Almost every corner is positive already; a Cholesky attempt is ten times cheaper than the eigenvalues.
  if (Eigen::LLT<Eigen::Matrix4d>(m).info() == Eigen::Success) return;
  Eigen::Matrix4d v = Eigen::Matrix4d::Identity();
  const double small = 1e-28 * m.squaredNorm();
  for (int sweep = 0; sweep < 12; ++sweep) {
    double off = 0.0;
    for (int i = 0; i < 4; ++i)
      for (int j = i + 1; j < 4; ++j) off += m(i, j) * m(i, j);
    if (off <= small) break;
    for (int i = 0; i < 4; ++i)
      for (int j = i + 1; j < 4; ++j) rotate(m, v, i, j);
  }
  const Eigen::Vector4d kept = m.diagonal().cwiseMax(0.0);
  m = v * kept.asDiagonal() * v.transpose();
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
  return {law.area * k.tension.f, law.area * k.shear.energy, law.area * k.rate.energy};
}

CornerEnergy corner_energy(const CornerLaw& law, const Vector3d& a, const Vector3d& b, double angle_before) {
  return corner_energy(law, corner_point(law, a, b, angle_before));
}

CornerGradient corner_gradient(const CornerLaw& law, const CornerPoint& k) {
  const Vector3d sa = law.area * sine_slope_a(k), sb = law.area * sine_slope_b(k);
  return {law.area * k.tension.fx / law.length_warp * k.p,
          law.area * k.tension.fy / law.length_weft * k.q,
          k.shear.first * sa,
          k.shear.first * sb,
          k.rate.first * sa,
          k.rate.first * sb};
}

CornerGradient corner_gradient(const CornerLaw& law, const Vector3d& a, const Vector3d& b,
                               double angle_before) {
  return corner_gradient(law, corner_point(law, a, b, angle_before));
}

CornerHessian corner_hessian(const CornerLaw& law, const Vector3d& a, const Vector3d& b, double angle_before,
                             Filter filter) {
  return corner_hessian(law, corner_point(law, a, b, angle_before), filter);
}

CornerHessian corner_hessian(const CornerLaw& law, const CornerPoint& k, Filter filter) {
  const Surface::Value& w = k.tension;
  const double f1 = k.shear.first + k.rate.first, f2 = k.shear.second + k.rate.second;

  // Frame of the corner: t1 = p, t2 in the plane of both tows, t3 normal. Out of plane the two edge
  // components decouple from the four in-plane ones, so a 2 x 2 and a 4 x 4 block hold everything.
  const Vector3d t2 = (k.q - k.s * k.p) / k.c;
  const Vector3d t3 = k.p.cross(t2);
  const double n1 = w.fx / law.length_warp, n2 = w.fy / law.length_weft;  // tension per length of edge

  // e_ww of |a| is 1/|a| across the edge; s has second derivatives -s/|a|^2, -s/|b|^2 and 1/(|a||b|) out of
  // plane.
  double oaa = law.area * (n1 / k.la - f1 * k.s / (k.la * k.la));
  double obb = law.area * (n2 / k.lb - f1 * k.s / (k.lb * k.lb));
  double oab = law.area * f1 / (k.la * k.lb);

  // In plane, in the frame (t1, t2): p = (1, 0), q = (s, c).
  const Eigen::Vector2d p(1.0, 0.0), q(k.s, k.c);
  const Eigen::Matrix2d I = Eigen::Matrix2d::Identity();
  const Eigen::Matrix2d pp = p * p.transpose(), qq = q * q.transpose(), pq = p * q.transpose();
  const Eigen::Vector2d sa = (q - k.s * p) / k.la, sb = (p - k.s * q) / k.lb;
  Eigen::Matrix2d saa = (-(pq + pq.transpose()) - k.s * I + 3.0 * k.s * pp) / (k.la * k.la);
  Eigen::Matrix2d sbb = (-(pq + pq.transpose()) - k.s * I + 3.0 * k.s * qq) / (k.lb * k.lb);
  Eigen::Matrix2d sab = (I - pp - qq + k.s * pq) / (k.la * k.lb);
  Eigen::Matrix4d in_plane;
  in_plane.topLeftCorner<2, 2>() = w.fxx / (law.length_warp * law.length_warp) * pp + n1 / k.la * (I - pp) +
                                   f2 * sa * sa.transpose() + f1 * saa;
  in_plane.bottomRightCorner<2, 2>() = w.fyy / (law.length_weft * law.length_weft) * qq +
                                       n2 / k.lb * (I - qq) + f2 * sb * sb.transpose() + f1 * sbb;
  in_plane.topRightCorner<2, 2>() =
      w.fxy / (law.length_warp * law.length_weft) * pq + f2 * sa * sb.transpose() + f1 * sab;
  in_plane.bottomLeftCorner<2, 2>() = in_plane.topRightCorner<2, 2>().transpose();
  in_plane *= law.area;

  if (filter != Filter::none) {
    make_positive(oaa, oab, obb);
    make_positive(in_plane);
  }
  Eigen::Matrix<double, 3, 2> frame;
  frame << k.p, t2;
  const Matrix3d nn = t3 * t3.transpose();
  return {frame * in_plane.topLeftCorner<2, 2>() * frame.transpose() + oaa * nn,
          frame * in_plane.topRightCorner<2, 2>() * frame.transpose() + oab * nn,
          frame * in_plane.bottomRightCorner<2, 2>() * frame.transpose() + obb * nn};
}

}  // namespace heddle::macroscale
