#include "pipeline/stamping_study_keys.h"

#include <algorithm>
#include <cctype>

namespace heddle::pipeline {

// clang-format off
std::vector<Key> stamping_study_keys() {
  const auto stage = Stage::stamping;
  const auto optional = Presence::optional;
  return {
      {.path = "stamping_study.binder_force", .type = KeyType::list, .unit = "N", .presence = optional,
       .range = "(0 N, )", .stage = stage,
       .help = "Forces in place of process.binder_force, for the case as given."},
      {.path = "stamping_study.speed_scale", .type = KeyType::list, .presence = optional, .range = "(0, )",
       .stage = stage, .help = "Values in place of process.punch.speed_scale, for the case as given and every model."},
      {.path = "stamping_study.models", .type = KeyType::names, .presence = optional, .stage = stage,
       .help = "The case with keys set, each as 'NAME: KEY=VALUE; KEY=VALUE', stamped at every speed."},
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
  return spec;
}

Problems check_stamping_study(const StampingStudySpec& spec) {
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
  if (spec.binder_forces.empty() && spec.speed_scales.empty())
    problems.push_back({"stamping_study.varies"_rule, "stamping_study", "", "changes nothing",
                        "Give binder_force or speed_scale a list of values."});
  return problems;
}

}  // namespace heddle::pipeline
