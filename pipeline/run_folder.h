#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "pipeline/case.h"
#include "pipeline/outputs.h"

namespace heddle::pipeline {

/// The folder of one run: where its files go, what its log says, what each stage cost.
class RunFolder {
 public:
  /// Creates the folder, removes what an earlier run of the case left, writes resolved.yaml: old results
  /// never stand beside new inputs.
  /// @throws InputError  if it holds another case, files that are not a run's, or a stamped part that a run
  /// without
  ///                     stamping would replace, and `force` is not set; if it cannot be created
  RunFolder(const Case& a_case, std::filesystem::path folder, bool force);

  const std::filesystem::path& path() const { return path_; }
  void write(const std::string& name, std::string_view bytes) const { write_file(path_ / name, bytes); }

  void log(const std::string& line) { log_ += line + '\n'; }

  /// Runs one stage and notes its time and memory.
  template <class Work>
  auto stage(const std::string& name, const Work& work) {
    const Meter meter = Meter::start();
    auto result = work();
    stages_.push_back(meter.record(name));
    return result;
  }

  /// manifest.json and log.txt.
  void close(const Case& a_case) const;

 private:
  struct Meter {
    double wall, cpu;
    static Meter start();
    StageRecord record(const std::string& name) const;
  };
  std::filesystem::path path_;
  std::string log_;
  std::vector<StageRecord> stages_;
};

}  // namespace heddle::pipeline
