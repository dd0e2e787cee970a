#include "pipeline/discover/stamping_campaign.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <tuple>

#include "core/measured_table.h"
#include "core/units.h"
#include "pipeline/discover/random.h"

namespace heddle::discover {

namespace {

/// One line of the table.
struct Line {
  int line = 0;
  std::string condition, sample, day;
  double speed_scale = 1.0, binder_force = 0.0, tool_temperature = 0.0, blank_temperature = 0.0;
  double orientation = 0.0, displacement = 0.0, force = 0.0;
  double draw_in = 0.0, shear_angle = 0.0;  ///< read, not used yet
};

using Column = TableColumn<Line>;
constexpr std::array columns{Column{"condition_id", "", &Line::condition, true},
                             Column{"sample_id", "", &Line::sample, true},
                             Column{"day_id", "", &Line::day},
                             Column{"speed_scale", "", &Line::speed_scale, true},
                             Column{"binder_force_N", "N", &Line::binder_force, true},
                             Column{"tool_temperature_C", "degC", &Line::tool_temperature, true},
                             Column{"blank_temperature_C", "degC", &Line::blank_temperature, true},
                             Column{"orientation_deg", "deg", &Line::orientation},
                             Column{"punch_displacement_mm", "mm", &Line::displacement, true},
                             Column{"punch_force_N", "N", &Line::force, true},
                             Column{"draw_in_max_mm", "mm", &Line::draw_in},
                             Column{"shear_angle_max_deg", "deg", &Line::shear_angle}};
constexpr TableRules rules{.what = "a table of stampings",
                           .unknown = "discover.stampings.column.unknown"_rule,
                           .missing = "discover.stampings.column.missing"_rule,
                           .twice = "discover.stampings.column.twice"_rule,
                           .number = "discover.stampings.number"_rule};

/// Lines of one blank.
using Curve = std::vector<const Line*>;

void check_line(const Line& line, TableProblems& problems) {
  const auto positive = [&](double value, std::string_view column, const char* unit) {
    if (!(value > 0.0))
      problems.add("discover.stampings.positive"_rule, column, write_quantity(value, unit),
                   "must be positive", "Correct the line, or leave it out.", line.line);
  };
  positive(line.speed_scale, "speed_scale", "");
  positive(line.binder_force, "binder_force_N", "N");
  constexpr double too_hot = 593.15;  // polypropylene is no more; 453 degC is 180 degC in kelvin
  for (const auto& [value, column] : {std::pair{line.tool_temperature, "tool_temperature_C"},
                                      std::pair{line.blank_temperature, "blank_temperature_C"}})
    if (value > too_hot)
      problems.add("discover.stampings.unit.temperature"_rule, column, write_quantity(value, "degC"),
                   "lies above 320 degC, where polypropylene is no more; is it in kelvin or fahrenheit?",
                   "Write it in degC.", line.line);
}

/// Said once of the table, where its largest values look like another unit.
void check_units(const std::vector<Line>& lines, TableProblems& problems) {
  double stroke = 0.0, force = 0.0;
  for (const Line& line : lines) {
    stroke = std::max(stroke, line.displacement);
    force = std::max(force, line.force);
  }
  if (stroke < 1e-3)
    problems.add("discover.stampings.unit.stroke"_rule, "punch_displacement_mm", write_quantity(stroke, "mm"),
                 "is the deepest stroke of the table, which forms nothing; is it in metres?",
                 "Write it in mm.", 0);
  if (force < 5.0)
    problems.add("discover.stampings.unit.force"_rule, "punch_force_N", write_quantity(force, "N"),
                 "is the largest force of the table, less than a blank's own weight asks for; is it in kN?",
                 "Write it in N.", 0);
}

/// Strictly deeper line by line; long enough to be binned.
void check_curve(const Curve& curve, TableProblems& problems) {
  for (std::size_t k = 1; k < curve.size(); ++k)
    if (!(curve[k]->displacement > curve[k - 1]->displacement)) {
      problems.add("discover.stampings.curve"_rule, "punch_displacement_mm",
                   write_quantity(curve[k]->displacement, "mm"),
                   fmt::format("must be deeper than the line before it of sample {}", curve[k]->sample),
                   "One line a depth, in the order of the stroke; each blank its own sample_id.",
                   curve[k]->line);
      return;
    }
  if (curve.size() >= 4) return;
  problems.add(
      "discover.stampings.short"_rule, "sample_id", curve.front()->sample,
      fmt::format("has {} {} only, which is no curve", curve.size(), curve.size() == 1 ? "line" : "lines"),
      "Give at least four points of each blank.", curve.front()->line);
}

std::vector<Curve> curves_of(const std::vector<Line>& lines) {
  std::vector<Curve> curves;
  std::map<std::tuple<std::string, std::string, std::string>, std::size_t> place;
  for (const Line& line : lines) {
    const auto [at, fresh] = place.try_emplace({line.condition, line.day, line.sample}, curves.size());
    if (fresh) curves.emplace_back();
    curves[at->second].push_back(&line);
  }
  return curves;
}

StampingCondition condition_of(const Line& line) {
  return {.name = line.condition,
          .speed_scale = line.speed_scale,
          .binder_force = line.binder_force,
          .tool_temperature = line.tool_temperature,
          .blank_temperature = line.blank_temperature,
          .orientation = line.orientation};
}

/// The number of a curve's condition, by its name; its settings must be those of the name.
std::size_t number_of(const Curve& curve, TableProblems& problems,
                      std::vector<StampingCondition>& conditions) {
  const std::string& name = curve.front()->condition;
  auto known = std::ranges::find(conditions, name, &StampingCondition::name);
  if (known == conditions.end()) known = conditions.insert(conditions.end(), condition_of(*curve.front()));
  for (const Line* line : curve)
    if (!(condition_of(*line) == *known)) {
      problems.add("discover.stampings.condition"_rule, "condition_id", name,
                   "is set differently here than in the lines before",
                   "Give lines with other settings a condition_id of their own.", line->line);
      break;
    }
  return static_cast<std::size_t>(known - conditions.begin());
}

std::vector<double> edges_of(const std::vector<Curve>& curves, const StampingReduction& reduction) {
  double start = 0.0, end = reduction.stroke;
  for (const Curve& curve : curves) {
    start = std::max(start, curve.front()->displacement);
    end = std::min(end, curve.back()->displacement);
  }
  start = std::max(start, reduction.start * end);
  std::vector<double> edges;
  for (int k = 0; k <= reduction.bins; ++k) edges.push_back(start + (end - start) * k / reduction.bins);
  return edges;
}

/// A row a bin.
void add_rows(StampingData& data, const Curve& curve, std::size_t condition, std::size_t day,
              const StampingReduction& reduction, TableProblems& problems) {
  std::vector<double> stroke, force;
  for (const Line* line : curve) {
    stroke.push_back(line->displacement);
    force.push_back(line->force);
  }
  const std::vector<double> means = bin_means(stroke, force, data.edges);
  const StampingCondition& set = data.conditions[condition];
  for (std::size_t k = 0; k < means.size(); ++k) {
    if (!(means[k] > 0.0)) {
      problems.add("discover.stampings.force"_rule, "punch_force_N", write_quantity(means[k], "N"),
                   fmt::format("must be positive on the mean between {:.1f} and {:.1f} mm of sample {}",
                               1e3 * data.edges[k], 1e3 * data.edges[k + 1], curve.front()->sample),
                   "Correct the sign or the offset of the force, or leave the blank out.",
                   curve.front()->line);
      return;
    }
    friction::CouponRow row;
    row.pull.name = fmt::format("{}/{}", set.name, curve.front()->sample);
    row.pull.velocity = set.speed_scale * reduction.punch_speed;
    row.pull.normal_force = set.binder_force;
    row.pull.tool_temperature = set.tool_temperature;
    row.pull.fabric_temperature = set.blank_temperature;
    row.pull.orientation = set.orientation;
    row.pull.measured_force = means[k];
    row.slip = 0.5 * (data.edges[k] + data.edges[k + 1]);
    row.condition = condition;
    row.sample = data.curves.samples.size();
    row.day = day;
    row.stretch = static_cast<int>(k);
    row.line = curve.front()->line;
    data.curves.rows.push_back(std::move(row));
  }
  data.curves.samples.push_back(curve.front()->sample);
}

}  // namespace

bool is_stamping_table(std::string_view text) {
  return has_column(parse_csv(text, ""), "punch_force_N");
}

std::vector<double> bin_means(const std::vector<double>& stroke, const std::vector<double>& force,
                              const std::vector<double>& edges) {
  constexpr double rounding = 1e-9;  // of a stroke written to seven digits or more
  std::vector<double> means;
  for (std::size_t k = 0; k + 1 < edges.size(); ++k) {
    const double low = edges[k], high = edges[k + 1];
    if (stroke.empty() || stroke.front() > low + rounding || stroke.back() < high - rounding) {
      means.push_back(std::numeric_limits<double>::quiet_NaN());
      continue;
    }
    double area = 0.0;
    for (std::size_t i = 0; i + 1 < stroke.size(); ++i) {
      const double from = std::max(low, stroke[i]), to = std::min(high, stroke[i + 1]);
      if (!(to > from)) continue;
      const double slope = (force[i + 1] - force[i]) / (stroke[i + 1] - stroke[i]);
      area += (force[i] + slope * (0.5 * (from + to) - stroke[i])) * (to - from);
    }
    means.push_back(area / (high - low));
  }
  return means;
}

StampingData parse_stampings(std::string_view text, const std::string& file,
                             const StampingReduction& reduction) {
  TableProblems problems{file};
  const std::vector<Line> lines = read_rows(parse_csv(text, file), columns, rules, problems);
  if (lines.empty())
    problems.add("discover.stampings.empty"_rule, "data", "", "must hold at least one curve",
                 "One line a point of a curve, after the header line.", 0);
  problems.throw_if_any();
  for (const Line& line : lines) check_line(line, problems);
  check_units(lines, problems);
  const std::vector<Curve> curves = curves_of(lines);
  StampingData data;
  data.curves.file = file;
  std::vector<std::size_t> condition;
  for (const Curve& curve : curves) {
    check_curve(curve, problems);
    condition.push_back(number_of(curve, problems, data.conditions));
  }
  if (data.conditions.size() < 2)
    problems.add("discover.stampings.alike"_rule, "condition_id", "",
                 "names one condition only, which cannot tell one effect from another",
                 "Stamp at two speeds or more.", 0);
  problems.throw_if_any();
  data.edges = edges_of(curves, reduction);
  if (!(data.edges.back() > data.edges.front()))
    problems.add("discover.stampings.overlap"_rule, "punch_displacement_mm", "",
                 "has no stroke that all curves and the case share",
                 "Leave out curves that begin late or end early, or give the case a deeper stroke.", 0);
  else
    for (std::size_t k = 0; k < curves.size(); ++k) {
      const std::string& day_name = curves[k].front()->day;
      const auto known = std::ranges::find(data.curves.days, day_name);
      const auto day = static_cast<std::size_t>(known - data.curves.days.begin());
      if (known == data.curves.days.end()) data.curves.days.push_back(day_name);
      add_rows(data, curves[k], condition[k], day, reduction, problems);
    }
  problems.throw_if_any();
  data.curves.conditions = data.conditions.size();
  data.curves.notes.push_back(
      fmt::format("{} curves were cut to their mean forces over {} bins of stroke from {:.1f} to {:.1f} mm.",
                  curves.size(), reduction.bins, 1e3 * data.edges.front(), 1e3 * data.edges.back()));
  return data;
}

Split split_stampings(const CouponCampaign& campaign, double share, std::uint64_t seed) {
  std::map<std::size_t, const CouponCell*> conditions;
  for (const CouponCell& cell : campaign.cells) conditions.try_emplace(cell.condition, &cell);
  std::vector<std::size_t> inside;
  for (const auto& [number, cell] : conditions) {
    const bool at_no_end = std::ranges::none_of(factors(), [&, at = cell](const Factor& factor) {
      if (std::string_view(factor.name) == "day") return false;
      double low = factor.of(*at), high = low;
      for (const auto& [other, other_cell] : conditions) {
        low = std::min(low, factor.of(*other_cell));
        high = std::max(high, factor.of(*other_cell));
      }
      return high > low && (factor.of(*at) == low || factor.of(*at) == high);
    });
    if (at_no_end) inside.push_back(number);
  }
  const auto wanted = static_cast<std::size_t>(std::lround(share * static_cast<double>(conditions.size())));
  const std::size_t room = conditions.size() > 3 ? conditions.size() - 3 : 0;
  Random random(seed);
  random.shuffle(inside);
  inside.resize(std::min({inside.size(), wanted, room}));
  Split split;
  for (std::size_t c = 0; c < campaign.cells.size(); ++c)
    (std::ranges::count(inside, campaign.cells[c].condition) > 0 ? split.held_out : split.training)
        .push_back(c);
  return split;
}

}  // namespace heddle::discover
