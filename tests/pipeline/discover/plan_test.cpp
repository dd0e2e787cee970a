// Planned campaigns: designs as tables, exchange of cells at equal cost, and the files that a plan leaves.
#include <catch2/catch.hpp>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "core/text_file.h"
#include "pipeline/command_line.h"
#include "pipeline/discover_plan.h"
#include "pipeline/outputs.h"
#include "shipped_question.h"
#include "tests/pipeline/scratch.h"

using namespace heddle;
using namespace heddle::discover;
namespace fs = std::filesystem;

namespace {

const fs::path source = test::source_dir;
const fs::path shipped = source / "configs/discover/friction.yaml";
const fs::path table2 = source / "configs/data/friction_table2.csv";

std::vector<std::string> rules_broken_by(const std::string& text) {
  std::vector<std::string> rules;
  try {
    pipeline::parse_design(text, "design.csv", {});
  } catch (const InputError& error) {
    for (const Problem& problem : error.problems()) {
      CHECK(problem.file == "design.csv");
      CHECK_FALSE(problem.way_out.empty());
      rules.push_back(problem.id);
    }
  }
  return rules;
}

double rate_of(const CouponQuestion& question, const std::vector<CouponCell>& cells) {
  return isolability_of(question, planned_campaign(question, cells, 3)).right_names;
}

pipeline::DiscoverOptions plan_options(const fs::path& output, const fs::path& design) {
  pipeline::DiscoverOptions options;
  options.run.file = shipped;
  options.run.output = output;
  options.run.print = false;
  options.design = design;
  return options;
}

}  // namespace

TEST_CASE("the paper's Table 2 is 22 conditions of five samples, in turn over four days",
          "[discover][plan]") {
  const pipeline::PlannedDesign design = pipeline::read_design(table2, {.dwell = 10.0});
  REQUIRE(design.cells.size() == 22);
  std::vector<int> on_day(4);
  for (const CouponCell& cell : design.cells) {
    CHECK(cell.samples == 5);
    CHECK(cell.dwell == 10.0);
    ++on_day.at(cell.day);
  }
  CHECK(*std::ranges::max_element(on_day) - *std::ranges::min_element(on_day) <= 1);
  CHECK(design.cells.front().pull.normal_force == 1500.0);
  CHECK(design.notes.size() == 3);
}

TEST_CASE("a design written for the lab reads back as the same conditions", "[discover][plan]") {
  std::vector<CouponCell> cells = test::crossed_cells();
  number_conditions(cells);
  const std::string text = pipeline::design_csv(cells);
  const pipeline::PlannedDesign design = pipeline::parse_design(text, "design.csv", {});
  REQUIRE(design.cells.size() == cells.size());
  CHECK(pipeline::design_csv(design.cells) == text);
  for (std::size_t k = 0; k < cells.size(); ++k) {
    CHECK(design.cells[k].day == cells[k].day);
    CHECK(design.cells[k].condition == cells[k].condition);
    for (const Knob& knob : knobs()) CHECK(knob.get(design.cells[k]) == Approx(knob.get(cells[k])));
  }
}

TEST_CASE("a design is refused with every problem and its line", "[discover][plan]") {
  const std::string head = "velocity_mm_s,normal_force_N,tool_temperature_C,fabric_temperature_C";
  using Rules = std::vector<std::string>;
  CHECK(
      rules_broken_by("velocity_m_s,normal_force_N,tool_temperature_C,fabric_temperature_C\n1,1,85,180\n") ==
      Rules{"discover.design.column.unknown", "discover.design.column.missing"});
  CHECK(rules_broken_by(head + ",dwell_s,dwell_s\n16.6,1500,85,180,1,1\n") ==
        Rules{"discover.design.column.twice"});
  CHECK(rules_broken_by(head + "\n") == Rules{"discover.design.empty"});
  CHECK(rules_broken_by(head + "\nfast,1500,85,180\n16.6,-1500,85,180\n16.6,1500,-300,180\n") ==
        Rules{"discover.design.number", "discover.design.range", "discover.design.range"});
  CHECK(rules_broken_by(head + ",replicates,dwell_s\n16.6,1500,85,180,2.5,-1\n8,1500,85,180,5,nan\n") ==
        Rules{"discover.design.number", "discover.design.range", "discover.design.replicates"});
  CHECK(rules_broken_by(head + "\n16.6,1500,85,180\n16.6,1500,85,180\n") == Rules{"discover.design.alike"});
  CHECK(rules_broken_by("parameter,unit,baseline,additional\nvelocity,m/s,1,2\n") ==
        Rules{"friction.design.unit"});
}

