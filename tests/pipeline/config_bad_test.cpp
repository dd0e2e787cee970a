#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "core/text_file.h"
#include "pipeline/case.h"

using namespace heddle;

namespace {

const std::filesystem::path folder = std::filesystem::path(HEDDLE_SOURCE_DIR) / "tests/pipeline/bad";

using Place = std::pair<std::string, int>;  ///< rule and line

struct BadFile {
  const char* name;
  std::vector<Place> problems;  ///< all that are found, in the order printed
};

const std::vector<BadFile> bad_files{
    {"alias", {{"resin.power_index.anchor", 4}, {"forming.bonding.alias", 5}}},
    {"anchor", {{"name.anchor", 2}}},
    {"blank_outside_the_die", {{"blank.size.reach", 7}}},
    {"block_is_a_value", {{"resin.map", 4}}},
    {"celsius_difference", {{"effects.tool_temperature_shift.slope.unit", 5}}},
    {"choice", {{"fabric.shear_rate.choice", 4}}},
    {"consistency_without_n", {{"resin.consistency.unit", 4}}},
    {"constants_beside_data", {{"friction.scale.beside_data", 6}}},
    {"duplicate_key", {{"name.duplicate", 4}}},
    {"fabric_thinner_than_its_tows", {{"weave.fabric_thickness.consistent", 3}}},
    {"fitted_to_nothing", {{"effects.tool_temperature_shift.slope.fitted", 5}}},
    {"key_of_another_block", {{"cell.fibre_density.unknown", 4}}},
    {"later_effect", {{"effects.binder_tilt.later", 5}}},
    {"later_tool_file", {{"tools.punch.file.later", 6}}},
    {"leading_zero", {{"forming.compaction_exponent.unit", 8}}},
    {"many_at_once",
     {{"weave.tow_width.unit", 3},
      {"weave.gap.range", 3},
      {"friction.law.choice", 4},
      {"process.stepz.unknown", 5},
      {"process.binder_force.required", 5},
      {"tools.die.fillet.range", 8},
      {"blank.size.pair", 10},
      {"blank.plies.range", 10}}},
    {"merge_key", {{"resin.<<.merge", 4}}},
    {"missing_by_law", {{"friction.coefficient.required", 4}}},
    {"missing_constant", {{"friction.scale.required", 4}}},
    {"missing_file", {{"friction.calibration.data.file", 4}}},
    {"missing_key", {{"weave.tow_width.required", 3}}},
    {"missing_plate_area", {{"friction.calibration.plate_area.required", 4}}},
    {"name_with_blank", {{"name.word", 2}}},
    {"no_unit", {{"resin.film_thickness.unit", 4}}},
    {"no_value", {{"name.value", 2}}},
    {"no_version", {{"heddle.required", 1}}},
    {"not_a_map", {{"yaml.map", 1}}},
    {"not_a_number", {{"resin.power_index.unit", 4}}},
    {"not_whole", {{"process.steps.integer", 5}}},
    {"other_version", {{"heddle.choice", 1}}},
    {"out_of_range", {{"resin.power_index.range", 4}}},
    {"pair", {{"blank.size.pair", 7}}},
    {"percent_of_a_number", {{"resin.power_index.unit", 4}}},
    {"plate_area_outside_its_band", {{"friction.rig.plate_area_band.order", 4}}},
    {"punch_too_large_for_the_fabric", {{"tools.die.opening_radius.fabric", 6}}},
    {"slow_down_longer_than_the_stroke", {{"process.punch.slow_down.range", 5}}},
    {"speed_scale_zero", {{"process.punch.speed_scale.range", 5}}},
    {"syntax", {{"yaml.syntax", 4}}},
    {"tab", {{"yaml.tab", 4}}},
    {"table_too_short", {{"friction.calibration.rows", 0}}},
    {"table_with_semicolons", {{"csv.separator", 1}}},
    {"table_with_nan", {{"friction.table.number", 3}}},
    {"tag", {{"resin.power_index.tag", 4}}},
    {"tow_without_room_for_its_material", {{"weave.tow_thickness.holds_material", 3}}},
    {"two_documents", {{"yaml.documents", 0}}},
    {"unit_on_a_number", {{"resin.power_index.unit", 4}}},
    {"unknown_key", {{"weave.tow_widht.unknown", 3}}},
    {"unknown_pattern", {{"weave.pattern.unknown", 3}}},
    {"value_is_a_map", {{"name.value", 2}}},
    {"wrong_unit", {{"resin.film_thickness.unit", 4}}},
    {"zero_plate_area", {{"friction.calibration.plate_area.range", 4}}},
};

/// One line a problem, sorted: a difference then reads well.
std::string listed(std::vector<Place> problems) {
  std::sort(problems.begin(), problems.end());
  std::string text;
  for (const auto& [id, line] : problems) text += id + " in line " + std::to_string(line) + "\n";
  return text;
}

std::string problems_of(const std::filesystem::path& file) {
  std::vector<Place> found;
  try {
    pipeline::read_case(file);
  } catch (const InputError& error) {
    for (const Problem& problem : error.problems()) {
      CHECK_FALSE(problem.rule.empty());
      CHECK_FALSE(problem.way_out.empty());
      CHECK_FALSE(problem.file.empty());
      found.emplace_back(problem.id, problem.line);
    }
  }
  return listed(found);
}

}  // namespace

