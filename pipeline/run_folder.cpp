#include "pipeline/run_folder.h"

#include <sys/resource.h>

#include <chrono>
#include <fstream>
#include <thread>
#include <utility>

#include <fmt/format.h>

#include "core/sparse_solver.h"
#include "pipeline/grid_error_stage.h"
#include "pipeline/stage_keys.h"
#include "pipeline/stamping_record.h"
#include "pipeline/stamping_study_keys.h"

namespace heddle::pipeline {

namespace {

namespace fs = std::filesystem;

// Name of the case a folder holds; "" if it holds no run.
std::string case_in(const fs::path& folder) {
  std::ifstream resolved(folder / "resolved.yaml");
  for (std::string line; std::getline(resolved, line);)
    if (line.rfind("name: ", 0) == 0) return line.substr(6);
  return "";
}

void demand_own_folder(const Case& a_case, const fs::path& folder) {
  if (fs::exists(folder) && !fs::is_directory(folder))
    throw InputError({{"output.folder.file"_rule, "-o", folder.string(),
                       "must be a folder, but a file has this name", "Choose another folder with -o."}});
  if (!fs::exists(folder) || fs::is_empty(folder)) return;
  const std::string held = case_in(folder);
  if (held == a_case.name && !a_case.stamping && fs::exists(folder / "macroscale"))
    throw InputError({{"output.folder.stamped"_rule, "-o", folder.string(),
                       "holds a stamped part, which this command would replace",
                       "Choose another folder with -o, or write over it with --force."}});
  if (held == a_case.name) return;
  throw InputError({{"output.folder.other"_rule, "-o", folder.string(),
                     held.empty() ? "holds files that are not a run of heddle"
                                  : fmt::format("holds another case: {}", held),
                     "Choose another folder with -o, or write over it with --force."}});
}

bool stays_for_resume(const fs::path& name) {
  return name == fs::path(checkpoint_name).filename() || name == fs::path(grid_error_name).filename();
}

double cpu_seconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

double wall_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace

RunFolder::RunFolder(const Case& a_case, fs::path folder, bool force, Entry entry)
    : path_(std::move(folder)), only_looks_(entry == Entry::look) {
  if (!force) demand_own_folder(a_case, path_);
  if (only_looks_) return;
  try {
    fs::create_directories(path_);
  } catch (const fs::filesystem_error& error) {
    throw InputError({{"output.folder.create"_rule, "-o", path_.string(),
                       "cannot be created: " + error.code().message(), "Choose another folder with -o."}});
  }
  // Cases of a list know by themselves whether they still hold (case_list.h).
  const bool lists_cases = stamping_study_of(a_case.settings).has_value();
  // The manifest says that a run is complete: it goes first and comes last.
  for (const char* name :
       {"manifest.json", "mesoscale", "friction", "inputs", "cases", "table.csv", "calibration",
        "calibration.json", "patched.yaml", "summary.json", "report.html", "log.txt"})
    if (!lists_cases || name != std::string_view("cases")) fs::remove_all(path_ / name);
  if (fs::exists(path_ / "macroscale"))
    for (const auto& file : fs::directory_iterator(path_ / "macroscale"))
      if (entry != Entry::resume || !stays_for_resume(file.path().filename())) fs::remove_all(file.path());
  if (entry == Entry::fresh) fs::remove_all(path_ / "macroscale");
  write_resolved(a_case, path_);
}

RunFolder::Meter RunFolder::Meter::start() {
  return {wall_seconds(), cpu_seconds()};
}

StageRecord RunFolder::Meter::record(const std::string& name, bool reused) const {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return {name, wall_seconds() - wall, cpu_seconds() - cpu, 1024.0 * static_cast<double>(usage.ru_maxrss),
          reused};
}

void RunFolder::close(const Case& a_case,
                      const std::vector<std::pair<std::string, std::string>>& hashes) const {
  Manifest manifest;
  manifest.name = a_case.name;
  manifest.versions = {{"heddle", HEDDLE_VERSION}, {"compiler", __VERSION__}};
  manifest.hashes = hashes;
  manifest.machine = {{"processor", processor_name()},
                      {"cores", fmt::format("{}", std::thread::hardware_concurrency())},
                      {"blas", blas_name()}};
  manifest.stages = stages_;
  write_log();
  write("manifest.json", manifest_json(manifest));
}

}  // namespace heddle::pipeline
