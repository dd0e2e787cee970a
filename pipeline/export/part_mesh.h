#pragma once

#include <array>
#include <vector>

#include "macroscale/stamping.h"

namespace heddle::pipeline {

/// An element of the part's middle surface, counter-clockwise about warp x weft.
struct PartFace {
  int quad = 0;  ///< of the blank that it lies in
  std::array<int, 4> corners{};
  int count = 4;           ///< of corners: 4, or 3 with the last twice
  double flat_area = 0.0;  ///< of its material before forming [m^2]
};

/// The formed blank as a conforming mesh of quads and triangles. Cells that no outline cuts, and that nothing
/// touches in the middle of a side, stay quads. The pieces of the others end anywhere on a side, so they and
/// their neighbours are cut into triangles through every corner that lies on their sides.
struct PartMesh {
  std::vector<std::array<double, 3>> position;  ///< [m]
  std::vector<PartFace> faces;
  double flat_area = 0.0;   ///< of all faces [m^2]
  double blank_area = 0.0;  ///< of the blank they stand for [m^2]; corners nearer than a thirtieth of a cell
                            ///< are made one, so that a trimmed edge is off by a little
};

/// @param blank  of one ply
/// @throws std::invalid_argument  if it has several
PartMesh part_mesh(const macroscale::BlankState& blank);

/// Sides that belong to one face alone, as {node, node}.
std::vector<std::array<int, 2>> free_sides(const PartMesh& mesh);

}  // namespace heddle::pipeline
