#include "friction/calibration/coupon_data.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <tuple>

#include "core/measured_table.h"
#include "core/text_file.h"
#include "core/units.h"

namespace heddle::friction {

namespace {

/// One line of the table.
struct Line {
  int line = 0;
  std::string name, condition, sample, day;
  double velocity = 0.0, normal_force = 0.0, tool_temperature = 0.0, fabric_temperature = 0.0;
  double orientation = 0.0, dwell = 0.0;
  std::optional<double> time, displacement, force, other_force, measured_normal_force;
};

using Column = TableColumn<Line>;
constexpr std::array columns{Column{"case", "", &Line::name},
                             Column{"condition_id", "", &Line::condition},
                             Column{"sample_id", "", &Line::sample},
                             Column{"day_id", "", &Line::day},
                             Column{"velocity_mm_s", "mm/s", &Line::velocity, true},
                             Column{"normal_force_N", "N", &Line::normal_force, true},
                             Column{"tool_temperature_C", "degC", &Line::tool_temperature, true},
                             Column{"fabric_temperature_C", "degC", &Line::fabric_temperature, true},
                             Column{"orientation_deg", "deg", &Line::orientation},
                             Column{"dwell_s", "s", &Line::dwell},
                             Column{"time_s", "s", &Line::time},
                             Column{"displacement_mm", "mm", &Line::displacement},
                             Column{"force_measured_N", "N", &Line::force},
                             Column{"pull_force_N", "N", &Line::other_force},
                             Column{"normal_force_measured_N", "N", &Line::measured_normal_force}};
/// Written by friction tests, or no matter of the fit.
constexpr std::array<std::string_view, 7> passed_over{
    "friction_coefficient", "force_error",   "error",   "paper_error",
    "force_paper_model_N",  "paper_force_N", "operator"};

constexpr TableRules rules{.what = "a coupon table",
                           .unknown = "friction.coupons.column.unknown"_rule,
                           .missing = "friction.coupons.column.missing"_rule,
                           .twice = "friction.coupons.column.twice"_rule,
                           .number = "friction.coupons.number"_rule};

std::vector<Line> lines_of(const CsvTable& table, TableProblems& problems) {
  std::vector<Line> lines = read_rows(table, columns, rules, problems, passed_over);
  // Our own tables hold the model's force under pull_force_N, beside what was measured.
  if (!has_column(table, "force_measured_N"))
    for (Line& line : lines) line.force = line.other_force;
  if (!has_column(table, "force_measured_N") && !has_column(table, "pull_force_N"))
    problems.add(rules.missing, "force_measured_N or pull_force_N", "",
                 fmt::format("must be a column of {}", rules.what),
                 fmt::format("Known columns: {}.", names_of(columns)), table.header.line);
  if (lines.empty())
    problems.add("friction.coupons.empty"_rule, "data", "", "must hold at least one pull",
                 "One line a pull, after the header line.", 0);
  return lines;
}

/// Lines of one piece of fabric under one condition.
using Pull = std::vector<const Line*>;

std::vector<Pull> pulls_of(const std::vector<Line>& lines) {
  std::vector<Pull> pulls;
  std::map<std::tuple<std::string, std::string, std::string, std::string>, std::size_t> place;
  for (const Line& line : lines) {
    const auto [at, fresh] =
        place.try_emplace({line.condition, line.name, line.day, line.sample}, pulls.size());
    // Without a sample_id each line is a piece of its own.
    if (fresh || line.sample.empty())
      pulls.push_back({&line});
    else
      pulls[at->second].push_back(&line);
  }
  return pulls;
}

/// Means of force, load and slip over the lines of one stretch.
CouponRow row_of(const Pull& stretch) {
  const Line& first = *stretch.front();
  CouponRow row;
  row.pull.name = !first.name.empty()        ? first.name
                  : !first.condition.empty() ? fmt::format("{}/{}", first.condition, first.sample)
                                             : fmt::format("line {}", first.line);
  row.pull.velocity = first.velocity;
  row.pull.tool_temperature = first.tool_temperature;
  row.pull.fabric_temperature = first.fabric_temperature;
  row.pull.orientation = first.orientation;
  row.dwell = first.dwell;
  row.line = first.line;
  const auto count = static_cast<double>(stretch.size());
  double force = 0.0, load = 0.0, slip = 0.0;
  for (const Line* line : stretch) {
    force += line->force.value_or(std::nan("")) / count;
    load += line->measured_normal_force.value_or(line->normal_force) / count;
    slip += line->displacement.value_or(0.0) / count;
  }
  row.pull.measured_force = force;
  row.pull.normal_force = load;
  row.load_measured =
      std::ranges::all_of(stretch, [](const Line* line) { return line->measured_normal_force.has_value(); });
  if (slip > 0.0) row.slip = slip;
  return row;
}

/// Shortest and longest slip, of those above 0.
struct SlipRange {
  double shortest = 1e300, longest = 0.0;
  void take(const Line& line) {
    longest = std::max(longest, line.displacement.value_or(0.0));
    if (line.displacement.value_or(0.0) > 0.0) shortest = std::min(shortest, *line.displacement);
  }
  bool is_one() const { return !(longest > shortest); }
};

SlipRange slips_of(const Pull& pull) {
  SlipRange range;
  for (const Line* line : pull) range.take(*line);
  return range;
}

/// The slips of all pulls that are histories.
SlipRange slips_of(const std::vector<Pull>& pulls) {
  SlipRange range;
  for (const Pull& pull : pulls)
    if (pull.size() > 1)
      for (const Line* line : pull) range.take(*line);
  return range;
}

/// The lines of a pull in stretches of slip that are even in their logarithm, some of them empty; of one, the
/// steady half.
std::vector<Pull> stretches_of(const Pull& pull, int count, const SlipRange& range) {
  if (pull.size() == 1) return {pull};
  std::vector<Pull> stretches(static_cast<std::size_t>(count));
  const double longest = slips_of(pull).longest;
  for (const Line* line : pull) {
    const double slip = *line->displacement;
    if (count == 1 ? slip < 0.5 * longest : slip <= 0.0) continue;
    const bool one = count == 1 || range.is_one();
    const double share =
        one ? 0.0 : std::log(slip / range.shortest) / std::log(range.longest / range.shortest);
    stretches[static_cast<std::size_t>(std::clamp(share * count, 0.0, count - 1.0))].push_back(line);
  }
  return stretches;
}

/// Numbers the different keys in the order in which they come.
template <class Key>
class Numbering {
 public:
  std::size_t of(const Key& key) { return place_.try_emplace(key, place_.size()).first->second; }
  std::size_t count() const { return place_.size(); }

