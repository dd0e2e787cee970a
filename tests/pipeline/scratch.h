#pragma once

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <vector>

#include "pipeline/commands.h"
#include "pipeline/outputs.h"
#include "pipeline/stage_keys.h"
#include "tests/source_dir.h"
#include "tool_settings.h"

/// What tests of whole runs share.
namespace heddle::test {

namespace fs = std::filesystem;

/// A folder of this test process alone, removed at the end.
class Scratch {
 public:
  Scratch() : path_(fs::temp_directory_path() / ("heddle-resume-test-" + std::to_string(getpid()))) {
    fs::create_directories(path_);
  }
  ~Scratch() {
    std::error_code ignored;  // a folder that stays behind is no failure of the test
    fs::remove_all(path_, ignored);
  }
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;
  fs::path operator/(const std::string& name) const { return path_ / name; }

 private:
  fs::path path_;
};

/// The shipped stamping, small: 13 x 13 nodes, 6 steps, constant mu, so that its friction stage has nothing
/// to fit.
inline std::vector<std::string> small_stamping() {
  return {"blank.spacing=32 mm", "process.steps=5", "process.punch={stroke: 20 mm, time: 0.12 s}",
          tools_by_shape};
}

inline std::vector<std::string> with(std::vector<std::string> base, const std::string& more) {
  base.push_back(more);
  return base;
}

/// A fabric so soft that the shipped binder presses through it while it closes.
inline std::string softest_fabric(const fs::path& file) {
  std::ofstream(file) << "thickness_mm,pressure_kPa\n1.5,0\n1,1\n0.5,2\n";
  return "fabric.compaction={file: " + file.string() + "}";
}

inline pipeline::RunOptions options_for(const fs::path& output, std::vector<std::string> settings) {
  pipeline::RunOptions options;
  options.file = fs::path(heddle::test::source_dir) / "configs" / "thermostamping.yaml";
  options.output = output;
  options.assignments = std::move(settings);
  options.quiet = true;
  options.print = false;
  options.checkpoint_interval = 0.0;
  return options;
}

/// Puts the unit cell of the shipped weave into a cache: it takes longer than all the small stampings here.
/// It is kept from test to test in the build folder, under a key that moves with the sources.
inline void warm(const fs::path& cache) {
  auto options = options_for(cache.parent_path() / "warm", {});
  options.cache = HEDDLE_TEST_CACHE;
  pipeline::weave_case(options);
  const std::string key =
      pipeline::inputs_of(pipeline::ChainStage::mesoscale, pipeline::read_case(options.file)).key();
  fs::create_directories(cache);
  fs::copy_file(options.cache / key, cache / key, fs::copy_options::overwrite_existing);
  fs::remove_all(cache.parent_path() / "warm");
}

/// Every file below a folder but those that hold times.
inline std::map<std::string, std::string> contents(const fs::path& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (entry.is_regular_file() && name != "manifest.json" && name != "log.txt")
      files[fs::relative(entry.path(), folder).string()] = pipeline::read_file(entry.path());
  }
  return files;
}

/// Name of the first file in which two folders differ, or "".
inline std::string first_difference(const std::map<std::string, std::string>& a,
                                    const std::map<std::string, std::string>& b) {
  for (const auto& [name, bytes] : a)
    if (b.count(name) == 0 || b.at(name) != bytes) return name;
  for (const auto& [name, bytes] : b)
    if (a.count(name) == 0) return name;
  return "";
}

/// "mesoscale friction macroscale" as far as manifest.json says they were reused.
inline std::string reused(const fs::path& folder) {
  const std::string text = pipeline::read_file(folder / "manifest.json");
  std::string names;
  for (const char* name : {"mesoscale", "friction", "macroscale"}) {
    const auto at = text.find('"' + std::string(name) + "\": {");
    if (at == std::string::npos) continue;
    const auto flag = text.find("\"reused\": ", at);
    if (text.compare(flag + 10, 4, "true") == 0) names += (names.empty() ? "" : " ") + std::string(name);
  }
  return names;
}

}  // namespace heddle::test