TEST_CASE("every rule is met by a small file that breaks it, at its line and alone", "[pipeline][config]") {
  for (const BadFile& bad : bad_files) {
    INFO(bad.name);
    CHECK(problems_of(folder / (std::string(bad.name) + ".yaml")) == listed(bad.problems));
  }
}

TEST_CASE("every small bad file stands in the table above", "[pipeline][config]") {
  std::set<std::string> in_table;
  for (const BadFile& bad : bad_files) in_table.insert(bad.name);
  std::set<std::string> present;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() == ".yaml") present.insert(entry.path().stem().string());
  }
  CHECK(present == in_table);
}

// The words a newcomer meets first. A change of wording is a change of these files, to be read by a person.
TEST_CASE("the commonest mistakes are answered in the words of tests/pipeline/golden", "[pipeline][config]") {
  const std::filesystem::path golden = std::filesystem::path(HEDDLE_SOURCE_DIR) / "tests/pipeline/golden";
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(golden)) {
    if (entry.path().extension() != ".yaml") continue;
    ++files;
    const std::string name = entry.path().filename().string();
    INFO(name);
    std::string answer;
    try {
      pipeline::read_case_text(read_text_file(entry.path()), name, golden);
    } catch (const InputError& error) {
      answer = error.what();
    }
    CHECK(answer == read_text_file(std::filesystem::path(entry.path()).replace_extension(".txt")));
  }
  CHECK(files >= 10);
}

TEST_CASE("problems of one key name the place, the value, the rule and the way out", "[pipeline][config]") {
  try {
    pipeline::read_case_text(
        "heddle: 1\nname: x\nweave: {patern: plain, tow_width: 4.64 mm, gap: 0.75 m,\n  tow_thickness: "
        "0.75 mm, fabric_thickness: 1.5 mm, linear_density: 1872 tex, fibre_mass_fraction: 60 "
        "%}\n",
        "x.yaml", "");
    FAIL("no problem found");
  } catch (const InputError& error) {
    CHECK(std::string(error.what()) ==
          "x.yaml: 2 problem(s)\n"
          "  weave.patern (line 3) = plain   is not a known key\n"
          "    The nearest known key is weave.pattern.\n"
          "  weave.gap (line 3) = 0.75 m   must satisfy 0 mm <= gap < 100 mm\n"
          "    Clear distance between neighbouring tows (Table 1: 0.75 mm).\n");
  }
}
