#include "run.h"

#include <algorithm>
#include <chrono>
#include <list>
#include <stdexcept>
#include <thread>

#include "answer.h"
#include "child.h"
#include "core/sha256.h"
#include "pipeline/outputs.h"

namespace heddle::blind {

namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

struct Job {
  Record record;
  Child child;
  Clock::time_point start;
};

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// The folder in which `discover` runs: data and side file, nothing else.
fs::path work_folder(const Store& store, int number) {
  return store.folder_of(number) / "work";
}

/// What the first answer asks for, as far as it asks for anything.
std::vector<blindgen::Condition> proposed_cells(const Store& store, int first) {
  const std::string report = store.report(first);
  if (report.empty()) return {};
  std::vector<blindgen::Condition> cells = read_answer(report).next_experiments;
  if (cells.size() > follow_up_cells) cells.resize(follow_up_cells);
  return cells;
}

Job start(const Store& store, const PlannedCase& planned, const RunOptions& options) {
  fs::remove_all(store.folder_of(planned.number));  // of a case that was broken off
  const fs::path folder = work_folder(store, planned.number);
  blindgen::Spec spec = planned.spec;
  if (planned.follow_up == FollowUp::proposed) spec.extra = proposed_cells(store, planned.first);
  if (planned.follow_up == FollowUp::random) spec.extra = random_cells(spec);
  const blindgen::Campaign data = measure(spec, draw_case(spec));
  const std::string table = data_text(data);
  pipeline::write_file(folder / "data.csv", table);
  pipeline::write_file(folder / "data.yaml", blindgen::sidecar_text());
  Record record;
  record.number = planned.number;
  record.rows = static_cast<int>(data.rows.size());
  record.data_sha256 = sha256(table);
  // What is left out must be all that differs: draws are those of the whole method.
  const int seed = planned.ablation == 0 ? planned.number : planned.first;
  std::vector<std::string> command{options.program.string(),
                                   "discover",
                                   options.config.string(),
                                   "--data",
                                   "data.csv",
                                   "-o",
                                   "out",
                                   "--seed",
                                   std::to_string(seed)};
  for (const std::string_view set : ablations().at(planned.ablation).sets) {
    command.emplace_back("--set");
    command.emplace_back(set);
  }
  const std::vector<std::pair<std::string, std::string>> environment{
      {"HEDDLE_CACHE", (store.folder() / "cache").string()}, {"OPENBLAS_NUM_THREADS", "1"}};
  return {record, Child(command, folder, environment, store.folder_of(planned.number) / "discover.log"),
          Clock::now()};
}

std::string report_of(const fs::path& out) {
  for (const fs::path& place : {out / "report.json", out / "discover" / "report.json"}) {
    if (fs::exists(place)) return pipeline::read_file(place);
  }
  return "";
}

void store_answer(const Store& store, Job& job, const Ending& ending, const RunOptions& options,
                  RunSummary& summary) {
  const fs::path folder = work_folder(store, job.record.number);
  job.record.wall_time = seconds_since(job.start);
  job.record.exit_code = ending.exit_code;
  job.record.cpu_time = ending.cpu_time;
  job.record.peak_memory = ending.peak_memory;
  const std::string report = ending.exit_code == 0 ? report_of(folder / "out") : "";
  if (!report.empty()) job.record.report_sha256 = sha256(report);
  store.keep(job.record, report);
  if (!options.keep_data) fs::remove_all(folder);
  ++summary.finished;
  if (report.empty()) ++summary.without_report;
}

/// A follow-up waits for the case it follows.
bool can_start(const Store& store, const PlannedCase& planned) {
  return planned.follow_up == FollowUp::none || store.finished(planned.first).has_value();
}

void need(const fs::path& file) {
  if (!fs::is_regular_file(file)) throw std::runtime_error("there is no file " + file.string());
}

}  // namespace

RunSummary run_cases(const Store& store, const std::vector<PlannedCase>& cases, const RunOptions& options,
                     const std::function<bool()>& stop, const std::function<void(const RunSummary&)>& say) {
  need(options.program);
  need(options.config);
  RunSummary summary{.cases = static_cast<int>(cases.size())};
  std::list<Job> jobs;
  std::size_t next = 0;
  while ((next < cases.size() || !jobs.empty()) && !(summary.stopped = stop())) {
    if (next < cases.size() && static_cast<int>(jobs.size()) < options.processes &&
        can_start(store, cases[next])) {
      const PlannedCase& planned = cases[next++];
      if (store.finished(planned.number))
        ++summary.skipped;
      else
        jobs.push_back(start(store, planned, options));
      continue;
    }
    bool any = false;
    for (auto job = jobs.begin(); job != jobs.end();) {
      if (seconds_since(job->start) > options.time_limit && !job->record.timed_out) {
        job->record.timed_out = true;
        job->child.kill();
      }
      const auto ending = job->child.poll();
      if (!ending) {
        ++job;
        continue;
      }
      store_answer(store, *job, *ending, options, summary);
      job = jobs.erase(job);
      any = true;
    }
    if (any)
      say(summary);
    else
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  return summary;
}

}  // namespace heddle::blind
