#include "macroscale/tools.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

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
  if (x.z() <= centre_z) {
    const Vector3d from_bowl(x.x(), x.y(), x.z() - (ring.level - ring.bowl_depth + ring.opening_radius));
    if (ring.bowl_depth > 0.0 && from_bowl.z() < 0.0) {
      const Distance inside = round(from_bowl, ring.opening_radius, Vector3d::Zero());
      return {-inside.distance, -inside.normal, -inside.curvature};
    }
    return {ring.opening_radius - r, -outward, hoop(-1.0)};
  }
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

// How far a point lies outside the part of the sector's plan that is a fillet away from its edges: q = |p|
// with one component an edge, each growing along a level unit vector; exact where the edges meet square.
Distance evaluate(const SectorShape& sector, const Vector3d& x) {
  struct Edge {
    double outside;      ///< of the inner plan, not below 0 [m]
    Vector3d direction;  ///< in which it grows
  };
  const double f = sector.fillet, r = std::max(std::hypot(x.x(), x.y()), 1e-12);
  const Vector3d outward = r > 1e-12 ? Vector3d(x.x() / r, x.y() / r, 0.0) : Vector3d::UnitX();
  const Vector3d past_from(std::sin(sector.from), -std::cos(sector.from), 0.0),
      past_to(-std::sin(sector.to), std::cos(sector.to), 0.0);
  const bool half_turn = sector.to - sector.from > std::numbers::pi - 1e-9;  // both its edges are one line
  const std::array<Edge, 3> edges = {{{std::max(sector.opening_radius + f - r, 0.0), -outward},
                                      {std::max(past_from.dot(x) + f, 0.0), past_from},
                                      {half_turn ? 0.0 : std::max(past_to.dot(x) + f, 0.0), past_to}}};
  double squared = 0.0;
  for (const Edge& edge : edges) squared += edge.outside * edge.outside;
  const double below = sector.level - x.z();
  if (squared == 0.0) return flat(below, -Vector3d::UnitZ());
  const double height = below + f;  // from the centres of the roundings
  const double rise = std::max(height, 0.0);
  const double rho = std::max(std::sqrt(squared + rise * rise), 1e-12);
  Vector3d n = -rise / rho * Vector3d::UnitZ();
  Matrix3d curvature = Matrix3d::Zero();
  if (rise > 0.0) curvature += Vector3d::UnitZ() * Vector3d::UnitZ().transpose() / rho;
  for (const Edge& edge : edges) {
    if (edge.outside == 0.0) continue;
    n += edge.outside / rho * edge.direction;
    curvature += edge.direction * edge.direction.transpose() / rho;
  }
  curvature -= n * n.transpose() / rho;
  const Vector3d around(-outward.y(), outward.x(), 0.0);
  curvature -= edges[0].outside / (rho * r) * around * around.transpose();
  return {rho - f, n, curvature};
}

// Distance to the middle of the path, positive above it.
Distance from_middle(const CurvedPlateShape& plate, const Vector3d& at) {
  const Vector3d x = at - Vector3d(0.0, 0.0, plate.level);
  const double radius = plate.path.radius, angle = plate.path.angle;
  const double reach = radius * std::sin(angle), drop = radius * (1.0 - std::cos(angle));
  if (x.x() <= plate.start) return flat(x.z(), Vector3d::UnitZ());
  if (x.x() >= plate.start + 2.0 * reach) return flat(x.z() + 2.0 * drop, Vector3d::UnitZ());
  // The two arcs meet on the line through their centres.
  const Vector3d inflection(plate.start + reach, x.y(), -drop);
  const Vector3d along(std::cos(angle), 0.0, -std::sin(angle));
  if ((x - inflection).dot(along) <= 0.0)
    return round(x - Vector3d(plate.start, x.y(), -radius), radius, Vector3d::UnitY());
  Distance d =
      round(x - Vector3d(plate.start + 2.0 * reach, x.y(), radius - 2.0 * drop), radius, Vector3d::UnitY());
  return {-d.distance, -d.normal, -d.curvature};
}

Distance evaluate(const CurvedPlateShape& plate, const Vector3d& x) {
  const Distance d = from_middle(plate, x);
  if (plate.up) return {d.distance + 0.5 * plate.gap, d.normal, d.curvature};
  return {0.5 * plate.gap - d.distance, -d.normal, -d.curvature};
}

Distance evaluate(const BandShape& tool, const Vector3d& x) {
  return evaluate(*tool.band, Vector3d(x - tool.offset));
}

}  // namespace

std::string name_of(Role role) {
  return role == Role::punch ? "punch" : role == Role::die ? "die" : "binder";
}

bool has_unknown(const Tool& tool) {
  return tool.motion == Motion::loaded || tool.motion == Motion::sprung;
}

int unknowns_of(const Tool& tool) {
  return has_unknown(tool) ? (tool.tilt ? 3 : 1) : 0;
}

Vector3d place_on(const CurvedPlateShape& plate, double s) {
  const double level = plate.level;
  const double radius = plate.path.radius, angle = plate.path.angle, half = radius * angle;
  const double reach = radius * std::sin(angle), drop = radius * (1.0 - std::cos(angle));
  if (s <= 0.0) return {plate.start + s, 0.0, level};
  if (s <= half)
    return {plate.start + radius * std::sin(s / radius), 0.0, level + radius * (std::cos(s / radius) - 1.0)};
  if (s <= 2.0 * half) {
    const double left = angle - (s - half) / radius;
    return {plate.start + 2.0 * reach - radius * std::sin(left), 0.0,
            level - 2.0 * drop + radius * (1.0 - std::cos(left))};
  }
  return {plate.start + 2.0 * reach + s - 2.0 * half, 0.0, level - 2.0 * drop};
}

Distance distance(const Shape& shape, const Vector3d& x) {
  return std::visit([&](const auto& s) { return evaluate(s, x); }, shape);
}

Distance distance(const Tool& tool, const Vector3d& x) {
  if (!tool.turn) return distance(tool.shape, x);
  const auto& [rotation, pivot] = *tool.turn;
  const Distance d = distance(tool.shape, Vector3d(pivot + rotation.transpose() * (x - pivot)));
  return {d.distance, rotation * d.normal, rotation * d.curvature * rotation.transpose()};
}

}  // namespace heddle::macroscale
