#pragma once

#include <cstddef>

namespace heddle::macroscale {

/// Which piece of a part that is its own mirror image is computed: all of it, what lies at x >= 0 (half_x) or
/// at y >= 0 (half_y), or where both hold (quarter). Nodes on a plane of symmetry stay in it. Forces,
/// energies, heat, frames and fields that a run gives are those of the whole part; node counts are the
/// piece's.
enum class Symmetry { none, half_x, half_y, quarter };

/// Whether the plane across an axis, x = 0 (axis 0) or y = 0 (axis 1), is one of symmetry.
constexpr bool mirrored_across(Symmetry symmetry, std::size_t axis) {
  return symmetry == Symmetry::quarter || symmetry == (axis == 0 ? Symmetry::half_x : Symmetry::half_y);
}

/// Pieces that make the whole part.
constexpr int images(Symmetry symmetry) {
  return (mirrored_across(symmetry, 0) ? 2 : 1) * (mirrored_across(symmetry, 1) ? 2 : 1);
}

}  // namespace heddle::macroscale
