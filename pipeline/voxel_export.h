#pragma once

#include <string>

#include "mesoscale/solid/sampler.h"

namespace heddle::pipeline {

/// A woven cell's voxels as an HDF5 file that says how its axes lie, so that no reader has to guess (read the
/// wrong way round a weave has wrong moduli):
///     /label           whole numbers, shape as /axes; 0 = no tow at the voxel's middle, then warps, then
///     wefts /tow_fraction    of the voxel's volume [-], same shape /tow_direction   unit vector of the tow
///     that fills more, same shape and 3; 0 where there is none /axes            "z y x": of the shape,
///     slowest first /order           "x-fastest", as the configuration calls it (cell.voxels.order) /count
///     /origin_m /spacing_m    along x (warp), y (weft), z (up), whatever the order
/// Equal cells give equal bytes.
/// @throws OutputError  as check_voxels
std::string voxels_hdf5(const mesoscale::solid::CellVoxels& voxels);

/// @throws OutputError  if there are not as many labels, shares or directions as voxels
void check_voxels(const mesoscale::solid::CellVoxels& voxels);

}  // namespace heddle::pipeline
