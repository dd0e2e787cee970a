#pragma once

#include <filesystem>
#include <vector>

#include "mesoscale/solid/solid_cell.h"
#include "pipeline/config_reader.h"
#include "pipeline/config_schema.h"

namespace heddle::pipeline {

/// Keys of the solid part's stiffness: `solid.*` of a weave, `cell.voxels`, `cell.boundary` and `cell.phases`
/// of a voxel file.
std::vector<Key> solid_keys();
std::vector<Key> voxel_keys();

mesoscale::solid::SolidSpec solid_of(const Settings& settings);
mesoscale::solid::VoxelFileSpec voxels_of(const Settings& settings, const std::filesystem::path& folder);

}  // namespace heddle::pipeline
