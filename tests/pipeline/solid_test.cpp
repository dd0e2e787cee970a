// The stiffness of the solid part from configuration to file, report and cache.
#include <unistd.h>

#include <Eigen/LU>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "core/text_file.h"
#include "pipeline/case.h"
#include "pipeline/commands.h"
#include "pipeline/report_solid.h"
#include "pipeline/solid_store.h"
#include "tests/source_dir.h"

using namespace heddle;
namespace fs = std::filesystem;
namespace solid = mesoscale::solid;

namespace {

struct Scratch {
  Scratch() : path(fs::temp_directory_path() / ("heddle-solid-test-" + std::to_string(getpid()))) {
    fs::create_directories(path);
  }
  ~Scratch() {
    std::error_code ignored;  // a folder that stays behind is no failure of the test
    fs::remove_all(path, ignored);
  }
  fs::path path;
};

pipeline::RunOptions options_for(const std::string& config, const fs::path& output,
                                 std::vector<std::string> settings) {
  pipeline::RunOptions options;
  options.file = fs::path(heddle::test::source_dir) / "configs" / config;
  options.output = output;
  options.assignments = std::move(settings);
  options.cache = HEDDLE_TEST_CACHE;
  options.quiet = true;
  options.print = false;
  return options;
}

const std::vector<std::string> coarse{"solid={per_pitch: 8, layers: 6, shear_angles: [0 deg, 30 deg]}"};

solid::SolidResult sample() {
  solid::SolidSpec spec;
  spec.grid = {.per_pitch = 6, .layers = 4};
  spec.shear_angles = {0.0, 0.5};
  spec.stack = {2, {0.0, 2.5e-3}, {}};
  return solid::analyse(mesoscale::WeaveSpec{}, spec);
}

bool has(const std::vector<pipeline::Verdict>& verdicts, pipeline::Tone tone, const std::string& text) {
  return std::any_of(verdicts.begin(), verdicts.end(), [&](const pipeline::Verdict& verdict) {
    return verdict.tone == tone && verdict.text.find(text) != std::string::npos;
  });
}

}  // namespace

TEST_CASE("a weave with solid writes its stiffness, from the cache to the same bytes", "[pipeline][solid]") {
  const Scratch scratch;
  auto options = options_for("unit_cell.yaml", scratch.path / "first", coarse);
  CHECK(pipeline::weave_case(options) == 0);
  const std::string text = read_text_file(scratch.path / "first/mesoscale/stiffness.json");
  const auto json = nlohmann::json::parse(text);
  CHECK(json["order"] == std::vector<std::string>{"11", "22", "33", "23", "13", "12"});
  CHECK(json["scaling"] == "voigt");
  CHECK(json["voxels"] == std::vector<int>{16, 16, 6});
  CHECK(json["iterations"].size() == 12);
  CHECK(json["C_MPa"].size() == 6);
  CHECK(json["C_MPa"][0][0].get<double>() == Approx(16000).epsilon(0.05));
  CHECK(json["A_N_per_mm"][0][0].get<double>() == Approx(6200).epsilon(0.05));
  CHECK(json["B_N"].size() == 3);
  CHECK(json["D_N_mm"][0][0].get<double>() == Approx(55).epsilon(0.15));
  // Free expansion per kelvin: more than glass, far less than resin; the tabled unsheared ply is the ply.
  CHECK(json["ply_expansion_1_per_K"][0].get<double>() > 5e-6);
  CHECK(json["ply_expansion_1_per_K"][0].get<double>() < 0.5 * 1.2e-4);
  CHECK(json["ply_expansion_1_per_K"][0].get<double>() ==
        Approx(json["ply_expansion_1_per_K"][1].get<double>()).epsilon(1e-3));
  CHECK(json["sheared"].size() == 2);
  CHECK(json["sheared"][0]["A_N_per_mm"] == json["A_N_per_mm"]);
  CHECK(json["sheared"][1]["thickness_mm"].get<double>() ==
        Approx(json["sheared"][0]["thickness_mm"].get<double>() / std::cos(std::acos(-1.0) / 6.0)));
  const std::string table = read_text_file(scratch.path / "first/mesoscale/stiffness_by_shear.csv");
  CHECK(std::count(table.begin(), table.end(), '\n') == 3);
  CHECK(table.starts_with("shear_angle_deg,thickness_mm,tow_fibre_volume_fraction,A11_N_per_mm,"));
  const std::string report = read_text_file(scratch.path / "first/report.html");
  CHECK(report.find("The solid part") != std::string::npos);
  CHECK(report.find("The solid is balanced") != std::string::npos);
  CHECK(report.find("thermal resultants of the ply against its trellis angle") != std::string::npos);
  CHECK(report.find("Stiffness of the ply by trellis angle") != std::string::npos);

  options.output = scratch.path / "second";
  CHECK(pipeline::weave_case(options) == 0);
  CHECK(read_text_file(scratch.path / "second/mesoscale/stiffness.json") == text);
  const auto manifest = nlohmann::json::parse(read_text_file(scratch.path / "second/manifest.json"));
  CHECK(manifest["stages"]["solid"]["reused"] == true);
}

