#include "pipeline/config_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <sstream>
#include <stdexcept>
#include <tuple>

#include "core/units.h"

namespace heddle::pipeline {
namespace {

std::string join_path(const std::string& parent, const std::string& name) {
  return parent.empty() ? name : parent + "." + name;
}

std::string last_name(const std::string& path) {
  return path.substr(path.rfind('.') + 1);
}

std::string join_words(const std::vector<std::string>& words, const std::string& separator) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : separator) + word;
  return text;
}

/// Number of single-letter insertions, deletions and substitutions that turn one word into another
/// (Levenshtein).
std::size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t above = row[j];
      row[j] = std::min({above + 1, row[j - 1] + 1, diagonal + (a[i - 1] == b[j - 1] ? 0 : 1)});
      diagonal = above;
    }
  }
  return row[b.size()];
}

/// The word nearest to `word`, or "" if none is near enough to be what was meant.
std::string nearest(const std::string& word, const std::vector<std::string>& words) {
  std::string best;
  std::size_t best_distance = std::max<std::size_t>(2, word.size() / 3) + 1;
  for (const std::string& candidate : words) {
    const std::size_t distance = edit_distance(word, candidate);
    if (distance < best_distance && distance < word.size()) {
      best = candidate;
      best_distance = distance;
    }
  }
  return best;
}

std::string way_out_of_unknown(const std::string& block, const std::string& name, const std::string& near) {
  const std::vector<std::string> known = names_below(block);
  if (!near.empty()) return fmt::format("The nearest known key is {}.", join_path(block, near));
  for (const Key& key : schema()) {
    if (last_name(key.path) == name) return fmt::format("There is {}.", key.path);
  }
  std::vector<std::string> read_now;
  for (const std::string& known_name : known) {
    const Key* key = find_key(join_path(block, known_name));
    if (key == nullptr || key->presence != Presence::later) read_now.push_back(known_name);
  }
  return fmt::format("Known here: {}.", join_words(read_now, ", "));
}

std::string flow_text(const ConfigNode& node) {
  if (node.kind == ConfigNode::Kind::scalar) return node.text;
  if (node.kind == ConfigNode::Kind::map) return "{...}";
  if (node.kind == ConfigNode::Kind::empty) return "";
  std::vector<std::string> items;
  for (const ConfigNode& item : node.items) items.push_back(flow_text(item));
  return "[" + join_words(items, ", ") + "]";
}

/// Reads the value of one key; collects what is wrong with it.
class ValueReader {
 public:
  ValueReader(const Key& key, const ConfigNode& node, const std::filesystem::path& folder, Problems& problems)
      : key_(key), node_(node), folder_(folder), problems_(problems) {}

  /// @return whether `setting` now holds a value
  bool read(Setting& setting) {
    setting.key = &key_;
    setting.written = flow_text(node_);
    setting.file = node_.file;
    setting.line = node_.line;
    setting.folder = folder_;
    const std::size_t before = problems_.size();
    if (node_.kind == ConfigNode::Kind::empty) {
      refuse("*.value"_family, "has no value", example());
    } else if (key_.type == KeyType::pair) {
      read_pair(setting);
    } else if (key_.type == KeyType::list) {
      read_list(setting, node_);
    } else if (key_.type == KeyType::rows) {
      read_rows(setting);
    } else if (key_.type == KeyType::bits) {
      read_bits(setting);
    } else if (key_.type == KeyType::names) {
      read_names(setting);
    } else if (node_.kind != ConfigNode::Kind::scalar) {
      refuse("*.value"_family, "must be a single value", example());
    } else {
      read_scalar(setting);
    }
    return problems_.size() == before;
  }

