#include "pipeline/study_keys.h"

#include <algorithm>

#include "pipeline/key_table.h"

namespace heddle::pipeline {
namespace {

namespace study = mesoscale::study;

template <class Value>
void check_distinct(Problems& problems, std::vector<Value> values, const std::string& key) {
  std::sort(values.begin(), values.end());
  if (std::adjacent_find(values.begin(), values.end()) != values.end())
    problems.push_back(
        {"*.distinct"_family.of(key), key, "", "must not hold a value twice", "Leave the second one out."});
}

}  // namespace

// A table reads better in rows than one field a line.
// clang-format off
std::vector<Key> cell_study_keys() {
  const auto stage = Stage::study;
  return {
      {.path = "study.pattern", .type = KeyType::names, .presence = optional, .stage = stage,
       .help = "Weaves beside weave.pattern, for instance [twill 2/2, satin 5/2, matrix 110/011/101]."},
      {.path = "study.tow_width", .type = KeyType::list, .unit = "mm", .presence = optional, .range = "(0 mm, 100 mm)",
       .stage = stage, .help = "Widths in place of weave.tow_width."},
      {.path = "study.gap", .type = KeyType::list, .unit = "mm", .presence = optional, .range = "[0 mm, 100 mm)",
       .stage = stage, .help = "Gaps in place of weave.gap."},
      {.path = "study.tow_thickness", .type = KeyType::list, .unit = "mm", .presence = optional,
       .range = "(0 mm, 20 mm)", .stage = stage,
       .help = "Thicknesses in place of weave.tow_thickness; the fabric's thickness follows."},
      {.path = "study.shear_angle", .type = KeyType::list, .unit = "deg", .presence = optional,
       .range = "[0 deg, 60 deg]", .stage = stage,
       .help = "Trellis angles at which every weave is looked at; 0 deg alone where left out."},
      {.path = "study.design", .type = KeyType::choice, .presence = defaulted, .default_text = "one_at_a_time",
       .choices = {"one_at_a_time", "crossed"}, .stage = stage,
       .help = "one_at_a_time: each value beside the weave given; crossed: every combination."},
      {.path = "study.sensitivities", .type = KeyType::choice, .presence = defaulted, .default_text = "on",
       .choices = {"on", "off"}, .stage = stage,
       .help = "First-order change of each property with tow_width, gap and tow_thickness."},
      {.path = "study.step", .type = KeyType::quantity, .unit = "%", .presence = defaulted, .default_text = "0.5 %",
       .range = "(0, 0.05]", .stage = stage, .used_when = "study.sensitivities=on",
       .help = "Of their central differences: of the tow width for width and gap, of itself for the thickness."},
  };
}
// clang-format on

study::StudySpec study_of(const Settings& settings) {
  study::StudySpec spec;
  if (settings.has("study.pattern")) spec.patterns = settings.names("study.pattern");
  for (const study::Dimension dimension : study::dimensions)
    if (const std::string key = "study." + study::name_of(dimension); settings.has(key))
      spec.values[static_cast<std::size_t>(dimension)] = settings.many(key);
  if (settings.has("study.shear_angle")) spec.shear_angles = settings.many("study.shear_angle");
  if (settings.is("study.design", "crossed")) spec.design = study::Design::crossed;
  spec.sensitivities = !settings.is("study.sensitivities", "off");
  if (settings.has("study.step")) spec.step = settings.number("study.step");
  return spec;
}

Problems check_study(const study::StudySpec& spec, const mesoscale::CellSpec& cell) {
  Problems problems;
  check_distinct(problems, spec.patterns, "study.pattern");
  for (const study::Dimension dimension : study::dimensions)
    check_distinct(problems, spec.values[static_cast<std::size_t>(dimension)],
                   "study." + study::name_of(dimension));
  check_distinct(problems, spec.shear_angles, "study.shear_angle");
  // A weave that is wrong by itself is said already, and would be said again for each cell.
  if (!mesoscale::check(cell).empty()) return problems;
  for (Problem& problem : study::check(spec, cell)) problems.push_back(std::move(problem));
  return problems;
}

}  // namespace heddle::pipeline
