#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>

#include "macroscale/cell_piece.h"
#include "macroscale/outline.h"
#include "macroscale/symmetry.h"

namespace heddle::macroscale {

/// Place (or movement) of node i in a vector of three unknowns a node.
inline Eigen::Vector3d node_of(const Eigen::VectorXd& x, int i) {
  return x.segment<3>(3 * i);
}

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

/// Two neighbouring nodes on a tow line that crosses a plane of symmetry at the first. The third node of
/// their triple is the mirror image of the second, so its second difference is twice what lies between them
/// in the plane.
struct MirroredTriple {
  int middle, beside;
  double width;   ///< tributary width across the tow, on this side of the plane [m]
  int direction;  ///< 0 = along warp, 1 = along weft
  int axis;       ///< across the plane: 0 = x, 1 = y
};

/// Two neighbouring nodes on one tow line.
struct TowSegment {
  int from, to;
  int direction;  ///< 0 = along warp, 1 = along weft
};

/// A material point as a mean of the corners of one quad.
struct MaterialPoint {
  int quad;
  std::array<double, 4> weight;  ///< of the quad's corners, sum 1; some < 0 just outside the quad
};

/// A point of the outer edge of the blank.
struct EdgePoint {
  MaterialPoint point;
  Eigen::Vector2d reference;  ///< [m]
  Eigen::Vector2d inward;     ///< unit normal of the edge, into the blank
};

/// Tow-aligned structured grid of one ply, trimmed to an outline: lines i across the warp, j across the weft
/// direction. Nodes and quads have the numbers they have in the blank.
struct Ply {
  int nu = 0, nv = 0;                    ///< cells of the grid along warp and weft, before trimming
  std::array<double, 2> spacing{};       ///< [m]
  std::array<double, 2> warp{1.0, 0.0};  ///< direction of the warp in the x-y plane, unit
  std::array<double, 2> centre{};        ///< of the grid, along warp and weft [m]
  std::vector<EdgePoint> edge;           ///< along the outer edge, about a spacing apart, corners left out
  Outline outline;                       ///< flat, in x and y
  std::vector<int> node_at;              ///< node of (i, j) at i * (nv + 1) + j, or -1
  std::vector<int> quad_at;              ///< quad of cell (i, j) at i * nv + j, or -1
  int first_node = 0, end_node = 0;      ///< its nodes are [first_node, end_node)
  int first_quad = 0, end_quad = 0;

  /// Node of grid lines i, j; -1 where trimming left none.
  int node(int i, int j) const { return node_at[i * (nv + 1) + j]; }
  /// Quad between lines i, i + 1 and j, j + 1; -1 outside the grid and where trimming left none.
  int quad(int i, int j) const { return i < 0 || j < 0 || i >= nu || j >= nv ? -1 : quad_at[i * nv + j]; }
  double corner_area() const { return 0.25 * spacing[0] * spacing[1]; }  ///< of a whole cell [m^2]
  /// A point of the flat blank in its cell, or in the nearest one left [m].
  MaterialPoint locate(const Eigen::Vector2d& reference) const;
};

/// One ply, or several on one another: `Ply` is the lowest, `above` are the others, bottom first. The lists
/// of nodes and elements hold all plies, one after the other, so whatever sums over elements need not know of
/// plies. Every energy of a cell carries its area share, the part of the cell inside the outline. Trusses
/// (edges), shear corners and bending triples share the nodes, so stiff tows cannot lock against shear.
struct Blank : Ply {
  std::vector<Eigen::Vector3d> reference;  ///< node positions, flat, stress-free [m]
  std::vector<std::array<int, 2>> grid;    ///< (i, j) of each node in its ply, ascending
  std::vector<std::array<int, 4>> quads;   ///< (i,j) (i+1,j) (i+1,j+1) (i,j+1)
  std::vector<double> share;               ///< per quad: its material area over the cell's; 1 = whole
  std::vector<TowSegment> segments;
  std::vector<TowTriple> triples;
  std::vector<MirroredTriple> mirrored;  ///< at planes of symmetry
  std::vector<double> node_area;         ///< tributary area [m^2]
  std::vector<CellPiece> pieces;         ///< of all quads that the outline cuts, by quad
  std::vector<Ply> above;
  Symmetry symmetry = Symmetry::none;  ///< which piece of the outline it is

  int nodes() const { return static_cast<int>(reference.size()); }
  int plies() const { return 1 + static_cast<int>(above.size()); }
  const Ply& ply(int k) const { return k == 0 ? *this : above[static_cast<std::size_t>(k) - 1]; }
  int ply_of_node(int node) const {
    int k = 0;
    while (node >= ply(k).end_node) ++k;
    return k;
  }
  int ply_of_quad(int quad) const {
    int k = 0;
    while (quad >= ply(k).end_quad) ++k;
    return k;
  }
};

/// Whether a node lies on the plane of symmetry across an axis (0 = x, 1 = y); exact.
inline bool on_plane(const Blank& blank, int node, std::size_t axis) {
  return mirrored_across(blank.symmetry, axis) &&
         blank.reference[node][static_cast<Eigen::Index>(axis)] == 0.0;
}

/// Cells with a smaller share are dropped and their area given to the neighbour that holds most: their outer
/// nodes would hang on next to nothing.
inline constexpr double smallest_share = 0.02;

/// The four corners of a quad.
std::array<Corner, 4> corners_of(const std::array<int, 4>& quad);

/// Blank of any outline with its warp at `orientation` to x. The grid covers the outline's box along the tows
/// and shares its centre. Areas sum to the outline's up to rounding.
/// @param spacing  upper bound of the node spacing: ceil(extent / spacing) cells along each tow direction
/// @param symmetry  of a symmetric outline with tows along x and y: the piece that is kept. Its grid is that
/// of
///                  the whole, with an even number of cells across each plane
Blank make_blank(const Outline& outline, double spacing, double orientation, double z = 0.0,
                 Symmetry symmetry = Symmetry::none);

/// Rectangle of a given size along warp and weft, centred at the origin and turned as a whole: no cell is
/// cut.
Blank make_blank(std::array<double, 2> size, double spacing, double orientation = 0.0, double z = 0.0);

/// The same blank, outline and tows, turned about the punch's axis by an angle [rad]; 0 changes no bit.
Blank turned(Blank blank, double angle);

/// Plies on one another as one blank, bottom first. @param plies  at least one, each of one ply
Blank stacked(std::vector<Blank> plies);

}  // namespace heddle::macroscale