 private:
  void read_scalar(Setting& setting) {
    setting.text = node_.text;
    switch (key_.type) {
      case KeyType::word:
        return check_word();
      case KeyType::text:
        return;
      case KeyType::choice:
        return check_choice();
      case KeyType::file:
        return check_file();
      case KeyType::integer:
        return read_integer(setting);
      case KeyType::quantity:
        if (is_choice()) return;
        setting.text.clear();
        setting.values[0] = read_number(node_);
        return;
      case KeyType::pair:
      case KeyType::list:
      case KeyType::rows:
      case KeyType::bits:
      case KeyType::names:
        return;  // read_pair, read_list, read_rows, read_bits, read_names
    }
  }

  void read_pair(Setting& setting) {
    const bool two = node_.kind == ConfigNode::Kind::list && node_.items.size() == 2;
    if (!two) return refuse("*.pair"_family, "must be a list of two values", example());
    setting.values = {read_number(node_.items[0]), read_number(node_.items[1])};
  }

  void read_list(Setting& setting, const ConfigNode& node) {
    if (node.kind != ConfigNode::Kind::list || node.items.empty())
      return refuse("*.list"_family, "must be a list of values", example());
    for (const ConfigNode& item : node.items) setting.many.push_back(read_number(item));
  }

  void read_rows(Setting& setting) {
    const auto columns = static_cast<std::size_t>(key_.columns);
    const bool fits = node_.kind == ConfigNode::Kind::list && !node_.items.empty() &&
                      std::all_of(node_.items.begin(), node_.items.end(), [&](const ConfigNode& row) {
                        return row.kind == ConfigNode::Kind::list && row.items.size() == columns;
                      });
    if (!fits)
      return refuse("*.rows"_family, fmt::format("must be a list of lists of {} values", columns), example());
    for (const ConfigNode& row : node_.items) read_list(setting, row);
  }

  void read_bits(Setting& setting) {
    const auto is_bit = [](const ConfigNode& node) { return node.text == "0" || node.text == "1"; };
    const auto is_row = [&](const ConfigNode& row) {
      return row.kind == ConfigNode::Kind::list && !row.items.empty() &&
             std::all_of(row.items.begin(), row.items.end(), is_bit);
    };
    if (node_.kind != ConfigNode::Kind::list || node_.items.empty() ||
        !std::all_of(node_.items.begin(), node_.items.end(), is_row))
      return refuse("*.bits"_family, "must be a list of lists of 0 and 1",
                    fmt::format("For instance {}: [[1, 0], [0, 1]]", last_name(key_.path)));
    for (const ConfigNode& row : node_.items) {
      if (!setting.text.empty()) setting.text += '/';
      for (const ConfigNode& bit : row.items) setting.text += bit.text;
    }
  }

  void read_names(Setting& setting) {
    if (node_.kind != ConfigNode::Kind::list || node_.items.empty())
      return refuse("*.list"_family, "must be a list of names", example());
    for (const ConfigNode& item : node_.items) {
      setting.names.push_back(item.text);
      if (key_.choices.empty() && !item.text.empty()) continue;
      if (std::find(key_.choices.begin(), key_.choices.end(), item.text) != key_.choices.end()) continue;
      const std::string near = nearest(item.text, key_.choices);
      problems_.push_back({"*.name"_family.of(key_.path), key_.path, flow_text(item), "is no name for it",
                           near.empty() ? key_.help : fmt::format("The nearest is {}.", near), item.file,
                           item.line});
    }
  }

  double read_number(const ConfigNode& node) {
    if (node.kind != ConfigNode::Kind::scalar) {
      refuse("*.value"_family, "must be a number", example());
      return 0.0;
    }
    const Reading reading = read_quantity(node.text, key_.unit);
    if (!reading.ok()) {
      refuse("*.unit"_family, reading.fault, reading.way_out);
      return 0.0;
    }
    check_range(reading.value);
    return reading.value;
  }

  void read_integer(Setting& setting) {
    setting.text.clear();
    const Reading reading = read_quantity(node_.text, "");
    if (!reading.ok()) return refuse("*.unit"_family, reading.fault, reading.way_out);
    if (reading.value != std::floor(reading.value))
      return refuse("*.integer"_family, "must be a whole number", example());
    check_range(reading.value);
    setting.values[0] = reading.value;
  }

