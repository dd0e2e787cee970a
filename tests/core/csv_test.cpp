#include "core/csv.h"

#include <catch2/catch.hpp>

using namespace heddle;

namespace {

std::string refusal_of(const std::string& text) {
  try {
    parse_csv(text, "t.csv");
  } catch (const InputError& error) {
    return error.problems().front().id;
  }
  return "accepted";
}

std::string refusal_of_file(const std::filesystem::path& path) {
  try {
    read_csv(path);
  } catch (const InputError& error) {
    CHECK(error.problems().front().file == path.string());
    return error.problems().front().id;
  }
  return "accepted";
}

}  // namespace

TEST_CASE("a table is read with the lines of the file, past comments, blanks, CR and a byte order mark",
          "[csv]") {
  const CsvTable table = parse_csv("\xEF\xBB\xBF# comment\r\n\r\n a , b,c\r\n1, 2 ,\r\n\n3,,5", "t.csv");
  CHECK(table.header.line == 3);
  CHECK(table.header.cells == std::vector<std::string>{"a", "b", "c"});
  REQUIRE(table.rows.size() == 2);
  CHECK(table.rows[0].line == 4);
  CHECK(table.rows[0].cells == std::vector<std::string>{"1", "2", ""});
  CHECK(table.rows[1].line == 6);
  CHECK(table.problems.empty());
}

TEST_CASE("rows of another length are left out and named; the others are kept", "[csv][wrong input]") {
  const CsvTable table = parse_csv("a,b\n1,2,3\n4,5\n6\n", "t.csv");
  REQUIRE(table.rows.size() == 1);
  REQUIRE(table.problems.size() == 2);
  CHECK(table.problems[0].id == "csv.cells");
  CHECK(table.problems[0].line == 2);
  CHECK(table.problems[1].line == 4);
}

TEST_CASE("what is no table says why", "[csv][wrong input]") {
  CHECK(refusal_of("") == "csv.empty");
  CHECK(refusal_of("# only words\n\n") == "csv.empty");
  CHECK(refusal_of("a;b;c\n1;2;3\n") == "csv.separator");
  CHECK(refusal_of("a\tb\n1\t2\n") == "csv.separator");
  CHECK(refusal_of(std::string("a\0,\0b\0", 6)) == "csv.encoding");
  CHECK(refusal_of("one\n1\n") == "accepted");
  CHECK(refusal_of_file("no/such.csv") == "file.missing");
  CHECK(refusal_of_file(std::filesystem::temp_directory_path()) == "file.folder");
}
