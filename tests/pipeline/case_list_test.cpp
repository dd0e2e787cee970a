// Lists of cases: one after the other, each with its record, none twice.
#include <catch2/catch.hpp>

#include <signal.h>

#include <atomic>
#include <chrono>
#include <fstream>
#include <thread>

#include "core/problem.h"
#include "pipeline/case_list.h"
#include "tests/pipeline/scratch.h"
#include "tests/source_dir.h"

using namespace heddle;
using namespace heddle::test;
using pipeline::CaseStatus;

namespace {

const fs::path config = fs::path(source_dir) / "configs/thermostamping.yaml";

std::vector<std::string> quick(const std::string& more) {
  return with(with(with(small_stamping(), "process.steps=2"), "friction={law: coulomb, coefficient: 0.3}"),
              more);
}

double result_of(const pipeline::CaseRecord& record, const std::string& name) {
  for (const auto& [key, value] : record.results)
    if (key == name) return value;
  FAIL("no result " << name);
  return 0.0;
}

}  // namespace

TEST_CASE("a list of cases runs each once, keeps a record of each, and is not stopped by one that fails",
          "[pipeline][cases]") {
  const Scratch scratch;
  warm(scratch / "cache");
  std::vector<pipeline::ListedCase> cases{
      {"soft", config, quick("process.binder_force=500 N")},
      {"broken", config, quick(softest_fabric(scratch / "softest.csv"))},
      {"wrong", config, quick("process.binder_force=many")},
      {"hard", config, quick("process.binder_force=2000 N")},
  };
  pipeline::CaseListOptions options{.folder = scratch / "list", .cache = scratch / "cache", .quiet = true};
  const auto first = pipeline::run_case_list(cases, options);
  REQUIRE(first.size() == 4);
  CHECK(first[0].status == CaseStatus::done);
  CHECK(first[1].status == CaseStatus::failed);
  CHECK(first[2].status == CaseStatus::bad_input);
  CHECK(first[3].status == CaseStatus::done);
  CHECK_THAT(first[1].message, Catch::Contains("closing the binder"));
  CHECK_THAT(first[2].message, Catch::Contains("process.binder_force"));
  const std::string force = "macroscale.peak_punch_force_N";
  CHECK(result_of(first[3], force) > result_of(first[0], force));
  CHECK(fs::exists(scratch / "list/cases/soft/report.html"));
  const auto bytes = contents(scratch / "list");
  for (const pipeline::CaseRecord& record : first) {
    const std::string name = "cases/" + record.id + ".json";
    REQUIRE(bytes.count(name) == 1);
    const auto back = pipeline::read_record(bytes.at(name), name);
    CHECK(back.status == record.status);
    CHECK(back.results == record.results);
    CHECK(pipeline::record_json(back) == bytes.at(name));
  }

  // Again: done cases are left alone, the one with new inputs is run, records stay the same bytes.
  const auto report = scratch / "list/cases/soft/report.html";
  const auto time = fs::last_write_time(report);
  CHECK(pipeline::run_case_list(cases, options)[0].run_before);
  CHECK(fs::last_write_time(report) == time);
  CHECK(first_difference(bytes, contents(scratch / "list")) == "");
  cases[3].assignments = quick("process.binder_force=1000 N");
  cases[2].assignments = quick("process.binder_force=500 N");  // the same as `soft`: out of the cache
  const auto second = pipeline::run_case_list(cases, options);
  CHECK(second[0].run_before);
  CHECK_FALSE(second[1].run_before);  // what failed is tried again
  CHECK(second[2].status == CaseStatus::done);
  CHECK(second[2].results == second[0].results);
  CHECK(reused(scratch / "list/cases/wrong") == "mesoscale friction macroscale");
  CHECK_FALSE(second[3].run_before);
  CHECK(result_of(second[3], force) < result_of(first[3], force));
}

TEST_CASE("a record that cannot be read counts as none, and says so", "[pipeline][cases][wrong input]") {
  const Scratch scratch;
  warm(scratch / "cache");
  const std::vector<pipeline::ListedCase> cases{
      {"cell", fs::path(source_dir) / "configs/unit_cell.yaml", {}}};
  const pipeline::CaseListOptions options{
      .folder = scratch / "list", .cache = scratch / "cache", .quiet = true};
  CHECK_FALSE(pipeline::run_case_list(cases, options)[0].run_before);
  CHECK(pipeline::run_case_list(cases, options)[0].run_before);
  std::ofstream(scratch / "list/cases/cell.json") << "{\"id\": \"cell\", \"status\": \"well\"}";
  const auto again = pipeline::run_case_list(cases, options);
  CHECK(again[0].status == CaseStatus::done);
  CHECK_FALSE(again[0].run_before);
  try {
    pipeline::read_record("{", "x.json");
    FAIL("was accepted");
  } catch (const InputError& error) {
    CHECK(error.problems().front().id == "cases.record");
    CHECK_THAT(error.what(), Catch::Contains("is no record of a case"));
  }
}

TEST_CASE("a list that is interrupted goes on in the middle of the case it was at", "[pipeline][cases]") {
  const Scratch scratch;
  warm(scratch / "cache");
  const auto steps = with(quick("process.steps=40"), "blank.spacing=26 mm");
  const std::vector<pipeline::ListedCase> cases{{"a", config, quick("process.binder_force=500 N")},
                                                {"b", config, steps},
                                                {"c", config, quick("process.binder_force=600 N")}};
  pipeline::CaseListOptions options{
      .folder = scratch / "list", .cache = scratch / "cache", .checkpoint_interval = 0.0, .quiet = true};
  // Outside a run the signal does nothing here; inside, the run takes it.
  struct sigaction ignore {
  }, before{};
  ignore.sa_handler = SIG_IGN;
  sigaction(SIGTERM, &ignore, &before);
  std::atomic<bool> over{false};
  std::thread user([&] {
    while (!over && !fs::exists(scratch / "list/cases/b/macroscale/checkpoint.h5"))
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    if (!over) kill(getpid(), SIGTERM);
  });
  const auto first = pipeline::run_case_list(cases, options);
  over = true;
  user.join();
  sigaction(SIGTERM, &before, nullptr);
  REQUIRE(first.size() == 2);
  CHECK(first[1].status == CaseStatus::interrupted);
  CHECK_THAT(first[1].message, Catch::Contains("interrupted at step") && Catch::Contains("of 40"));
  const auto second = pipeline::run_case_list(cases, options);
  REQUIRE(second.size() == 3);
  CHECK(second[0].run_before);
  CHECK(second[1].status == CaseStatus::done);
  CHECK_THAT(pipeline::read_file(scratch / "list/cases/b/log.txt"),
             Catch::Contains("of 40 steps were done before"));
  CHECK(second[2].status == CaseStatus::done);
}

TEST_CASE("ids of a list that repeat or cannot name a folder are refused, all at once",
          "[pipeline][cases][wrong input]") {
  const Scratch scratch;
  const std::vector<pipeline::ListedCase> cases{{"a", config}, {"a", config}, {"b/c", config}, {"", config}};
  try {
    pipeline::run_case_list(cases, {.folder = scratch / "list"});
    FAIL("nothing was refused");
  } catch (const InputError& error) {
    REQUIRE(error.problems().size() == 3);
    CHECK(error.problems()[0].id == "cases.id.unique");
    CHECK(error.problems()[1].id == "cases.id.word");
    CHECK(error.problems()[2].id == "cases.id.word");
  }
  CHECK_FALSE(fs::exists(scratch / "list"));
}
