#include "core/problem.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <ostream>

namespace heddle {
namespace {

/// "weave.gap (line 6) = 0.75 m   must satisfy 0 <= gap < 0.1 m", each part only where there is something to
/// say.
std::string headline(const Problem& problem) {
  std::string text = problem.key.empty() ? "the file" : problem.key;
  if (problem.line > 0) text += fmt::format(" (line {})", problem.line);
  if (!problem.value.empty()) text += fmt::format(" = {}", problem.value);
  return text + "   " + problem.rule;
}

/// Files in the order in which they are first met, so that the user's own file stays first.
std::vector<std::string> files_in_order(const Problems& problems) {
  std::vector<std::string> files;
  for (const Problem& problem : problems) {
    if (std::find(files.begin(), files.end(), problem.file) == files.end()) files.push_back(problem.file);
  }
  return files;
}

Problems problems_of_file(const Problems& problems, const std::string& file) {
  Problems selected;
  std::copy_if(problems.begin(), problems.end(), std::back_inserter(selected),
               [&](const Problem& problem) { return problem.file == file; });
  std::stable_sort(selected.begin(), selected.end(),
                   [](const Problem& a, const Problem& b) { return a.line < b.line; });
  return selected;
}

}  // namespace

RuleId RuleFamily::of(std::string_view key) const {
  const std::size_t star = name_.find('*');
  std::string text = std::string(name_.substr(0, star)) + std::string(key);
  std::string_view rest = name_.substr(star + 1);
  if (text.empty()) rest.remove_prefix(std::min(rest.size(), rest.find_first_not_of('.')));
  return {text + std::string(rest), name_};
}

std::ostream& operator<<(std::ostream& stream, const RuleId& id) {
  return stream << id.text();
}

std::string format(const Problems& problems) {
  std::string text;
  for (const std::string& file : files_in_order(problems)) {
    const Problems selected = problems_of_file(problems, file);
    text += fmt::format("{}: {} problem(s)\n", file.empty() ? "input" : file, selected.size());
    for (const Problem& problem : selected) {
      text += "  " + headline(problem) + "\n";
      if (!problem.way_out.empty()) text += "    " + problem.way_out + "\n";
    }
  }
  return text;
}

InputError::InputError(Problems problems)
    : std::runtime_error(format(problems)), problems_(std::move(problems)) {}

}  // namespace heddle
