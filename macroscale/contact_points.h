#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>

#include "macroscale/blank.h"
#include "macroscale/stamping.h"

namespace heddle::macroscale {

/// A point of the blank that may touch a tool and rub on it: a node with its tributary area, or one of the 2
/// x 2 Gauss points of a cell. It follows its nodes by bilinear weights.
struct ContactPoint {
  std::array<int, 4> node{};       ///< the first `nodes` count
  std::array<double, 4> weight{};  ///< of those, sum 1
  int nodes = 1;                   ///< 1 or 4
  double area = 0.0;               ///< of the flat blank [m^2]
};

/// How many there are: as many as nodes, or four a cell.
int contact_count(const Blank& blank, ContactSites sites);

/// All of them. Node i is point i; the points of quad q are 4 q to 4 q + 3, each nearest to the corner of
/// that number, with a quarter of the cell's material.
std::vector<ContactPoint> contact_points(const Blank& blank, ContactSites sites);

/// A nodal field (three numbers a node: positions, velocities) at a contact point.
inline Eigen::Vector3d at_point(const ContactPoint& point, const Eigen::VectorXd& field) {
  if (point.nodes == 1) return field.segment<3>(3 * point.node[0]);
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t a = 0; a < 4; ++a) sum += point.weight[a] * field.segment<3>(3 * point.node[a]);
  return sum;
}

/// Trellis angle at each contact point, signed in tow axes [rad]: at nodes the mean of the corners that meet
/// there, in a cell interpolated between its corners.
std::vector<double> contact_shear_angle(const Blank& blank, ContactSites sites,
                                        const std::vector<double>& corner_angle);

/// How the tows run at a contact point of a blank at x, along warp and weft [m].
struct TowDirections {
  Eigen::Vector3d warp, weft;
};
TowDirections tow_directions(const Blank& blank, ContactSites sites, const Eigen::VectorXd& x, int point);

}  // namespace heddle::macroscale
