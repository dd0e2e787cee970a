#include "friction/test_design.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <functional>
#include <map>
#include <numbers>
#include <sstream>

#include <fmt/format.h>

#include "core/csv.h"
#include "core/text_file.h"
#include "core/units.h"

namespace heddle::friction {

namespace {

struct Factor {
  const char* unit;
  std::vector<double> TestDesign::*levels;
  double (*to_si)(double);
};

const std::map<std::string, Factor>& factors() {
  static const std::map<std::string, Factor> all = {
      {"velocity", {"mm/s", &TestDesign::velocity, [](double v) { return 1e-3 * v; }}},
      {"normal_force", {"N", &TestDesign::normal_force, [](double v) { return v; }}},
      {"tool_temperature", {"C", &TestDesign::tool_temperature, [](double v) { return v + zero_celsius; }}},
      {"fabric_temperature",
       {"C", &TestDesign::fabric_temperature, [](double v) { return v + zero_celsius; }}},
      {"orientation",
       {"deg", &TestDesign::orientation, [](double v) { return v * std::numbers::pi / 180.0; }}}};
  return all;
}

constexpr std::array<std::string_view, 4> layout{"parameter", "unit", "baseline", "additional"};

class Reader {
 public:
  Reader(const CsvTable& table, std::string file) : table_(table), file_(std::move(file)) {}

  TestDesign read() {
    problems_ = table_.problems;
    line_ = table_.header.line;
    if (!std::ranges::equal(table_.header.cells, layout))
      report("friction.design.header"_rule, "", fmt::format("{}", fmt::join(table_.header.cells, ",")),
             fmt::format("must start with the line {}", fmt::join(layout, ",")),
             "One line a parameter follows.");
    else
      for (const CsvRow& row : table_.rows) read_factor(row);
    line_ = 0;
    const bool read = problems_.empty();
    for (const auto& [name, factor] : factors())
      if (read && (design_.*factor.levels).empty())
        report("friction.design.missing"_rule, name, "", "must have a line", "Give at least its baseline.");
    if (!problems_.empty()) throw InputError(std::move(problems_));
    return std::move(design_);
  }

 private:
  void read_factor(const CsvRow& row) {
    line_ = row.line;
    const auto& cells = row.cells;
    if (cells[0] == "bending") return read_bending(cells);
    const auto found = factors().find(cells[0]);
    if (found == factors().end()) {
      report(
          "friction.design.parameter"_rule, cells[0], "", "is no parameter of the friction test",
          "Known are velocity, normal_force, tool_temperature, fabric_temperature, orientation and bending.");
      return;
    }
    const Factor& factor = found->second;
    if (cells[1] != factor.unit)
      report("friction.design.unit"_rule, cells[0], cells[1], fmt::format("must be in {}", factor.unit),
             "Convert the levels.");
    add_level(factor, cells[0], cells[2]);
    std::stringstream levels(cells[3]);
    for (std::string level; std::getline(levels, level, ';');) add_level(factor, cells[0], level);
  }

  void read_bending(const std::vector<std::string>& cells) {
    design_.s_curve = cells[3] == "s_curve";
    if (cells[1].empty() && cells[2] == "flat" && (design_.s_curve || cells[3].empty())) return;
    report("friction.design.bending"_rule, "bending", fmt::format("{}", fmt::join(cells, ",")),
           "must read bending,,flat,s_curve", "Leave the line out if all plates were flat.");
  }

  void add_level(const Factor& factor, const std::string& name, const std::string& text) {
    double value = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size())
      report("friction.design.number"_rule, name, text, "must be a number",
             "Separate levels by ; without spaces.");
    else
      (design_.*factor.levels).push_back(factor.to_si(value));
  }

  void report(Rule id, const std::string& key, const std::string& value, const std::string& rule,
              const std::string& way_out) {
    problems_.push_back({id, key, value, rule, way_out, file_, line_});
  }

  const CsvTable& table_;
  std::string file_;
  int line_ = 0;
  TestDesign design_;
  Problems problems_;
};

FrictionTestRow baseline(const TestDesign& design) {
  FrictionTestRow row;
  row.name = "baseline";
  row.velocity = design.velocity.front();
  row.normal_force = design.normal_force.front();
  row.tool_temperature = design.tool_temperature.front();
  row.fabric_temperature = design.fabric_temperature.front();
  row.orientation = design.orientation.front();
  return row;
}

}  // namespace

std::vector<FrictionTestRow> one_at_a_time(const TestDesign& design) {
  std::vector<FrictionTestRow> rows = {baseline(design)};
  const auto vary = [&](const std::vector<double>& levels, double FrictionTestRow::*field,
                        const std::function<std::string(double)>& name) {
    for (std::size_t k = 1; k < levels.size(); ++k) {
      FrictionTestRow row = baseline(design);
      row.*field = levels[k];
      row.name = name(levels[k]);
      rows.push_back(row);
    }
  };
  vary(design.velocity, &FrictionTestRow::velocity,
       [](double v) { return fmt::format("velocity {:.4g} mm/s", 1e3 * v); });
  vary(design.normal_force, &FrictionTestRow::normal_force,
       [](double v) { return fmt::format("normal force {:.4g} N", v); });
  vary(design.tool_temperature, &FrictionTestRow::tool_temperature,
       [](double v) { return fmt::format("tool {:.4g} degC", v - zero_celsius); });
  vary(design.fabric_temperature, &FrictionTestRow::fabric_temperature,
       [](double v) { return fmt::format("fabric {:.4g} degC", v - zero_celsius); });
  vary(design.orientation, &FrictionTestRow::orientation,
       [](double v) { return fmt::format("orientation {:.4g} deg", v * 180.0 / std::numbers::pi); });
  return rows;
}

std::vector<FrictionTestRow> all_combinations(const TestDesign& design) {
  std::vector<FrictionTestRow> rows;
  for (double velocity : design.velocity)
    for (double force : design.normal_force)
      for (double tool : design.tool_temperature)
        for (double fabric : design.fabric_temperature) {
          FrictionTestRow row = baseline(design);
          row.velocity = velocity;
          row.normal_force = force;
          row.tool_temperature = tool;
          row.fabric_temperature = fabric;
          rows.push_back(row);
        }
  return rows;
}

TestDesign parse_test_design(const std::string& text, const std::string& file) {
  return Reader(parse_csv(text, file), file).read();
}

TestDesign read_test_design(const std::string& path) {
  return parse_test_design(read_text_file(path), path);
}

}  // namespace heddle::friction
