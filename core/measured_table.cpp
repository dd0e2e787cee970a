#include "core/measured_table.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "core/units.h"

namespace heddle {

namespace {

/// "normal_force" of "normal_force_N" and of "normal_force_kN".
std::string_view without_unit(std::string_view column) {
  for (const std::string_view unit : {"_mm_s", "_m_s", "_mm_min", "_m_min", "_in_s"})
    if (column.ends_with(unit)) return column.substr(0, column.size() - unit.size());
  return column.substr(0, column.rfind('_'));
}

}  // namespace

void TableProblems::add(RuleId id, std::string_view key, std::string value, std::string rule,
                        std::string way_out, int line) {
  list.push_back({.id = std::move(id),
                  .key = std::string(key),
                  .value = std::move(value),
                  .rule = std::move(rule),
                  .way_out = std::move(way_out),
                  .file = file,
                  .line = line});
}

void TableProblems::throw_if_any() {
  if (!list.empty()) throw InputError(std::move(list));
}

bool has_column(const CsvTable& table, std::string_view name) {
  return std::ranges::count(table.header.cells, name) > 0;
}

namespace table_detail {

void check_header(const CsvRow& header, std::span<const Name> known,
                  std::span<const std::string_view> passed_over, const TableRules& rules,
                  TableProblems& problems) {
  std::vector<std::string_view> names;
  for (const Name& column : known) names.push_back(column.name);
  const std::string list = fmt::format("Known columns: {}.", fmt::join(names, ", "));
  for (const std::string& name : header.cells) {
    if (std::ranges::count(names, name) > 0 || std::ranges::count(passed_over, name) > 0) continue;
    const auto meant = std::ranges::find_if(known, [&](const Name& column) {
      return !column.unit.empty() && without_unit(column.name) == without_unit(name);
    });
    problems.add(
        rules.unknown, name, "", fmt::format("is no column of {}", rules.what),
        meant == known.end()
            ? list
            : fmt::format("Convert its numbers and call it {}: the unit stands in the name.", meant->name),
        header.line);
  }
  for (const Name& column : known)
    if (column.required && std::ranges::count(header.cells, column.name) == 0)
      problems.add(rules.missing, column.name, "", fmt::format("must be a column of {}", rules.what), list,
                   header.line);
  std::set<std::string_view> seen;
  for (const std::string& name : header.cells)
    if (!seen.insert(name).second)
      problems.add(rules.twice, name, "", "names two columns", "Leave one of them out.", header.line);
}

std::optional<double> number(const std::string& cell, std::string_view unit, std::string_view name, int line,
                             const TableRules& rules, TableProblems& problems) {
  const Reading reading = read_quantity(unit.empty() ? cell : fmt::format("{} {}", cell, unit), unit);
  if (reading.ok() && std::isfinite(reading.value)) return reading.value;
  problems.add(rules.number, name, cell,
               unit.empty() ? "must be a number" : fmt::format("must be a number in {}", unit),
               "Write digits only; the unit stands in the column's name.", line);
  return {};
}

}  // namespace table_detail

}  // namespace heddle
