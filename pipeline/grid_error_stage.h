#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "core/hdf5_file.h"
#include "macroscale/grid_error.h"
#include "pipeline/cache.h"
#include "pipeline/run_folder.h"

namespace heddle::pipeline {

/// A sealed HDF5 file for the cache; every number comes back bit for bit.
std::string bytes_of(const macroscale::GridError& error, const std::string& key);
/// @throws Hdf5Error  if something is missing
macroscale::GridError read_grid_error(const Hdf5Reader& file);

/// Name of the file below the folder of a run: the comparison outlives the run without a cache.
inline constexpr const char* grid_error_name = "macroscale/grid_error.h5";

/// The comparison that stands under this key in a folder or in the cache, or nothing.
std::optional<macroscale::GridError> known_grid_error(const std::filesystem::path& folder, const Cache& cache,
                                                      const std::string& key);

/// Runs the companion of a stamping that came to its end, or takes the comparison from folder or cache.
/// @param key   of the stage's inputs
/// @param stop  asked between Newton iterations; what was stopped is not kept
macroscale::GridError run_grid_error_stage(const macroscale::StampingSpec& spec,
                                           const mesoscale::FabricProperties& fabric,
                                           const friction::Model& friction,
                                           const macroscale::StampingResult& run, RunFolder& folder,
                                           const Cache& cache, const std::string& key,
                                           const std::function<bool()>& stop, bool quiet);

}  // namespace heddle::pipeline
