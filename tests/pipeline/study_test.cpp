// `heddle study` from the command to the files it leaves.
#include "pipeline/study_command.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>

#include "core/csv.h"
#include "core/hdf5_file.h"
#include "core/problem.h"
#include "pipeline/outputs.h"
#include "scratch.h"

using namespace heddle;
using heddle::test::Scratch;
namespace fs = std::filesystem;

namespace {

pipeline::RunOptions small_study(const fs::path& output) {
  pipeline::RunOptions options;
  options.file = fs::path(heddle::test::source_dir) / "configs" / "study_weave.yaml";
  options.output = output;
  options.assignments = {"study={pattern: [twill 2/2], gap: [1 mm], shear_angle: [0 deg, 40 deg]}",
                         "solid={per_pitch: 4, layers: 4}"};
  options.quiet = true;
  options.print = false;
  return options;
}

std::size_t column(const CsvTable& table, const std::string& name) {
  const auto& cells = table.header.cells;
  const auto found = std::find(cells.begin(), cells.end(), name);
  REQUIRE(found != cells.end());
  return static_cast<std::size_t>(found - cells.begin());
}

}  // namespace

TEST_CASE("a study leaves a row a weave and angle, slopes, and a page that shows them", "[pipeline][study]") {
  const Scratch scratch;
  REQUIRE(pipeline::study_case(small_study(scratch / "a")) == pipeline::exit_done);
  const CsvTable table = read_csv(scratch / "a" / "table.csv");
  REQUIRE(table.problems.empty());
  REQUIRE(table.rows.size() == 3 * 2);  // the weave given, the twill, the wider gap; at two angles
  CHECK(table.rows[2].cells[column(table, "pattern")] == "twill 2/2");
  CHECK(table.rows[4].cells[column(table, "gap_mm")] == "1");
  const auto crimp = [&](std::size_t row) {
    return std::stod(table.rows[row].cells[column(table, "crimp_warp")]);
  };
  CHECK(crimp(0) == Approx(0.01156).epsilon(1e-3));  // Table 1's fabric, as docs/theory/mesoscale.md has it
  CHECK(crimp(2) == Approx(0.5 * crimp(0)).epsilon(1e-6));  // every second step of a 2/2 twill floats

  const Hdf5Reader file(pipeline::read_file(scratch / "a" / "table.h5"));
  CHECK(file.doubles("/results/crimp_warp").at(2) == crimp(2));
  CHECK(file.doubles("/keys/shear_angle_deg").at(1) == Approx(40.0));

  const CsvTable slopes = read_csv(scratch / "a" / "sensitivities.csv");
  CHECK(slopes.problems.empty());
  CHECK(slopes.rows.size() > 60);
  const std::string page = pipeline::read_file(scratch / "a" / "report.html");
  CHECK(page.find("First-order sensitivities") != std::string::npos);
  CHECK(page.find("What shear does") != std::string::npos);
}

TEST_CASE("the same study leaves the same bytes, out of the cache as well", "[pipeline][study]") {
  const Scratch scratch;
  auto options = small_study(scratch / "a");
  options.assignments = {"study={gap: [1 mm], sensitivities: off}", "solid={per_pitch: 4, layers: 4}"};
  options.cache = scratch / "cache";
  REQUIRE(pipeline::study_case(options) == pipeline::exit_done);
  options.output = scratch / "b";
  REQUIRE(pipeline::study_case(options) == pipeline::exit_done);
  CHECK(pipeline::read_file(scratch / "b" / "manifest.json").find("\"reused\": true") != std::string::npos);
  options.output = scratch / "c";
  options.cache.clear();
  REQUIRE(pipeline::study_case(options) == pipeline::exit_done);
  const auto a = heddle::test::contents(scratch / "a");
  CHECK(heddle::test::first_difference(a, heddle::test::contents(scratch / "b")) == "");
  CHECK(heddle::test::first_difference(a, heddle::test::contents(scratch / "c")) == "");
}

TEST_CASE("a case without a study is refused with the way out", "[pipeline][study]") {
  const Scratch scratch;
  auto options = small_study(scratch / "a");
  options.file = fs::path(heddle::test::source_dir) / "configs" / "unit_cell.yaml";
  options.assignments.clear();
  try {
    pipeline::study_case(options);
    FAIL("a case without a study was run");
  } catch (const InputError& error) {
    CHECK(error.problems().front().id == "study.missing");
  }
}

TEST_CASE("a solid cell goes out as a CalculiX deck, and without one the way out is named",
          "[pipeline][export]") {
  const Scratch scratch;
  pipeline::ExportOptions options;
  options.run = small_study(scratch / "deck");
  options.target = "ccx";
  REQUIRE(pipeline::export_case(options) == pipeline::exit_done);
  const std::string deck = pipeline::read_file(scratch / "deck" / "cell.inp");
  CHECK(deck.find("*ELEMENT, TYPE=C3D8") != std::string::npos);
  options.run.file = fs::path(heddle::test::source_dir) / "configs" / "unit_cell.yaml";
  options.run.assignments.clear();
  try {
    pipeline::export_case(options);
    FAIL("a cell that is not there went out");
  } catch (const InputError& error) {
    CHECK(error.problems().front().id == "export.solid");
  }
}
