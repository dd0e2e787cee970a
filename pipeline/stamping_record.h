#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "macroscale/checkpoint.h"
#include "macroscale/stamping.h"
#include "pipeline/stage_keys.h"

namespace heddle::pipeline {

/// All of a stamping up to some step: where it stands, what it has shown, and what it depends on. The file
/// macroscale/checkpoint.h5 and an entry of the cache are the same thing; the latter stands at the last step.
struct StampingRecord {
  std::string key;     ///< StageInputs::key
  std::string inputs;  ///< StageInputs::text, so that a later run can say what changed
  int steps = 0;       ///< of the whole run
  macroscale::StampingCheckpoint at;
  struct Frame {
    int step = 0;
    macroscale::BlankState blank;
  };
  std::vector<Frame> frames;  ///< for pictures, in order

  bool complete() const { return at.step == steps; }
};

/// A sealed HDF5 file; equal records give equal bytes.
std::string bytes_of(const StampingRecord& record);
/// @throws Hdf5Error  if something is missing
StampingRecord read_stamping_record(const Hdf5Reader& file);

/// Name of the file below the folder of a run.
inline constexpr const char* checkpoint_name = "macroscale/checkpoint.h5";

/// The checkpoint that a run in this folder left, or nothing if it left none.
/// @throws InputError  run.resume.damaged: it cannot be trusted; run.resume.changed: it belongs to other
/// inputs, and the
///                     problem names them
std::optional<StampingRecord> checkpoint_in(const std::filesystem::path& folder, const StageInputs& inputs);

}  // namespace heddle::pipeline
