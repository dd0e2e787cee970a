#include "pipeline/config_tree.h"

#include <fmt/format.h>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/parser.h>

#include <algorithm>
#include <sstream>

namespace heddle::pipeline {
namespace {

std::string join_path(const std::string& parent, const std::string& key) {
  return parent.empty() ? key : parent + "." + key;
}

/// Builds our tree from parser events. yaml-cpp's own node tree hides duplicate keys and anchors, and has
/// octal integers; the events show all of it.
class TreeBuilder : public YAML::EventHandler {
 public:
  /// @param top  path that the only key of the text stands for; "" = the keys are those of a file
  TreeBuilder(std::string file, Problems& problems, std::string top = "")
      : file_(std::move(file)), problems_(problems), top_(std::move(top)) {}

  ConfigNode root;

  void OnDocumentStart(const YAML::Mark&) override {}
  void OnDocumentEnd() override {}

  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    refuse_anchor(mark, anchor);
    add(node(ConfigNode::Kind::empty, mark));
  }

  void OnAlias(const YAML::Mark& mark, YAML::anchor_t) override {
    report(mark, "*.alias"_family, "is an alias, which is not read", "Write the value out where it is used.");
    drop_entry(mark);
  }

  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                const std::string& value) override {
    refuse_anchor(mark, anchor);
    refuse_tag(mark, tag);
    ConfigNode scalar = node(ConfigNode::Kind::scalar, mark);
    scalar.text = value;
    add(std::move(scalar));
  }

  void OnSequenceStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value) override {
    open(ConfigNode::Kind::list, mark, tag, anchor);
  }
  void OnSequenceEnd() override { close(); }

  void OnMapStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value) override {
    open(ConfigNode::Kind::map, mark, tag, anchor);
  }
  void OnMapEnd() override { close(); }

 private:
  /// A list or map still being read.
  struct Open {
    ConfigNode node;
    std::string key;  ///< of a map: read, its value still to come
    int key_line = 0;
    bool has_key = false;
  };

  ConfigNode node(ConfigNode::Kind kind, const YAML::Mark& mark) const {
    ConfigNode fresh;
    fresh.kind = kind;
    fresh.file = file_;
    fresh.line = mark.line + 1;
    return fresh;
  }

  void open(ConfigNode::Kind kind, const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor) {
    refuse_anchor(mark, anchor);
    refuse_tag(mark, tag);
    open_.push_back({node(kind, mark), "", 0, false});
  }

  void close() {
    ConfigNode finished = std::move(open_.back().node);
    open_.pop_back();
    add(std::move(finished));
  }

  void add(ConfigNode&& value) {
    if (open_.empty()) {
      root = std::move(value);
      return;
    }
    Open& parent = open_.back();
    if (parent.node.kind == ConfigNode::Kind::list) {
      parent.node.items.push_back(std::move(value));
    } else if (!parent.has_key) {
      take_key(parent, value);
    } else {
      add_entry(parent, std::move(value));
    }
  }

  void take_key(Open& parent, const ConfigNode& key) {
    if (key.kind != ConfigNode::Kind::scalar || key.text.empty()) {
      problems_.push_back({"*.key"_family.of(path()), path(), "", "has a key that is not a word",
                           "Keys are plain words.", file_, key.line});
    }
    parent.key = key.text;
    parent.key_line = key.line;
    parent.has_key = true;
  }

  void add_entry(Open& parent, ConfigNode&& value) {
    const std::string path_of_key = path();
    parent.has_key = false;
    if (parent.key.empty()) return;  // refused by take_key
    if (parent.key == "<<") {
      problems_.push_back({"*.merge"_family.of(path_of_key), path_of_key, "",
                           "is a merge key, which is not read", "Write the keys out.", file_,
                           parent.key_line});
      return;
    }
    if (const ConfigNode* first = parent.node.find(parent.key)) {
      problems_.push_back({"*.duplicate"_family.of(path_of_key), path_of_key, value.text,
                           fmt::format("is given twice, first in line {}", first->line),
                           "Keep one of the two.", file_, parent.key_line});
      return;
    }
    // A block or an empty value is where its key stands, not where the text after it begins.
    if (value.kind != ConfigNode::Kind::scalar) value.line = parent.key_line;
    parent.node.entries.push_back({parent.key, parent.key_line, std::move(value)});
  }

  /// An entry already refused: nothing more is said about its value.
  void drop_entry(const YAML::Mark& mark) {
    if (!open_.empty() && open_.back().has_key) {
      open_.back().has_key = false;
    } else {
      add(node(ConfigNode::Kind::empty, mark));
    }
  }

  /// Dotted path of the value being read.
  std::string path() const {
    std::string path;
    for (const Open& open : open_) {
      if (open.has_key) path = path.empty() && !top_.empty() ? top_ : join_path(path, open.key);
    }
    return path;
  }

  void report(const YAML::Mark& mark, RuleFamily id, const std::string& rule, const std::string& way_out) {
    problems_.push_back({id.of(path()), path(), "", rule, way_out, file_, mark.line + 1});
  }

  void refuse_anchor(const YAML::Mark& mark, YAML::anchor_t anchor) {
    if (anchor == YAML::NullAnchor) return;
    report(mark, "*.anchor"_family, "has an anchor, which is not read",
           "Write the value out where it is used.");
  }

  /// "?" marks a plain scalar and "!" a quoted one; any other tag was written by the user.
  void refuse_tag(const YAML::Mark& mark, const std::string& tag) {
    if (tag.empty() || tag == "?" || tag == "!") return;
    report(mark, "*.tag"_family, fmt::format("has the tag {}, which is not read", tag), "Leave the tag out.");
  }

  std::string file_;
  Problems& problems_;
  std::string top_;
  std::vector<Open> open_;
};