TEST_CASE("two load cases at once give the file of six to six digits, of a weave and of voxels",
          "[pipeline][solid][long]") {
  const Scratch scratch;
  const auto stiffness = [&](const char* config, const char* name, std::vector<std::string> settings) {
    REQUIRE(pipeline::weave_case(options_for(config, scratch.path / name, std::move(settings))) == 0);
    const auto json = nlohmann::json::parse(read_text_file(scratch.path / name / "mesoscale/stiffness.json"));
    return json["C_MPa"].get<std::vector<std::vector<double>>>();
  };
  const auto compare = [](const auto& two, const auto& six) {
    bool other = false;
    for (std::size_t i = 0; i < 6; ++i)
      for (std::size_t j = 0; j < 6; ++j) {
        CHECK(two[i][j] == Approx(six[i][j]).epsilon(1e-6).margin(1e-6 * six[0][0]));
        other = other || two[i][j] != six[i][j];
      }
    CHECK(other);  // solved anew, not out of the cache
  };
  std::vector<std::string> pairs = coarse;
  pairs.push_back("solid.load_cases_at_once=2");
  compare(stiffness("unit_cell.yaml", "weave2", pairs), stiffness("unit_cell.yaml", "weave6", coarse));
  compare(stiffness("voxel_cell.yaml", "voxels2", {"cell.voxels.load_cases_at_once=2"}),
          stiffness("voxel_cell.yaml", "voxels6", {}));
}

TEST_CASE("a weave without solid writes no stiffness and says nothing of it", "[pipeline][solid]") {
  const Scratch scratch;
  CHECK(pipeline::weave_case(options_for("unit_cell.yaml", scratch.path / "plain", {})) == 0);
  CHECK_FALSE(fs::exists(scratch.path / "plain/mesoscale/stiffness.json"));
  const std::string report = read_text_file(scratch.path / "plain/report.html");
  CHECK(report.find("The solid part") == std::string::npos);
  CHECK(report.find("Patches of the upper face that touch a flat tool, sheared by 30 degrees") !=
        std::string::npos);
}

TEST_CASE("a voxel file is homogenised as a stack and as a plate", "[pipeline][solid][long]") {
  const Scratch scratch;
  CHECK(pipeline::weave_case(options_for("voxel_cell.yaml", scratch.path / "stack", {})) == 0);
  const auto stack = nlohmann::json::parse(read_text_file(scratch.path / "stack/mesoscale/stiffness.json"));
  CHECK(stack["C_MPa"][0][0].get<double>() == Approx(7854.094).epsilon(1e-5));
  CHECK(stack["C_MPa"][2][2].get<double>() == Approx(5273.421).epsilon(1e-5));
  CHECK(stack["C_MPa"][5][5].get<double>() ==
        Approx(0.5 * 4561.944).epsilon(1e-5));  // Mandel's is twice Voigt's
  CHECK(stack.count("A_N_per_mm") == 0);
  CHECK(fs::exists(scratch.path / "stack/inputs"));  // the folder runs on its own
}

TEST_CASE("a solid result comes back from the cache's bytes bit for bit", "[pipeline][solid][cache]") {
  const solid::SolidResult before = sample();
  const std::string bytes = pipeline::bytes_of(before, "key");
  const solid::SolidResult after = pipeline::read_solid_result(Hdf5Reader(bytes));
  CHECK(pipeline::bytes_of(after, "key") == bytes);
  CHECK(pipeline::stiffness_json(after) == pipeline::stiffness_json(before));
  CHECK(pipeline::stiffness_tables(after) == pipeline::stiffness_tables(before));
  CHECK(after.stack->reuss == before.stack->reuss);
  CHECK(after.sheared.size() == 2);
  CHECK(pipeline::sheared_csv(after.sheared) == pipeline::sheared_csv(before.sheared));
  CHECK(after.plate->upper == before.plate->upper);
  CHECK(after.laminate->plate == before.laminate->plate);
  CHECK(pipeline::laminate_table(after) == pipeline::laminate_table(before));
  CHECK(after.balance.size() == before.balance.size());
}

TEST_CASE("verdicts name moduli that should be equal and are not, with both numbers", "[pipeline][solid]") {
  solid::SolidResult result = sample();
  CHECK(has(pipeline::solid_verdicts(result), pipeline::Tone::holds, "C11 = C22, C13 = C23, G13 = G23"));
  CHECK(has(pipeline::solid_verdicts(result), pipeline::Tone::note, "solid.resin_modulus"));
  result.stack->stiffness(0, 0) = 5815e6;
  result.stack->stiffness(1, 1) = 7531e6;
  result.balance = solid::balance_of(result);
  const auto verdicts = pipeline::solid_verdicts(result);
  CHECK(has(verdicts, pipeline::Tone::attention, "C11 is 5815 MPa and C22 is 7531 MPa, 23 % apart"));
  CHECK_FALSE(has(verdicts, pipeline::Tone::holds, "balanced"));
  result.plate->solver.converged = false;
  result.plate->solver.reason = "1000 iterations were not enough";
  CHECK(has(pipeline::solid_verdicts(result), pipeline::Tone::fails, "1000 iterations were not enough"));
}

TEST_CASE("what the check of a solid case would run is said in a line", "[pipeline][solid]") {
  const auto lines = [](const std::string& config, const std::vector<std::string>& settings) {
    std::string text;
    for (const std::string& line : pipeline::stage_lines(
             pipeline::read_case(fs::path(heddle::test::source_dir) / "configs" / config, settings)))
      text += line + "\n";
    return text;
  };
  CHECK(lines("unit_cell.yaml", coarse)
            .find("solid: stiffness of the consolidated weave, 8 voxels a pitch, 6 layers") !=
        std::string::npos);
  CHECK(lines("voxel_cell.yaml", {}) == "solid: stiffness of 64 x 64 x 64 voxels, periodic\n");
}
