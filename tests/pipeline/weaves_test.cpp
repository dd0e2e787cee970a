// The configurations of configs/weaves.
#include <unistd.h>

#include <catch2/catch.hpp>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "core/text_file.h"
#include "pipeline/case.h"
#include "pipeline/commands.h"
#include "tests/source_dir.h"

using namespace heddle;
namespace fs = std::filesystem;

namespace {

const fs::path folder = fs::path(heddle::test::source_dir) / "configs/weaves";

nlohmann::json summary_of(const fs::path& file, std::vector<std::string> settings) {
  const fs::path output =
      fs::temp_directory_path() / ("heddle-weaves-" + std::to_string(getpid()) + "-" + file.stem().string());
  pipeline::RunOptions options;
  options.file = file;
  options.output = output;
  options.assignments = std::move(settings);
  options.cache = HEDDLE_TEST_CACHE;
  options.quiet = true;
  options.print = false;
  REQUIRE(pipeline::weave_case(options) == 0);
  auto summary = nlohmann::json::parse(read_text_file(output / "summary.json"))["mesoscale"];
  summary["report"] = read_text_file(output / "report.html");
  summary["resolved"] = read_text_file(output / "resolved.yaml");
  if (fs::exists(output / "mesoscale/nesting.csv"))
    summary["nesting"] = read_text_file(output / "mesoscale/nesting.csv");
  if (fs::exists(output / "mesoscale/stiffness.json"))
    summary["stiffness"] = nlohmann::json::parse(read_text_file(output / "mesoscale/stiffness.json"));
  fs::remove_all(output);
  return summary;
}

}  // namespace

TEST_CASE("every weave of configs/weaves is a case without a problem", "[pipeline][weaves]") {
  int files = 0;
  for (const auto& entry : fs::directory_iterator(folder)) {
    CAPTURE(entry.path().string());
    CHECK_NOTHROW(pipeline::read_case(entry.path()));
    ++files;
  }
  CHECK(files >= 4);
}

TEST_CASE("every weave of configs/weaves runs, and no tow reaches into another", "[pipeline][weaves][slow]") {
  for (const auto& entry : fs::directory_iterator(folder)) {
    CAPTURE(entry.path().string());
    const auto summary = summary_of(entry.path(), {});
    CHECK(summary["height_overlap_depth_mm"] == 0.0);
    CHECK(summary["height_overlap_volume_mm3"] == 0.0);
    CHECK(summary["tow_overlap_share"] < 1e-4);
  }
}

TEST_CASE("tows that overlap are stated in summary and report, with depth and volume", "[pipeline][weaves]") {
  const auto summary =
      summary_of(fs::path(heddle::test::source_dir) / "configs/unit_cell.yaml", {"weave.section=ellipse"});
  CHECK(summary["height_overlap_depth_mm"] > 0.05);
  CHECK(summary["height_overlap_volume_mm3"] > 0.5);
  CHECK(summary["report"].get<std::string>().find("Tows reach into each other by up to") !=
        std::string::npos);
  CHECK(summary["report"].get<std::string>().find("and cuts into them by up to") != std::string::npos);
  CHECK(summary["resolved"].get<std::string>().find("section: ellipse") != std::string::npos);
}

TEST_CASE("a stack of plies is stated in summary, table, report and stiffness",
          "[pipeline][weaves][stack][long]") {
  const auto summary = summary_of(folder / "stack.yaml", {"solid={per_pitch: 8, layers: 6}"});
  CHECK(summary["stack"]["plies"] == 2);
  CHECK(summary["stack"]["thickness_mm"].get<double>() == Approx(2.5152).epsilon(1e-4));
  CHECK(summary["stack"]["thickness_apart_mm"].get<double>() == Approx(3.0));
  CHECK(summary["stack"]["void_share"].get<double>() < summary["void_share"].get<double>());
  const std::string table = summary["nesting"];
  CHECK(table.starts_with("shift_warp_mm,shift_weft_mm,thickness_mm,glass_share\n0,0,3"));
  CHECK(summary["report"].get<std::string>().find("Plies on one another") != std::string::npos);
  CHECK(summary["report"].get<std::string>().find("A laminate of 2 plies") != std::string::npos);
  const auto& laminate = summary["stiffness"]["laminate"];
  CHECK(laminate["converged"] == true);
  CHECK(laminate["thickness_mm"].get<double>() ==
        Approx(2.0 * summary["consolidated_thickness_mm"].get<double>()));
  CHECK(laminate["together"]["A_N_per_mm"][0][0] > laminate["apart"]["A_N_per_mm"][0][0]);
  // A lone ply says nothing of stacks.
  CHECK_FALSE(summary_of(folder / "twill.yaml", {}).contains("stack"));
}

TEST_CASE("the compacted state goes from a file to the summary, by thickness and by pressure",
          "[pipeline][weaves][state][long]") {
  const fs::path file = fs::path(heddle::test::source_dir) / "configs/unit_cell.yaml";
  const auto thin = summary_of(file, {"cell={state: compacted, thickness: 0.8 mm}"});
  CHECK(thin["thickness_mm"].get<double>() == Approx(0.8));
  CHECK(thin["void_share"].get<double>() == Approx(1.0 - 0.4757 / 0.8).epsilon(1e-3));
  CHECK(thin["report"].get<std::string>().find("free of stress at its thickness") != std::string::npos);
  const auto pressed = summary_of(file, {"cell={state: compacted, pressure: 10 kPa}"});
  CHECK(pressed["thickness_mm"].get<double>() == Approx(0.5844).margin(1e-4));
}
