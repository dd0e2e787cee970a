#include "pipeline/settings.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <sstream>
#include <stdexcept>
#include <string_view>

#include "core/units.h"

namespace heddle::pipeline {

namespace {

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
    case KeyType::names: {
      std::string names;
      for (const std::string& name : setting.names)
        names += (names.empty() ? "" : ", ") + quoted_where_needed(name);
      return "[" + names + "]";
    }
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
