// `heddle calibrate` from the command to the files it leaves, and the case it patches.
#include "pipeline/calibrate_command.h"

#include <unistd.h>

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "core/text_file.h"
#include "friction/calibrate.h"
#include "pipeline/stages.h"
#include "tests/source_dir.h"

using namespace heddle;
namespace fs = std::filesystem;

namespace {

const fs::path source = heddle::test::source_dir;
const fs::path table4 = source / "configs/data/friction_table4.csv";

class Scratch {
 public:
  Scratch() : path_(fs::temp_directory_path() / ("heddle-calibrate-test-" + std::to_string(getpid()))) {}
  ~Scratch() {
    std::error_code ignored;  // a folder that stays behind is no failure of the test
    fs::remove_all(path_, ignored);
  }
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;
  fs::path operator/(const std::string& name) const { return path_ / name; }

 private:
  fs::path path_;
};

pipeline::CalibrateOptions options_for(const fs::path& output, std::vector<std::string> settings = {}) {
  pipeline::CalibrateOptions options;
  options.run.file = source / "configs/calibrate.yaml";
  options.run.output = output;
  options.run.assignments = std::move(settings);
  options.run.print = false;
  options.data = table4;
  return options;
}

nlohmann::json json_of(const fs::path& file) {
  return nlohmann::json::parse(read_text_file(file));
}

std::string rule_broken_by(const pipeline::CalibrateOptions& options) {
  try {
    pipeline::calibrate_case(options);
  } catch (const InputError& error) {
    return error.problems().front().id;
  }
  return "";
}

}  // namespace

TEST_CASE("calibrating the shipped case leaves a case that pulls the measured forces",
          "[pipeline][calibration]") {
  const Scratch scratch;
  REQUIRE(pipeline::calibrate_case(options_for(scratch / "a")) == pipeline::exit_done);
  const auto json = json_of(scratch / "a" / "calibration.json");
  CHECK(json["degrees_of_freedom"] == 1);
  CHECK_FALSE(json["saturated"].get<bool>());
  CHECK(json["numbers"][0]["fixed_by_assumed_plate_area"].get<bool>());
  CHECK_FALSE(json["numbers"][1]["fixed_by_assumed_plate_area"].get<bool>());
  CHECK(json["covariance"].size() == 3);
  const std::string report = read_text_file(scratch / "a" / "report.html");
  CHECK(report.find("degree of freedom left") != std::string::npos);
  CHECK(report.find("No condition was pulled twice on one day") != std::string::npos);  // one replicate
  CHECK(report.find("the table has no day_id") != std::string::npos);

  const pipeline::Case patched = pipeline::read_case(scratch / "a" / "patched.yaml");
  const auto& law = std::get<friction::HerseyPower>(patched.friction->model.law);
  CHECK(law.scale == json["numbers"][0]["value"].get<double>());  // bit for bit
  CHECK(law.exponent == json["numbers"][1]["value"].get<double>());
  CHECK(patched.friction->model.effects.tool_temperature_shift->slope ==
        json["numbers"][2]["value"].get<double>());
  CHECK(patched.friction->model.box.pressure_high == 3e5);
  const pipeline::FrictionStage stage = pipeline::run_friction_stage(patched, nullptr);
  REQUIRE(stage.test.size() == 4);
  for (const pipeline::FrictionTestRow& row : stage.test)
    CHECK(std::abs(pipeline::error_of_model(row).value()) < 0.01);

  // Same configuration, same bytes.
  pipeline::calibrate_case(options_for(scratch / "b"));
  for (const char* name : {"calibration.json", "patched.yaml", "report.html", "calibration/numbers.csv",
                           "calibration/residuals.csv", "resolved.yaml", "log.txt"})
    CHECK(read_text_file(scratch / "a" / name) == read_text_file(scratch / "b" / name));
  // Calibrated again from where it ended, it stays there.
  pipeline::CalibrateOptions again = options_for(scratch / "c");
  again.run.file = scratch / "a" / "patched.yaml";
  pipeline::calibrate_case(again);
  const auto second = json_of(scratch / "c" / "calibration.json");
  for (std::size_t k = 0; k < 3; ++k)
    CHECK(second["numbers"][k]["value"].get<double>() ==
          Approx(json["numbers"][k]["value"].get<double>()).epsilon(1e-9));
}

TEST_CASE("with n free the report of Table 4 says saturated and states no interval",
          "[pipeline][calibration][paper]") {
  const Scratch scratch;
  const std::string free =
      "calibrate.parameters=[friction.scale, friction.exponent, effects.tool_temperature_shift.slope, "
      "resin.power_index]";
  REQUIRE(pipeline::calibrate_case(options_for(scratch / "n", {free})) == pipeline::exit_done);
  const auto json = json_of(scratch / "n" / "calibration.json");
  CHECK(json["saturated"].get<bool>());
  for (const auto& number : json["numbers"]) CHECK_FALSE(number.contains("interval"));
  CHECK(read_text_file(scratch / "n" / "report.html").find("saturated") != std::string::npos);
  // A prior on n in the place of a fifth row.
  REQUIRE(pipeline::calibrate_case(options_for(
              scratch / "prior", {free, "calibrate.prior.resin.power_index=[0.38, 0.02]",
                                  "calibrate.bounds.resin.power_index=[0.2, 1]"})) == pipeline::exit_done);
  const auto held = json_of(scratch / "prior" / "calibration.json");
  CHECK(held["degrees_of_freedom"] == 1);
  CHECK(held["degrees_of_freedom_from_priors"] == 1);
  CHECK(held["numbers"][3]["prior"]["sd"] == 0.02);
}

