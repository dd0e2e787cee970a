#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/problem.h"
#include "pipeline/config_schema.h"
#include "pipeline/settings.h"

namespace heddle::pipeline {

/// One model that a study of stampings runs at every speed: the case with some keys set.
struct StudyModel {
  std::string name;                      ///< letters, digits, _ and -
  std::vector<std::string> assignments;  ///< as of --set; empty = the case as given
};

/// What `heddle study` is to change of a stamping: every model at every speed, and the case as given at every
/// binder force.
struct StampingStudySpec {
  std::vector<double> binder_forces;  ///< [N]
  std::vector<double> speed_scales;   ///< of the punch [-]
  std::vector<StudyModel> models;     ///< the case as given first, by the name "given"
  std::vector<std::string> refused;   ///< texts of models that cannot be read
};

/// The keys below `stamping_study`. They change no stamping of the case itself.
std::vector<Key> stamping_study_keys();
/// Nothing where the configuration has no such block.
std::optional<StampingStudySpec> stamping_study_of(const Settings& settings);
/// Models that cannot be read, names and values that appear twice, nothing to change.
Problems check_stamping_study(const StampingStudySpec& spec);

}  // namespace heddle::pipeline
