#pragma once

#include "mesoscale/cell.h"
#include "mesoscale/compaction.h"
#include "mesoscale/fabric_properties.h"
#include "mesoscale/nesting.h"
#include "mesoscale/state.h"

namespace heddle::mesoscale {

/// Two equal plies pressed onto each other, upper face of the lower against lower face of the upper. Where
/// the tows that face each other overlap, both give way until they carry the same stress (PairSqueeze):
///
///     P(g) = (1/A) int sigma(H - g - D_lower - D_upper) dA,   g = distance of the middles, H = thickness of
///     a ply
///
/// and no less than an even layer of the ply's glass carries at that thickness: whatever the columns of a
/// stack hold, the mean of a convex law is no less than the law at the mean. D is the depth of each face
/// below its crowns. Crown on crown this is the flat plate, each face by half; shifted, crowns sink beside
/// crowns, so that the plies come to rest nearer and begin softer.

/// One ply shifted against the other. Rest: where the first tows touch (closest_approach).
PlyFacing facing_of_shift(const FabricGeometry& fabric, const CompactionLaw& law, const PlyShift& shift);

/// Mean over all shifts (a lattice of them over the repeat), at one distance of the middles: what plies have
/// whose tows lie anyhow against each other. Heights of the two faces are then independent, so turned plies
/// take it as well. Rest: crown on crown.
PlyFacing facing_of_all_shifts(const FabricGeometry& fabric, const CompactionLaw& law);

}  // namespace heddle::mesoscale
