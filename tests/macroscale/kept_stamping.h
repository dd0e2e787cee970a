#pragma once

#include <string>
#include <vector>

#include "core/hdf5_file.h"
#include "macroscale/checkpoint.h"
#include "macroscale/stamping.h"

namespace heddle::test {

inline std::string bytes_of(const macroscale::StampingCheckpoint& checkpoint) {
  Hdf5Writer file;
  write(file, "/stamping", checkpoint);
  return file.finish();
}

/// The way back.
inline macroscale::StampingCheckpoint from(const std::string& bytes) {
  return macroscale::read_checkpoint(Hdf5Reader(bytes), "/stamping");
}

/// A stamping with the bytes of all its checkpoints, in order.
struct Kept {
  std::vector<std::string> checkpoints;
  macroscale::StampingResult result;
};

inline Kept run_and_keep(const macroscale::StampingSpec& spec, const mesoscale::FabricProperties& fabric,
                         const friction::Model& friction, macroscale::StampingControl control = {}) {
  Kept kept;
  control.keep = [&](const macroscale::StampingCheckpoint& c, bool) {
    kept.checkpoints.push_back(bytes_of(c));
  };
  kept.result = run_stamping(spec, fabric, friction, control);
  return kept;
}

/// The same stamping, gone on with from what one of its checkpoints kept.
inline macroscale::StampingResult go_on(const std::string& bytes, const macroscale::StampingSpec& spec,
                                        const mesoscale::FabricProperties& fabric,
                                        const friction::Model& friction) {
  const macroscale::StampingCheckpoint checkpoint = from(bytes);
  macroscale::StampingControl control;
  control.resume_from = &checkpoint;
  return run_stamping(spec, fabric, friction, control);
}

}  // namespace heddle::test
