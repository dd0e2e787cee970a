#pragma once

#include <filesystem>
#include <functional>
#include <iosfwd>

#include "store.h"

namespace heddle::blind {

struct RunOptions {
  std::filesystem::path program;  ///< heddle
  std::filesystem::path config;   ///< the case given to `discover`
  int processes = 2;
  double time_limit = 300.0;  ///< for one case [s]
  bool keep_data = false;     ///< leave the data and all outputs of each case; they can be made again
};

struct RunSummary {
  int cases = 0, finished = 0, skipped = 0;  ///< skipped: their reports were there already
  int without_report = 0;
  bool stopped = false;
};

/// Runs every case of a plan that has no report yet: writes its data, calls `discover` in a folder that holds
/// nothing else, and stores what it answers with its hash. The truth is not written anywhere.
/// @param stop  asked between looks at the children; true ends the campaign, unfinished cases leave nothing
/// @param say   one line of progress each time a case ends
/// @throws std::runtime_error  program or config is missing; a file cannot be written
RunSummary run_cases(const Store& store, const std::vector<PlannedCase>& cases, const RunOptions& options,
                     const std::function<bool()>& stop, const std::function<void(const RunSummary&)>& say);

}  // namespace heddle::blind
