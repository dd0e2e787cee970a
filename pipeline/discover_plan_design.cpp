#include "pipeline/discover_plan_design.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>

#include "core/measured_table.h"
#include "core/text_file.h"
#include "core/units.h"
#include "friction/test_design.h"
#include "pipeline/discover/design_exchange.h"

namespace heddle::pipeline {

namespace {

using discover::CouponCell;

/// One line of the table; what is not there is the default.
struct Line {
  int line = 0;
  std::string name, other_name, day, replicates;
  std::optional<double> velocity, normal_force, tool_temperature, fabric_temperature, orientation, dwell;
};

using Column = TableColumn<Line>;
constexpr std::array columns{Column{"condition_id", "", &Line::name},
                             Column{"case", "", &Line::other_name},
                             Column{"day_id", "", &Line::day},
                             Column{"replicates", "", &Line::replicates},
                             Column{"velocity_mm_s", "mm/s", &Line::velocity, true},
                             Column{"normal_force_N", "N", &Line::normal_force, true},
                             Column{"tool_temperature_C", "degC", &Line::tool_temperature, true},
                             Column{"fabric_temperature_C", "degC", &Line::fabric_temperature, true},
                             Column{"orientation_deg", "deg", &Line::orientation},
                             Column{"dwell_s", "s", &Line::dwell}};
constexpr TableRules rules{.what = "a design, whose header may also be parameter,unit,baseline,additional",
                           .unknown = "discover.design.column.unknown"_rule,
                           .missing = "discover.design.column.missing"_rule,
                           .twice = "discover.design.column.twice"_rule,
                           .number = "discover.design.number"_rule};

int replicates_of(const std::string& text) {
  int count = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), count);
  return error == std::errc() && end == text.data() + text.size() ? count : 0;
}

/// Of what could be read.
void check_line(const Line& line, bool has_replicates, TableProblems& problems) {
  const auto demand = [&](std::string_view column, const std::optional<double>& value, const char* unit,
                          bool zero_too, const char* rule) {
    if (value && !(*value > 0.0 || (zero_too && *value == 0.0)))
      problems.add("discover.design.range"_rule, column, write_quantity(*value, unit), rule,
                   "Correct the cell.", line.line);
  };
  demand("velocity_mm_s", line.velocity, "mm/s", false, "must be positive");
  demand("normal_force_N", line.normal_force, "N", false, "must be positive");
  demand("tool_temperature_C", line.tool_temperature, "degC", false, "is below absolute zero");
  demand("fabric_temperature_C", line.fabric_temperature, "degC", false, "is below absolute zero");
  demand("dwell_s", line.dwell, "s", true, "must be 0 or more");
  const int replicates = replicates_of(line.replicates);
  if (has_replicates && (replicates < 1 || replicates > 1000))
    problems.add("discover.design.replicates"_rule, "replicates", line.replicates,
                 "must be a whole number from 1 to 1000", "Five samples of each condition are usual.",
                 line.line);
}

PlannedDesign one_row_a_condition(const CsvTable& table, const std::string& file,
                                  const DesignDefaults& defaults) {
  const bool has_replicates = has_column(table, "replicates");
  TableProblems problems{file};
  const std::vector<Line> lines = read_rows(table, columns, rules, problems);
  if (table.rows.empty() && problems.list.empty())
    problems.add("discover.design.empty"_rule, "rows", "", "must hold a condition",
                 "Write one row a condition.", 0);
  for (const Line& line : lines) check_line(line, has_replicates, problems);
  problems.throw_if_any();

  PlannedDesign design;
  std::map<std::string, std::size_t> days;
  for (const Line& line : lines) {
    CouponCell& cell = design.cells.emplace_back();
    cell.pull.name = line.name.empty() ? line.other_name : line.name;
    cell.pull.velocity = *line.velocity;
    cell.pull.normal_force = *line.normal_force;
    cell.pull.tool_temperature = *line.tool_temperature;
    cell.pull.fabric_temperature = *line.fabric_temperature;
    cell.pull.orientation = line.orientation.value_or(0.0);
    cell.dwell = line.dwell.value_or(defaults.dwell);
    cell.day = days.try_emplace(line.day, days.size()).first->second;
    cell.samples = has_replicates ? replicates_of(line.replicates) : defaults.replicates;
  }
  if (!has_replicates)
    design.notes.push_back(
        fmt::format("No replicates: {} samples of each condition ASSUMED.", defaults.replicates));
  return design;
}