  void check_range(double value) {
    const Interval interval = interval_of(key_.range, key_.unit);
    if (!interval.contains(value)) {
      refuse("*.range"_family, "must satisfy " + interval.rule(last_name(key_.path)), key_.help);
    }
  }

  void check_word() {
    const bool plain = std::all_of(node_.text.begin(), node_.text.end(), [](char c) {
      return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
             c == '-';
    });
    if (!plain || node_.text.empty()) {
      refuse("*.word"_family, "must be one word of letters, digits, _ and -",
             "Results go to a folder of this name.");
    }
  }

  bool is_choice() const {
    return std::find(key_.choices.begin(), key_.choices.end(), node_.text) != key_.choices.end();
  }

  void check_choice() {
    if (is_choice()) return;
    const std::string near = nearest(node_.text, key_.choices);
    refuse("*.choice"_family, "must be " + join_words(key_.choices, " or "),
           near.empty() ? key_.help : fmt::format("The nearest is {}.", near));
  }

  void check_file() {
    std::error_code ignored;  // a path that cannot be looked at is as good as absent
    if (std::filesystem::is_regular_file(folder_ / node_.text, ignored)) return;
    refuse("*.file"_family, "is not a file that can be read",
           "The path is relative to the folder of the configuration file.");
  }

  std::string example() const {
    if (!key_.default_text.empty())
      return fmt::format("For instance {}: {}", last_name(key_.path), key_.default_text);
    if (key_.type == KeyType::pair)
      return fmt::format("For instance {0}: [1 {1}, 2 {1}]", last_name(key_.path), key_.unit);
    if (key_.type == KeyType::list)
      return fmt::format("For instance {0}: [0 {1}, 45 {1}]", last_name(key_.path), key_.unit);
    if (key_.type == KeyType::names) return key_.help;
    if (!key_.choices.empty()) return "Known: " + join_words(key_.choices, ", ") + ".";
    return key_.help;
  }

  void refuse(RuleFamily id, const std::string& rule, const std::string& way_out) {
    problems_.push_back(
        {id.of(key_.path), key_.path, flow_text(node_), rule, way_out, node_.file, node_.line});
  }

  const Key& key_;
  const ConfigNode& node_;
  const std::filesystem::path& folder_;
  Problems& problems_;
};

/// A block that is no map stands for each key below it.
bool is_in_or_below(const std::set<std::string>& paths, const std::string& path) {
  return std::any_of(paths.begin(), paths.end(), [&](const std::string& failed) {
    return path == failed || path.starts_with(failed + ".");
  });
}

/// The keys of "friction.law=stribeck !friction.calibration.data".
std::vector<std::string> keys_in(const std::string& conditions) {
  std::vector<std::string> keys;
  std::istringstream stream(conditions);
  for (std::string term; stream >> term;) {
    const std::size_t negated = term.front() == '!' ? 1 : 0;
    keys.push_back(term.substr(negated, term.find('=') - negated));
  }
  return keys;
}

bool is_unknowable(const std::string& path, const std::set<std::string>& failed) {
  if (is_in_or_below(failed, path)) return true;
  const Key* key = find_key(path);
  if (key == nullptr) return false;
  const std::vector<std::string> deciding = keys_in(key->used_when);
  return std::any_of(deciding.begin(), deciding.end(),
                     [&](const std::string& one) { return is_unknowable(one, failed); });
}

/// Goes through what the user wrote, then through the schema for what is missing.
class ConfigReader {
 public:
  ConfigReader(ReadConfig& config, const std::filesystem::path& folder) : config_(config), folder_(folder) {}

  void read() {
    find_dropped();
    read_block(config_.root, "");
    find_stages();
    add_defaults();
    find_missing();
    note_unused();
    config_.failed = std::move(failed_);
  }

