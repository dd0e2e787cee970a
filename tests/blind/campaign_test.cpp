#include <unistd.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>

#include "judge.h"
#include "pipeline/outputs.h"
#include "run.h"

using namespace heddle::blind;
namespace fs = std::filesystem;

namespace {

class Folder {
 public:
  Folder() : path_(fs::temp_directory_path() / ("heddle-blind-test-" + std::to_string(getpid()))) {
    fs::remove_all(path_);
    fs::create_directories(path_);
  }
  ~Folder() {
    std::error_code ignored;  // a folder that stays behind is no failure of the test
    fs::remove_all(path_, ignored);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  fs::path operator/(const std::string& name) const { return path_ / name; }

 private:
  fs::path path_;
};

/// Stands in for `heddle discover`: refuses a folder that holds more than the data, dies on case 2, sleeps on
/// case 3, else says NO_GAP.
constexpr const char* answering_machine = R"sh(#!/bin/sh
while [ $# -gt 0 ]; do
  case $1 in -o) out=$2;; --seed) seed=$2;; esac
  shift
done
[ "$(ls)" = "data.csv
data.yaml" ] || exit 3
[ "$seed" = 2 ] && kill -9 $$
[ "$seed" = 3 ] && exec sleep 60
mkdir "$out"
echo '{"verdict": "NO_GAP", "effects": [], "candidate_set": [], "ranking": [], "next_experiments":
 [{"velocity_mm_s": 83.3}, {"tool_temperature_C": 140, "dwell_s": 2}, {"normal_force_N": 343}, {"dwell_s": 60}]}' \
 > "$out/report.json"
)sh";

RunOptions options(const Folder& folder) {
  const fs::path program = folder / "machine", config = folder / "case.yaml";
  std::ofstream(program) << answering_machine;
  fs::permissions(program, fs::perms::owner_all);
  std::ofstream(config) << "heddle: 1\n";
  return {.program = program, .config = config, .processes = 2, .time_limit = 2.0};
}

Manifest manifest(int limit) {
  Manifest m;
  m.campaign = "smoke";
  m.selection.limit = limit;
  return m;
}

bool never() {
  return false;
}
void silent(const RunSummary&) {}

}  // namespace

TEST_CASE("campaigns have the cases that the protocol asks for, under numbers that say nothing", "[blind]") {
  const auto cases = plan("acceptance", {.seed = 4711});
  std::map<blindgen::Kind, int> kinds;
  std::map<blindgen::Kind, double> place;
  for (const PlannedCase& planned : cases) {
    ++kinds[planned.spec.kind];
    place[planned.spec.kind] += planned.number;
  }
  using enum blindgen::Kind;
  CHECK(kinds[single] == 660);
  CHECK(kinds[null] + kinds[null_exact] == 240);
  CHECK(kinds[pair] == 240);
  CHECK(kinds[outside] >= 60);
  CHECK(kinds[rig] == 60);
  // Shuffled: the mean number of each kind is that of all, within five deviations.
  const double count = static_cast<double>(cases.size());
  for (const auto& [kind, sum] : place) {
    CHECK(std::abs(sum / kinds[kind] - count / 2.0) < 5.0 * count / std::sqrt(12.0 * kinds[kind]));
  }
  CHECK(plan("smoke", {}).size() == 12);
  CHECK(plan("development", {.limit = 10}).size() == 10);
  for (const PlannedCase& planned : plan("development", {.kinds = {rig}})) CHECK(planned.spec.kind == rig);
  CHECK_THROWS_AS(plan("final", {}), std::invalid_argument);

  const auto proposals = plan("proposals", {});
  CHECK(proposals.size() == 300);
  for (const PlannedCase& planned : proposals) {
    CHECK((planned.follow_up == FollowUp::none ? planned.first == 0 : planned.first < planned.number));
    if (planned.follow_up == FollowUp::none) continue;
    CHECK(proposals.at(static_cast<std::size_t>(planned.first - 1)).spec.effects == planned.spec.effects);
  }
}