PlannedDesign one_at_a_time(std::string_view text, const std::string& file, const DesignDefaults& defaults) {
  const friction::TestDesign factors = friction::parse_test_design(std::string(text), file);
  PlannedDesign design;
  for (const friction::FrictionTestRow& row : friction::one_at_a_time(factors)) {
    CouponCell cell;
    cell.pull = row;
    cell.dwell = defaults.dwell;
    cell.samples = defaults.replicates;
    design.cells.push_back(std::move(cell));
  }
  design.notes.push_back(fmt::format("Factors varied one at a time; {} samples of each condition ASSUMED.",
                                     defaults.replicates));
  if (factors.s_curve) design.notes.emplace_back("Bent plates are no condition of a coupon: left out.");
  return design;
}

/// In turn over the days they need.
void spread_over_days(PlannedDesign& design, int cells_a_day) {
  const std::size_t each = static_cast<std::size_t>(cells_a_day);
  const std::size_t days = (design.cells.size() + each - 1) / each;
  for (std::size_t k = 0; k < design.cells.size(); ++k) design.cells[k].day = k % days;
  design.notes.push_back(
      fmt::format("No day_id: conditions in turn over {} days, {} a day, ASSUMED.", days, cells_a_day));
}

void demand_variety(const std::vector<CouponCell>& cells, const std::string& file) {
  if (std::ranges::any_of(discover::levels_of(cells), [](const auto& levels) { return levels.size() > 1; }))
    return;
  throw InputError({{"discover.design.alike"_rule, "design", "",
                     "holds one condition only, which cannot tell one effect from another",
                     "Vary at least one of speed, load, temperatures, orientation and dwell.", file}});
}

}  // namespace

PlannedDesign parse_design(std::string_view text, const std::string& file, const DesignDefaults& defaults) {
  const CsvTable table = parse_csv(text, file);
  const bool factors = !table.header.cells.empty() && table.header.cells.front() == "parameter";
  PlannedDesign design =
      factors ? one_at_a_time(text, file, defaults) : one_row_a_condition(table, file, defaults);
  demand_variety(design.cells, file);
  if (factors || !has_column(table, "day_id")) spread_over_days(design, defaults.cells_a_day);
  discover::number_conditions(design.cells);
  for (CouponCell& cell : design.cells)
    if (cell.pull.name.empty()) cell.pull.name = fmt::format("c{:02}", cell.condition + 1);
  return design;
}

PlannedDesign read_design(const std::filesystem::path& file, const DesignDefaults& defaults) {
  return parse_design(read_text_file(file), file.lexically_normal().string(), defaults);
}

std::string design_csv(const std::vector<CouponCell>& cells) {
  std::string text =
      "condition_id,day_id,velocity_mm_s,normal_force_N,tool_temperature_C,fabric_temperature_C,"
      "orientation_deg,dwell_s,replicates\n";
  for (const CouponCell& cell : cells)
    text +=
        fmt::format("c{:02},d{:02},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{}\n", cell.condition + 1,
                    cell.day + 1, 1e3 * cell.pull.velocity, cell.pull.normal_force,
                    cell.pull.tool_temperature - zero_celsius, cell.pull.fabric_temperature - zero_celsius,
                    cell.pull.orientation * 180.0 / std::numbers::pi, cell.dwell, cell.samples);
  return text;
}

}  // namespace heddle::pipeline