 private:
  /// Keys whose value the parser had to leave out are not missing as well.
  void find_dropped() {
    for (const Problem& problem : config_.problems)
      if (!problem.key.empty() && config_.root.find_path(problem.key) == nullptr) failed_.insert(problem.key);
  }

  void read_block(const ConfigNode& block, const std::string& path) {
    for (const ConfigNode::Entry& entry : block.entries) read_entry(entry, path);
  }

  void read_entry(const ConfigNode::Entry& entry, const std::string& block) {
    const std::string path = join_path(block, entry.key);
    const ConfigNode& value = entry.value;
    const int line = value.line == 0 ? 0 : entry.line;
    if (is_effect_left_out(entry, block)) return;
    if (const Key* key = find_key(path)) {
      if (key->presence == Presence::later) {
        report(path, "*.later"_family, value, line, "comes with a later version",
               key->help + " Leave it out for now.");
      } else {
        read_value(*key, value);
      }
    } else if (!is_block(path)) {
      const std::string near = nearest(entry.key, names_below(block));
      // What was meant is then not missing as well.
      if (!near.empty()) failed_.insert(join_path(block, near));
      report(path, "*.unknown"_family, value, line, "is not a known key",
             way_out_of_unknown(block, entry.key, near));
    } else if (value.kind == ConfigNode::Kind::map || value.kind == ConfigNode::Kind::empty) {
      config_.settings.blocks.insert(path);
      read_block(value, path);
    } else {
      failed_.insert(path);
      report(path, "*.map"_family, value, line, "must be a map of keys and values",
             fmt::format("Known below it: {}.{}", join_words(names_below(path), ", "),
                         block == "effects" ? " Or off, to leave the effect out." : ""));
    }
  }

  /// `ID: off` is as good as no ID at all.
  static bool is_effect_left_out(const ConfigNode::Entry& entry, const std::string& block) {
    const std::string path = join_path(block, entry.key);
    return block == "effects" && (is_block(path) || find_key(path) != nullptr) &&
           entry.value.kind == ConfigNode::Kind::scalar && entry.value.text == "off";
  }

  void read_value(const Key& key, const ConfigNode& node) {
    Setting setting;
    if (ValueReader(key, node, folder_, config_.problems).read(setting)) {
      config_.settings.add(std::move(setting));
    } else {
      failed_.insert(key.path);
      config_.settings.blocks.insert(key.path);
    }
  }

  bool given(const std::string& block) const { return config_.root.find(block) != nullptr; }

  /// A stage runs when one of its blocks is there; the stages it feeds on run too. A file with no block at
  /// all is meant to be a cell.
  void find_stages() {
    std::set<Stage>& stages = config_.settings.stages;
    stages.insert(Stage::always);
    if (given("blank") || given("tools") || given("process")) stages.insert(Stage::stamping);
    if (given("orientation_study")) {
      stages.insert(Stage::orientation_study);
      stages.insert(Stage::stamping);
    }
    if (stages.count(Stage::stamping) > 0) stages.insert(Stage::grid_error);
    if (given("friction_test")) stages.insert(Stage::friction_test);
    if (given("calibrate")) stages.insert(Stage::calibrate);
    if (given("discover")) stages.insert(Stage::discover);
    if (given("friction") || stages.size() > 1) stages.insert(Stage::friction);
    if (given("study")) {
      stages.insert(Stage::study);
      stages.insert(Stage::cell);
    }
    const bool voxels = config_.root.find_path("cell.voxels") != nullptr;
    const bool weave =
        given("weave") || (given("cell") && !voxels) || given("fabric") || given("forming") || given("solid");
    const ConfigNode* pressure = config_.root.find_path("friction.contact_pressure");
    const bool nominal = pressure != nullptr && pressure->text == "nominal";
    const bool friction_needs_area = stages.count(Stage::friction) > 0 && !nominal;
    const bool nothing_else = stages.size() == 1 && !voxels;
    if (weave || stages.count(Stage::stamping) > 0 || friction_needs_area || nothing_else) {
      stages.insert(Stage::cell);
    }
    if (given("solid")) stages.insert(Stage::solid);
    if (voxels) stages.insert(Stage::voxels);
  }

