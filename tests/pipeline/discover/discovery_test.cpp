// Whole discoveries, from a table on disk to the folder of results, in coupons made here (inverse crime: see
// coupons_made_here.h), and what the command says of bad tables.
#include <catch2/catch.hpp>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "coupons_made_here.h"
#include "pipeline/case.h"
#include "pipeline/commands.h"
#include "pipeline/outputs.h"
#include "tests/pipeline/scratch.h"

using namespace heddle;
namespace fs = std::filesystem;
using nlohmann::json;

namespace {

pipeline::DiscoverOptions options_in(const fs::path& folder, std::vector<std::string> settings = {}) {
  pipeline::DiscoverOptions options;
  options.run.file = fs::path(test::source_dir) / "configs/discover/friction.yaml";
  options.run.output = folder / "out";
  options.run.assignments = std::move(settings);
  options.run.print = false;
  options.run.quiet = true;
  options.run.force = true;
  options.data = folder / "coupons.csv";
  return options;
}

json discovered(const fs::path& folder, const std::string& table, std::vector<std::string> settings = {}) {
  fs::create_directories(folder);
  pipeline::write_file(folder / "coupons.csv", table);
  REQUIRE(pipeline::discover_case(options_in(folder, std::move(settings))) == pipeline::exit_done);
  return json::parse(read_text_file((folder / "out/discover/report.json").string()));
}

std::set<std::string> rules_broken_by(const fs::path& folder, const std::string& table) {
  fs::create_directories(folder);
  pipeline::write_file(folder / "coupons.csv", table);
  std::set<std::string> rules;
  try {
    pipeline::discover_case(options_in(folder));
  } catch (const InputError& error) {
    for (const Problem& problem : error.problems()) rules.insert(problem.id);
  }
  return rules;
}

test::Campaign hidden_shift() {
  test::Campaign campaign{.model = test::plain_stribeck()};
  campaign.model.effects.tool_temperature_shift = friction::ToolTemperatureShift{.slope = -9e-4};
  return campaign;
}

}  // namespace

TEST_CASE(
    "a hidden tool-temperature effect is named, added, and closes the gap on conditions that no fit saw",
    "[discover][run]") {
  const test::Scratch scratch;
  const json report = discovered(scratch / "shift", test::coupons_csv(hidden_shift()));
  CHECK(report["verdict"] == "NAMED");
  REQUIRE(report["effects"].size() == 1);
  CHECK(report["effects"][0]["id"] == "tool_temperature_shift");
  const json& slope = report["effects"][0]["parameters"]["slope"];
  CHECK(slope["low"].get<double>() < -9e-4);
  CHECK(slope["high"].get<double>() > -9e-4);
  CHECK(report["location"][0]["factor"].get<std::string>().starts_with("tool_temperature"));
  CHECK(report["gap"]["shrink"].get<double>() > 0.5);
  CHECK(report["gap"]["shrink_low"].get<double>() > 0.0);
  CHECK_FALSE(report["gap"]["saturated"].get<bool>());
  SECTION("the patched case reads, and without the effect it is the case with the fitted baseline") {
    const pipeline::Case patched = pipeline::read_case(scratch / "shift/out/discover/patched.yaml");
    REQUIRE(patched.friction->model.effects.tool_temperature_shift);
    CHECK(patched.friction->model.effects.tool_temperature_shift->slope == slope["value"].get<double>());
  }
  SECTION("same table, same seed, same bytes") {
    discovered(scratch / "again", test::coupons_csv(hidden_shift()));
    for (const char* file : {"report.json", "patched.yaml", "gap.csv", "shape.csv", "report.html"})
      CHECK(read_text_file((scratch / "shift/out/discover" / file).string()) ==
            read_text_file((scratch / "again/out/discover" / file).string()));
  }
}

TEST_CASE("where nothing is hidden nothing is named, whatever the seed of the noise",
          "[discover][run][long]") {
  const test::Scratch scratch;
  int gaps = 0;
  for (const std::uint64_t seed : {2, 3, 4, 5, 6, 7}) {
    test::Campaign campaign{.model = test::plain_stribeck()};
    campaign.seed = seed;
    const json report = discovered(scratch / "null", test::coupons_csv(campaign));
    CAPTURE(seed, report["reasons"].dump(), report["gate"].dump(), report["ranking"].dump());
    CHECK((report["verdict"] == "NO_GAP" || report["verdict"] == "UNKNOWN"));
    gaps += report["verdict"] != "NO_GAP" ? 1 : 0;
  }
  CHECK(gaps <= 1);  // the gate lets one campaign of a hundred through
}

