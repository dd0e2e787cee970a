// The four measured forces of the paper's Table 4: what they can show and what not.
#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "core/text_file.h"
#include "friction/friction_test.h"
#include "pipeline/commands.h"
#include "pipeline/discover/contrasts.h"
#include "tests/pipeline/scratch.h"

using namespace heddle;
namespace fs = std::filesystem;

TEST_CASE("a plain Stribeck law is caught missing a tool-temperature effect in Table 4, not which",
          "[discover][paper]") {
  const test::Scratch scratch;
  pipeline::DiscoverOptions options;
  options.run.file = fs::path(test::source_dir) / "configs/discover/table4.yaml";
  options.run.output = scratch / "t4";
  options.run.print = false;
  options.data = fs::path(test::source_dir) / "configs/data/friction_table4.csv";
  REQUIRE(pipeline::discover_case(options) == pipeline::exit_done);
  const auto report = nlohmann::json::parse(read_text_file((scratch / "t4/discover/report.json").string()));
  CHECK(report["verdict"] == "ONE_OF");
  CHECK(report["group"] == "a tool-temperature effect");
  const std::set<std::string> set = report["candidate_set"];
  CHECK(set == std::set<std::string>{"tool_temperature_film", "tool_temperature_shift", "solidification"});
  CHECK(report["location"][0]["factor"] == "tool_temperature");
  CHECK(report["gap"]["saturated"].get<bool>());
  CHECK_FALSE(report["gap"].contains("shrink"));  // as many numbers as forces: nothing is claimed
  bool wrong_sign = false;
  for (const std::string note : report["notes"])
    wrong_sign = wrong_sign || note.find("wrong sign in ln normal force") != std::string::npos;
  CHECK(wrong_sign);
}

TEST_CASE("the paper's own model has the wrong sign of the normal force, which no Hersey number can have",
          "[discover][paper]") {
  const auto rows =
      friction::read_friction_table(std::string(test::source_dir) + "/configs/data/friction_table4.csv");
  std::vector<double> measured, modelled;
  for (const friction::FrictionTestRow& row : rows) {
    measured.push_back(*row.measured_force);
    modelled.push_back(*row.paper_model_force);
  }
  const discover::Sensitivities nature = discover::sensitivities_of(rows, measured);
  const discover::Sensitivities paper = discover::sensitivities_of(rows, modelled);
  CHECK(*nature.velocity == Approx(0.067).margin(1e-3));
  CHECK(*nature.normal_force == Approx(-0.120).margin(1e-3));
  CHECK(*paper.velocity == Approx(0.058).margin(1e-3));
  CHECK(*paper.normal_force == Approx(0.057).margin(1e-3));
  CHECK(*nature.tool_temperature * 55.0 == Approx(-0.200).margin(1e-3));
  // mu of U^n/N: the slopes to ln U and to ln N have opposite signs for n > 0, and n is their ratio.
  CHECK(*nature.implied_index() == Approx(0.55).margin(0.01));
  CHECK(*paper.implied_index() == Approx(-1.0).margin(0.03));
  CHECK(nature.can_be_hersey());
  CHECK_FALSE(paper.can_be_hersey());
  // Twice the load multiplies the force by less than 2 in nature, by more in the paper's model.
  CHECK(measured[2] / measured[0] < 2.0);
  CHECK(modelled[2] / modelled[0] > 2.0);
}
