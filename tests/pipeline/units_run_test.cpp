// One case in two systems of units.
#include <unistd.h>

#include <catch2/catch.hpp>
#include <filesystem>

#include "core/text_file.h"
#include "pipeline/case.h"
#include "pipeline/commands.h"
#include "tests/source_dir.h"

using namespace heddle;
namespace fs = std::filesystem;

namespace {

const fs::path folder = fs::path(heddle::test::source_dir) / "tests/pipeline/units";

pipeline::Case read(const char* name, const std::vector<std::string>& settings = {}) {
  return pipeline::read_case(folder / name, settings);
}

}  // namespace

TEST_CASE("a case in millimetres, newtons and megapascals gives the bytes of the same case in SI",
          "[pipeline][run][units][long]") {
  CHECK(read_text_file(folder / "millimetres.yaml") != read_text_file(folder / "metres.yaml"));
  const std::string resolved = pipeline::resolved_yaml(read("millimetres.yaml").settings);
  CHECK(resolved == pipeline::resolved_yaml(read("metres.yaml").settings));
  // The comparison can fail: a tenth of a nanometre is seen.
  CHECK(resolved !=
        pipeline::resolved_yaml(read("metres.yaml", {"tools.punch.radius=0.0700000001 m"}).settings));

  const fs::path scratch = fs::temp_directory_path() / ("heddle-units-test-" + std::to_string(getpid()));
  for (const char* name : {"millimetres", "metres"}) {
    pipeline::RunOptions options;
    options.file = folder / (std::string(name) + ".yaml");
    options.output = scratch / name;
    options.quiet = true;
    options.print = false;  // and no cache: both are computed
    REQUIRE(pipeline::run_case(options) == pipeline::exit_done);
  }
  for (const char* file :
       {"summary.json", "macroscale/history.csv", "mesoscale/fabric.json", "friction/curve.csv"})
    CHECK(read_text_file(scratch / "millimetres" / file) == read_text_file(scratch / "metres" / file));
  fs::remove_all(scratch);
}

TEST_CASE("degrees and degrees Celsius are radians and kelvins to the last digits", "[pipeline][units]") {
  const auto degrees = read("metres.yaml");
  const auto radians =
      read("metres.yaml", {"blank.orientation=0.17453292519943295 rad", "process.tool_temperature=358.15 K",
                           "process.blank_temperature=453.15 K", "resin.reference_temperature=453.15 K"});
  CHECK(radians.stamping->blank.orientation == Approx(degrees.stamping->blank.orientation).epsilon(1e-15));
  CHECK(radians.stamping->process.tool_temperature ==
        Approx(degrees.stamping->process.tool_temperature).epsilon(1e-15));
  CHECK(radians.stamping->process.blank_temperature ==
        Approx(degrees.stamping->process.blank_temperature).epsilon(1e-15));
  CHECK(radians.friction->model.film.reference_temperature ==
        Approx(degrees.friction->model.film.reference_temperature).epsilon(1e-15));
}
