#pragma once

#include <vector>

#include "macroscale/stamping.h"

namespace heddle::macroscale {

/// A blank of which a piece was computed, with the mirror images of that piece, in the order in which a blank
/// computed whole has its nodes and cells.
struct WholeBlank {
  BlankState state;
  std::vector<int> node;  ///< of the piece, behind each node
};

/// @param warp_along_x  whether the warp runs along x; else along y
WholeBlank whole_of(const BlankState& piece, Symmetry symmetry, bool warp_along_x);
WholeBlank whole_of(const BlankState& piece, const BlankSpec& blank);

}  // namespace heddle::macroscale
