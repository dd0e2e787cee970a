#include "pipeline/run_folder.h"

#include <sys/resource.h>

#include <chrono>
#include <fstream>
#include <thread>

#include <fmt/format.h>

#include "core/sparse_solver.h"

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
    throw InputError({{"output.folder.file", "-o", folder.string(),
                       "must be a folder, but a file has this name", "Choose another folder with -o."}});
  if (!fs::exists(folder) || fs::is_empty(folder)) return;
  const std::string held = case_in(folder);
  if (held == a_case.name && !a_case.stamping && fs::exists(folder / "macroscale"))
    throw InputError({{"output.folder.stamped", "-o", folder.string(),
                       "holds a stamped part, which this command would replace",
                       "Choose another folder with -o, or write over it with --force."}});
  if (held == a_case.name) return;
  throw InputError({{"output.folder.other", "-o", folder.string(),
                     held.empty() ? "holds files that are not a run of heddle"
                                  : fmt::format("holds another case: {}", held),
                     "Choose another folder with -o, or write over it with --force."}});
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

std::string processor_name() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);)
    if (line.rfind("model name", 0) == 0) return line.substr(line.find(':') + 2);
  return "unknown";
}

}  // namespace

RunFolder::RunFolder(const Case& a_case, fs::path folder, bool force) : path_(std::move(folder)) {
  if (!force) demand_own_folder(a_case, path_);
  try {
    fs::create_directories(path_);
  } catch (const fs::filesystem_error& error) {
    throw InputError({{"output.folder.create", "-o", path_.string(),
                       "cannot be created: " + error.code().message(), "Choose another folder with -o."}});
  }
  for (const char* name : {"mesoscale", "friction", "macroscale", "inputs", "cases", "table.csv",
                           "summary.json", "report.html", "manifest.json", "log.txt"})
    fs::remove_all(path_ / name);
  write_resolved(a_case, path_);
}

RunFolder::Meter RunFolder::Meter::start() {
  return {wall_seconds(), cpu_seconds()};
}

StageRecord RunFolder::Meter::record(const std::string& name) const {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return {name, wall_seconds() - wall, cpu_seconds() - cpu, 1024.0 * static_cast<double>(usage.ru_maxrss),
          false};
}

void RunFolder::close(const Case& a_case) const {
  Manifest manifest;
  manifest.name = a_case.name;
  manifest.versions = {{"heddle", HEDDLE_VERSION}, {"compiler", __VERSION__}};
  manifest.machine = {{"processor", processor_name()},
                      {"cores", fmt::format("{}", std::thread::hardware_concurrency())},
                      {"blas", blas_name()}};
  manifest.stages = stages_;
  write("manifest.json", manifest_json(manifest));
  write("log.txt", log_);
}

}  // namespace heddle::pipeline
