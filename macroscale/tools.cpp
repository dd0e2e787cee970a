#include "macroscale/tools.h"

#include <algorithm>
#include <cmath>

#include "macroscale/tool_band.h"

namespace heddle::macroscale {

namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

Distance flat(double distance, const Vector3d& normal) {
  return {distance, normal, Matrix3d::Zero()};
}

// Distance to a sphere or, with the axis taken out, to a cylinder: curvature (I - n n^T - axis axis^T) / r.
Distance round(const Vector3d& from_centre, double radius, const Vector3d& axis) {
  // The centre itself has no normal; 1e-12 m keeps the quotient finite there.
  const double r = std::max(from_centre.norm(), 1e-12);
  const Vector3d n = from_centre / r;
  return {r - radius, n, (Matrix3d::Identity() - n * n.transpose() - axis * axis.transpose()) / r};
}

Distance evaluate(const PlaneShape& plane, const Vector3d& x) {
  return flat(plane.normal.dot(x - plane.point), plane.normal);
}

Distance evaluate(const CylinderShape& cylinder, const Vector3d& x) {
  Vector3d from_axis = x - cylinder.centre;
  from_axis.y() = 0.0;
  return round(from_axis, cylinder.radius, Vector3d::UnitY());
}

Distance evaluate(const HemisphereShape& punch, const Vector3d& x) {
  Vector3d from_centre = x - punch.apex - Vector3d(0, 0, punch.radius);
  if (from_centre.z() <= 0.0) return round(from_centre, punch.radius, Vector3d::Zero());
  from_centre.z() = 0.0;
  return round(from_centre, punch.radius, Vector3d::UnitZ());
}

// The ring as a die (solid below). Meridian in (r, z): flat, quarter circle, vertical wall.
Distance evaluate_up(const RingShape& ring, const Vector3d& x) {
  const double centre_r = ring.opening_radius + ring.fillet;
  const double centre_z = ring.level - ring.fillet;
  const double r = std::hypot(x.x(), x.y());
  if (r >= centre_r) return flat(x.z() - ring.level, Vector3d::UnitZ());
  // On the axis every direction points to the wall; take x.
  const Vector3d outward = r > 1e-12 ? Vector3d(x.x() / r, x.y() / r, 0.0) : Vector3d::UnitX();
  const Vector3d around(-outward.y(), outward.x(), 0.0);
  const auto hoop = [&](double normal_r) -> Matrix3d {
    return (normal_r / std::max(r, 1e-12)) * around * around.transpose();
  };
  if (x.z() <= centre_z) return {ring.opening_radius - r, -outward, hoop(-1.0)};
  const double dr = r - centre_r, dz = x.z() - centre_z;
  const double rho = std::max(std::hypot(dr, dz), 1e-12);
  const Vector3d n = (dr / rho) * outward + Vector3d(0, 0, dz / rho);
  const Vector3d t = (-dz / rho) * outward + Vector3d(0, 0, dr / rho);
  return {rho - ring.fillet, n, t * t.transpose() / rho + hoop(dr / rho)};
}

Distance evaluate(const RingShape& ring, const Vector3d& x) {
  if (ring.up) return evaluate_up(ring, x);
  RingShape mirrored = ring;
  mirrored.up = true;
  mirrored.level = -ring.level;
  Distance d = evaluate_up(mirrored, Vector3d(x.x(), x.y(), -x.z()));
  d.normal.z() = -d.normal.z();
  const Vector3d flip(1.0, 1.0, -1.0);
  d.curvature = flip.asDiagonal() * d.curvature * flip.asDiagonal();
  return d;
}

Distance evaluate(const BandShape& tool, const Vector3d& x) {
  return evaluate(*tool.band, Vector3d(x - tool.offset));
}

}  // namespace

std::string name_of(Role role) {
  return role == Role::punch ? "punch" : role == Role::die ? "die" : "binder";
}

Distance distance(const Shape& shape, const Vector3d& x) {
  return std::visit([&](const auto& s) { return evaluate(s, x); }, shape);
}

}  // namespace heddle::macroscale
