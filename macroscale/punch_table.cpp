#include "macroscale/punch_table.h"

#include <array>
#include <vector>

#include <fmt/format.h>

#include "core/measured_table.h"
#include "core/units.h"

namespace heddle::macroscale {

namespace {

struct Row {
  int line = 0;
  double time = 0.0;    ///< [s]
  double travel = 0.0;  ///< [m]
};

constexpr std::array columns{TableColumn<Row>{"time_s", "s", &Row::time, true},
                             TableColumn<Row>{"punch_displacement_mm", "mm", &Row::travel, true}};
constexpr TableRules rules{.what = "a table of the punch's motion",
                           .unknown = "process.punch.file.column.unknown"_rule,
                           .missing = "process.punch.file.column.missing"_rule,
                           .twice = "process.punch.file.column.twice"_rule,
                           .number = "process.punch.file.number"_rule};

void check_motion(const std::vector<Row>& rows, TableProblems& problems) {
  if (rows.size() < 2) {
    problems.add("process.punch.file.rows"_rule, columns[0].name, fmt::format("{} rows", rows.size()),
                 "must have two rows or more", "Begin with 0 s and 0 mm, end with the whole stroke.",
                 rows.empty() ? 1 : rows.front().line);
    return;
  }
  if (rows.front().time != 0.0 || rows.front().travel != 0.0)
    problems.add("process.punch.file.start"_rule, columns[1].name,
                 fmt::format("{} at {}", write_quantity(rows.front().travel, "mm"),
                             write_quantity(rows.front().time, "s")),
                 "must begin with 0 mm at 0 s", "Count both from where the punch touches the blank.",
                 rows.front().line);
  for (std::size_t k = 1; k < rows.size(); ++k) {
    if (!(rows[k].time > rows[k - 1].time))
      problems.add(
          "process.punch.file.time"_rule, columns[0].name, write_quantity(rows[k].time, "s"),
          fmt::format("must be later than the row before ({})", write_quantity(rows[k - 1].time, "s")),
          "Sort the rows by time.", rows[k].line);
    if (!(rows[k].travel > rows[k - 1].travel))
      problems.add(
          "process.punch.file.travel"_rule, columns[1].name, write_quantity(rows[k].travel, "mm"),
          fmt::format("must be deeper than the row before ({})", write_quantity(rows[k - 1].travel, "mm")),
          "Downwards counts positive. Steps are equal in stroke: leave out where the punch stands or goes "
          "back.",
          rows[k].line);
  }
}

}  // namespace

Curve read_punch_table(const std::filesystem::path& path) {
  TableProblems problems{path.string()};
  const std::vector<Row> rows = read_rows(read_csv(path), columns, rules, problems);
  problems.throw_if_any();
  check_motion(rows, problems);
  problems.throw_if_any();
  std::vector<double> time, travel;
  for (const Row& row : rows) {
    time.push_back(row.time);
    travel.push_back(row.travel);
  }
  return Curve(std::move(time), std::move(travel));
}

}  // namespace heddle::macroscale