TEST_CASE("without replicates no one name is given", "[discover][run]") {
  const test::Scratch scratch;
  test::Campaign campaign = hidden_shift();
  campaign.replicates = 1;
  const json report = discovered(scratch / "single", test::coupons_csv(campaign));
  CHECK(report["verdict"] != "NAMED");
  CHECK(report["noise"]["sample_source"] == "assumed");
  CHECK(report["effects"].empty());
}

TEST_CASE("tables that cannot be discovered in are refused with the reason", "[discover][bad]") {
  const test::Scratch scratch;
  const std::string whole = test::coupons_csv(hidden_shift());
  SECTION("one condition only") {
    test::Campaign campaign = hidden_shift();
    campaign.cells.resize(1);
    CHECK(rules_broken_by(scratch / "one", test::coupons_csv(campaign)) ==
          std::set<std::string>{"discover.data.alike"});
  }
  SECTION("a column is missing") {
    std::string text = whole;
    text.replace(text.find("tool_temperature_C"), 18, "tool_temperature_F");
    CHECK(rules_broken_by(scratch / "column", text).contains("friction.coupons.column.missing"));
  }
  SECTION("not a number") {
    std::string text = whole;
    const std::size_t row = text.find('\n') + 1, comma = text.find(",d1,", row) + 4;
    text.replace(comma, text.find(',', comma) - comma, "NaN");
    CHECK(rules_broken_by(scratch / "nan", text).contains("friction.coupons.number"));
  }
  SECTION("pull forces in kN") {
    test::Campaign campaign = hidden_shift();
    for (discover::CouponCell& cell : campaign.cells) cell.pull.normal_force *= 1e-3;
    std::string text = test::coupons_csv(campaign);        // loads a thousandth: mu by Hs^s of other loads
    CHECK(rules_broken_by(scratch / "kn", text).empty());  // read, and asked about
    const json report = json::parse(read_text_file((scratch / "kn/out/discover/report.json").string()));
    bool asked = false;
    for (const json& note : report["notes"])
      asked = asked || note.get<std::string>().find("kN") != std::string::npos;
    CHECK(asked);
  }
  SECTION("a sidecar with keys nobody knows") {
    fs::create_directories(scratch / "side");
    pipeline::write_file(scratch / "side/coupons.yaml",
                         "rig: {plate_area: 0.01 N, faces: 3}\nweather: fine\n");
    CHECK(rules_broken_by(scratch / "side", whole) == std::set<std::string>{"discover.sidecar.unknown",
                                                                            "discover.sidecar.plate_area",
                                                                            "discover.sidecar.faces"});
  }
  SECTION("wishes that no model or library has") {
    fs::create_directories(scratch / "wish");
    pipeline::write_file(scratch / "wish/coupons.csv", whole);
    std::set<std::string> rules;
    try {
      pipeline::discover_case(options_in(scratch / "wish", {"discover.parameters=[friction.offset]",
                                                            "discover.effects=static_peak moonlight"}));
    } catch (const InputError& error) {
      for (const Problem& problem : error.problems()) rules.insert(problem.id);
    }
    CHECK(rules == std::set<std::string>{"discover.parameters.acts", "discover.effects.known"});
  }
  SECTION("a case without friction") {
    fs::create_directories(scratch / "none");
    pipeline::write_file(scratch / "none/coupons.csv", whole);
    pipeline::DiscoverOptions options = options_in(scratch / "none");
    options.run.file = fs::path(test::source_dir) / "configs/voxel_cell.yaml";
    std::string rule;
    try {
      pipeline::discover_case(options);
    } catch (const InputError& error) {
      rule = error.problems().front().id;
    }
    CHECK(rule == "discover.friction");
  }
}

TEST_CASE("duplicated rows and a sample under a wrong label do not make a name", "[discover][run]") {
  const test::Scratch scratch;
  test::Campaign campaign{.model = test::plain_stribeck()};
  campaign.seed = 5;
  std::string text = test::coupons_csv(campaign);
  const std::size_t header = text.find('\n') + 1;
  const std::string twice = text + text.substr(header);  // every row once more, same sample ids
  CHECK(discovered(scratch / "twice", twice)["verdict"] == "NO_GAP");
}
