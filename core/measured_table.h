#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "core/csv.h"
#include "core/problem.h"

/// Tables of measurements: one header, whose columns have a known name with the unit in it ("velocity_mm_s"),
/// and one row a line. A kind of table is a list of columns, each tied to a member of the row it fills.
namespace heddle {

/// One column of a kind of table, and the member of Row it fills in SI. A text is taken as it stands.
template <class Row>
struct TableColumn {
  std::string_view name;
  std::string_view unit;  ///< of the numbers in it, as read_quantity takes it; "" for bare numbers and text
  std::variant<std::string Row::*, double Row::*, std::optional<double> Row::*> member;
  bool required = false;  ///< the column must be there, and no cell of its numbers empty
};

/// The rules of a kind of table.
struct TableRules {
  std::string_view what;  ///< "a coupon table"
  Rule unknown, missing, twice, number;
};

/// Collects what is wrong with one file.
struct TableProblems {
  std::string file;
  Problems list = {};

  void add(RuleId id, std::string_view key, std::string value, std::string rule, std::string way_out,
           int line);
  /// @throws InputError  if anything was wrong
  void throw_if_any();
};

namespace table_detail {

struct Name {
  std::string_view name;
  std::string_view unit;
  bool required;
};

void check_header(const CsvRow& header, std::span<const Name> known,
                  std::span<const std::string_view> passed_over, const TableRules& rules,
                  TableProblems& problems);

/// Empty, and a problem more, where the cell is no finite number.
std::optional<double> number(const std::string& cell, std::string_view unit, std::string_view name, int line,
                             const TableRules& rules, TableProblems& problems);

template <class Row>
void read_cell(Row& row, const TableColumn<Row>& column, const std::string& cell, int line,
               const TableRules& rules, TableProblems& problems) {
  if (const auto* text = std::get_if<std::string Row::*>(&column.member)) {
    row.*(*text) = cell;
    return;
  }
  if (cell.empty() && !column.required) return;
  const std::optional<double> value = number(cell, column.unit, column.name, line, rules, problems);
  if (!value) return;
  if (const auto* sure = std::get_if<double Row::*>(&column.member)) row.*(*sure) = *value;
  if (const auto* maybe = std::get_if<std::optional<double> Row::*>(&column.member)) row.*(*maybe) = *value;
}

}  // namespace table_detail

/// The rows of a table, in its order; members without a cell keep what Row gives them, and a member `line`
/// takes the line of the file. Every fault of the header and of the cells goes to `problems`, with those of
/// the table: rows are whole only where it stays empty.
/// @param passed_over  columns that may be there and are not read
template <class Row, std::size_t n>
std::vector<Row> read_rows(const CsvTable& table, const std::array<TableColumn<Row>, n>& columns,
                           const TableRules& rules, TableProblems& problems,
                           std::span<const std::string_view> passed_over = {}) {
  problems.list.insert(problems.list.end(), table.problems.begin(), table.problems.end());
  std::vector<table_detail::Name> names;
  for (const TableColumn<Row>& column : columns) names.push_back({column.name, column.unit, column.required});
  table_detail::check_header(table.header, names, passed_over, rules, problems);

  std::vector<const TableColumn<Row>*> of_cell(table.header.cells.size(), nullptr);
  for (std::size_t i = 0; i < of_cell.size(); ++i)
    for (const TableColumn<Row>& column : columns)
      if (column.name == table.header.cells[i]) of_cell[i] = &column;

  std::vector<Row> rows;
  for (const CsvRow& line : table.rows) {
    Row& row = rows.emplace_back();
    if constexpr (requires { row.line = line.line; }) row.line = line.line;
    for (std::size_t i = 0; i < line.cells.size(); ++i)
      if (of_cell[i]) table_detail::read_cell(row, *of_cell[i], line.cells[i], line.line, rules, problems);
  }
  return rows;
}

/// Whether a table has a column.
bool has_column(const CsvTable& table, std::string_view name);

/// "velocity_mm_s, normal_force_N, ...": for ways out.
template <class Row, std::size_t n>
std::string names_of(const std::array<TableColumn<Row>, n>& columns) {
  std::string list;
  for (const TableColumn<Row>& column : columns) list.append(list.empty() ? "" : ", ").append(column.name);
  return list;
}

}  // namespace heddle