  bool stage_runs(const Key& key) const { return config_.settings.stages.count(key.stage) > 0; }

  void add_defaults() {
    for (const Key& key : schema()) {
      if (key.presence != Presence::defaulted || config_.settings.has(key.path) ||
          failed_.count(key.path) > 0)
        continue;
      if (!stage_runs(key) || !is_used(key, config_.settings)) continue;
      config_.settings.add(default_of(key));
    }
  }

  Setting default_of(const Key& key) const {
    ConfigNode node;
    node.kind = ConfigNode::Kind::scalar;
    node.text = key.default_text;
    Problems problems;
    Setting setting;
    if (!ValueReader(key, node, folder_, problems).read(setting)) {
      throw std::logic_error("the schema's default of " + key.path +
                             " breaks its own rule: " + format(problems));
    }
    return setting;
  }

  void find_missing() {
    std::set<std::string> missing;
    for (const Key& key : schema()) {
      if (key.presence != Presence::required || config_.settings.has(key.path)) continue;
      if (is_in_or_below(failed_, key.path) || !stage_runs(key) || !is_used(key, config_.settings)) continue;
      const ConfigNode& parent = nearest_block(key.path);
      config_.problems.push_back({"*.required"_family.of(key.path), key.path, "",
                                  "is required" + because(key), key.help, parent.file, parent.line});
      missing.insert(key.path);
    }
    failed_.merge(missing);
  }

  std::string because(const Key& key) const {
    switch (key.stage) {
      case Stage::stamping:
        return " to stamp a part";
      case Stage::friction_test:
        return " by the friction test";
      case Stage::orientation_study:
        return " by the orientation study";
      case Stage::grid_error:
        return " for the grid error";
      case Stage::study:
        return " by `heddle study`";
      case Stage::calibrate:
        return " by `heddle calibrate`";
      case Stage::discover:
        return " by `heddle discover`";
      case Stage::always:
        return "";
      case Stage::cell:
        return " to build the cell";
      case Stage::solid:
        return " for the solid part";
      case Stage::voxels:
        return key.used_when.empty() ? " for a voxel cell" : " when " + readable(key.used_when);
      case Stage::friction:
        return key.used_when.empty() ? " for friction" : " when " + readable(key.used_when);
    }
    return "";
  }

  static std::string readable(const std::string& conditions) {
    std::vector<std::string> words;
    std::istringstream stream(conditions);
    for (std::string term; stream >> term;) {
      const std::size_t equals = term.find('=');
      if (equals != std::string::npos) {
        const std::size_t start = term.front() == '!' ? 1 : 0;
        words.push_back(term.substr(start, equals - start) + (start == 1 ? " is not " : " is ") +
                        term.substr(equals + 1));
      } else if (term.front() == '!') {
        words.push_back(term.substr(1) + " is not given");
      } else {
        words.push_back(term + " is given");
      }
    }
    return join_words(words, " and ");
  }

  const ConfigNode& nearest_block(const std::string& path) const {
    const ConfigNode* node = &config_.root;
    std::string rest = path;
    for (std::size_t dot = rest.find('.'); dot != std::string::npos; dot = rest.find('.')) {
      const ConfigNode* below = node->find(rest.substr(0, dot));
      if (below == nullptr) break;
      node = below;
      rest.erase(0, dot + 1);
    }
    return *node;
  }

  void note_unused() {
    for (const Key& key : schema()) {
      const Setting* setting = config_.settings.find(key.path);
      if (setting == nullptr || setting->is_default()) continue;
      if (!is_used(key, config_.settings)) {
        const std::string place = setting->line > 0 ? fmt::format("line {}", setting->line) : setting->file;
        config_.notes.push_back(
            fmt::format("{} ({}) is not used: it counts when {}", key.path, place, readable(key.used_when)));
      }
    }
  }

