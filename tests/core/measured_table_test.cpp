#include "core/measured_table.h"

#include <catch2/catch.hpp>

using namespace heddle;

namespace {

struct Pull {
  int line = 0;
  std::string day = "monday";
  double speed = 7.0;
  std::optional<double> rest;
};

using Column = TableColumn<Pull>;
constexpr std::array columns{Column{"day_id", "", &Pull::day},
                             Column{"speed_mm_s", "mm/s", &Pull::speed, true},
                             Column{"rest_s", "s", &Pull::rest}};
constexpr TableRules rules{.what = "a table of pulls",
                           .unknown = "test.unknown"_rule,
                           .missing = "test.missing"_rule,
                           .twice = "test.twice"_rule,
                           .number = "test.number"_rule};

struct Result {
  std::vector<Pull> rows;
  Problems problems;
};

Result read(const std::string& text, std::span<const std::string_view> passed_over = {}) {
  TableProblems problems{"t.csv"};
  std::vector<Pull> rows = read_rows(parse_csv(text, "t.csv"), columns, rules, problems, passed_over);
  return {std::move(rows), std::move(problems.list)};
}

std::vector<std::string> ids(const Problems& problems) {
  std::vector<std::string> list;
  for (const Problem& problem : problems) list.push_back(problem.id);
  return list;
}
using Ids = std::vector<std::string>;

}  // namespace

TEST_CASE("a row of measurements has SI numbers, its line, and defaults where the table says nothing",
          "[csv]") {
  const Result all = read("rest_s,speed_mm_s\n60,16\n# between\n,20\n");
  CHECK(all.problems.empty());
  REQUIRE(all.rows.size() == 2);
  CHECK(all.rows[0].line == 2);
  CHECK(all.rows[0].speed == 0.016);
  CHECK(all.rows[0].rest == 60.0);
  CHECK(all.rows[0].day == "monday");
  CHECK(all.rows[1].line == 4);
  CHECK_FALSE(all.rows[1].rest.has_value());
  CHECK(read("day_id,speed_mm_s\n,1\n").rows[0].day.empty());  // a text is what stands there, nothing too
}

TEST_CASE("every fault of a table of measurements is named with its line", "[csv][wrong input]") {
  const Result all = read("rest_min,rest_s,rest_s,day_name\n1,nan,2,sun\n1,2\n");
  CHECK(ids(all.problems) ==
        Ids{"csv.cells", "test.unknown", "test.unknown", "test.missing", "test.twice", "test.number"});
  CHECK(all.problems[0].line == 3);
  CHECK(all.problems[1].key == "rest_min");
  CHECK(all.problems[1].way_out == "Convert its numbers and call it rest_s: the unit stands in the name.");
  // day_id has no unit that day_name could be another of.
  CHECK(all.problems[2].way_out == "Known columns: day_id, speed_mm_s, rest_s.");
  CHECK(all.problems[3].key == "speed_mm_s");
  CHECK(all.problems[3].rule == "must be a column of a table of pulls");
  CHECK(all.problems[4].key == "rest_s");
  CHECK(all.problems[5].value == "nan");
  CHECK(all.problems[5].line == 2);
  CHECK(all.problems[5].file == "t.csv");
}

TEST_CASE("no cell of a required column may be empty, infinite or carry a unit", "[csv][wrong input]") {
  CHECK(ids(read("speed_mm_s\n\"\"\n1e999\n1 m/s\n1\n").problems) ==
        Ids{"test.number", "test.number", "test.number"});
  CHECK(ids(read("speed_mm_s,rest_s\n,\n").problems) == Ids{"test.number"});
}

TEST_CASE("columns that are passed over are no fault, and stay unread", "[csv]") {
  constexpr std::array<std::string_view, 1> known{"operator"};
  const Result all = read("speed_mm_s,operator\n16,nan\n", known);
  CHECK(all.problems.empty());
  CHECK(all.rows[0].speed == 0.016);
  CHECK(ids(read("speed_mm_s,operator\n16,nan\n").problems) == Ids{"test.unknown"});
}
