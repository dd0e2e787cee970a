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

/// Of a blank that is whole, itself.
WholeBlank whole_of(const BlankState& piece);

}  // namespace heddle::macroscale
