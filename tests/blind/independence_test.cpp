#include <array>
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "tests/source_dir.h"

namespace {

namespace fs = std::filesystem;

const fs::path folder = fs::path(heddle::test::source_dir) / "tests" / "blind" / "blindgen";

/// Headers of the C++ standard library that a generator may want.
const std::set<std::string> standard{
    "algorithm", "array",      "charconv",  "cmath",      "cstdarg",     "cstdint", "cstdio",
    "exception", "filesystem", "fstream",   "functional", "iostream",    "map",     "numeric",
    "optional",  "span",       "stdexcept", "string",     "string_view", "utility", "vector"};

/// #include lines of a text that reach outside: neither a file of the folder, nor the standard library, nor
/// Eigen.
std::vector<std::string> foreign_includes(std::istream& text, const fs::path& own) {
  std::vector<std::string> foreign;
  for (std::string line; std::getline(text, line);) {
    const std::size_t first = line.find_first_not_of(" \t");
    if (first == std::string::npos || line[first] != '#' || line.find("include") == std::string::npos)
      continue;
    const std::size_t open = line.find_first_of("<\""), close = line.find_last_of(">\"");
    const std::string path = open < close ? line.substr(open + 1, close - open - 1) : line;
    const bool quoted = open != std::string::npos && line[open] == '"';
    const bool allowed = quoted ? path.find('/') == std::string::npos && fs::exists(own / path)
                                : standard.count(path) > 0 || path.starts_with("Eigen/");
    if (!allowed) foreign.push_back(line);
  }
  return foreign;
}

}  // namespace

TEST_CASE("the generator of hidden effects includes nothing of the program it tests", "[blind]") {
  int files = 0;
  for (const auto& entry : fs::directory_iterator(folder)) {
    const std::string kind = entry.path().extension().string();
    if (kind != ".h" && kind != ".cpp") continue;
    ++files;
    std::ifstream stream(entry.path());
    INFO(entry.path().filename().string());
    CHECK(foreign_includes(stream, folder) == std::vector<std::string>{});
  }
  CHECK(files >= 10);
}

TEST_CASE("an include of a law, of a library or out of the folder is seen", "[blind]") {
  const std::array<std::string, 5> lines{"#include \"friction/model.h\"", "  # include <nlohmann/json.hpp>",
                                         "#include \"../score.h\"", "#include \"model.h\"",
                                         "#include HEADER"};
  for (const std::string& line : lines) {
    std::istringstream text("#include <vector>\n" + line +
                            "\n#include \"random.h\"\n#include <Eigen/Dense>\n");
    CHECK(foreign_includes(text, folder) == std::vector<std::string>{line});
  }
}
