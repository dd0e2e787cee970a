#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "pipeline/discover/stamping_campaign.h"
#include "pipeline/discover/stamping_surrogate.h"
#include "pipeline/discover_command.h"
#include "pipeline/discover_stamping_runs.h"

namespace heddle::pipeline {

/// How one hypothesis fared when it was stamped truly.
struct TrueCheck {
  std::string name;         ///< "none", "shear_rate", "shear_rate+discretisation"
  int round = 0;            ///< 0: of the first surrogate; 1, 2: after it was taken anew about the trial
  double size = 0.0;        ///< rms change of ln F from the case [-]
  double difference = 0.0;  ///< rms of true - affine [-]
};

/// A discovery in stampings, with what it rests on.
struct StampingDiscovery {
  DiscoveryRecord record;  ///< curves stand as pulls in it (pipeline/discover/stamping_campaign.h)
  std::vector<discover::SlopeCheck> slopes;
  std::vector<TrueCheck> true_checks;
  std::vector<std::string> patch;  ///< KEY=VALUE of the case with what was found
  double grid_error = 0.0;         ///< rms of ln F on a finer grid less that of the case [-]
};

/// Looks for what a case misses in measured stampings: affine surrogate of the case, search, verdict, true
/// runs of the best hypothesis, gap on held-out conditions from true runs.
/// @param data  table with punch_force_N
/// @throws InputError            with every problem of data, sidecar and wish
/// @throws NumericalError        if the case itself does not come to its end at a condition of the data
/// @throws StampingsInterrupted  after a signal; what was stamped is in the cache
StampingDiscovery discover_stamping_in(const Case& a_case, StampingRuns& runs,
                                       const std::filesystem::path& data,
                                       const std::vector<std::filesystem::path>& own_effects = {});

/// One row a slope: number, step, change, disagreement, whether it is used.
std::string slopes_csv(const StampingDiscovery& discovery);

/// The command, for tables of stampings.
int discover_stamping(const DiscoverOptions& options);

}  // namespace heddle::pipeline
