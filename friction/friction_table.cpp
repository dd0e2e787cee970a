#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <stdexcept>

#include "core/measured_table.h"
#include "core/text_file.h"
#include "core/units.h"
#include "friction/friction_test.h"

namespace heddle::friction {

namespace {

using Row = FrictionTestRow;
using Column = TableColumn<Row>;
constexpr std::string_view name_column = "case";
constexpr std::array columns{
    Column{name_column, "", &Row::name, true},
    Column{"velocity_mm_s", "mm/s", &Row::velocity, true},
    Column{"normal_force_N", "N", &Row::normal_force, true},
    Column{"tool_temperature_C", "degC", &Row::tool_temperature, true},
    Column{"fabric_temperature_C", "degC", &Row::fabric_temperature, true},
    Column{"orientation_deg", "deg", &Row::orientation},
    Column{"force_measured_N", "N", &Row::measured_force},
    Column{"force_paper_model_N", "N", &Row::paper_model_force},
};
/// Written by our own friction test; results, not conditions.
constexpr std::array<std::string_view, 3> passed_over{"friction_coefficient", "pull_force_N", "force_error"};
constexpr TableRules rules{.what = "a friction-test table",
                           .unknown = "friction.table.column.unknown"_rule,
                           .missing = "friction.table.column.missing"_rule,
                           .twice = "friction.table.column.twice"_rule,
                           .number = "friction.table.number"_rule};

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
  const auto column = std::ranges::find(columns, name, &Column::name);
  std::optional<double> value;
  if (const auto* number = std::get_if<double Row::*>(&column->member)) value = row.*(*number);
  if (const auto* maybe = std::get_if<std::optional<double> Row::*>(&column->member)) value = row.*(*maybe);
  return value ? in_unit(*value, column->unit) : "";
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
  TableProblems problems{file};
  std::vector<FrictionTestRow> rows = read_rows(parse_csv(text, file), columns, rules, problems, passed_over);
  problems.throw_if_any();
  return rows;
}

std::vector<FrictionTestRow> read_friction_table(const std::string& path) {
  return parse_friction_table(read_text_file(path), path);
}

}  // namespace heddle::friction
