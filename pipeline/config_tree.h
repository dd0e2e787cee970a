#pragma once

#include <string>
#include <vector>

#include "core/problem.h"

namespace heddle::pipeline {

/// A YAML value with the place it came from. Text is kept as written: types are decided by the schema, not
/// guessed.
struct ConfigNode {
  enum class Kind { empty, scalar, list, map };
  struct Entry;  ///< a key of a map and its value

  Kind kind = Kind::empty;
  std::string text;               ///< of a scalar
  std::vector<ConfigNode> items;  ///< of a list
  std::vector<Entry> entries;     ///< of a map, in the order written
  std::string file;               ///< file name, or "--set #2"
  int line = 0;                   ///< 1-based; 0 for --set

  const ConfigNode* find(const std::string& key) const;
  /// @param path  dotted, for instance "weave.gap"; "" is this node
  const ConfigNode* find_path(const std::string& path) const;
};

struct ConfigNode::Entry {
  std::string key;
  int line = 0;
  ConfigNode value;
};

struct ParsedConfig {
  ConfigNode root;    ///< always a map
  Problems problems;  ///< syntax, duplicate keys, anchors, aliases, merge keys, tags
};

/// Reads a YAML map strictly. What two readers could take in two ways is a problem here.
/// @param file  name shown in problems
ParsedConfig parse_config(const std::string& text, const std::string& file);

/// Applies "PATH=VALUE": VALUE is YAML flow text as it would stand after `key: ` in a file; a map replaces a
/// map.
/// @param place  "--set #2"
Problems apply_setting(ConfigNode& root, const std::string& assignment, const std::string& place);

}  // namespace heddle::pipeline