  void report(const std::string& path, RuleFamily id, const ConfigNode& value, int line,
              const std::string& rule, const std::string& way_out) {
    config_.problems.push_back({id.of(path), path, flow_text(value), rule, way_out, value.file, line});
  }

  ReadConfig& config_;
  const std::filesystem::path& folder_;
  std::set<std::string> failed_;
};

/// YAML scalar that reads back as the same text.
std::string quoted_where_needed(const std::string& text) {
  const bool plain =
      !text.empty() && text.front() != '-' && std::all_of(text.begin(), text.end(), [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
               std::string_view("_-./ ").find(c) != std::string_view::npos;
      });
  if (plain && text.back() != ' ' && text.front() != ' ' && text != "null" && text != "Null" &&
      text != "NULL")
    return text;
  std::string quoted = "'";
  for (const char c : text) quoted += c == '\'' ? std::string("''") : std::string(1, c);
  return quoted + "'";
}

std::string list_text(std::vector<double>::const_iterator begin, std::vector<double>::const_iterator end,
                      const std::string& unit) {
  std::string text;
  for (auto value = begin; value != end; ++value)
    text += (value == begin ? "" : ", ") + write_quantity(*value, unit);
  return "[" + text + "]";
}

/// All settings below a block ("" or "weave."), each block once: the schema lists some keys of a block after
/// those of others.
std::string block_text(const std::vector<const Setting*>& settings, const std::string& block) {
  const auto depth = static_cast<std::size_t>(std::count(block.begin(), block.end(), '.'));
  std::set<std::string> written;
  std::string text;
  for (const Setting* setting : settings) {
    const std::string& path = setting->key->path;
    if (!path.starts_with(block)) continue;
    const std::size_t dot = path.find('.', block.size());
    const std::string name = path.substr(block.size(), dot - block.size());
    if (!written.insert(name).second) continue;
    text += std::string(2 * depth, ' ') + name + ":";
    text += dot == std::string::npos ? " " + resolved_value(*setting) + "\n"
                                     : "\n" + block_text(settings, block + name + ".");
  }
  return text;
}

}  // namespace

void Settings::add(Setting setting) {
  settings_[setting.key->path] = std::move(setting);
}

const Setting* Settings::find(const std::string& path) const {
  const auto found = settings_.find(path);
  return found == settings_.end() ? nullptr : &found->second;
}

const Setting& Settings::get(const std::string& path) const {
  const Setting* setting = find(path);
  if (setting == nullptr) throw std::logic_error("no value of " + path + " was read");
  return *setting;
}

double Settings::number(const std::string& path) const {
  const Setting& setting = get(path);
  if (!setting.text.empty()) throw std::logic_error(path + " holds a word, not a number");
  return setting.values[0];
}

int Settings::integer(const std::string& path) const {
  return static_cast<int>(number(path));
}

std::array<double, 2> Settings::pair(const std::string& path) const {
  return get(path).values;
}

const std::vector<double>& Settings::many(const std::string& path) const {
  return get(path).many;
}

const std::vector<std::string>& Settings::names(const std::string& path) const {
  return get(path).names;
}

const std::string& Settings::text(const std::string& path) const {
  return get(path).text;
}

bool is_used(const Key& key, const Settings& settings) {
  std::istringstream conditions(key.used_when);
  for (std::string term; conditions >> term;) {
    const std::size_t equals = term.find('=');
    const bool negated = term.front() == '!';
    const std::size_t start = negated ? 1 : 0;
    const std::string path = term.substr(start, equals == std::string::npos ? equals : equals - start);
    bool holds = false;
    if (equals != std::string::npos) {
      holds = settings.is(path, term.substr(equals + 1)) != negated;
    } else {
      holds = (settings.has(path) || settings.blocks.count(path) > 0) != negated;
    }
    if (!holds) return false;
  }
  return true;
}

