// The part of the page of a study of stampings about the keys that vary: a chart a result, and the table.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/units.h"
#include "pipeline/chart.h"
#include "pipeline/page.h"
#include "pipeline/report_figures.h"
#include "pipeline/stamping_study.h"
#include "pipeline/value_reader.h"

namespace heddle::pipeline {

namespace {

using Runs = std::vector<const StudiedStamping*>;

/// One result, as a chart and a column show it.
struct Shown {
  const char* quantity;
  const char* unit;
  const char* caption;
  double (*value)(const StudiedStamping&);
};

double of_place(const StudiedStamping& run, double ShearPlace::*member) {
  return run.shear ? (*run.shear).*member : std::nan("");
}

constexpr std::array shown{
    Shown{"Peak force", "N", "Peak punch force.",
          [](const StudiedStamping& run) { return run.peak()->force; }},
    Shown{"Grid error", "N", "Estimated grid error of the force, from a companion on twice the spacing.",
          [](const StudiedStamping& run) { return run.grid_error; }},
    Shown{"Largest shear", "°", "Largest shear angle when the force is largest.",
          [](const StudiedStamping& run) { return degrees * run.peak()->shear; }},
    Shown{"Draw-in", "mm", "Largest draw-in when the force is largest.",
          [](const StudiedStamping& run) { return 1e3 * run.peak()->draw_in; }},
    Shown{"Its place", "mm",
          "Where shear is largest at the end: distance from the punch's axis in the flat blank. Nodes of the "
          "grid: it jumps by a spacing.",
          [](const StudiedStamping& run) { return 1e3 * of_place(run, &ShearPlace::flat_radius); }},
    Shown{"Shear, deep", "°", "Shear at the end, root mean square, deeper than half the stroke.",
          [](const StudiedStamping& run) { return degrees * of_place(run, &ShearPlace::deep_rms); }},
    Shown{"Shear, level", "°",
          "The same where the blank has sunk by less than 2 % of the stroke: on the die's face.",
          [](const StudiedStamping& run) { return degrees * of_place(run, &ShearPlace::level_rms); }},
    Shown{"Residual", "%", "What the energy ledger leaves over.",
          [](const StudiedStamping& run) { return 100.0 * run.energy_residual_max; }}};

/// The number of a value in its key's unit; not one for a word.
double number_of(const std::string& value) {
  char* end = nullptr;
  const double number = std::strtod(value.c_str(), &end);
  return end == value.c_str() ? std::nan("") : number;
}

/// One variation with where its keys stand among those of the study.
struct Variation {
  const std::vector<VariedKey>& keys;
  std::vector<std::size_t> column;
  Runs runs;

  const std::string& value(const StudiedStamping& run, std::size_t key) const {
    return run.values[column[key]];
  }
  /// Values of all keys but the first, which is the abscissa.
  std::string name(const StudiedStamping& run) const {
    std::string text;
    for (std::size_t k = 1; k < keys.size(); ++k)
      text += (k > 1 ? ", " : "") + last_name(keys[k].key) + " " + value(run, k);
    return text;
  }
};

LineChart chart_of(const Variation& variation, const Shown& result) {
  LineChart chart;
  const std::string& key = variation.keys.front().key;
  chart.label = fmt::format("{} over {}", result.quantity, key);
  const Key* known = find_key(key);
  chart.x = {key, known ? known->unit : ""};
  chart.y = {result.quantity, result.unit};
  chart.width = half_width;
  chart.height = 300.0;
  std::size_t longest = 0;
  for (const StudiedStamping* run : variation.runs) longest = std::max(longest, variation.name(*run).size());
  chart.label_room = 20.0 + 7.0 * static_cast<double>(longest);
  double low = std::numeric_limits<double>::infinity(), high = 0.0;
  for (const StudiedStamping* run : variation.runs) {
    const double x = number_of(variation.value(*run, 0));
    low = std::min(low, x);
    high = std::max(high, x);
    const std::string name = variation.name(*run);
    auto series = std::find_if(chart.series.begin(), chart.series.end(),
                               [&](const Series& s) { return s.name == name; });
    if (series == chart.series.end()) series = chart.series.insert(series, Series{name, {}, {}});
    series->x.push_back(x);
    series->y.push_back(result.value(*run));
  }
  if (low > 0.0 && high >= 50.0 * low) chart.x.scale = Scale::logarithmic;
  // A line needs rising abscissae, whatever the order in the file.
  for (Series& series : chart.series) {
    std::vector<std::size_t> order(series.x.size());
    for (std::size_t k = 0; k < order.size(); ++k) order[k] = k;
    std::sort(order.begin(), order.end(),
              [&](std::size_t a, std::size_t b) { return series.x[a] < series.x[b]; });
    Series sorted{series.name, {}, {}};
    for (const std::size_t k : order) {
      sorted.x.push_back(series.x[k]);
      sorted.y.push_back(series.y[k]);
    }
    series = std::move(sorted);
  }
  return chart;
}

std::string table_of(const Variation& variation) {
  std::vector<std::string> head{"Stamping"};
  for (const Shown& result : shown) head.push_back(fmt::format("{}, {}", result.quantity, result.unit));
  std::vector<std::vector<std::string>> rows;
  for (const StudiedStamping* run : variation.runs) {
    std::vector<std::string> values;
    for (std::size_t k = 0; k < variation.keys.size(); ++k) values.push_back(variation.value(*run, k));
    rows.push_back({fmt::format("{}", fmt::join(values, ", "))});
    for (const Shown& result : shown) {
      const double value = result.value(*run);
      rows.back().push_back(significant_or_dash(value, 4));
    }
  }
  return table(head, rows);
}

}  // namespace

std::string variation_sections(const StampingStudyFindings& findings) {
  std::string out;
  for (std::size_t k = 0; k < findings.spec.variations.size(); ++k) {
    Variation variation{findings.spec.variations[k], {}, over_variation(findings, static_cast<int>(k))};
    std::vector<std::string> names;
    for (const VariedKey& varied : variation.keys) {
      const auto found = std::find(findings.keys.begin(), findings.keys.end(), varied.key);
      variation.column.push_back(static_cast<std::size_t>(found - findings.keys.begin()));
      names.push_back(varied.key);
    }
    if (variation.runs.empty()) continue;
    const bool numbers = variation.runs.size() > 1 &&
                         std::all_of(variation.runs.begin(), variation.runs.end(), [&](const auto* run) {
                           return std::isfinite(number_of(variation.value(*run, 0)));
                         });
    std::vector<std::string> charts;
    if (numbers)
      for (const Shown& result : shown)
        charts.push_back(figure(draw(chart_of(variation, result)), result.caption));
    out += section(fmt::format("{}", fmt::join(names, " and ")), pairs(charts) + table_of(variation));
  }
  return out;
}

}  // namespace heddle::pipeline
