#include <fmt/format.h>

#include "pipeline/case.h"
#include "pipeline/commands.h"
#include "pipeline/config_reference.h"

namespace heddle::pipeline {

int check_file(const CheckOptions& options) {
  if (options.reference) {
    fmt::print("{}", config_reference());
    return exit_done;
  }
  const Case checked = read_case_and_tools(options.file, options.assignments);
  fmt::print("{}: no problems\nwould run\n", options.file.string());
  for (const std::string& line : stage_lines(checked)) fmt::print("  {}\n", line);
  if (!checked.notes.empty()) fmt::print("notes\n");
  for (const std::string& note : checked.notes) fmt::print("  {}\n", note);
  return exit_done;
}

}  // namespace heddle::pipeline
