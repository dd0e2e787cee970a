#pragma once

#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include "core/text_file.h"
#include "pipeline/case.h"
#include "tests/source_dir.h"

namespace heddle::test {

inline const std::filesystem::path bad_folder =
    std::filesystem::path(heddle::test::source_dir) / "tests/pipeline/bad";

/// Names of the small bad configurations, without ".yaml".
inline std::vector<std::string> bad_file_names() {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(bad_folder))
    if (entry.path().extension() == ".yaml") names.push_back(entry.path().stem().string());
  return names;
}

/// What the file wants to be set besides, one "#--set PATH=VALUE" a line: some rules are those of --set.
inline std::vector<std::string> assignments_in(const std::string& text) {
  const std::string mark = "#--set ";
  std::vector<std::string> assignments;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);)
    if (line.starts_with(mark)) assignments.push_back(line.substr(mark.size()));
  return assignments;
}

/// Everything `heddle check` says of tests/pipeline/bad/NAME.yaml.
inline Problems problems_of_bad_file(const std::string& name) {
  const std::filesystem::path file = bad_folder / (name + ".yaml");
  try {
    pipeline::read_case_and_tools(file, assignments_in(read_text_file(file)));
  } catch (const InputError& error) {
    return error.problems();
  }
  return {};
}

}  // namespace heddle::test
