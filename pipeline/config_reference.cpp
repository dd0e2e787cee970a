#include "pipeline/config_reference.h"

#include <fmt/format.h>

#include <set>
#include <utility>
#include <vector>

#include "core/units.h"
#include "pipeline/config_schema.h"

namespace heddle::pipeline {
namespace {

constexpr const char* introduction =
    "# Configuration keys\n"
    "\n"
    "Written by `heddle check --reference` from the table that validates every file. Values carry their "
    "unit\n"
    "(`gap: 0.75 mm`); any unit of the same kind is taken, and 0.75 mm is exactly 0.75e-3 m. Temperatures "
    "are in\n"
    "degC or K, differences of temperature in K, fractions plain or in %.\n"
    "`--set PATH=VALUE` changes a key for one run. A stage runs when one of its blocks is there: `weave`, "
    "`friction`,\n"
    "`friction_test`, or `blank`, `tools` and `process` together. An effect acts when its block is there and "
    "is\n"
    "not `off`: `effects: {tool_temperature_shift: off}` is the same as no such line.\n";

std::string top_block(const std::string& path) {
  return path.substr(0, path.find('.'));
}

std::string value_column(const Key& key) {
  switch (key.type) {
    case KeyType::word:
      return "word";
    case KeyType::text:
      return "text";
    case KeyType::integer:
      return "whole number";
    case KeyType::file:
      return "file";
    case KeyType::names:
      return key.choices.empty() ? "[text, ...]" : "[key, ...]";
    case KeyType::bits:
      return "[[0 or 1, ...], ...]";
    case KeyType::pair:
      return fmt::format("[{0}, {0}]", key.unit);
    case KeyType::list:
      return fmt::format("[{0}, ...]", key.unit);
    case KeyType::rows: {
      std::string row = key.unit;
      for (int k = 1; k < key.columns; ++k) row += ", " + key.unit;
      return fmt::format("[[{}], ...]", row);
    }
    case KeyType::quantity:
    case KeyType::choice:
      break;
  }
  std::string text = key.type == KeyType::choice ? "" : key.unit.empty() ? "number" : key.unit;
  for (const std::string& choice : key.choices)
    text += (text.empty() ? "" : " or ") + fmt::format("`{}`", choice);
  return text;
}

std::string default_column(const Key& key) {
  switch (key.presence) {
    case Presence::required:
      return "required";
    case Presence::defaulted:
      return fmt::format("`{}`", key.default_text);
    case Presence::optional:
    case Presence::later:
      return "none";
  }
  return "";
}

/// What the key means, and the conditions under which it counts.
std::string help_column(const Key& key) {
  return key.used_when.empty() ? key.help : fmt::format("{} Used when `{}`.", key.help, key.used_when);
}

std::string row(const Key& key) {
  if (!key.family.empty())
    return fmt::format("| `{}` | pair in the unit of KEY | {} | | {} |\n", key.family, default_column(key),
                       help_column(key));
  return fmt::format("| `{}` | {} | {} | {} | {} |\n", key.path, value_column(key), default_column(key),
                     key.range, help_column(key));
}

}  // namespace

std::string config_reference() {
  std::string text = introduction;
  std::string block;
  std::vector<std::pair<std::string, std::string>> later;  // why, and the keys
  std::set<std::string> families;
  for (const Key& key : schema()) {
    if (key.presence == Presence::later) {
      if (later.empty() || later.back().first != key.help) later.emplace_back(key.help, "");
      std::string& listed = later.back().second;
      listed += (listed.empty() ? "`" : ", `") + key.path + "`";
      continue;
    }
    const bool alone = key.path.find('.') == std::string::npos;
    const std::string heading = alone ? "case" : top_block(key.path);
    if (heading != block) {
      text += fmt::format("\n## {}\n\n| key | value | default | range | |\n|---|---|---|---|---|\n", heading);
      block = heading;
    }
    if (key.family.empty() || families.insert(key.family).second) text += row(key);
  }
  text += "\n## Known, not read by this version\n";
  for (const auto& [why, listed] : later) text += fmt::format("\n{} {}\n", why, listed);
  return text;
}

}  // namespace heddle::pipeline
