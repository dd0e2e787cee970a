#pragma once

#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "core/problem.h"
#include "pipeline/config_tree.h"
#include "pipeline/settings.h"

namespace heddle::pipeline {

struct ReadConfig {
  ConfigNode root;    ///< the file with all --set applied
  Settings settings;  ///< what could be read; keys with problems are missing
  Problems problems;
  std::vector<std::string> notes;  ///< keys given that nothing uses
  /// Keys and blocks that have no value though they need one: not given, not readable, or written wrongly
  /// under another name.
  std::set<std::string> failed;
};

/// Drops every problem of a rule that looks at a key without a value: with a default in its place the rule
/// would blame a key that may be right. A rule looks at its own key, at Problem::others, and at the keys that
/// decide whether those are used.
void drop_unknowable(Problems& problems, const std::set<std::string>& failed);

/// Reads a configuration and finds everything wrong with single keys.
/// @param text         YAML
/// @param file         name shown in problems
/// @param folder       against which file keys are resolved
/// @param assignments  of --set, in order
ReadConfig read_config(const std::string& text, const std::string& file, const std::filesystem::path& folder,
                       const std::vector<std::string>& assignments = {});

/// Adds file, line and value to problems that name only their key.
void locate(Problems& problems, const ReadConfig& config);

/// The file's own problems first, then those of --set #1, #2 and so on.
void sort_by_place(Problems& problems, const std::string& file);

}  // namespace heddle::pipeline
