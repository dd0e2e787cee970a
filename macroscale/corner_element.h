#pragma once

#include <array>

#include <Eigen/Core>

#include "macroscale/fabric_effects.h"
#include "macroscale/shear_friction.h"
#include "mesoscale/fabric_properties.h"

namespace heddle::macroscale {

/// What one corner of a quad adds to the energy: tension along both tows and shear between them.
///
///     W = A/4 [ w(e1, e2) + Psi(s) + dt R(gdot) ],   e1 = |a|/|a0| - 1,  e2 = |b|/|b0| - 1,  s = p.q
///
/// a, b are the edge vectors from the corner node along warp and weft, p, q their directions, gamma = asin(s)
/// the trellis shear angle, R = m_s/(n+1) |gdot|^(n+1) the rate term with gdot = (gamma - gamma_n)/dt.
/// Evaluating at the corners (not at the centre) leaves no hourglass mode. See docs/theory/macroscale.md.
/// Where a share f of the shear resistance is friction between the tows, Psi is (1 - f) Psi and the work done
/// against that friction since the last step (macroscale/shear_friction.h). Three effects may add to it:
/// locking to Psi, tension that stiffens Psi, and tows that resist the rate of their stretch
/// (macroscale/fabric_effects.h).
struct CornerLaw {
  const mesoscale::FabricProperties* fabric = nullptr;
  double area = 0.0;              ///< A/4 [m^2]
  double length_warp = 0.0;       ///< |a0| [m]
  double length_weft = 0.0;       ///< |b0| [m]
  double rate_consistency = 0.0;  ///< m_s at the blank's temperature [N s^n/m]; 0 = rate-free
  double rate_index = 1.0;        ///< n [-]
  double time_step = 0.0;         ///< dt [s]; 0 = no rate term
  ShearFriction friction;
  const ShearMemory* memory = nullptr;  ///< of this corner; null = no friction between tows
  double shear_factor = 1.0;            ///< on the rate-free resistance of the table: its softening [-]
  ShearLocking locking;
  const Surface* coupling = nullptr;      ///< c g(e1, e2) [-]; null = tension does not stiffen shear
  double tow_viscosity = 0.0;             ///< [N s/m]; 0 = none
  std::array<double, 2> strain_before{};  ///< of warp and weft at the start; read where tow_viscosity > 0 [-]
};

/// The law of a trimmed cell: its area counts by the share inside the outline.
inline CornerLaw trimmed(CornerLaw law, double share) {
  law.area *= share;
  return law;
}

/// All that energy, forces and stiffness of a corner share: its kinematics, each law looked up once.
struct CornerPoint {
  double la = 1.0, lb = 1.0;                 ///< |a|, |b| [m]
  double s = 0.0, c = 1.0;                   ///< sin and cos of gamma
  Eigen::Vector3d p{1, 0, 0}, q{0, 1, 0};    ///< directions of a and b
  Surface::Value tension{0, 0, 0, 0, 0, 0};  ///< w(e1, e2) with its slopes [N/m]
  CornerScalar shear, rate;
};

CornerPoint corner_point(const CornerLaw& law, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                         double angle_before);

/// Energies of one corner [J].
struct CornerEnergy {
  double tension = 0.0, shear = 0.0, rate = 0.0, tow_rate = 0.0;
  double total() const { return tension + shear + rate + tow_rate; }
};

CornerEnergy corner_energy(const CornerLaw& law, const CornerPoint& point);
CornerEnergy corner_energy(const CornerLaw& law, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                           double angle_before);

/// Forces of one corner as dW/da, dW/db [N], by part (the ledger needs them apart).
struct CornerGradient {
  Eigen::Vector3d tension_a, tension_b, shear_a, shear_b, rate_a, rate_b;
  Eigen::Vector3d tow_rate_a{0, 0, 0}, tow_rate_b{0, 0, 0};
  Eigen::Vector3d a() const { return tension_a + shear_a + rate_a + tow_rate_a; }
  Eigen::Vector3d b() const { return tension_b + shear_b + rate_b + tow_rate_b; }
};

CornerGradient corner_gradient(const CornerLaw& law, const CornerPoint& point);
CornerGradient corner_gradient(const CornerLaw& law, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                               double angle_before);

/// d2W/da2, d2W/dadb (rows a, columns b), d2W/db2 [N/m].
struct CornerHessian {
  Eigen::Matrix3d aa, ab, bb;
};

/// How second derivatives are taken. `positive`: negative eigenvalues set to zero (projected Newton);
/// `bounding`: the same, and friction by its secant, a quadratic that lies above its potential.
enum class Filter { none, positive, bounding };

CornerHessian corner_hessian(const CornerLaw& law, const CornerPoint& point, Filter filter);
CornerHessian corner_hessian(const CornerLaw& law, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                             double angle_before, Filter filter);

/// gamma = asin(p.q) [rad], in (-pi/2, pi/2).
double corner_angle(const Eigen::Vector3d& a, const Eigen::Vector3d& b);

}  // namespace heddle::macroscale
