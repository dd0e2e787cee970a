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
