#pragma once

#include <array>
#include <limits>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "core/curve.h"
#include "macroscale/blank.h"
#include "macroscale/contact.h"
#include "macroscale/contact_points.h"

namespace heddle::macroscale {

/// The middle of a cell that may touch the next ply on one side of its own, or its own ply where that folds.
/// Both sides of an interface look at each other, each with half of its material, so that neither is master.
/// In the middle of a cell its slopes are good to second order: asked for anywhere else, plies that stick
/// could not bend (docs/theory/plies.md).
struct PlyPoint {
  int quad = 0;
  int against = 0;  ///< ply whose surface it may touch: the next above or below, or its own
  int side = 1;     ///< +1: it lies above that ply; of its own ply: it touches with its own upper face
};

/// All between plies: interface by interface from the bottom, cells of the lower ply first. None in a single
/// ply.
std::vector<PlyPoint> ply_points(const Blank& blank);
/// Number of its lower ply from the bottom.
inline int interface_of(const PlyPoint& point) {
  return point.side > 0 ? point.against : point.against - 1;
}

/// Where a ply point meets the other ply, found once a step and held over it: the material point of the other
/// surface, its normal, and how far both smooth surfaces stand off their flat patches there. Gap and slip are
/// linear in the positions, so contact is a convex potential with its exact slopes.
struct PlyPair {
  int quad = -1;              ///< of the other ply; -1: it meets none
  std::array<int, 8> node{};  ///< corners of its own cell, then of the other quad
  std::array<double, 8>
      weight{};  ///< in what stands between the surfaces: a quarter each, then below 0; sum 0
  Eigen::Vector3d normal{0, 0, 1};  ///< unit, from the other ply towards the point
  double offset = 0.0;              ///< of the smooth surfaces from the patches, along the normal [m]
  std::array<Eigen::Vector3d, 4>
      turn{};                     ///< of its own corners: distance times the gradient of the weight [-]
  double area = 0.0;              ///< half of its cell's material [m^2]
  double rest = 0.0;              ///< distance of the middle surfaces that do not press each other [m]
  std::array<double, 2> local{};  ///< place in the other quad, 0..1
  bool own = false;               ///< of the sheet with another part of itself
};

/// Where a point meets a surface, by whatever was looked for.
struct PlyPlace {
  int quad = -1;            ///< of the surface
  double u = 0.5, v = 0.5;  ///< in it, 0..1
  int side = 1;             ///< +1: the point lies on the side of the surface's normal
  double rest = 0.0;        ///< [m]
  /// Largest height of the smooth surface over its patch that is believed [m]: across a crease the patch says
  /// nothing of it.
  double most_rise = std::numeric_limits<double>::infinity();
};
/// The pair of a point and that place. @param normals  at the nodes at x
PlyPair pair_at(const Blank& blank, const PlyPoint& point, const PlyPlace& place, const Eigen::VectorXd& x,
                const std::vector<Eigen::Vector3d>& normals);

/// Pairs of points between plies of a blank at x. A point further than half a cell off the other ply's edge
/// meets none, nor does one further than `reach` from it [m].
std::vector<PlyPair> pair_plies(const Blank& blank, std::span<const PlyPoint> points,
                                const Eigen::VectorXd& x, double reach, double rest);

/// Distance of the two middle surfaces at a pair, along its normal [m]: linear in x.
double gap(const PlyPair& pair, const Eigen::VectorXd& x);

/// How the faces of the two plies move against each other in the tangent plane when the nodes move by
/// `field` (positions: displacement [m], velocities: slip velocity [m/s]). Middle surfaces lie a thickness
/// apart; the part of their relative motion that is a rotation of both is taken out.
Eigen::Vector3d slip(const PlyPair& pair, const Eigen::VectorXd& field);
/// Factors of the nodes in it: slip = sum B_j v_j.
std::array<Eigen::Matrix3d, 8> slip_factors(const PlyPair& pair);

/// How the tows run at a point, along warp and weft [m].
TowDirections tow_directions(const Blank& blank, const PlyPoint& point, const Eigen::VectorXd& x);

/// Two plies of a rest distance pressed to a gap. Each of the two faces takes half of the closing by the
/// fabric's own compaction curve: energy 2 W((rest - gap) / 2) per area, so the pressure is p of that
/// approach. `approach` is that of one face, `stiffness` is against the gap.
NormalContact ply_contact(const Curve& compaction, double gap, double rest);

/// Which blocks of the matrix pairs may fill: for each ply point the quad and the place in it where it stood
/// when the pattern was made. A pair may move within a margin of half a cell before a new pattern is due.
struct PlyCoupling {
  std::vector<int> quad;
  std::vector<std::array<double, 2>> local;

  bool empty() const { return quad.empty(); }
  bool operator==(const PlyCoupling&) const = default;
};
PlyCoupling coupling_of(const std::vector<PlyPair>& pairs);
/// Nodes of the other ply that a point may couple with.
std::vector<int> coupled_nodes(const Blank& blank, const PlyCoupling& coupling, std::size_t point);
/// Whether all pairs stay within it.
bool covers(const Blank& blank, const PlyCoupling& coupling, const std::vector<PlyPair>& pairs);

}  // namespace heddle::macroscale
