#include "pipeline/config_reader.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <sstream>
#include <tuple>

#include "pipeline/value_reader.h"

namespace heddle::pipeline {

namespace {

std::string join_path(const std::string& parent, const std::string& name) {
  return parent.empty() ? name : parent + "." + name;
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
  return fmt::format("Known here: {}.", fmt::join(read_now, ", "));
}

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
        read_given(*key, value);
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
             fmt::format("Known below it: {}.{}", fmt::join(names_below(path), ", "),
                         block == "effects" ? " Or off, to leave the effect out." : ""));
    }
  }

  /// `ID: off` is as good as no ID at all.
  static bool is_effect_left_out(const ConfigNode::Entry& entry, const std::string& block) {
    const std::string path = join_path(block, entry.key);
    return block == "effects" && (is_block(path) || find_key(path) != nullptr) &&
           entry.value.kind == ConfigNode::Kind::scalar && entry.value.text == "off";
  }

  void read_given(const Key& key, const ConfigNode& node) {
    Setting setting;
    if (read_value(key, node, folder_, setting, config_.problems)) {
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
    if (given("blank") || given("tools") || given("process") || given("stamping_study"))
      stages.insert(Stage::stamping);
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
    if (!read_value(key, node, folder_, setting, problems)) {
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
    return fmt::format("{}", fmt::join(words, " and "));
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

}  // namespace

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

}  // namespace heddle::pipeline
