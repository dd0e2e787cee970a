#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "pipeline/case.h"
#include "pipeline/outputs.h"

namespace heddle::pipeline {

/// How a run enters its folder.
enum class Entry {
  fresh,   ///< removes what an earlier run of the case left: old results never stand beside new inputs
  resume,  ///< the same, but leaves checkpoint and grid error until newer ones take their place
  look     ///< changes nothing: what would be written is there already
};

/// The folder of one run: where its files go, what its log says, what each stage cost.
class RunFolder {
 public:
  /// Creates the folder, removes what the entry asks for, writes resolved.yaml.
  /// @throws InputError  if it holds another case, files that are not a run's, or a stamped part that a run
  /// without
  ///                     stamping would replace, and `force` is not set; if it cannot be created
  RunFolder(const Case& a_case, std::filesystem::path folder, bool force, Entry entry = Entry::fresh);

  const std::filesystem::path& path() const { return path_; }
  void write(const std::string& name, std::string_view bytes) const { put(name, bytes, false); }
  /// The same, safe against a power cut.
  void write_durably(const std::string& name, std::string_view bytes) const { put(name, bytes, true); }

  void log(const std::string& line) { log_ += line + '\n'; }

  /// Runs one stage and notes its time and memory, and whether it was reused.
  /// @param work  bool& reused -> result
  template <class Work>
  auto stage(const std::string& name, const Work& work) {
    const Meter meter = Meter::start();
    bool reused = false;
    auto result = work(reused);
    stages_.push_back(meter.record(name, reused));
    return result;
  }

  /// log.txt, and for a run that came to its end manifest.json behind it, the last file of a run.
  /// @param hashes  of the stages' inputs
  void close(const Case& a_case, const std::vector<std::pair<std::string, std::string>>& hashes) const;
  void write_log() const { write("log.txt", log_); }

 private:
  struct Meter {
    double wall, cpu;
    static Meter start();
    StageRecord record(const std::string& name, bool reused) const;
  };
  void put(const std::string& name, std::string_view bytes, bool durable) const {
    if (!only_looks_) write_file(path_ / name, bytes, durable);
  }

  std::filesystem::path path_;
  bool only_looks_ = false;
  std::string log_;
  std::vector<StageRecord> stages_;
};

}  // namespace heddle::pipeline
