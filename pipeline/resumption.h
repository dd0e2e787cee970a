#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "pipeline/case.h"
#include "pipeline/commands.h"
#include "pipeline/run_folder.h"
#include "pipeline/stamping_stage.h"

/// What an earlier run left in its folder and in the cache, and how to go on from it.
namespace heddle::pipeline {

/// What --resume finds.
struct Resumption {
  Entry entry = Entry::fresh;
  std::optional<StampingRecord> record;
};

/// Says on standard error what it finds.
Resumption look_for_resumption(const RunOptions& options, const Case& a_case,
                               const std::filesystem::path& folder);

/// The command line that goes on with a run.
std::string command_to_resume(const RunOptions& options);

/// Whether a stage is left to run that needs the tools: reading them takes seconds.
bool tools_are_needed(const RunOptions& options, const Case& a_case, const std::filesystem::path& folder,
                      const Resumption& resumption);

}  // namespace heddle::pipeline
