#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "mesoscale/fabric_properties.h"
#include "pipeline/cache.h"
#include "pipeline/case.h"
#include "pipeline/discover/effect_library.h"
#include "pipeline/discover/hypothesis.h"
#include "pipeline/discover/stamping_campaign.h"

namespace heddle::pipeline {

/// A signal came between two Newton iterations.
struct StampingsInterrupted : std::runtime_error {
  StampingsInterrupted() : std::runtime_error("interrupted between two stampings") {}
};

/// Punch force against stroke of one stamping.
struct ForceCurve {
  std::vector<double> stroke, force;  ///< [m], [N]
  bool completed = false;
};

/// Stampings of one case with some keys set, each run once: what the cache holds is not run again, so that a
/// second start goes on where the first was ended.
class StampingRuns {
 public:
  /// @param file         of the case
  /// @param assignments  of --set, before those of each run
  /// @param done         called after each stamping that was not known yet, with its keys
  StampingRuns(std::filesystem::path file, std::vector<std::string> assignments, const Cache& cache,
               std::function<void(const std::string& keys)> done);

  /// @param keys  KEY=VALUE as of --set
  /// @throws InputError            if the case cannot be read with them
  /// @throws StampingsInterrupted  after a signal
  const ForceCurve& operator()(const std::vector<std::string>& keys);

  Case case_with(const std::vector<std::string>& keys) const;
  std::size_t count() const { return curves_.size(); }

 private:
  ForceCurve stamp(const std::vector<std::string>& keys);
  const mesoscale::FabricProperties& fabric_of(const Case& a_case);

  std::filesystem::path file_;
  std::vector<std::string> assignments_;
  const Cache& cache_;
  std::function<void(const std::string&)> done_;
  std::map<std::string, ForceCurve> curves_;                    ///< by their keys
  std::map<std::string, mesoscale::FabricProperties> fabrics_;  ///< by the key of the stage
};

/// What a stamping can move and miss.
struct StampingLibrary {
  std::vector<discover::Unknown> baseline;
  /// With their amplitude alone free: an effect with one more number appears once for each of three values of
  /// it, weighed as Gauss-Hermite quadrature over its prior weighs them; further numbers stay at the centre.
  std::vector<discover::Candidate> candidates;
  std::vector<std::pair<std::string, std::string>> refused;  ///< ids, and why they are not tried
};

/// Constants of the friction law and the friction between tows, which sets the level of shear without rate;
/// effects of friction that the law admits, shear_rate, inertia, discretisation.
/// @param numbers  keys that the case asks for instead (discover.parameters); empty: the usual ones
/// @throws InputError  for a number that does not act, a calibrated law
StampingLibrary stamping_library(const Case& a_case, const std::vector<discover::EffectFile>& effects);

/// The keys of a trial, for --set. `discretisation` has none: it is no other model.
/// @param library  the model whose candidates the trial counts
std::vector<std::string> keys_of(const discover::ForwardModel& library, const discover::Trial& trial);
std::vector<std::string> keys_of(const discover::StampingCondition& condition);

/// ln of the mean force in each bin of stroke, condition after condition; every prediction a stamping each.
/// @param edges  of the bins [m]
discover::ForwardModel stamping_forward(StampingRuns& runs, const StampingLibrary& library,
                                        const std::vector<discover::StampingCondition>& conditions,
                                        const std::vector<double>& edges);

/// ln F of the case on two thirds of its node spacing with half as many steps again, less that of the case.
Eigen::VectorXd grid_change(StampingRuns& runs, const std::vector<discover::StampingCondition>& conditions,
                            const std::vector<double>& edges);

}  // namespace heddle::pipeline
