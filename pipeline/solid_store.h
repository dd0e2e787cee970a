#pragma once

#include <string>

#include "core/hdf5_file.h"
#include "mesoscale/solid/solid_cell.h"

namespace heddle::pipeline {

/// Result of the stage `solid` as a sealed HDF5 file, for the cache. Every number comes back bit for bit.
std::string bytes_of(const mesoscale::solid::SolidResult& result, const std::string& key);
/// @throws Hdf5Error  if something is missing
mesoscale::solid::SolidResult read_solid_result(const Hdf5Reader& file);

}  // namespace heddle::pipeline