ReadConfig read_config(const std::string& text, const std::string& file, const std::filesystem::path& folder,
                       const std::vector<std::string>& assignments) {
  ParsedConfig parsed = parse_config(text, file);
  ReadConfig config;
  config.root = std::move(parsed.root);
  config.problems = std::move(parsed.problems);
  const bool readable =
      std::none_of(config.problems.begin(), config.problems.end(),
                   [](const Problem& problem) { return problem.id.text().starts_with("yaml."); });
  int number = 0;
  for (const std::string& assignment : assignments) {
    for (Problem& problem : apply_setting(config.root, assignment, fmt::format("--set #{}", ++number))) {
      config.problems.push_back(std::move(problem));
    }
  }
  // Half a file would only give problems that vanish with the first one.
  if (readable) ConfigReader(config, folder).read();
  return config;
}

void sort_by_place(Problems& problems, const std::string& file) {
  const auto place = [&](const Problem& problem) {
    // "--set #2" before "--set #10"; the file itself before both.
    const std::size_t rank = problem.file == file ? 0 : 1;
    return std::make_tuple(rank, problem.file.size(), problem.file);
  };
  std::stable_sort(problems.begin(), problems.end(),
                   [&](const Problem& a, const Problem& b) { return place(a) < place(b); });
}

void drop_unknowable(Problems& problems, const std::set<std::string>& failed) {
  std::erase_if(problems, [&](const Problem& problem) {
    return is_unknowable(problem.key, failed) ||
           std::any_of(problem.others.begin(), problem.others.end(),
                       [&](const std::string& other) { return is_unknowable(other, failed); });
  });
}

void locate(Problems& problems, const ReadConfig& config) {
  for (Problem& problem : problems) {
    if (!problem.file.empty()) continue;
    const ConfigNode* node = config.root.find_path(problem.key);
    for (std::string path = problem.key; node == nullptr; node = config.root.find_path(path)) {
      path.erase(path.find('.') == std::string::npos ? 0 : path.rfind('.'));
    }
    problem.file = node->file;
    problem.line = node->line;
    if (problem.value.empty()) {
      const Setting* setting = config.settings.find(problem.key);
      if (setting != nullptr) problem.value = setting->written;
    }
  }
}

std::string resolved_value(const Setting& setting) {
  const Key& key = *setting.key;
  switch (key.type) {
    case KeyType::word:
    case KeyType::text:
    case KeyType::choice:
      return quoted_where_needed(setting.text);
    case KeyType::file:
      return quoted_where_needed(resolved_file_name(setting));
    case KeyType::integer:
      return fmt::format("{:.0f}", setting.values[0]);
    case KeyType::quantity:
      return setting.text.empty() ? write_quantity(setting.values[0], key.unit)
                                  : quoted_where_needed(setting.text);
    case KeyType::pair:
      return fmt::format("[{}, {}]", write_quantity(setting.values[0], key.unit),
                         write_quantity(setting.values[1], key.unit));
    case KeyType::list:
      return list_text(setting.many.begin(), setting.many.end(), key.unit);
    case KeyType::bits: {
      std::string rows;
      for (const char c : setting.text)
        rows += c == '/' ? "], [" : (rows.empty() || rows.back() == '[' ? "" : ", ") + std::string(1, c);
      return "[[" + rows + "]]";
    }
    case KeyType::names:
      return "[" + join_words(setting.names, ", ") + "]";
    case KeyType::rows: {
      std::string rows;
      for (auto row = setting.many.begin(); row != setting.many.end(); row += key.columns)
        rows += (rows.empty() ? "" : ", ") + list_text(row, row + key.columns, key.unit);
      return "[" + rows + "]";
    }
  }
  return "";
}

std::string resolved_file_name(const Setting& setting) {
  return "inputs/" + setting.key->path + std::filesystem::path(setting.text).extension().string();
}

std::string resolved_yaml(const Settings& settings) {
  std::vector<const Setting*> given;
  for (const Key& key : schema())
    if (const Setting* setting = settings.find(key.path)) given.push_back(setting);
  return block_text(given, "");
}

}  // namespace heddle::pipeline