TEST_CASE("a plan takes its case and design from the command line, and not data as well",
          "[discover][plan][command_line]") {
  pipeline::DiscoverOptions seen;
  int calls = 0;
  const auto call = [&](std::vector<std::string> arguments) {
    pipeline::Commands commands;
    commands.discover = [&](const pipeline::DiscoverOptions& options) {
      seen = options;
      ++calls;
      return 0;
    };
    return pipeline::dispatch(arguments, commands);
  };
  CHECK(call({"discover", "--plan", "case.yaml", "--design", table2.string(), "-o", "x"}) == 0);
  CHECK(seen.run.file == "case.yaml");
  CHECK(seen.design == table2);
  CHECK(seen.run.output == "x");
  CHECK(call({"discover", "case.yaml", "--data", table2.string()}) == 0);
  CHECK(seen.run.file == "case.yaml");
  CHECK(calls == 2);
  for (const std::vector<std::string>& faulty : std::vector<std::vector<std::string>>{
           {"discover", "case.yaml"},
           {"discover", "--data", table2.string()},
           {"discover", "--plan", "case.yaml"},
           {"discover", "--design", table2.string()},
           {"discover", "case.yaml", "--plan", "case.yaml", "--design", table2.string()},
           {"discover", "--plan", "case.yaml", "--design", table2.string(), "--data", table2.string()}})
    CHECK(call(faulty) == pipeline::exit_bad_input);
  CHECK(calls == 2);
}

TEST_CASE("exchanging cells at equal cost names more effects, on the levels of the design alone",
          "[discover][plan]") {
  CouponQuestion question = test::shipped_question();
  const std::vector<CouponCell> given = test::paper_cells();
  const Exchange exchange = exchanged_design(question, given, {.stretches = 2, .passes = 1});
  REQUIRE(exchange.cells.size() == given.size());
  CHECK(exchange.after > exchange.before);
  CHECK(rate_of(question, exchange.cells) > rate_of(question, given) + 0.05);
  const auto before = levels_of(given), after = levels_of(exchange.cells);
  for (std::size_t k = 0; k < knobs().size(); ++k)
    for (const double level : after[k]) CHECK(std::ranges::count(before[k], level) == 1);
  for (std::size_t c = 0; c < given.size(); ++c) {
    CHECK(exchange.cells[c].samples == given[c].samples);
    CHECK(exchange.cells[c].day == given[c].day);
  }
  for (const Knob& knob : knobs()) CHECK(knob.get(exchange.cells[0]) == knob.get(given[0]));

  // The criterion that it climbed is the one of whole campaigns, not of blocks.
  const PlannedCampaign whole = planned_campaign(question, exchange.cells, 2);
  CHECK(criterion_of(fingerprints_of(changes_of(whole.forward, whole.baseline), *whole.baseline.data,
                                     whole.observations)) == Approx(exchange.after).epsilon(1e-3));
}

TEST_CASE("a condition that days repeat stays in an exchange", "[discover][plan]") {
  std::vector<CouponCell> cells{test::cell_at(85, 1500, 16.6)};
  for (int day = 0; day < 3; ++day) cells.push_back(test::cell_at(100, 1500, 16.6));
  for (const double tool : {21.0, 140.0}) cells.push_back(test::cell_at(tool, 343, 16.6));
  for (std::size_t k = 0; k < cells.size(); ++k) cells[k].day = k % 3;
  number_conditions(cells);
  CHECK(cells.back().condition == 3);
  const Exchange exchange = exchanged_design(test::shipped_question(), cells, {.stretches = 1, .passes = 1});
  for (std::size_t k = 0; k < 4; ++k)
    for (const Knob& knob : knobs()) CHECK(knob.get(exchange.cells[k]) == knob.get(cells[k]));
}

TEST_CASE("a plan leaves the same files twice, and its design can be planned again", "[discover][plan]") {
  const test::Scratch scratch;
  std::string head = "velocity_mm_s,normal_force_N,tool_temperature_C,fabric_temperature_C,dwell_s\n";
  pipeline::write_file(
      scratch / "small.csv",
      head + "16.6,1500,85,180,10\n83.3,1500,85,180,10\n16.6,4000,85,180,60\n16.6,1500,140,180,10\n");
  for (const char* name : {"a", "b"})
    REQUIRE(pipeline::discover_case(plan_options(scratch / name, scratch / "small.csv")) == 0);
  for (const char* file : {"discover/plan.json", "discover/plan.html", "discover/design.csv"})
    CHECK(read_text_file(scratch / "a" / file) == read_text_file(scratch / "b" / file));
  const auto json = nlohmann::json::parse(read_text_file(scratch / "a" / "discover/plan.json"));
  CHECK(json["given"]["pulls"] == 20);
  CHECK(json["proposed"]["pulls"] == 20);
  CHECK(json["right_names"]["proposed"].get<double>() >= json["right_names"]["given"].get<double>());
  const std::size_t effects = json["given"]["isolability"]["effects"].size();
  CHECK(effects >= 15);
  CHECK(json["given"]["isolability"]["lambda"].size() == effects);
  CHECK(json["given"]["detectable"].size() == effects);
  // Orientation is not varied: no amplitude of it can be seen.
  for (const auto& one : json["given"]["detectable"])
    if (one["id"] == "orientation") CHECK((one["amplitude"].is_null() && !one["seen"].get<bool>()));
  CHECK(pipeline::read_design(scratch / "a" / "discover/design.csv", {}).cells.size() == 4);
}
