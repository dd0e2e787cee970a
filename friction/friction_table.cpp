#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <stdexcept>

#include "core/csv.h"
#include "core/text_file.h"
#include "core/units.h"
#include "friction/friction_test.h"

namespace heddle::friction {

namespace {

/// A number of the row, and the unit in which the table holds it.
struct Column {
  std::string_view name;
  std::string_view unit;
  bool required;
  void (*store)(FrictionTestRow&, double);
  std::optional<double> (*load)(const FrictionTestRow&);
};

template <auto member>
constexpr Column column(std::string_view name, std::string_view unit, bool required) {
  return {.name = name,
          .unit = unit,
          .required = required,
          .store = [](FrictionTestRow& row, double value) { row.*member = value; },
          .load = [](const FrictionTestRow& row) { return std::optional<double>(row.*member); }};
}

using Row = FrictionTestRow;
constexpr std::array columns{
    column<&Row::velocity>("velocity_mm_s", "mm/s", true),
    column<&Row::normal_force>("normal_force_N", "N", true),
    column<&Row::tool_temperature>("tool_temperature_C", "degC", true),
    column<&Row::fabric_temperature>("fabric_temperature_C", "degC", true),
    column<&Row::orientation>("orientation_deg", "deg", false),
    column<&Row::measured_force>("force_measured_N", "N", false),
    column<&Row::paper_model_force>("force_paper_model_N", "N", false),
};
constexpr std::string_view name_column = "case";
/// Written by our own friction test; results, not conditions.
constexpr std::array<std::string_view, 3> passed_over{"friction_coefficient", "pull_force_N", "force_error"};

const Column* find_column(std::string_view name) {
  const auto found = std::ranges::find(columns, name, &Column::name);
  return found == columns.end() ? nullptr : &*found;
}

std::string known_columns() {
  std::string list(name_column);
  for (const Column& known : columns) list += fmt::format(", {}", known.name);
  return list;
}

class TableReader {
 public:
  TableReader(const CsvTable& table, std::string file) : table_(table), file_(std::move(file)) {}

  /// @throws InputError  if anything was wrong
  std::vector<FrictionTestRow> rows() {
    problems_ = table_.problems;
    for (const std::string& name : header()) check_known(name);
    check_present(name_column);
    for (const Column& known : columns)
      if (known.required) check_present(known.name);
    std::vector<FrictionTestRow> rows;
    for (const CsvRow& line : table_.rows) {
      rows.emplace_back();
      for (std::size_t i = 0; i < line.cells.size(); ++i)
        read_cell(rows.back(), header()[i], line.cells[i], line.line);
    }
    if (!problems_.empty()) throw InputError(std::move(problems_));
    return rows;
  }

 private:
  const std::vector<std::string>& header() const { return table_.header.cells; }

  void check_known(std::string_view name) {
    if (name == name_column || find_column(name) || std::ranges::count(passed_over, name) > 0) return;
    add("friction.table.column.unknown"_rule, "", "is no column of a friction-test table",
        "Known columns: " + known_columns() + ".", name, table_.header.line);
  }

  void check_present(std::string_view name) {
    const auto count = std::ranges::count(header(), name);
    if (count == 1) return;
    add(count == 0 ? "friction.table.column.missing"_rule : "friction.table.column.twice"_rule, "",
        count == 0 ? "must be a column of the table" : "must be there once",
        "Known columns: " + known_columns() + ".", name, table_.header.line);
  }

  void read_cell(FrictionTestRow& row, std::string_view name, std::string_view cell, int line) {
    if (name == name_column) row.name = cell;
    const Column* known = find_column(name);
    if (!known || (cell.empty() && !known->required)) return;
    const Reading reading = read_quantity(fmt::format("{} {}", cell, known->unit), known->unit);
    if (reading.ok()) {
      known->store(row, reading.value);
    } else {
      add("friction.table.number"_rule, std::string(cell), "must be a number in " + std::string(known->unit),
          "Write digits only; the unit stands in the column's name.", name, line);
    }
  }

  void add(Rule id, std::string value, std::string rule, std::string way_out, std::string_view key,
           int line) {
    problems_.push_back({.id = id,
                         .key = std::string(key),
                         .value = std::move(value),
                         .rule = std::move(rule),
                         .way_out = std::move(way_out),
                         .file = file_,
                         .line = line});
  }

  const CsvTable& table_;
  std::string file_;
  Problems problems_;
};

/// The number alone, in the column's unit.
std::string in_unit(double value, std::string_view unit) {
  const std::string text = write_quantity(value, unit);
  const std::string suffix = fmt::format(" {}", unit);
  if (text.ends_with(suffix)) return text.substr(0, text.size() - suffix.size());
  // No short text gives these bits in this unit: as near as 15 digits come.
  const double zero = read_quantity(fmt::format("0 {}", unit), unit).value;
  const double one = read_quantity(fmt::format("1 {}", unit), unit).value;
  return fmt::format("{:.15g}", (value - zero) / (one - zero));
}

std::string cell_of(const FrictionTestRow& row, const FrictionTestResult& result, std::string_view name) {
  if (name == name_column) return row.name;
  if (name == "friction_coefficient") return fmt::format("{}", result.mu);
  if (name == "pull_force_N") return fmt::format("{}", result.pull_force);
  if (name == "force_error") return result.relative_error ? fmt::format("{}", *result.relative_error) : "";
  const Column* known = find_column(name);
  const std::optional<double> value = known->load(row);
  return value ? in_unit(*value, known->unit) : "";
}

}  // namespace

std::string format_friction_table(std::span<const FrictionTestRow> rows,
                                  std::span<const FrictionTestResult> results) {
  constexpr std::array<std::string_view, 11> layout{name_column,
                                                    "velocity_mm_s",
                                                    "normal_force_N",
                                                    "tool_temperature_C",
                                                    "fabric_temperature_C",
                                                    "orientation_deg",
                                                    "friction_coefficient",
                                                    "pull_force_N",
                                                    "force_measured_N",
                                                    "force_paper_model_N",
                                                    "force_error"};
  if (rows.size() != results.size()) throw std::invalid_argument("format_friction_table: one result a row");
  std::string text = fmt::format("{}\n", fmt::join(layout, ","));
  for (std::size_t i = 0; i < rows.size(); ++i) {
    std::vector<std::string> cells;
    for (const std::string_view name : layout) cells.push_back(cell_of(rows[i], results[i], name));
    text += fmt::format("{}\n", fmt::join(cells, ","));
  }
  return text;
}

std::vector<FrictionTestRow> parse_friction_table(std::string_view text, const std::string& file) {
  return TableReader(parse_csv(text, file), file).rows();
}

std::vector<FrictionTestRow> read_friction_table(const std::string& path) {
  return parse_friction_table(read_text_file(path), path);
}

}  // namespace heddle::friction
