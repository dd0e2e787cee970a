#pragma once

#include <string>
#include <utility>
#include <vector>

#include "pipeline/case.h"
#include "pipeline/config_schema.h"

/// What each stage depends on, by name and value, and the hash of it: a stage with the same key gives the
/// same bytes.
namespace heddle::pipeline {

enum class ChainStage { mesoscale, solid, friction, friction_rig, macroscale, grid_error };

/// "mesoscale": the name in manifest.json and in messages.
std::string name_of(ChainStage stage);

/// One thing a stage's result depends on.
struct StageInput {
  std::string name;  ///< key of the configuration, "sources.core", "machine.processor"
  std::string
      value;  ///< exact: a quantity so that it reads back bit for bit, a file as the hash of its contents
};

struct StageInputs {
  std::vector<StageInput> inputs;

  /// One line an input, "name = value".
  std::string text() const;
  /// SHA-256 of the text, 64 hexadecimal digits.
  std::string key() const;
};

/// Everything the stage reads: its own keys and those of the stages before it, contents of files, hashes of
/// the sources that compute it, and the kind of processor and BLAS, which decide last bits.
StageInputs inputs_of(ChainStage stage, const Case& a_case);

/// Whether a stage itself (not one before it) reads a key of the configuration.
bool reads(ChainStage stage, const Key& key);

/// Keys that change no result of a stage: version of the file format, name of the case, lists of runs.
const std::vector<std::string>& keys_without_effect();

/// What differs between two texts of inputs, a line each: "process.binder_force was 650 N, is 700 N". For
/// files and sources it says that they changed.
std::vector<std::string> differences(const std::string& before, const std::string& now);

/// One hash over everything the case asks for.
std::string case_hash(const Case& a_case);

/// SHA-256 of the sources of each room and of what turns a case into stages, and the compiler with its flags.
/// From the build (cmake/hash_sources.cmake).
const std::vector<std::pair<std::string, std::string>>& source_hashes();

/// Model name of the processor, from the system.
std::string processor_name();

}  // namespace heddle::pipeline