TEST_CASE("each part left out meets the worlds of the whole method, with its draws", "[blind]") {
  const auto cases = plan("ablations", {});
  const std::size_t worlds = cases.size() / ablations().size();
  CHECK(cases.size() == worlds * ablations().size());
  for (std::size_t k = 0; k < cases.size(); ++k) {
    const PlannedCase& planned = cases[k];
    CHECK(planned.ablation == k / worlds);
    CHECK(planned.first == (planned.ablation == 0 ? 0 : static_cast<int>(k % worlds) + 1));
    CHECK(planned.spec.kind == cases[k % worlds].spec.kind);
    CHECK(planned.spec.case_number == cases[k % worlds].spec.case_number);
  }
}

TEST_CASE("acceptance seeds are the first digits of the two trees", "[blind]") {
  CHECK(acceptance_seed("0123456789abcdef", "fedcba9876543210") == 0x01234567fedcba98ULL);
  CHECK_THROWS_AS(acceptance_seed("none", "fedcba9876543210"), std::invalid_argument);
}

TEST_CASE("a campaign keeps what was answered and counts what was not", "[blind]") {
  const Folder folder;
  const Store store(folder / "campaign");
  store.open(manifest(6));
  const auto cases = plan("smoke", manifest(6).selection);
  const RunSummary first = run_cases(store, cases, options(folder), never, silent);
  CHECK(first.finished == 6);
  CHECK(first.without_report == 2);

  const Scored scored = judge(store);
  CHECK(scored.cases.at(0).answer.value().verdict == "NO_GAP");
  CHECK(scored.cases.at(1).failure == "exit code 137");
  CHECK(scored.cases.at(2).failure == "ran out of time");
  CHECK(score(scored.cases).failed == 2);

  const RunSummary second = run_cases(store, cases, options(folder), never, silent);
  CHECK(second.finished == 0);
  CHECK(second.skipped == 6);

  // Neither the data nor the truth is left beside the answers.
  std::set<std::string> names;
  for (const auto& entry : fs::recursive_directory_iterator(folder / "campaign")) {
    if (entry.is_regular_file()) names.insert(entry.path().filename().string());
  }
  CHECK(names == std::set<std::string>{"campaign.json", "discover.log", "record.json", "report.json"});

  std::ofstream(store.folder_of(1) / "report.json") << "{}";
  CHECK_THROWS_WITH(judge(store), Catch::Contains("not the one that was stored"));
}

TEST_CASE("a campaign that was stopped goes on, and another one is refused its folder", "[blind]") {
  const Folder folder;
  const Store store(folder / "campaign");
  store.open(manifest(1));
  const auto cases = plan("smoke", manifest(1).selection);
  int looks = 0;
  const RunSummary stopped = run_cases(
      store, cases, options(folder), [&] { return ++looks > 1; }, silent);
  CHECK(stopped.stopped);
  CHECK(stopped.finished == 0);
  CHECK_THROWS_WITH(judge(store), Catch::Contains("has not been run"));
  store.open(manifest(1));
  CHECK(run_cases(store, cases, options(folder), never, silent).finished == 1);
  CHECK(judge(store).cases.size() == 1);
  CHECK_THROWS_WITH(store.open(manifest(2)), Catch::Contains("another campaign"));
}

TEST_CASE("a follow-up has the three cells that the first answer asks for", "[blind]") {
  const Folder folder;
  Manifest proposals = manifest(1);
  proposals.campaign = "proposals";
  const Store store(folder / "campaign");
  store.open(proposals);
  const auto cases = plan("proposals", proposals.selection);
  REQUIRE(cases.size() == 3);
  run_cases(store, cases, options(folder), never, silent);
  const auto rows = [&](int number) { return store.finished(number).value().rows; };
  const blindgen::Campaign first = measure(cases[0].spec, draw_case(cases[0].spec));
  const int points = static_cast<int>(std::ranges::count(first.rows, 1, &blindgen::Row::sample));
  CHECK(rows(1) == static_cast<int>(first.rows.size()));
  CHECK(rows(2) == rows(1) + 4 * 5 * points);  // three cells and the baseline of that day, five samples each
  CHECK(rows(3) == rows(2));
}
