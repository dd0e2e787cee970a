// docs/theory/equations.md maps Eqs 1-8 of the paper to code. Here the map is walked.

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "tests/source_dir.h"

namespace {

struct Entry {
  int equation = 0;  ///< 0 in the table of symbols
  std::string file;
  std::string symbol;
};

std::string content_of(const std::filesystem::path& path) {
  std::ifstream stream(path);
  std::stringstream text;
  text << stream.rdbuf();
  return text.str();
}

std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells;
  std::stringstream stream(line);
  for (std::string cell; std::getline(stream, cell, '|');) cells.push_back(cell);
  return cells;
}

std::string in_backticks(const std::string& cell) {
  std::smatch match;
  return std::regex_search(cell, match, std::regex("`([^`]+)`")) ? match[1].str() : "";
}

/// Rows of the Markdown tables: the last two cells are `file` and `symbol`; the first of the first table is
/// the number of the equation. Header rows carry no backticks there.
std::vector<Entry> entries_of(const std::string& text) {
  std::vector<Entry> entries;
  std::stringstream stream(text);
  for (std::string line; std::getline(stream, line);) {
    if (!line.starts_with("|")) continue;
    const auto cells = cells_of(line);
    if (cells.size() < 4) continue;
    Entry entry{.file = in_backticks(cells[cells.size() - 2]), .symbol = in_backticks(cells.back())};
    if (entry.file.empty()) continue;
    std::smatch number;
    if (std::regex_match(cells[1], number, std::regex(" *([0-9]+) *"))) entry.equation = std::stoi(number[1]);
    entries.push_back(entry);
  }
  return entries;
}

/// The last part of "Type::member", as it is written in the file that declares it, as a whole word.
bool declares(const std::string& text, const std::string& symbol) {
  std::string rest = symbol;
  for (;;) {
    const auto separator = rest.find("::");
    const std::string name = rest.substr(0, separator);
    if (!std::regex_search(text, std::regex("\\b" + name + "\\b"))) return false;
    if (separator == std::string::npos) return true;
    rest = rest.substr(separator + 2);
  }
}

/// What is wrong with one row; empty where nothing is.
std::string fault_of(const Entry& entry) {
  const std::filesystem::path path = std::filesystem::path(heddle::test::source_dir) / entry.file;
  if (!std::filesystem::is_regular_file(path)) return entry.file + " does not exist";
  if (entry.symbol.empty()) return entry.file + " is named without a symbol";
  if (!declares(content_of(path), entry.symbol)) return entry.file + " does not hold " + entry.symbol;
  return "";
}

}  // namespace

TEST_CASE("every equation of the paper is mapped to a file and a symbol that exist", "[paper][docs]") {
  const auto entries =
      entries_of(content_of(std::filesystem::path(heddle::test::source_dir) / "docs/theory/equations.md"));
  std::set<int> mapped;
  for (const Entry& entry : entries) {
    CHECK(fault_of(entry) == "");
    if (entry.equation > 0) mapped.insert(entry.equation);
  }
  CHECK(mapped == std::set<int>{1, 2, 3, 4, 5, 6, 7, 8});
  CHECK(entries.size() > 20);  // the table of symbols is walked as well
}

TEST_CASE("a map that points nowhere is noticed", "[paper][docs]") {
  CHECK(fault_of({.file = "friction/hersey.h", .symbol = "hersey_number"}) == "");
  CHECK(fault_of({.file = "friction/hersey.h", .symbol = "hersey_numbe"}) != "");
  CHECK(fault_of({.file = "friction/laws.h", .symbol = "HerseyPower::coefficient_of_nothing"}) != "");
  CHECK(fault_of({.file = "friction/no_such_file.h", .symbol = "hersey_number"}) != "");
  CHECK(fault_of({.file = "friction/hersey.h", .symbol = ""}) != "");
  const auto entries =
      entries_of("| 3 | H | [-] | `friction/hersey.h` | `hersey_number` |\n| a | b | c | d |\n");
  REQUIRE(entries.size() == 1);
  CHECK(entries[0].equation == 3);
  CHECK(entries[0].file == "friction/hersey.h");
  CHECK(entries[0].symbol == "hersey_number");
}
