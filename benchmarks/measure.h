#pragma once

#include <algorithm>
#include <chrono>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>
#include <string>

namespace heddle::benchmark {

/// Wall and processor time of all threads [s].
struct Time {
  double wall = 0.0, cpu = 0.0;
};

inline Time time_of(const std::function<void()>& work) {
  const std::clock_t ticks = std::clock();
  const auto start = std::chrono::steady_clock::now();
  work();
  return {std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(),
          static_cast<double>(std::clock() - ticks) / CLOCKS_PER_SEC};
}

/// Smallest wall time of many repeats [s]: on a shared machine the best is what the code costs.
inline double best_seconds(int repeats, const std::function<void()>& work) {
  double best = std::numeric_limits<double>::infinity();
  for (int k = 0; k < repeats; ++k) best = std::min(best, time_of(work).wall);
  return best;
}

/// Largest resident memory of the process so far [MB].
inline double peak_megabytes() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.starts_with("VmHWM:")) return std::stod(line.substr(6)) * 1024e-6;
  return 0.0;
}

inline std::string today() {
  const std::time_t now = std::time(nullptr);
  char text[16];
  std::strftime(text, sizeof text, "%Y-%m-%d", std::gmtime(&now));
  return text;
}

/// Adds a line to benchmarks/results/NAME.csv, under `header` if the file is new. Whether it was written.
inline bool append_row(const std::string& name, const std::string& header, const std::string& row) {
  const std::filesystem::path file =
      std::filesystem::path(HEDDLE_SOURCE_DIR) / "benchmarks/results" / (name + ".csv");
  std::filesystem::create_directories(file.parent_path());
  const bool is_new = !std::filesystem::exists(file);
  std::ofstream out(file, std::ios::app);
  if (is_new) out << header << '\n';
  out << row << '\n';
  return static_cast<bool>(out);
}

}  // namespace heddle::benchmark
