#include "pipeline/command_line.h"

#include <catch2/catch.hpp>
#include <cstdlib>

#include "core/problem.h"
#include "tests/source_dir.h"

using namespace heddle::pipeline;

namespace {

/// What was called, and with what.
struct Record {
  std::string called;
  RunOptions run;
  CheckOptions check;
  CalibrateOptions calibrate;
  DiscoverOptions discover;
  ExportOptions exported;
};

int call(const std::vector<std::string>& arguments, Record& record) {
  const auto note = [&](const char* name) {
    return [&record, name](const RunOptions& options) {
      record.called = name;
      record.run = options;
      return 7;
    };
  };
  return dispatch(arguments, {.run = note("run"),
                              .weave = note("weave"),
                              .friction = note("friction"),
                              .check =
                                  [&](const CheckOptions& options) {
                                    record.called = "check";
                                    record.check = options;
                                    return 8;
                                  },
                              .calibrate =
                                  [&](const CalibrateOptions& options) {
                                    record.called = "calibrate";
                                    record.calibrate = options;
                                    return 9;
                                  },
                              .discover =
                                  [&](const DiscoverOptions& options) {
                                    record.called = "discover";
                                    record.discover = options;
                                    return 11;
                                  },
                              .export_law =
                                  [&](const ExportOptions& options) {
                                    record.called = "export";
                                    record.exported = options;
                                    return 10;
                                  }});
}

}  // namespace

TEST_CASE("run takes file, folder, threads and assignments in order", "[pipeline][command_line]") {
  Record record;
  CHECK(call({"run", "case.yaml", "-o", "out/x", "-j", "2", "--set", "blank.size=[320 mm, 320 mm]", "--set",
              "weave.gap=1.5 mm", "--resume", "--force", "--quiet"},
             record) == 7);
  CHECK(record.called == "run");
  CHECK(record.run.file == "case.yaml");
  CHECK(record.run.output == "out/x");
  CHECK(record.run.threads == 2);
  CHECK(record.run.assignments ==
        std::vector<std::string>{"blank.size=[320 mm, 320 mm]", "weave.gap=1.5 mm"});
  CHECK(record.run.resume);
  CHECK(record.run.force);
  CHECK(record.run.quiet);
}

TEST_CASE("an assignment does not swallow the file after it", "[pipeline][command_line]") {
  Record record;
  CHECK(call({"run", "--set", "effects={tool_temperature_shift: {slope: 0 1/K}}", "case.yaml"}, record) == 7);
  CHECK(record.run.file == "case.yaml");
  CHECK(record.run.assignments ==
        std::vector<std::string>{"effects={tool_temperature_shift: {slope: 0 1/K}}"});
}

TEST_CASE("each subcommand reaches its function", "[pipeline][command_line]") {
  Record record;
  CHECK(call({"weave", "a.yaml"}, record) == 7);
  CHECK(record.called == "weave");
  CHECK(call({"friction", "a.yaml"}, record) == 7);
  CHECK(record.called == "friction");
  CHECK(call({"check", "a.yaml"}, record) == 8);
  CHECK(record.called == "check");
  CHECK(record.check.file == "a.yaml");
  CHECK(call({"check", "--reference"}, record) == 8);
  CHECK(record.check.reference);
  const std::string data = std::string(heddle::test::source_dir) + "/configs/data/friction_table4.csv";
  CHECK(call({"calibrate", "a.yaml", "--data", data, "-o", "out/x"}, record) == 9);
  CHECK(record.called == "calibrate");
  CHECK(record.calibrate.run.file == "a.yaml");
  CHECK(record.calibrate.run.output == "out/x");
  CHECK(record.calibrate.data == data);
  CHECK(call({"discover", "a.yaml", "--data", data, "--seed", "3", "--resume"}, record) == 11);
  CHECK(record.called == "discover");
  CHECK(record.discover.run.file == "a.yaml");
  CHECK(record.discover.run.resume);
  CHECK(record.discover.data == data);
  CHECK(record.discover.seed == 3);
  CHECK(call({"export", "out/x", "--to", "abaqus"}, record) == 10);
  CHECK(record.called == "export");
  CHECK(record.exported.run.file == "out/x");
  CHECK(record.exported.target == "abaqus");
  CHECK(call({"export", "out/x", "--to", "ccx", "--stress-free", "120 degC", "--room", "20 degC"}, record) ==
        10);
  CHECK(record.exported.stress_free == "120 degC");
  CHECK(record.exported.room == "20 degC");
}

TEST_CASE("a faulty interval in the environment is refused", "[pipeline][command_line]") {
  Record record;
  REQUIRE(setenv("HEDDLE_CHECKPOINT_SECONDS", "soon", 1) == 0);
  std::string broken;
  try {
    call({"run", "a.yaml"}, record);
  } catch (const heddle::InputError& error) {
    broken = error.problems().front().id;
  }
  unsetenv("HEDDLE_CHECKPOINT_SECONDS");
  CHECK(broken == "environment.checkpoint_seconds");
  CHECK(record.called.empty());
}

TEST_CASE("a faulty command line is bad input and calls nothing", "[pipeline][command_line]") {
  Record record;
  CHECK(call({}, record) == exit_bad_input);
  CHECK(call({"run"}, record) == exit_bad_input);
  CHECK(call({"check"}, record) == exit_bad_input);
  CHECK(call({"fly", "a.yaml"}, record) == exit_bad_input);
  CHECK(call({"run", "a.yaml", "--fast"}, record) == exit_bad_input);
  CHECK(call({"run", "a.yaml", "-j", "0"}, record) == exit_bad_input);
  CHECK(call({"calibrate", "a.yaml"}, record) == exit_bad_input);  // fitted to what?
  CHECK(call({"export", "a.yaml", "--to", "nowhere"}, record) == exit_bad_input);
  CHECK(call({"calibrate", "a.yaml", "--data", "no-such-file.csv"}, record) == exit_bad_input);
  CHECK(record.called.empty());
  CHECK(call({"--version"}, record) == exit_done);
  CHECK(call({"--help"}, record) == exit_done);
  CHECK(record.called.empty());
}
