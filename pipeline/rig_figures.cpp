#include "pipeline/rig_figures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include <fmt/format.h>

#include "core/units.h"
#include "pipeline/report_figures.h"

namespace heddle::pipeline {

namespace {

struct Parameter {
  double FrictionRigRow::*value;
  const char* name;
  const char* unit;
  double factor, offset;
  Scale scale;
};

constexpr std::array<Parameter, 5> parameters{
    {{&FrictionRigRow::velocity, "Pull speed", "mm/s", 1e3, 0.0, Scale::logarithmic},
     {&FrictionRigRow::normal_force, "Normal force", "N", 1.0, 0.0, Scale::logarithmic},
     {&FrictionRigRow::tool_temperature, "Tool temperature", "°C", 1.0, -zero_celsius, Scale::linear},
     {&FrictionRigRow::fabric_temperature, "Fabric temperature", "°C", 1.0, -zero_celsius, Scale::linear},
     {&FrictionRigRow::orientation, "Warp against the pull", "°", degrees, 0.0, Scale::linear}}};

/// Tables 3 and 4 give 16.67 mm/s where Table 2 has 16.6: one speed.
bool same(double a, double b) {
  return std::abs(a - b) <= 0.01 * std::max(std::abs(a), std::abs(b));
}

/// Rows that differ from the baseline in this parameter alone, by its value.
std::vector<FrictionRigRow> varied(const std::vector<FrictionRigRow>& rows, const Parameter& parameter) {
  const auto base =
      std::find_if(rows.begin(), rows.end(), [](const auto& row) { return !row.measured_force; });
  const FrictionRigRow& baseline = base == rows.end() ? rows.front() : *base;
  std::vector<FrictionRigRow> kept;
  for (const FrictionRigRow& row : rows) {
    const bool others = std::all_of(parameters.begin(), parameters.end(), [&](const Parameter& p) {
      return p.value == parameter.value || same(row.*p.value, baseline.*p.value);
    });
    if (others && !row.curved) kept.push_back(row);
  }
  std::stable_sort(kept.begin(), kept.end(),
                   [&](const auto& a, const auto& b) { return a.*parameter.value < b.*parameter.value; });
  return kept;
}

}  // namespace

std::optional<Canvas> rig_chart(const std::vector<FrictionRigRow>& rows, RigParameter which,
                                RigQuantity quantity) {
  const Parameter& parameter = parameters[static_cast<std::size_t>(which)];
  if (rows.empty()) return {};
  const std::vector<FrictionRigRow> kept = varied(rows, parameter);
  if (kept.size() < 2 || kept.front().*parameter.value == kept.back().*parameter.value) return {};
  const bool force = quantity == RigQuantity::pull_force;
  LineChart chart;
  chart.label = fmt::format("{} against {}", force ? "Pull force" : "Friction coefficient", parameter.name);
  chart.x = {parameter.name, parameter.unit, parameter.scale};
  chart.y = force ? Axis{"Pull force", "N"} : Axis{"Friction coefficient F/(2 N)", ""};
  chart.y.low = 0.0;
  const auto add = [&](const char* name, bool dots, const auto& value) {
    Series series{name, {}, {}, dots};
    for (const FrictionRigRow& row : kept) {
      const std::optional<double> f = value(row);
      if (!f) continue;
      series.x.push_back(parameter.factor * row.*parameter.value + parameter.offset);
      series.y.push_back(force ? *f : *f / (2.0 * row.normal_force));
    }
    if (!series.x.empty()) chart.series.push_back(std::move(series));
  };
  add("law", false, [](const FrictionRigRow& r) { return std::optional(r.law_force); });
  add("measured", true, [](const FrictionRigRow& r) { return r.measured_force; });
  add("finite elements", true, [](const FrictionRigRow& r) { return r.element_force; });
  add("paper's model", true, [](const FrictionRigRow& r) { return r.paper_force; });
  chart.width = half_width;
  chart.height = 280.0;
  chart.label_room = 112.0;
  return draw(chart);
}

namespace {

constexpr std::size_t shown_pulls = 5;

/// One line a pull, the first few.
std::vector<Series> lines_of(const std::vector<FrictionHistoryRow>& history, double FrictionHistoryRow::*x,
                             double scale, double FrictionHistoryRow::*y) {
  std::vector<Series> lines;
  for (const FrictionHistoryRow& row : history) {
    if (lines.empty() || lines.back().name != row.name) {
      if (lines.size() == shown_pulls) break;
      lines.push_back({row.name, {}, {}, false});
    }
    lines.back().x.push_back(scale * row.*x);
    lines.back().y.push_back(row.*y);
  }
  return lines;
}

}  // namespace

Canvas pull_chart(const std::vector<FrictionHistoryRow>& history) {
  LineChart chart;
  chart.label = "Pull force against displacement of the sample";
  chart.x = {"Displacement", "mm"};
  chart.y = {"Pull force", "N"};
  chart.series = lines_of(history, &FrictionHistoryRow::displacement, 1e3, &FrictionHistoryRow::pull_force);
  chart.width = full_width;
  chart.height = 340.0;
  chart.label_room = 170.0;
  return draw(chart);
}

std::optional<Canvas> normal_force_chart(const std::vector<FrictionHistoryRow>& history) {
  LineChart chart;
  chart.label = "Normal force against time";
  chart.x = {"Time", "s"};
  chart.y = {"Normal force", "N"};
  chart.y.low = 0.0;
  chart.series = lines_of(history, &FrictionHistoryRow::time, 1.0, &FrictionHistoryRow::normal_force);
  const bool lost = std::any_of(chart.series.begin(), chart.series.end(),
                                [](const Series& line) { return line.y.back() < line.y.front(); });
  if (!lost) return {};
  chart.width = full_width;
  chart.height = 300.0;
  chart.label_room = 170.0;
  return draw(chart);
}

Canvas plate_picture(const PlatePressure& pressure, Plate plate) {
  const std::vector<double>& nodes = plate == Plate::lower ? pressure.lower : pressure.upper;
  GridPicture picture;
  picture.label =
      fmt::format("Pressure on the {} plate, {}", plate == Plate::lower ? "lower" : "upper", pressure.name);
  picture.nx = pressure.nx;
  picture.ny = pressure.ny;
  picture.spacing_x = pressure.spacing_x;
  picture.spacing_y = pressure.spacing_y;
  for (int j = 0; j < pressure.ny; ++j)
    for (int i = 0; i < pressure.nx; ++i)
      picture.value.push_back(1e-3 * nodes.at(static_cast<std::size_t>(i * pressure.ny + j)));
  // Both plates in one scale, from nothing: a plate without a pattern must look like one.
  double high = 0.0;
  for (const auto* side : {&pressure.lower, &pressure.upper})
    for (const double p : *side) high = std::max(high, 1e-3 * p);
  picture.colours = {0.0, high > 0.0 ? high : 1.0, "Pressure", "kPa", ColourMap::height};
  picture.width = half_width;
  return draw(picture);
}

Canvas film_chart(const friction::FilmConduction& film) {
  LineChart chart;
  chart.label = "Share of the tool in the film's temperature against time in contact";
  chart.x = {"Time in contact", "s", Scale::logarithmic};
  chart.y = {"Share of the tool in the temperature", "%"};
  chart.y.low = 0.0;
  chart.y.high = 100.0;
  const auto add = [&](const char* name, const Curve& curve) {
    Series series{name, {}, {}, false};
    for (double t = 1e-4; t < 20.0; t *= 1.1) {
      series.x.push_back(t);
      series.y.push_back(100.0 * curve(std::log(t)));
    }
    chart.series.push_back(std::move(series));
  };
  add("face at the tool", film.face);
  add("middle of the film", film.share[friction::film_points / 2]);
  add("towards the ply", film.share[friction::film_points - 1]);
  chart.width = full_width;
  chart.height = 320.0;
  chart.label_room = 140.0;
  return draw(chart);
}

}  // namespace heddle::pipeline
