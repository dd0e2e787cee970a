#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>

namespace heddle::macroscale {

/// Three nodes of a quad's corner: the corner itself and its neighbours along warp and weft.
struct Corner {
  int node;
  int along_warp;
  int along_weft;
  int sign;  ///< +1 where both neighbours lie forwards or both backwards: the sign of sin(gamma) in tow axes
};

/// Three neighbouring nodes on one tow line, middle one second.
struct TowTriple {
  int before, middle, after;
  double width;   ///< tributary width across the tow [m]
  int direction;  ///< 0 = along warp, 1 = along weft
};

/// Tow-aligned structured grid of one ply: nodes i along warp, j along weft, index = i * (nv + 1) + j.
/// Trusses (edges), shear corners and bending triples share the nodes, so stiff tows cannot lock against
/// shear.
struct Blank {
  int nu = 0, nv = 0;                      ///< cells along warp and weft
  std::array<double, 2> spacing{};         ///< [m]
  std::vector<Eigen::Vector3d> reference;  ///< node positions, flat, stress-free [m]
  std::vector<std::array<int, 4>> quads;   ///< (i,j) (i+1,j) (i+1,j+1) (i,j+1)
  std::vector<TowTriple> triples;
  std::vector<double> node_area;  ///< tributary area [m^2]

  int nodes() const { return static_cast<int>(reference.size()); }
  int node(int i, int j) const { return i * (nv + 1) + j; }
  double corner_area() const { return 0.25 * spacing[0] * spacing[1]; }
};

/// The four corners of a quad.
std::array<Corner, 4> corners_of(const std::array<int, 4>& quad);

/// Blank of a given size centred at the origin, warp turned by `orientation` against x.
/// @param spacing  upper bound of the node spacing: ceil(size / spacing) cells each way
Blank make_blank(std::array<double, 2> size, double spacing, double orientation = 0.0, double z = 0.0);

}  // namespace heddle::macroscale
