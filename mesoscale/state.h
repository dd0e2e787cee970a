#pragma once

#include "core/problem.h"
#include "mesoscale/cell.h"

namespace heddle::mesoscale {

/// The fabric in the state that the specification asks for.
/// @throws InputError      if weave.pattern is no weave
/// @throws NumericalError  if no compaction carries the pressure (check finds it before)
FabricGeometry fabric_geometry(const CellSpec& spec);

/// Thickness of the as-woven fabric between flat plates at a pressure, H - 2 d(P): what the compaction table
/// of the fabric says, drained [m].
/// @throws NumericalError  if fibres cannot carry it
double thickness_under(const CellSpec& spec, double pressure);

/// What a sheet is made of, as shares of its volume. One balance for all states: glass and resin come from
/// the tows' densities and lengths alone, voids are what the thickness leaves. Adds up to 1.
struct SheetShares {
  double glass = 0.0, resin = 0.0, voids = 0.0;
  double tows = 0.0;  ///< the sections, with all that is in them; no part of the sum
};
SheetShares sheet_shares(const FabricGeometry& fabric);

/// Problems of the compacted state of a sound weave: keys of the block `cell`.
Problems check_state(const CellSpec& spec);

}  // namespace heddle::mesoscale
