#include "macroscale/tool_pose.h"

#include <Eigen/Geometry>

namespace heddle::macroscale {

namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

Vector3d turn_of(const Tilt& tilt, const Pose& pose) {
  return {pose.lift[0] / tilt.arm, pose.lift[1] / tilt.arm, 0.0};
}

// A = 1 - [theta]x takes differences of points to the tool as drawn. Its inverse and its transpose's follow
// from (1 + [t]x) (v - t x v + t (t v)) = (1 + t^2) v.
Vector3d inverse_transposed(const Vector3d& turn, const Vector3d& v) {
  return (v - turn.cross(v) + turn * turn.dot(v)) / (1.0 + turn.squaredNorm());
}

Vector3d inverse(const Vector3d& turn, const Vector3d& v) {
  return inverse_transposed(-turn, v);
}

}  // namespace

Distance distance(const Tool& tool, const Pose& pose, const Vector3d& x) {
  const Vector3d raised = x - Vector3d(0, 0, pose.z);
  if (!tool.tilt) return distance(tool, raised);
  const Vector3d turn = turn_of(*tool.tilt, pose);
  const Distance d = distance(tool, Vector3d(raised - turn.cross(x - tool.tilt->pivot)));
  Matrix3d to_drawn = Matrix3d::Identity();
  for (int c = 0; c < 3; ++c) to_drawn.col(c) -= turn.cross(Vector3d::Unit(c));
  return {d.distance, to_drawn.transpose() * d.normal, to_drawn.transpose() * d.curvature * to_drawn};
}

Vector3d carried(const Tool& tool, const Pose& from, const Pose& to, const Vector3d& x) {
  const Vector3d lifted(0, 0, to.z - from.z);
  if (!tool.tilt) return lifted;
  return lifted + (turn_of(*tool.tilt, to) - turn_of(*tool.tilt, from)).cross(x - tool.tilt->pivot);
}

double angle_of(const Tool& tool, const Pose& pose) {
  return tool.tilt ? turn_of(*tool.tilt, pose).norm() : 0.0;
}

std::array<Vector3d, 3> ways_at(const Tilt& tilt, const Vector3d& x) {
  const Vector3d r = (x - tilt.pivot) / tilt.arm;
  return {Vector3d::UnitZ(), Vector3d::UnitX().cross(r), Vector3d::UnitY().cross(r)};
}

Vector3d slopes_at(const Tilt& tilt, const Pose& pose, const Vector3d& x, const Vector3d& normal) {
  const Vector3d drawn = inverse_transposed(turn_of(tilt, pose), normal);
  const std::array<Vector3d, 3> way = ways_at(tilt, x);
  return {-drawn.dot(way[0]), -drawn.dot(way[1]), -drawn.dot(way[2])};
}

TiltCurvature curvature_at(const Tilt& tilt, const Pose& pose, const Vector3d& x, const Distance& surface) {
  const Vector3d turn = turn_of(tilt, pose);
  const Vector3d drawn = inverse_transposed(turn, surface.normal);
  const std::array<Vector3d, 3> way = ways_at(tilt, x);
  Matrix3d moved;  // what each way is to the surface where it stands
  for (int j = 0; j < 3; ++j) moved.col(j) = inverse(turn, way[j]);
  TiltCurvature result;
  result.with_point = -surface.curvature * moved;
  result.with_point.col(1) += Vector3d::UnitX().cross(drawn) / tilt.arm;
  result.with_point.col(2) += Vector3d::UnitY().cross(drawn) / tilt.arm;
  result.own = moved.transpose() * surface.curvature * moved;
  return result;
}

}  // namespace heddle::macroscale