 private:
  std::map<Key, std::size_t> place_;
};

void check_line(TableProblems& problems, const Line& line) {
  const auto positive = [&](double value, std::string_view column, std::string_view unit) {
    if (value > 0.0 && std::isfinite(value)) return;
    problems.add("friction.coupons.positive"_rule, column, write_quantity(value, unit), "must be positive",
                 "Correct the line, or leave it out.", line.line);
  };
  positive(line.velocity, "velocity_mm_s", "mm/s");
  positive(line.normal_force, "normal_force_N", "N");
  if (line.measured_normal_force) positive(*line.measured_normal_force, "normal_force_measured_N", "N");
  // Steel and melt stay far below; 453 degC is 180 degC in kelvin.
  constexpr double too_hot = 593.15;
  for (const auto& [value, column] : {std::pair{line.tool_temperature, "tool_temperature_C"},
                                      std::pair{line.fabric_temperature, "fabric_temperature_C"}})
    if (value > too_hot)
      problems.add("friction.coupons.unit.temperature"_rule, column, write_quantity(value, "degC"),
                   "lies above 320 degC, where polypropylene is no more; is it in kelvin or fahrenheit?",
                   "Write it in degC.", line.line);
}

/// @param column  in which the table has them
void check_forces(TableProblems& problems, const std::vector<CouponRow>& rows, int faces,
                  std::string_view column) {
  std::vector<const CouponRow*> odd;
  for (const CouponRow& row : rows) {
    const double force = *row.pull.measured_force;
    if (!(force > 0.0 && std::isfinite(force))) {
      problems.add("friction.coupons.force"_rule, column, std::isnan(force) ? "" : write_quantity(force, "N"),
                   "must be a positive force", "Fill in the measured pull force, or leave the line out.",
                   row.line);
      continue;
    }
    if (!(row.pull.normal_force > 0.0)) continue;  // said already
    const double mu = measured_coefficient(row, faces);
    if (mu > 5.0 || mu < 5e-3) odd.push_back(&row);
  }
  if (odd.empty()) return;
  // A unit is the table's: once, however long it is.
  const CouponRow& first = *odd.front();
  problems.add("friction.coupons.unit.force"_rule, column, write_quantity(*first.pull.measured_force, "N"),
               fmt::format("gives mu = F/({} N) = {:.3g}, which no fabric has{}; is one of the two forces in "
                           "kN or in kg?",
                           faces, measured_coefficient(first, faces),
                           odd.size() > 1 ? fmt::format(" (so do {} forces more)", odd.size() - 1) : ""),
               "Write pull force and normal force both in N.", first.line);
}

/// A piece of fabric with several lines needs the slip of each, some of it.
bool check_history(TableProblems& problems, const Pull& pull) {
  if (pull.size() == 1) return true;
  const bool whole = std::ranges::all_of(pull, [](const Line* l) { return l->displacement.has_value(); });
  if (whole && std::ranges::any_of(pull, [](const Line* l) { return *l->displacement > 0.0; })) return true;
  const Line& first = *pull.front();
  problems.add(
      "friction.coupons.history"_rule, "displacement_mm", "",
      fmt::format("must be given, and rise above 0, where a sample has several lines ({} of sample {})",
                  pull.size(), first.sample),
      "Give the displacement of each line, or each piece of fabric its own sample_id.", first.line);
  return false;
}

/// Conditions named by the experimenter are alike though their measured numbers scatter.
using Condition = std::tuple<std::string, double, double, double, double, double, double>;
Condition condition_of(const Line& line) {
  if (!line.condition.empty()) return {line.condition, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0};
  return {"",
          line.velocity,
          line.normal_force,
          line.tool_temperature,
          line.fabric_temperature,
          line.orientation,
          line.dwell};
}

std::string reduction_in_words(std::size_t histories, int stretches) {
  if (stretches == 1)
    return fmt::format("{} histories were cut to the mean force over the second half of their displacement.",
                       histories);
  return fmt::format("{} histories were cut to the mean forces of up to {} stretches of displacement.",
                     histories, stretches);
}

/// What is no fault for certain, but would be if all rows had it.
std::vector<std::string> odd_looks(const std::vector<CouponRow>& rows) {
  double load = 0.0, speed = 0.0;
  for (const CouponRow& row : rows) {
    load = std::max(load, row.pull.normal_force);
    speed = std::max(speed, row.pull.velocity);
  }
  std::vector<std::string> notes;
  if (load < 10.0)
    notes.push_back(fmt::format(
        "No normal force is above {:.3g} N. A sled weighs as little; plates press with 200 to 4000 N: if the "
        "table is in kN, multiply its forces by 1000.",
        load));
  if (speed < 1e-4)
    notes.push_back(fmt::format(
        "No pull is faster than {:.3g} mm/s. If the speeds are in m/s, multiply them by 1000.", 1e3 * speed));
  return notes;
}

}  // namespace

double measured_coefficient(const CouponRow& row, int faces) {
  return *row.pull.measured_force / (faces * row.pull.normal_force);
}

CouponData parse_coupons(std::string_view text, const std::string& file, const CouponReduction& reduction) {
  TableProblems problems{file};
  const CsvTable table = parse_csv(text, file);
  const std::vector<Line> lines = lines_of(table, problems);
  problems.throw_if_any();
  for (const Line& line : lines) check_line(problems, line);

  CouponData data;
  data.file = file;
  Numbering<Condition> conditions_seen;
  Numbering<std::string> days;
  std::size_t histories = 0;
  const std::vector<Pull> pulls = pulls_of(lines);
  const SlipRange all_slips = slips_of(pulls);
  for (const Pull& pull : pulls) {
    if (!check_history(problems, pull)) continue;
    if (pull.size() > 1) ++histories;
    const Line& first = *pull.front();
    if (days.of(first.day) == data.days.size()) data.days.push_back(first.day);
    const std::vector<Pull> stretches =
        stretches_of(pull, reduction.stretches, reduction.same_stretches ? all_slips : slips_of(pull));
    for (std::size_t k = 0; k < stretches.size(); ++k) {
      if (stretches[k].empty()) continue;
      CouponRow row = row_of(stretches[k]);
      row.stretch = static_cast<int>(k);
      row.condition = conditions_seen.of(condition_of(first));
      row.day = days.of(first.day);
      row.sample = data.samples.size();
      data.rows.push_back(std::move(row));
    }
    data.samples.push_back(first.sample.empty() ? data.rows.back().pull.name : first.sample);
  }
  check_forces(problems, data.rows, reduction.faces,
               has_column(table, "force_measured_N") ? "force_measured_N" : "pull_force_N");
  problems.throw_if_any();
  data.conditions = conditions_seen.count();
  data.notes = odd_looks(data.rows);
  if (histories > 0) data.notes.push_back(reduction_in_words(histories, reduction.stretches));
  return data;
}

CouponData read_coupons(const std::string& path, const CouponReduction& reduction) {
  return parse_coupons(read_text_file(path), path, reduction);
}

}  // namespace heddle::friction
