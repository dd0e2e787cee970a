#include "pipeline/discover_plan_design.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <set>

#include "core/csv.h"
#include "core/problem.h"
#include "core/text_file.h"
#include "core/units.h"
#include "friction/test_design.h"
#include "pipeline/discover/design_exchange.h"

namespace heddle::pipeline {

namespace {

using discover::CouponCell;

struct Column {
  std::string_view name, unit;
  bool required = false;
  double above = -INFINITY;  ///< numbers must be above this
};

/// In the order of discover::knobs().
constexpr std::array columns{
    Column{"velocity_mm_s", "mm/s", true, 0.0}, Column{"normal_force_N", "N", true, 0.0},
    Column{"tool_temperature_C", "degC", true}, Column{"fabric_temperature_C", "degC", true},
    Column{"orientation_deg", "deg"},           Column{"dwell_s", "s"}};
constexpr std::array<std::string_view, 4> names{"condition_id", "case", "day_id", "replicates"};

std::vector<std::string_view> known_columns() {
  std::vector<std::string_view> known;
  for (const Column& column : columns) known.push_back(column.name);
  known.insert(known.end(), names.begin(), names.end());
  return known;
}

class RowReader {
 public:
  RowReader(const CsvTable& table, std::string file, const DesignDefaults& defaults)
      : table_(table), file_(std::move(file)), defaults_(defaults), problems_(table.problems) {}

  PlannedDesign read() {
    check_columns();
    if (table_.rows.empty() && problems_.empty())
      add("discover.design.empty"_rule, "rows", "", "must hold a condition", "Write one row a condition.", 0);
    PlannedDesign design;
    for (const CsvRow& row : table_.rows) design.cells.push_back(cell_of(row));
    if (!problems_.empty()) throw InputError(std::move(problems_));
    return design;
  }

  bool has(std::string_view column) const { return std::ranges::count(table_.header.cells, column) > 0; }

 private:
  void add(Rule id, std::string_view key, std::string value, std::string rule, std::string way_out,
           int line) {
    problems_.push_back(
        {id, std::string(key), std::move(value), std::move(rule), std::move(way_out), file_, line});
  }

  void check_columns() {
    const std::vector<std::string>& header = table_.header.cells;
    for (const std::string& name : header)
      if (std::ranges::count(known_columns(), name) == 0)
        add("discover.design.column.unknown"_rule, name, "", "is no column of a design",
            fmt::format("Known columns: {}; or the header parameter,unit,baseline,additional.",
                        fmt::join(known_columns(), ", ")),
            table_.header.line);
    for (const Column& column : columns)
      if (column.required && !has(column.name))
        add("discover.design.column.missing"_rule, column.name, "", "must be a column of the design",
            "The unit stands in the name.", table_.header.line);
    if (std::set<std::string>(header.begin(), header.end()).size() < header.size())
      add("discover.design.column.twice"_rule, "header", "", "names a column twice", "Leave one of them out.",
          table_.header.line);
  }

  CouponCell cell_of(const CsvRow& row) {
    CouponCell cell;
    cell.dwell = defaults_.dwell;
    cell.samples = defaults_.replicates;
    for (std::size_t i = 0; i < row.cells.size(); ++i) {
      const std::string &name = table_.header.cells[i], &text = row.cells[i];
      if (name == "condition_id" || name == "case") cell.pull.name = text;
      if (name == "day_id") cell.day = days_.try_emplace(text, days_.size()).first->second;
      if (name == "replicates") cell.samples = replicates(text, row.line);
      const auto column = std::ranges::find(columns, name, &Column::name);
      if (column != columns.end())
        if (const auto value = number(*column, text, row.line))
          discover::knobs()[static_cast<std::size_t>(column - columns.begin())].set(cell, *value);
    }
    return cell;
  }

  int replicates(const std::string& text, int line) {
    int count = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), count);
    if (error == std::errc() && end == text.data() + text.size() && count >= 1 && count <= 1000) return count;
    add("discover.design.replicates"_rule, "replicates", text, "must be a whole number from 1 to 1000",
        "Five samples of each condition are usual.", line);
    return defaults_.replicates;
  }

  std::optional<double> number(const Column& column, const std::string& text, int line) {
    const Reading reading = read_quantity(fmt::format("{} {}", text, column.unit), column.unit);
    if (!reading.ok()) {
      add("discover.design.number"_rule, column.name, text, "must be a number",
          fmt::format("In {}, as the column says.", column.unit), line);
      return {};
    }
    const bool cold = column.unit == "degC" && !(reading.value > 0.0);
    const bool negative_rest = column.name == "dwell_s" && reading.value < 0.0;
    if (!cold && !negative_rest && reading.value > column.above) return reading.value;
    add("discover.design.range"_rule, column.name, text,
        cold            ? "is below absolute zero"
        : negative_rest ? "must be 0 or more"
                        : "must be positive",
        "Correct the cell.", line);
    return {};
  }

  const CsvTable& table_;
  std::string file_;
  const DesignDefaults& defaults_;
  Problems problems_;
  std::map<std::string, std::size_t> days_;
};

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
  PlannedDesign design;
  bool has_days = false;
  if (factors) {
    design = one_at_a_time(text, file, defaults);
  } else {
    RowReader reader(table, file, defaults);
    design = reader.read();
    has_days = reader.has("day_id");
    if (!reader.has("replicates"))
      design.notes.push_back(
          fmt::format("No replicates: {} samples of each condition ASSUMED.", defaults.replicates));
  }
  demand_variety(design.cells, file);
  if (!has_days) spread_over_days(design, defaults.cells_a_day);
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
    text += fmt::format("c{:02},d{:02},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{}\n", cell.condition + 1,
                        cell.day + 1, 1e3 * cell.pull.velocity, cell.pull.normal_force,
                        cell.pull.tool_temperature - 273.15, cell.pull.fabric_temperature - 273.15,
                        cell.pull.orientation * 180.0 / std::numbers::pi, cell.dwell, cell.samples);
  return text;
}

}  // namespace heddle::pipeline
