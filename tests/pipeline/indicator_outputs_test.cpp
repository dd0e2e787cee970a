#include "pipeline/indicator_outputs.h"
#include "pipeline/outputs.h"

#include <catch2/catch.hpp>
#include <string>
#include <tuple>
#include <vector>

#include "core/csv.h"

using namespace heddle;
using macroscale::LargestIndicator;

namespace {

// A harmless part: every indicator below its limit.
std::vector<LargestIndicator> harmless() {
  return {{"tow_load_max", 0.4, "", {0.01, 0.02, -0.03}},
          {"tow_compression_max", 0.002, "", {}},
          {"gap_opening_max", 0.05, "mm", {}},
          {"wrinkle_height_max", 0.1, "mm", {}},
          {"thickening_max", 1.3, "", {}},
          {"thickening_min", 0.99, "", {}}};
}

pipeline::IndicatorLimits limits() {
  pipeline::IndicatorLimits of;
  of.wrinkle_height = 0.3e-3;
  of.gap_opening = 0.5e-3;
  return of;
}

std::vector<std::string> warnings_with(const std::string& name, double value) {
  auto all = harmless();
  for (LargestIndicator& i : all)
    if (i.name == name) i.value = value;
  return pipeline::indicator_warnings(all, limits());
}

}  // namespace

TEST_CASE("an indicator is a warning beyond its limit and not before", "[pipeline][indicators]") {
  CHECK(pipeline::indicator_warnings(harmless(), limits()).empty());
  CHECK(pipeline::indicator_warnings({}, limits()).empty());
  for (const auto& [name, below, above, word] : {std::tuple{"tow_load_max", 0.99, 1.2, "torn"},
                                                 std::tuple{"tow_compression_max", 0.0099, 0.011, "buckle"},
                                                 std::tuple{"gap_opening_max", 0.49, 0.51, "part by"},
                                                 std::tuple{"wrinkle_height_max", 0.29, 0.31, "wrinkles"}}) {
    INFO(name);
    CHECK(warnings_with(name, below).empty());
    const auto said = warnings_with(name, above);
    REQUIRE(said.size() == 1);
    CHECK_THAT(said[0], Catch::Contains(word));
  }
  CHECK_THAT(warnings_with("tow_load_max", 1.2)[0], Catch::Contains("(10, 20, -30) mm"));
}

TEST_CASE("the summary holds each indicator under its unit, and without them stays as it was",
          "[pipeline][indicators]") {
  pipeline::SummaryRecord record;
  record.stamping.emplace();
  record.stamping->peak_punch_force = 517.25;
  CHECK_THAT(pipeline::summary_json(record), !Catch::Contains("indicators"));
  record.indicators = harmless();
  const std::string text = pipeline::summary_json(record);
  for (const char* part :
       {"\"indicators\": {", "\"tow_load_max\": 0.4", "\"gap_opening_max_mm\": 0.05", "517.25"})
    CHECK_THAT(text, Catch::Contains(part));
}

TEST_CASE("the table of indicators says where each is largest", "[pipeline][indicators]") {
  const CsvTable table = parse_csv(pipeline::indicators_csv(harmless()), "indicators.csv");
  REQUIRE(table.problems.empty());
  REQUIRE(table.rows.size() == 6);
  CHECK(table.rows[0].cells == std::vector<std::string>{"tow_load_max", "0.4", "", "10", "20", "-30"});
}

TEST_CASE("folds are told where they are, and a sheet that has passed through itself in so many words",
          "[pipeline][indicators][folds]") {
  macroscale::StampingSummary run;
  macroscale::Folds none;
  CHECK(pipeline::fold_warnings(none, run).empty());
  macroscale::Folds folds;
  folds.folded = 12;
  folds.near = 3;
  folds.place = {{15, {0.01, 0.02, -0.03}, 2.5, 1e-3}, {2, {}, 2.2, 1.5e-3}};
  const auto said = pipeline::fold_warnings(folds, run);
  REQUIRE(said.size() == 1);
  CHECK_THAT(said[0], Catch::Contains("in 2 places") && Catch::Contains("(10, 20, -30) mm") &&
                          Catch::Contains("12 nodes turn") && Catch::Contains("3 stand nearer"));
  // Said even if nothing crosses any more in the end.
  run.self_crossings = 4;
  run.first_crossing = 0.0315;
  REQUIRE(pipeline::fold_warnings(none, run).size() == 1);
  CHECK_THAT(pipeline::fold_warnings(none, run)[0], Catch::Contains("passed through itself") &&
                                                        Catch::Contains("31.5 mm") &&
                                                        Catch::Contains("feels no contact with itself"));
  // What is said of its contact is what it has.
  CHECK_THAT(said[0], Catch::Contains("which it does not feel"));
  macroscale::StampingSummary touching = run;
  touching.self_contact.emplace().met = true;
  const auto of_touching = pipeline::fold_warnings(folds, touching);
  REQUIRE(of_touching.size() == 2);
  CHECK_THAT(of_touching[0], Catch::Contains("did not hold"));
  CHECK_THAT(of_touching[1], Catch::Contains("presses and rubs"));

  pipeline::SummaryRecord record;
  record.stamping = run;
  record.folds = folds;
  const std::string text = pipeline::summary_json(record);
  for (const char* part : {"\"folds\": {", "\"count\": 2", "\"folded_nodes\": 12", "\"distance_mm\": 1.0",
                           "\"self_crossings_in_any_step\": 4", "\"first_self_crossing_mm\": 31.5"})
    CHECK_THAT(text, Catch::Contains(part));
}
