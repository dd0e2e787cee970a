#include "mesoscale/study/cell_study.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "mesoscale/weave.h"

namespace heddle::mesoscale::study {

namespace {

double& length_of(WeaveSpec& weave, Dimension dimension) {
  switch (dimension) {
    case Dimension::tow_width:
      return weave.tow_width;
    case Dimension::gap:
      return weave.gap;
    case Dimension::tow_thickness:
      break;
  }
  return weave.tow_thickness;
}

std::optional<double>& own_length_of(OwnTow& own, Dimension dimension) {
  switch (dimension) {
    case Dimension::tow_width:
      return own.tow_width;
    case Dimension::gap:
      return own.gap;
    case Dimension::tow_thickness:
      break;
  }
  return own.tow_thickness;
}

StudyPoint base_point(const CellSpec& base) {
  return {base, base.weave.pattern, {base.weave.tow_width, base.weave.gap, base.weave.tow_thickness}};
}

StudyPoint with_pattern(StudyPoint point, const std::string& pattern) {
  point.cell.weave.pattern = point.pattern = pattern;
  return point;
}

// The value itself, not the sum of what it was and by how much it changes: 0.5 mm stays 0.5 mm.
StudyPoint with_length(StudyPoint point, Dimension dimension, double value) {
  const auto k = static_cast<std::size_t>(dimension);
  point.cell = changed(point.cell, dimension, value - point.lengths[k]);
  length_of(point.cell.weave, dimension) = point.lengths[k] = value;
  return point;
}

void add_new(std::vector<StudyPoint>& all, StudyPoint point) {
  if (std::find(all.begin(), all.end(), point) == all.end()) all.push_back(std::move(point));
}

// Each point with each value of one axis in its place, itself among them.
template <class Value, class With>
std::vector<StudyPoint> crossed_with(const std::vector<StudyPoint>& all, const std::vector<Value>& values,
                                     const With& with) {
  std::vector<StudyPoint> result;
  for (const StudyPoint& point : all) {
    result.push_back(point);
    const std::size_t first = result.size() - 1;
    for (const Value& value : values) {
      StudyPoint next = with(point, value);
      if (std::find(result.begin() + static_cast<std::ptrdiff_t>(first), result.end(), next) == result.end())
        result.push_back(std::move(next));
    }
  }
  return result;
}

// How many cells at most, without making them.
double count_of(const StudySpec& spec) {
  double product = 1.0 + static_cast<double>(spec.patterns.size());
  double sum = product;
  for (const auto& values : spec.values) {
    product *= 1.0 + static_cast<double>(values.size());
    sum += static_cast<double>(values.size());
  }
  return spec.design == Design::crossed ? product : sum;
}

std::string key_of(Dimension dimension) {
  return "study." + name_of(dimension);
}

// A length that a direction has of its own hides the common one, and a list of values would do nothing.
void check_common(Problems& problems, const StudySpec& spec, const CellSpec& base) {
  for (const Dimension dimension : dimensions)
    for (std::size_t i = 0; i < 2; ++i) {
      OwnTow own = base.weave.own[i];
      if (spec.values[static_cast<std::size_t>(dimension)].empty() || !own_length_of(own, dimension))
        continue;
      const std::string own_key = fmt::format("weave.{}.{}", i == 0 ? "warp" : "weft", name_of(dimension));
      problems.push_back({"*.hidden"_family.of(key_of(dimension)), key_of(dimension), "",
                          fmt::format("changes both directions, but {} is given", own_key),
                          "Leave that out, or this; the sensitivities work for unlike tows too."});
    }
}

// The key of the study that is to blame for a weave that cannot be: that of the number named, else the first
// that differs.
std::string key_to_blame(const StudyPoint& point, const StudyPoint& base, const std::string& named) {
  std::string first;
  for (const Dimension dimension : dimensions) {
    const auto k = static_cast<std::size_t>(dimension);
    if (point.lengths[k] == base.lengths[k]) continue;
    if (named == "weave." + name_of(dimension)) return key_of(dimension);
    if (first.empty()) first = key_of(dimension);
  }
  return point.pattern != base.pattern && (first.empty() || named == "weave.pattern") ? "study.pattern"
                                                                                      : first;
}

std::string shown(const StudyPoint& point) {
  return fmt::format("{}, {:.6g} mm wide, {:.6g} mm apart, {:.6g} mm thick", point.pattern,
                     1e3 * point.lengths[0], 1e3 * point.lengths[1], 1e3 * point.lengths[2]);
}

// A crossed study may hold the same clash hundreds of times: each is said once a key and rule.
void check_points(Problems& problems, const StudySpec& spec, const CellSpec& base) {
  const StudyPoint start = base_point(base);
  for (const StudyPoint& point : points(base, spec))
    for (const Problem& found : mesoscale::check(point.cell)) {
      const std::string key = key_to_blame(point, start, found.key);
      const std::string rule =
          fmt::format("asks for a weave that cannot be: {} = {} {}", found.key, found.value, found.rule);
      const bool known = std::any_of(problems.begin(), problems.end(),
                                     [&](const Problem& p) { return p.key == key && p.rule == rule; });
      if (!known) problems.push_back({"*.weave"_family.of(key), key, shown(point), rule, found.way_out});
    }
}

void check_steps(Problems& problems, const StudySpec& spec, const CellSpec& base) {
  if (!spec.sensitivities) return;
  for (const Dimension dimension : dimensions)
    for (const CellSpec& cell : stencil(base, spec, dimension))
      for (const Problem& found : mesoscale::check(cell)) {
        problems.push_back(
            {"study.step.weave"_rule,
             "study.step",
             fmt::format("{:.6g} %", 100.0 * spec.step),
             fmt::format("must leave the {} sound when it moves by {:.4g} mm either way: {} = {} {}",
                         name_of(dimension), 2e3 * step_of(base, spec, dimension), found.key, found.value,
                         found.rule),
             "Take a smaller step, or write sensitivities: off.",
             "",
             0,
             {"study.sensitivities"}});
        return;
      }
}

}  // namespace

std::string name_of(Dimension dimension) {
  switch (dimension) {
    case Dimension::tow_width:
      return "tow_width";
    case Dimension::gap:
      return "gap";
    case Dimension::tow_thickness:
      break;
  }
  return "tow_thickness";
}

CellSpec changed(CellSpec cell, Dimension dimension, double by) {
  WeaveSpec& weave = cell.weave;
  const double excess = std::abs(weave.crimp_excess());
  length_of(weave, dimension) += by;
  for (OwnTow& own : weave.own)
    if (std::optional<double>& length = own_length_of(own, dimension)) *length += by;
  if (dimension == Dimension::tow_thickness)
    weave.fabric_thickness += 2.0 * by + (std::abs(weave.crimp_excess()) - excess);
  return cell;
}

std::vector<StudyPoint> points(const CellSpec& base, const StudySpec& spec) {
  const StudyPoint start = base_point(base);
  std::vector<StudyPoint> all{start};
  const auto length = [](Dimension dimension) {
    return
        [dimension](const StudyPoint& point, double value) { return with_length(point, dimension, value); };
  };
  if (spec.design == Design::crossed) {
    all = crossed_with(all, spec.patterns, with_pattern);
    for (const Dimension dimension : dimensions)
      all = crossed_with(all, spec.values[static_cast<std::size_t>(dimension)], length(dimension));
    return all;
  }
  for (const std::string& pattern : spec.patterns) add_new(all, with_pattern(start, pattern));
  for (const Dimension dimension : dimensions)
    for (const double value : spec.values[static_cast<std::size_t>(dimension)])
      add_new(all, with_length(start, dimension, value));
  return all;
}

Problems check(const StudySpec& spec, const CellSpec& base) {
  Problems problems;
  for (const std::string& pattern : spec.patterns)
    for (Problem found : check_pattern(pattern))
      problems.push_back({"study.pattern.weave"_rule, "study.pattern", pattern, found.rule, found.way_out});
  if (const double count = count_of(spec); count > static_cast<double>(most_cells))
    problems.push_back(
        {"study.design.cells"_rule, "study.design", "",
         fmt::format("asks for {:.0f} cells, and must not ask for more than {}", count, most_cells),
         "Leave values out, or write design: one_at_a_time."});
  check_common(problems, spec, base);
  if (problems.empty()) check_points(problems, spec, base);
  check_steps(problems, spec, base);
  return problems;
}

double step_of(const CellSpec& base, const StudySpec& spec, Dimension dimension) {
  const TowSpec warp = base.weave.tow(0);
  // The gap may be small or zero: its step is that of the width.
  return spec.step * (dimension == Dimension::tow_thickness ? warp.thickness : warp.width);
}

std::array<CellSpec, 4> stencil(const CellSpec& base, const StudySpec& spec, Dimension dimension) {
  const double h = step_of(base, spec, dimension);
  return {changed(base, dimension, -2.0 * h), changed(base, dimension, -h), changed(base, dimension, h),
          changed(base, dimension, 2.0 * h)};
}

std::vector<Sensitivity> sensitivities(const CellProperties& base,
                                       const std::array<CellProperties, 4>& around, double step,
                                       Dimension dimension, std::span<const double> angles) {
  std::vector<Sensitivity> result;
  for (std::size_t k = 0; k < angles.size(); ++k)
    for (std::size_t p = 0; p < properties().size(); ++p) {
      const auto at = [&](std::size_t i) { return around[i].at[k][p]; };
      const double near = (at(2) - at(1)) / (2.0 * step), far = (at(3) - at(0)) / (4.0 * step);
      const double value = base.at[k][p];
      if (!std::isfinite(value) || !std::isfinite(near) || !std::isfinite(far)) continue;
      if (!properties()[p].of_the_angle && k > 0) continue;  // said once
      result.push_back({p, dimension, angles[k], value, near, std::abs(far - near) / 3.0});
    }
  return result;
}

}  // namespace heddle::mesoscale::study