TEST_CASE("a case that fits its law in each run is patched to constants and needs no block",
          "[pipeline][calibration]") {
  const Scratch scratch;
  pipeline::CalibrateOptions options = options_for(scratch / "run");
  options.run.file = source / "configs/friction_test.yaml";  // friction.calibration.data, slope: fitted
  REQUIRE(pipeline::calibrate_case(options) == pipeline::exit_done);
  const pipeline::Case before = pipeline::read_case(options.run.file);
  const pipeline::Case after = pipeline::read_case(scratch / "run" / "patched.yaml");
  CHECK(before.friction->calibrated());
  CHECK_FALSE(after.friction->calibrated());
  const pipeline::FrictionStage fitted = pipeline::run_friction_stage(before, nullptr);
  const pipeline::FrictionStage patched = pipeline::run_friction_stage(after, nullptr);
  REQUIRE(patched.test.size() == fitted.test.size());
  // ln F here, F/F_measured there: alike to the square of the errors.
  for (std::size_t k = 0; k < fitted.test.size(); ++k)
    CHECK(patched.test[k].pull_force == Approx(fitted.test[k].pull_force).epsilon(2e-3));
  CHECK(patched.model.box.hersey_low == Approx(fitted.model.box.hersey_low).epsilon(1e-12));
}

TEST_CASE("a resolved case with constants and the weave of other pulls reads back", "[pipeline][config]") {
  // Keys of friction.calibration stand before and after those of the law in the schema.
  const std::string text =
      "heddle: 1\nname: x\nweave: {pattern: plain, tow_width: 4.64 mm, gap: 0.75 mm, tow_thickness: 0.75 mm, "
      "fabric_thickness: 1.5 mm, linear_density: 1872 tex, fibre_mass_fraction: 60 %}\n"
      "friction: {law: stribeck, scale: 0.3, exponent: 0.1, box: {speed: [1 mm/s, 90 mm/s]}, "
      "calibration: {plate_area: 0.01 m^2}}\n";
  const auto once = pipeline::read_case_text(text, "x.yaml", {});
  const std::string resolved = pipeline::resolved_yaml(once.settings);
  const auto twice = pipeline::read_case_text(resolved, "resolved.yaml", {});
  CHECK(pipeline::resolved_yaml(twice.settings) == resolved);
  CHECK(twice.friction->model.box.speed_high == 90e-3);
}

TEST_CASE("a calibration without friction, or of numbers that do not act, is refused",
          "[pipeline][calibration][wrong input]") {
  const Scratch scratch;
  pipeline::CalibrateOptions options = options_for(scratch / "x");
  options.run.file = source / "configs/unit_cell.yaml";
  CHECK(rule_broken_by(options) == "calibrate.friction");
  CHECK(rule_broken_by(options_for(scratch / "x", {"calibrate.parameters=[friction.offset]"})) ==
        "calibrate.parameters.acts");
  CHECK_FALSE(fs::exists(scratch / "x"));  // refused before anything is written
}

TEST_CASE("a calibrated folder is exported with its fitted numbers", "[pipeline][export]") {
  const Scratch scratch;
  REQUIRE(pipeline::calibrate_case(options_for(scratch / "a")) == pipeline::exit_done);
  const std::string scale =
      pipeline::shortest(json_of(scratch / "a" / "calibration.json")["numbers"][0]["value"].get<double>());
  pipeline::ExportOptions options;
  options.run.file = scratch / "a";
  options.run.print = false;
  options.target = "abaqus";
  REQUIRE(pipeline::export_case(options) == pipeline::exit_done);
  const std::string routine = read_text_file(scratch / "a" / "export" / "heddle_friction.f");
  CHECK(routine.find("c_scale =\n     & " + scale + "D0") != std::string::npos);
  CHECK(routine.find("Fitted between 150 and 300 kPa") != std::string::npos);
  CHECK(routine.find(scratch.operator/("").string()) == std::string::npos);  // no paths
  options.target = "csv";
  options.run.output = scratch / "table";
  REQUIRE(pipeline::export_case(options) == pipeline::exit_done);
  CHECK(fs::file_size(scratch / "table" / "friction_law.csv") > 100000);
}

TEST_CASE("an export without a case or a law is refused", "[pipeline][export][wrong input]") {
  const Scratch scratch;
  const auto rule = [](const fs::path& file, std::vector<std::string> settings = {}) -> std::string {
    pipeline::ExportOptions options;
    options.run.file = file;
    options.run.assignments = std::move(settings);
    options.run.print = false;
    options.target = "csv";
    try {
      pipeline::export_case(options);
    } catch (const InputError& error) {
      return error.problems().front().id;
    }
    return "";
  };
  fs::create_directories(scratch / "empty");
  CHECK(rule(scratch / "empty") == "export.folder");
  CHECK(rule(source / "configs/unit_cell.yaml") == "export.friction");
  CHECK(rule(source / "configs/calibrate.yaml", {"effects={static_peak: {amplitude: 0.3}}"}) ==
        "export.memory");
}
