#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/problem.h"
#include "pipeline/discover/hypothesis.h"

namespace heddle::discover {

/// One file of configs/effects: a name that a gap may have.
struct EffectFile {
  std::string id;
  /// Where it acts: film, area, coefficient (friction), fabric, process, rig or numerics.
  std::string stage;
  /// Id of the term that it switches on; its own id unless the file says otherwise. "" with a file that moves
  /// numbers of the model alone.
  std::string term;
  std::string form;
  std::vector<Unknown> numbers;  ///< the amplitude first
  std::vector<double> off;       ///< off value of each; NaN where any will do
  std::vector<std::string> look_alikes;
  std::string source;
  std::string file;  ///< where it was read

  Candidate candidate() const;
};

/// Reads an effect file, strictly: an unknown key, a prior that cannot be read, an amplitude without off
/// value are problems.
/// @throws InputError  with all of them
EffectFile read_effect(const std::string& text, const std::string& file);

/// The files of configs/effects as they were when the program was built: name and text.
const std::vector<std::pair<std::string, std::string>>& built_in_effect_texts();

/// All effects of the house, in library order: F1 to F15, R1 to R6, then fabric, process and numerics.
std::vector<EffectFile> built_in_effects();

}  // namespace heddle::discover
