#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/problem.h"
#include "pipeline/config_schema.h"
#include "pipeline/config_tree.h"
#include "pipeline/settings.h"

namespace heddle::pipeline {

/// One model that a study of stampings runs at every speed: the case with some keys set.
struct StudyModel {
  std::string name;                      ///< letters, digits, _ and -
  std::vector<std::string> assignments;  ///< as of --set; empty = the case as given
};

/// A key and the values it takes, as a file would have them: "0.25", "650 N", "off".
struct VariedKey {
  std::string key;  ///< dotted
  std::vector<std::string> values;
};

/// What `heddle study` is to change of a stamping: every model at every speed, the case as given at every
/// binder force, and the case with each variation's keys at every combination of their values.
struct StampingStudySpec {
  std::vector<double> binder_forces;  ///< [N]
  std::vector<double> speed_scales;   ///< of the punch [-]
  std::vector<StudyModel> models;     ///< the case as given first, by the name "given"
  std::vector<std::string> refused;   ///< texts of models that cannot be read
  /// One after the other, each by itself; keys of one variation are crossed. One that cannot be read is
  /// empty.
  std::vector<std::vector<VariedKey>> variations = {};
  std::vector<std::string> variation_texts = {};  ///< as written, for messages
};

/// The keys below `stamping_study`. They change no stamping of the case itself.
std::vector<Key> stamping_study_keys();
/// Nothing where the configuration has no such block.
std::optional<StampingStudySpec> stamping_study_of(const Settings& settings);
/// Models and variations that cannot be read, names and values that appear twice, nothing to change.
/// @param root  of the file, for the lines of variations
Problems check_stamping_study(const StampingStudySpec& spec, const ConfigNode& root);

/// All keys that vary, in order, each once.
std::vector<std::string> varied_keys(const StampingStudySpec& spec);

/// The combinations of one variation's values, the last key's fastest: values in the order of its keys.
std::vector<std::vector<std::string>> combinations(const std::vector<VariedKey>& variation);
/// Letters, digits, _ and - for one combination: "tools-die-friction_coefficient-0p125".
std::string id_of(const std::vector<VariedKey>& variation, const std::vector<std::string>& values);

}  // namespace heddle::pipeline
