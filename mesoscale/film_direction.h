#pragma once

#include <vector>

#include "mesoscale/cell_spec.h"
#include "mesoscale/compaction.h"
#include "mesoscale/state.h"

namespace heddle::mesoscale {

/// Friction over the direction of sliding from the film that the geometry of the cell carries (film.h):
///
///     mu = mean (1 + K_c cos 2 theta + K_s sin 2 theta)
///
/// theta against the warp, from the directions 0, 45, 90 and 135 deg. Of a balanced plain weave sheared by
/// gamma it is K = D (sin gamma, cos gamma): largest along the long diagonal of the trellis, and nothing
/// without shear; then along and across that diagonal are enough.
/// @param balanced  warp and weft are alike and cross at every turn
/// @throws NumericalError  where a film is not found (names angle, pressure and direction)
DragDirection drag_direction(const FabricGeometry& fabric, const CompactionLaw& law, const ResinSpec& resin,
                             const FilmDirectionSpec& spec, bool balanced);
/// Of a specification: plain, and no number of one direction alone.
bool is_balanced(const WeaveSpec& weave);

/// Where the table is taken: nominal pressures [Pa] and trellis angles [rad].
const std::vector<double>& film_pressures();
const std::vector<double>& film_angles();

}  // namespace heddle::mesoscale
