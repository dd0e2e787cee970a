#pragma once

#include <functional>
#include <optional>

#include "macroscale/stamping.h"
#include "pipeline/cache.h"
#include "pipeline/run_folder.h"
#include "pipeline/stamping_record.h"

namespace heddle::pipeline {

/// How the stamping of one run is shown, kept and stopped. None of it changes a result.
struct StampingStageOptions {
  StageInputs inputs;                         ///< of the stage, for checkpoints and cache
  std::optional<StampingRecord> resume = {};  ///< where to go on
  double checkpoint_interval = 10.0;          ///< wall time after which one is due [s]; 0: after each step
  std::function<bool()> stop = {};            ///< asked between Newton iterations
  bool quiet = false;
};

/// Runs the stamping, or takes it from checkpoint or cache. Writes history.csv, the frames of the blank,
/// blank.pvd and checkpoint.h5 as it goes; a run that fails leaves blank_last.vtu and blank_failed.vtu as
/// well. A complete run goes into the cache.
macroscale::StampingResult run_stamping_stage(const macroscale::StampingSpec& spec,
                                              const mesoscale::FabricProperties& fabric,
                                              const friction::Model& friction, RunFolder& folder,
                                              const Cache& cache, StampingStageOptions options);

}  // namespace heddle::pipeline
