#include "pipeline/stamping_study_keys.h"

#include <algorithm>
#include <cctype>
#include <set>

#include <fmt/format.h>

#include "pipeline/key_table.h"
#include "pipeline/value_reader.h"

namespace heddle::pipeline {

// clang-format off
std::vector<Key> stamping_study_keys() {
  const auto stage = Stage::stamping;
  return {
      {.path = "stamping_study.binder_force", .type = KeyType::list, .unit = "N", .presence = optional,
       .range = "(0 N, )", .stage = stage,
       .help = "Forces in place of process.binder_force, for the case as given."},
      {.path = "stamping_study.speed_scale", .type = KeyType::list, .presence = optional, .range = "(0, )",
       .stage = stage, .help = "Values in place of process.punch.speed_scale, for the case as given and every model."},
      {.path = "stamping_study.models", .type = KeyType::names, .presence = optional, .stage = stage,
       .help = "The case with keys set, each as 'NAME: KEY=VALUE; KEY=VALUE', stamped at every speed."},
      {.path = "stamping_study.vary", .type = KeyType::names, .presence = optional, .stage = stage,
       .help = "Keys and the values they take, each as 'KEY: VALUE; VALUE' and one after the other; 'KEY: VALUE; VALUE & KEY: VALUE; VALUE' takes every combination."},
  };
}
// clang-format on

namespace {

template <class Value>
bool holds_one_twice(std::vector<Value> values) {
  std::sort(values.begin(), values.end());
  return std::adjacent_find(values.begin(), values.end()) != values.end();
}

std::string trimmed(const std::string& text) {
  const auto first = text.find_first_not_of(' '), last = text.find_last_not_of(' ');
  return first == std::string::npos ? "" : text.substr(first, last - first + 1);
}

std::vector<std::string> parts_of(const std::string& text, char between) {
  std::vector<std::string> parts;
  for (std::size_t begin = 0, end = 0; end != std::string::npos; begin = end + 1) {
    end = text.find(between, begin);
    parts.push_back(trimmed(text.substr(begin, end == std::string::npos ? end : end - begin)));
  }
  return parts;
}

// "KEY: VALUE; VALUE & KEY: VALUE; VALUE"; empty where the text is none.
std::vector<VariedKey> variation_of(const std::string& text) {
  std::vector<VariedKey> variation;
  for (const std::string& part : parts_of(text, '&')) {
    const std::size_t colon = part.find(':');
    if (colon == std::string::npos) return {};
    VariedKey varied{trimmed(part.substr(0, colon)), parts_of(part.substr(colon + 1), ';')};
    const bool whole = !varied.key.empty() && std::none_of(varied.values.begin(), varied.values.end(),
                                                           [](const std::string& v) { return v.empty(); });
    if (!whole) return {};
    variation.push_back(std::move(varied));
  }
  return variation;
}

// "NAME: KEY=VALUE; KEY=VALUE"; no name where the text is none.
StudyModel model_of(const std::string& text) {
  StudyModel model;
  const std::size_t colon = text.find(':');
  if (colon == std::string::npos) return {};
  model.name = trimmed(text.substr(0, colon));
  const auto letter = [](unsigned char c) { return std::isalnum(c) != 0 || c == '_' || c == '-'; };
  if (!std::all_of(model.name.begin(), model.name.end(), letter)) return {};
  std::string rest = text.substr(colon + 1);
  for (std::size_t end = 0; end != std::string::npos;) {
    end = rest.find(';');
    const std::string assignment = trimmed(rest.substr(0, end));
    if (assignment.find('=') == std::string::npos) return {};
    model.assignments.push_back(assignment);
    rest = end == std::string::npos ? "" : rest.substr(end + 1);
  }
  return model;
}

}  // namespace

std::optional<StampingStudySpec> stamping_study_of(const Settings& settings) {
  if (settings.blocks.count("stamping_study") == 0) return std::nullopt;
  StampingStudySpec spec;
  if (settings.has("stamping_study.binder_force"))
    spec.binder_forces = settings.many("stamping_study.binder_force");
  if (settings.has("stamping_study.speed_scale"))
    spec.speed_scales = settings.many("stamping_study.speed_scale");
  spec.models.push_back({"given", {}});
  if (settings.has("stamping_study.models"))
    for (const std::string& text : settings.names("stamping_study.models")) {
      StudyModel model = model_of(text);
      if (model.name.empty())
        spec.refused.push_back(text);
      else
        spec.models.push_back(std::move(model));
    }
  if (settings.has("stamping_study.vary")) spec.variation_texts = settings.names("stamping_study.vary");
  for (const std::string& text : spec.variation_texts) spec.variations.push_back(variation_of(text));
  return spec;
}

std::vector<std::string> varied_keys(const StampingStudySpec& spec) {
  std::vector<std::string> keys;
  for (const auto& variation : spec.variations)
    for (const VariedKey& varied : variation)
      if (std::find(keys.begin(), keys.end(), varied.key) == keys.end()) keys.push_back(varied.key);
  return keys;
}

std::vector<std::vector<std::string>> combinations(const std::vector<VariedKey>& variation) {
  std::vector<std::vector<std::string>> all{{}};
  for (const VariedKey& varied : variation) {
    std::vector<std::vector<std::string>> longer;
    for (const auto& begun : all)
      for (const std::string& value : varied.values) {
        longer.push_back(begun);
        longer.back().push_back(value);
      }
    all = std::move(longer);
  }
  return all;
}

std::string id_of(const std::vector<VariedKey>& variation, const std::vector<std::string>& values) {
  std::string id;
  for (std::size_t k = 0; k < variation.size(); ++k) {
    std::string key = variation[k].key, value = values[k];
    std::replace(key.begin(), key.end(), '.', '-');
    std::replace(value.begin(), value.end(), '.', 'p');
    std::erase_if(value, [](unsigned char c) { return std::isalnum(c) == 0 && c != '-' && c != '_'; });
    id += (k == 0 ? "" : "_") + key + "-" + value;
  }
  return id;
}

namespace {

constexpr std::size_t most_stampings = 500;

/// What is wrong with one variation, by itself.
void check_variation(const std::vector<VariedKey>& variation, const std::string& text, Problems& problems) {
  const std::string place = "stamping_study.vary";
  if (variation.empty()) {
    problems.push_back({"stamping_study.vary.form"_rule, place, text,
                        "is no variation: a key, a colon, and values with ; between them",
                        "For instance 'tools.die.friction_coefficient: 0; 0.25; 0.5'."});
    return;
  }
  std::size_t count = 1;
  for (const VariedKey& varied : variation) {
    count *= varied.values.size();
    const Key* key = find_key(varied.key);
    const bool single =
        key && key->presence != Presence::later && !varied.key.starts_with("stamping_study.") &&
        (key->type == KeyType::quantity || key->type == KeyType::integer || key->type == KeyType::choice);
    if (!single) {
      problems.push_back(
          {"stamping_study.vary.key"_rule, place, varied.key,
           key ? "is no key of a single number or word" : "is no key",
           "docs/reference/config.md lists all keys; what takes more than one key is a model."});
      continue;
    }
    for (const std::string& value : varied.values) {
      ConfigNode node;
      node.kind = ConfigNode::Kind::scalar;
      node.text = value;
      Setting setting;
      Problems of_value;
      read_value(*key, node, {}, setting, of_value);
      for (Problem& problem : of_value) {
        problem.key = place;
        problem.value = varied.key + ": " + value;
        problem.file.clear();
        problems.push_back(std::move(problem));
      }
    }
  }
  if (count > most_stampings) {
    problems.push_back({"stamping_study.vary.many"_rule, place, fmt::format("{} combinations", count),
                        fmt::format("must give at most {} stampings", most_stampings),
                        "Vary one key after the other: each in a line of its own."});
    return;
  }
  std::set<std::string> seen;
  for (const auto& values : combinations(variation))
    if (!seen.insert(id_of(variation, values)).second)
      problems.push_back({"*.distinct"_family.of(place), place, fmt::format("{}", fmt::join(values, ", ")),
                          "must not hold a value twice", "Leave the second one out."});
}

void check_variations(const StampingStudySpec& spec, const ConfigNode& root, Problems& problems) {
  const ConfigNode* node = root.find_path("stamping_study.vary");
  std::set<std::string> seen;
  for (std::size_t k = 0; k < spec.variations.size(); ++k) {
    Problems here;
    check_variation(spec.variations[k], spec.variation_texts[k], here);
    std::string keys;
    for (const VariedKey& varied : spec.variations[k]) keys += varied.key + " ";
    if (here.empty() && !seen.insert(keys).second)
      here.push_back({"*.distinct"_family.of("stamping_study.vary"), "stamping_study.vary", keys,
                      "must not vary the same keys twice", "Put all values into one line."});
    for (Problem& problem : here) {
      if (node && k < node->items.size()) {
        problem.file = node->items[k].file;
        problem.line = node->items[k].line;
      }
      problems.push_back(std::move(problem));
    }
  }
}

}  // namespace

Problems check_stamping_study(const StampingStudySpec& spec, const ConfigNode& root) {
  Problems problems;
  const auto distinct = [&](bool holds, const std::string& key) {
    if (!holds)
      problems.push_back(
          {"*.distinct"_family.of(key), key, "", "must not hold a value twice", "Leave the second one out."});
  };
  std::vector<std::string> names;
  for (const StudyModel& model : spec.models) names.push_back(model.name);
  distinct(!holds_one_twice(spec.binder_forces), "stamping_study.binder_force");
  distinct(!holds_one_twice(spec.speed_scales), "stamping_study.speed_scale");
  distinct(!holds_one_twice(names), "stamping_study.models");
  for (const std::string& text : spec.refused)
    problems.push_back(
        {"stamping_study.models.form"_rule, "stamping_study.models", text,
         "is no model: a name, a colon, and keys as --set takes them",
         "For instance 'coulomb: friction={law: coulomb, coefficient: 0.3}; fabric.shear_rate=off'."});
  check_variations(spec, root, problems);
  if (spec.binder_forces.empty() && spec.speed_scales.empty() && spec.variations.empty())
    problems.push_back({"stamping_study.varies"_rule, "stamping_study", "", "changes nothing",
                        "Give binder_force or speed_scale a list of values, or vary other keys."});
  return problems;
}

}  // namespace heddle::pipeline