ConfigNode empty_map(const std::string& file, int line) {
  ConfigNode map;
  map.kind = ConfigNode::Kind::map;
  map.file = file;
  map.line = line;
  return map;
}

std::vector<std::string> split_path(const std::string& path) {
  std::vector<std::string> keys;
  std::istringstream stream(path);
  for (std::string key; std::getline(stream, key, '.');) keys.push_back(key);
  return keys;
}

bool is_plain_path(const std::string& path) {
  const bool letters_only = std::all_of(path.begin(), path.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '.';
  });
  return letters_only && !path.empty() && path.front() != '.' && path.back() != '.' &&
         path.find("..") == std::string::npos;
}

/// The entry of `key`, made if it is not there.
ConfigNode& entry_of(ConfigNode& map, const std::string& key, const std::string& place) {
  for (ConfigNode::Entry& entry : map.entries) {
    if (entry.key == key) return entry.value;
  }
  map.entries.push_back({key, 0, empty_map(place, 0)});
  return map.entries.back().value;
}

/// Values given by --set have no line: the place names them.
void move_to_place(ConfigNode& node, const std::string& place) {
  node.file = place;
  node.line = 0;
  for (ConfigNode& item : node.items) move_to_place(item, place);
  for (ConfigNode::Entry& entry : node.entries) {
    entry.line = 0;
    move_to_place(entry.value, place);
  }
}

}  // namespace

const ConfigNode* ConfigNode::find(const std::string& key) const {
  const auto found =
      std::find_if(entries.begin(), entries.end(), [&](const Entry& entry) { return entry.key == key; });
  return found == entries.end() ? nullptr : &found->value;
}

const ConfigNode* ConfigNode::find_path(const std::string& path) const {
  const ConfigNode* node = this;
  for (const std::string& key : split_path(path)) {
    node = node->find(key);
    if (node == nullptr) return nullptr;
  }
  return node;
}

namespace {

/// 1-based; 0 = none is.
int first_line_indented_by_tab(const std::string& text) {
  std::istringstream stream(text);
  int line = 0;
  for (std::string content; std::getline(stream, content);) {
    ++line;
    const std::size_t first = content.find_first_not_of(" \t");
    if (first != std::string::npos && content.find('\t') < first) return line;
  }
  return 0;
}

ParsedConfig parse(const std::string& text, const std::string& file, const std::string& top) {
  ParsedConfig parsed;
  parsed.root = empty_map(file, 1);
  TreeBuilder builder(file, parsed.problems, top);
  try {
    std::istringstream stream(text);
    YAML::Parser parser(stream);
    parser.HandleNextDocument(builder);
    if (builder.root.kind == ConfigNode::Kind::map) {
      parsed.root = std::move(builder.root);
    } else if (builder.root.kind != ConfigNode::Kind::empty) {
      parsed.problems.push_back({"yaml.map"_rule, "", builder.root.text, "must be a map of keys and values",
                                 "Write lines such as \"name: my_part\".", file, builder.root.line});
    }
    Problems of_the_rest;
    TreeBuilder rest(file, of_the_rest);
    if (parser.HandleNextDocument(rest)) {
      parsed.problems.push_back({"yaml.documents"_rule, "", "", "must hold one YAML document, and holds more",
                                 "Remove everything after the second \"---\".", file, 0});
    }
  } catch (const YAML::Exception& error) {
    if (const int line = first_line_indented_by_tab(text); line > 0)
      parsed.problems.push_back({"yaml.tab"_rule, "", "", "begins with a tab, and YAML is indented by blanks",
                                 "Replace the tabs at the beginning of lines by blanks.", file, line});
    else
      parsed.problems.push_back(
          {"yaml.syntax"_rule, "", "", fmt::format("cannot be read as YAML: {}", error.msg),
           "Check indentation, colons and brackets near this line.", file, error.mark.line + 1});
  }
  return parsed;
}

}  // namespace

ParsedConfig parse_config(const std::string& text, const std::string& file) {
  return parse(text, file, "");
}

Problems apply_setting(ConfigNode& root, const std::string& assignment, const std::string& place) {
  const std::size_t equals = assignment.find('=');
  const std::string path = assignment.substr(0, equals);
  if (equals == std::string::npos || !is_plain_path(path)) {
    return {{"set.syntax"_rule, "--set", assignment, "must have the form PATH=VALUE with a dotted path",
             "For instance --set weave.gap='1.5 mm'.", place, 0}};
  }

  ParsedConfig parsed = parse("value: " + assignment.substr(equals + 1), place, path);
  for (Problem& problem : parsed.problems) {
    problem.line = 0;
    if (problem.key.empty()) problem.key = path;
  }
  if (!parsed.problems.empty()) return parsed.problems;
  if (parsed.root.entries.size() != 1) {
    return {{"set.syntax"_rule, path, assignment, "must give one value",
             "Write a map in braces: {a: 1, b: 2}.", place, 0}};
  }
  ConfigNode value = std::move(parsed.root.entries.front().value);
  move_to_place(value, place);

  ConfigNode* node = &root;
  for (const std::string& key : split_path(path)) {
    if (node->kind == ConfigNode::Kind::empty) *node = empty_map(place, 0);
    if (node->kind != ConfigNode::Kind::map) {
      return {{"*.set"_family.of(path), path, assignment.substr(equals + 1),
               fmt::format("cannot be reached: a value stands before \"{}\"", key),
               "Set the value above it to a map first.", place, 0}};
    }
    node = &entry_of(*node, key, place);
  }
  *node = std::move(value);
  return {};
}

}  // namespace heddle::pipeline
