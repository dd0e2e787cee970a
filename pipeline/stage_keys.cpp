#include "pipeline/stage_keys.h"

#include <algorithm>
#include <fstream>
#include <map>
#include <sstream>
#include <stdexcept>

#include <fmt/format.h>

#include "core/sha256.h"
#include "core/sparse_solver.h"
#include "core/units.h"
#include "pipeline/outputs.h"

namespace heddle::pipeline {

namespace {

std::string value_of(const Setting& setting) {
  if (setting.key->type != KeyType::file) return resolved_value(setting);
  return "sha256 " + sha256(read_file(setting.folder / setting.text));
}

bool stamps(ChainStage stage) {
  return stage == ChainStage::macroscale || stage == ChainStage::grid_error;
}

/// Stages whose results go into this one, itself last.
std::vector<ChainStage> chain_of(ChainStage stage, const Case& a_case) {
  std::vector<ChainStage> chain;
  if (a_case.cell) chain.push_back(ChainStage::mesoscale);
  if (stage == ChainStage::solid) return {ChainStage::mesoscale, ChainStage::solid};
  if (stage != ChainStage::mesoscale && a_case.friction) chain.push_back(ChainStage::friction);
  if (stage == ChainStage::friction_rig) chain.push_back(stage);
  if (stamps(stage)) chain.push_back(ChainStage::macroscale);
  if (stage == ChainStage::grid_error) chain.push_back(stage);
  return chain;
}

std::vector<std::string> source_groups(ChainStage stage) {
  switch (stage) {
    case ChainStage::mesoscale:
    case ChainStage::solid:
      return {"core", "mesoscale", "stages", "build"};
    case ChainStage::friction:
      return {"core", "friction", "mesoscale", "stages", "build"};
    case ChainStage::friction_rig:
    case ChainStage::macroscale:
    case ChainStage::grid_error:
      return {"core", "friction", "mesoscale", "macroscale", "stages", "build"};
  }
  throw std::logic_error("no such stage");
}

std::map<std::string, std::string> by_name(const std::string& text) {
  std::map<std::string, std::string> values;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) {
    const std::size_t equals = line.find(" = ");
    if (equals != std::string::npos) values[line.substr(0, equals)] = line.substr(equals + 3);
  }
  return values;
}

}  // namespace

std::string name_of(ChainStage stage) {
  switch (stage) {
    case ChainStage::mesoscale:
      return "mesoscale";
    case ChainStage::solid:
      return "solid";
    case ChainStage::friction:
      return "friction";
    case ChainStage::friction_rig:
      return "friction_rig";
    case ChainStage::macroscale:
      return "macroscale";
    case ChainStage::grid_error:
      return "grid_error";
  }
  throw std::logic_error("no such stage");
}

const std::vector<std::string>& keys_without_effect() {
  // A study lists runs; each has what it changes in its own key.
  static const std::vector<std::string> keys{"heddle",
                                             "name",
                                             "orientation_study.blanks",
                                             "orientation_study.friction",
                                             "stamping_study.binder_force",
                                             "stamping_study.speed_scale",
                                             "stamping_study.models",
                                             "stamping_study.vary"};
  return keys;
}

bool reads(ChainStage stage, const Key& key) {
  const auto& idle = keys_without_effect();
  if (std::find(idle.begin(), idle.end(), key.path) != idle.end()) return false;
  switch (key.stage) {
    case Stage::always:  // what every stage may read, as the melt
      return true;
    case Stage::cell:
      return stage == ChainStage::mesoscale;
    case Stage::solid:
    case Stage::voxels:
      return stage == ChainStage::solid;
    case Stage::friction:
      return stage == ChainStage::friction;
    case Stage::friction_test: {  // what only the machine reads moves nothing that the stamping takes from
                                  // the law
      const bool of_machine = key.path.starts_with("friction_test.rig.") &&
                              key.path != "friction_test.rig.pull_length" &&
                              key.path != "friction_test.rig.dwell";
      return stage == (of_machine ? ChainStage::friction_rig : ChainStage::friction);
    }
    case Stage::stamping:
      return stage == ChainStage::macroscale;
    case Stage::grid_error:
      return stage == ChainStage::grid_error;
    case Stage::orientation_study:  // a list of runs, each with its own blank.orientation
    case Stage::study:              // commands of their own
    case Stage::calibrate:
    case Stage::discover:
      return false;
  }
  throw std::logic_error("no such stage");
}

std::string StageInputs::text() const {
  std::string out;
  for (const StageInput& input : inputs) out += input.name + " = " + input.value + "\n";
  return out;
}

std::string StageInputs::key() const {
  return sha256(text());
}

StageInputs inputs_of(ChainStage stage, const Case& a_case) {
  const std::vector<ChainStage> chain = chain_of(stage, a_case);
  StageInputs result{{{"stage", name_of(stage)}}};
  for (const Key& key : schema()) {
    const Setting* setting = a_case.settings.find(key.path);
    const bool read = std::any_of(chain.begin(), chain.end(), [&](ChainStage s) { return reads(s, key); });
    if (setting != nullptr && read) result.inputs.push_back({key.path, value_of(*setting)});
  }
  const std::vector<std::string> groups = source_groups(stage);
  for (const auto& [name, hash] : source_hashes())
    if (std::find(groups.begin(), groups.end(), name) != groups.end())
      result.inputs.push_back({"sources." + name, hash});
  result.inputs.push_back({"machine.processor", processor_name()});
  if (stamps(stage) || stage == ChainStage::friction_rig)
    result.inputs.push_back({"machine.blas", blas_name()});
  return result;
}

std::vector<std::string> differences(const std::string& before, const std::string& now) {
  const auto a = by_name(before), b = by_name(now);
  std::vector<std::string> lines;
  for (const auto& [name, value] : b) {
    const auto found = a.find(name);
    if (found != a.end() && found->second == value) continue;
    const bool hash = value.starts_with("sha256 ") || name.starts_with("sources.");
    if (hash && found != a.end())
      lines.push_back(name +
                      (name.starts_with("sources.") ? " (this program) changed" : " holds other contents"));
    else
      lines.push_back(found == a.end() ? fmt::format("{} is new", name)
                                       : fmt::format("{} was {}, is {}", name, found->second, value));
  }
  for (const auto& [name, value] : a)
    if (b.count(name) == 0) lines.push_back(fmt::format("{} = {} is gone", name, value));
  return lines;
}

std::string case_hash(const Case& a_case) {
  std::string text;
  if (a_case.cell) text += inputs_of(ChainStage::mesoscale, a_case).text();
  if (a_case.solid || a_case.voxels) text += inputs_of(ChainStage::solid, a_case).text();
  if (a_case.friction) text += inputs_of(ChainStage::friction, a_case).text();
  if (a_case.friction_machine) text += inputs_of(ChainStage::friction_rig, a_case).text();
  if (a_case.stamping) text += inputs_of(ChainStage::macroscale, a_case).text();
  if (a_case.grid_error) text += inputs_of(ChainStage::grid_error, a_case).text();
  return sha256(text);
}

std::string processor_name() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);)
    if (line.rfind("model name", 0) == 0) return line.substr(line.find(':') + 2);
  return "unknown";
}

}  // namespace heddle::pipeline
