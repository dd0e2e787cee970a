#pragma once

#include <array>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "pipeline/config_schema.h"

namespace heddle::pipeline {

/// One key with its value, in SI.
struct Setting {
  const Key* key = nullptr;
  std::string written;             ///< as the user or the schema wrote it: "0.75 mm"
  std::string text;                ///< of words, choices and files; of a quantity only when it is a choice
  std::array<double, 2> values{};  ///< of quantities and integers: the first; of pairs: both
  std::vector<double> many = {};   ///< of lists; of rows, one row after the other
  std::vector<std::string> names = {};
  std::string file = {};  ///< where it was written; "" = default
  int line = 0;
  std::filesystem::path folder = {};  ///< of the configuration: file keys are relative to it
  bool is_default() const { return file.empty(); }
};

/// All values of a configuration that was read. Asking for a key that is not there is our mistake:
/// std::logic_error.
class Settings {
 public:
  void add(Setting setting);
  void remove(const std::string& path) { settings_.erase(path); }
  bool has(const std::string& path) const { return settings_.count(path) > 0; }
  const Setting* find(const std::string& path) const;

  double number(const std::string& path) const;
  int integer(const std::string& path) const;
  std::array<double, 2> pair(const std::string& path) const;
  const std::vector<double>& many(const std::string& path) const;
  const std::string& text(const std::string& path) const;
  const std::vector<std::string>& names(const std::string& path) const;
  bool is(const std::string& path, const std::string& choice) const {
    return has(path) && text(path) == choice;
  }

  /// Blocks the user wrote, for instance "effects.tool_temperature_shift": some switch by being there. Keys
  /// whose value could not be read are here too: they count as given.
  std::set<std::string> blocks;
  /// Stages that the blocks given ask for.
  std::set<Stage> stages;

 private:
  const Setting& get(const std::string& path) const;
  std::map<std::string, Setting> settings_;
};

/// Whether the conditions of Key::used_when hold.
bool is_used(const Key& key, const Settings& settings);

/// The configuration with every default filled in, such that read_config gives the same bits again.
/// File keys name copies: "inputs/KEY.csv" (see write_resolved in case.h).
std::string resolved_yaml(const Settings& settings);

/// The value as resolved.yaml holds it, which reads back bit for bit.
std::string resolved_value(const Setting& setting);

/// Path of the copy of a file key's file, below the output folder.
std::string resolved_file_name(const Setting& setting);

}  // namespace heddle::pipeline
