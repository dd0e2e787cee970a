#pragma once

#include "mesoscale/cell_spec.h"
#include "mesoscale/compaction.h"
#include "mesoscale/state.h"

namespace heddle::mesoscale {

/// Friction over the direction of sliding from the film that the geometry of the cell carries (film.h):
///
///     mu = mean (1 + K_c cos 2 theta + K_s sin 2 theta)
///
/// theta against the warp. Of a balanced plain weave sheared by gamma it is K = D (sin gamma, cos gamma),
/// largest or least along the long diagonal of the trellis: nothing without shear, the same on both faces,
/// and mirrored with the fabric. D is the second harmonic of mu from the directions along, across and halfway
/// between the diagonals, over their mean. Other weaves have none of these symmetries.
/// @throws NumericalError  where a film is not found (names angle, pressure and direction)
DragDirection drag_direction(const FabricGeometry& fabric, const CompactionLaw& law, const ResinSpec& resin,
                             const FilmDirectionSpec& spec);

}  // namespace heddle::mesoscale
