#include "pipeline/value_reader.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/units.h"

namespace heddle::pipeline {

namespace {

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
    refuse("*.choice"_family, fmt::format("must be {}", fmt::join(key_.choices, " or ")),
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
    if (!key_.choices.empty()) return fmt::format("Known: {}.", fmt::join(key_.choices, ", "));
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

}  // namespace

bool read_value(const Key& key, const ConfigNode& node, const std::filesystem::path& folder, Setting& setting,
                Problems& problems) {
  return ValueReader(key, node, folder, problems).read(setting);
}

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

std::string last_name(const std::string& path) {
  return path.substr(path.rfind('.') + 1);
}

std::string flow_text(const ConfigNode& node) {
  if (node.kind == ConfigNode::Kind::scalar) return node.text;
  if (node.kind == ConfigNode::Kind::map) return "{...}";
  if (node.kind == ConfigNode::Kind::empty) return "";
  std::vector<std::string> items;
  for (const ConfigNode& item : node.items) items.push_back(flow_text(item));
  return fmt::format("[{}]", fmt::join(items, ", "));
}

}  // namespace heddle::pipeline
