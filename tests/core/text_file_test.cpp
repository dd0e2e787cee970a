#include "core/text_file.h"

#include <unistd.h>

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <string>

#include "core/problem.h"

using namespace heddle;

namespace {

std::string rule_broken_by(const std::filesystem::path& path) {
  try {
    read_text_file(path);
  } catch (const InputError& error) {
    return error.problems().front().id;
  }
  return "";
}

}  // namespace

TEST_CASE("a file that cannot be read is refused under the rule it breaks", "[core][wrong input]") {
  const auto folder =
      std::filesystem::temp_directory_path() / ("heddle-text-file-test-" + std::to_string(getpid()));
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "letter.txt") << "mine";
  CHECK(read_text_file(folder / "letter.txt") == "mine");
  CHECK(rule_broken_by(folder / "other.txt") == "file.missing");
  CHECK(rule_broken_by(folder) == "file.folder");
  // Longer than any file system takes: neither there nor known to be missing.
  CHECK(rule_broken_by(folder / std::string(10000, 'x')) == "file.unreadable");
  std::filesystem::remove_all(folder);
}
