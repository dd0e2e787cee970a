#pragma once

#include <array>

namespace heddle::macroscale {

/// Convex piece of the material inside a trimmed cell, in the cell's own coordinates: (0, 0) at its first
/// corner, (1, 0) at its second, (1, 1) at its third. Pieces of a sliver that was given to a neighbour lie
/// outside [0, 1].
struct CellPiece {
  int quad;
  std::array<std::array<double, 2>, 4> corners;  ///< counter-clockwise; two may coincide
};

}  // namespace heddle::macroscale
