#include "pipeline/resumption.h"

#include <iostream>

#include <fmt/format.h>

#include "pipeline/cache.h"
#include "pipeline/findings.h"
#include "pipeline/grid_error_stage.h"
#include "pipeline/stage_keys.h"
#include "pipeline/stage_store.h"

namespace heddle::pipeline {

namespace {

namespace fs = std::filesystem;

// Whether a folder holds the finished results of exactly these inputs: the manifest is written last.
bool holds_all_of(const fs::path& folder, const Case& a_case) {
  for (const char* name : {"manifest.json", "summary.json", "report.html", "resolved.yaml"})
    if (!fs::is_regular_file(folder / name)) return false;
  if (read_file(folder / "resolved.yaml") != resolved_yaml(a_case.settings)) return false;
  const std::string manifest = read_file(folder / "manifest.json");
  for (const auto& [name, hash] : stage_hashes(a_case))
    if (manifest.find(hash) == std::string::npos) return false;
  return true;
}

// A word as a shell takes it.
std::string shell_word(const std::string& word) {
  const std::string plain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-./=,:+%";
  if (!word.empty() && word.find_first_not_of(plain) == std::string::npos) return word;
  std::string quoted = "'";
  for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

// Whether the stamping need not run.
bool stamped_before(const RunOptions& options, const Case& a_case, const Resumption& resumption) {
  if (resumption.record && resumption.record->complete()) return true;
  const Cache cache(options.cache,
                    [](const std::string&) {});  // what is wrong with it is said when it is used
  const auto record = cache.find(inputs_of(ChainStage::macroscale, a_case).key(), read_stamping_record);
  return record && record->complete();
}

}  // namespace

Resumption look_for_resumption(const RunOptions& options, const Case& a_case, const fs::path& folder) {
  Resumption found;
  const auto say = [](const std::string& text) { std::cerr << "heddle: " << text << '\n'; };
  if (!options.resume) {
    if (fs::exists(folder / checkpoint_name) && !fs::exists(folder / "manifest.json"))
      say(fmt::format(
          "{} holds a run that was interrupted. It starts from the beginning; --resume would have gone on.",
          folder.string()));
    return found;
  }
  if (a_case.stamping) found.record = checkpoint_in(folder, inputs_of(ChainStage::macroscale, a_case));
  const bool whole = !a_case.stamping || (found.record && found.record->complete());
  if (whole && holds_all_of(folder, a_case)) {
    found.entry = Entry::look;
    say(folder.string() + " is complete: there is nothing left to do");
  } else if (found.record) {
    found.entry = Entry::resume;
    say(fmt::format("going on from step {} of {}", found.record->at.step, found.record->steps));
  } else {
    say(folder.string() + " holds no checkpoint: the run starts from the beginning");
  }
  return found;
}

std::string command_to_resume(const RunOptions& options) {
  std::string command = "heddle run " + shell_word(options.file.string());
  for (const std::string& assignment : options.assignments) command += " --set " + shell_word(assignment);
  if (!options.output.empty()) command += " -o " + shell_word(options.output.string());
  return command + " --resume";
}

bool tools_are_needed(const RunOptions& options, const Case& a_case, const fs::path& folder,
                      const Resumption& resumption) {
  if (!a_case.stamping) return false;
  if (!stamped_before(options, a_case, resumption)) return true;
  const Cache cache(options.cache, [](const std::string&) {});
  return a_case.grid_error &&
         !known_grid_error(resumption.entry == Entry::fresh ? fs::path() : folder, cache,
                           inputs_of(ChainStage::grid_error, a_case).key());  // a fresh run clears its folder
}

}  // namespace heddle::pipeline
