#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "pipeline/chart.h"
#include "pipeline/discover_report_parts.h"
#include "pipeline/discover_report_pictures.h"
#include "pipeline/page.h"
#include "pipeline/report_figures.h"

namespace heddle::pipeline {

namespace {

using discover::Location;

/// "tool temperature" of "tool_temperature = 140 degC" or "tool_temperature x velocity".
std::string first_factor(const Location& location) {
  return spaced(location.factor.substr(0, location.factor.find(' ')));
}

/// What the strongest statistic of a place says in words. One over the trend speaks of how the force runs
/// along the pull.
std::string seen_in(const Location& location) {
  const bool above = location.statistic > 0.0, trend = location.segment == "trend";
  const std::string goes = above ? "rises" : "falls", factor = first_factor(location);
  if (location.factor == "all conditions")
    return trend ? fmt::format("{} along the pull, in all conditions", goes)
                 : fmt::format("is too {}, in all conditions", above ? "high" : "low");
  if (const std::size_t sign = location.factor.find(" = "); sign != std::string::npos) {
    std::string level = location.factor.substr(sign + 3);
    if (const std::size_t unit = level.find(" deg"); unit != std::string::npos)
      level.replace(unit, std::string::npos, level.ends_with('C') ? " °C" : "°");
    return trend ? fmt::format("{} along the pull where {} is {}, more than elsewhere", goes, factor, level)
                 : fmt::format("is {} where {} is {} than elsewhere", above ? "higher" : "lower", factor,
                               level);
  }
  if (const std::size_t cross = location.factor.find(" x "); cross != std::string::npos) {
    const std::string other = spaced(location.factor.substr(cross + 3));
    return trend ? fmt::format("{} along the pull as {} and {} grow together", goes, factor, other)
                 : fmt::format("{} as {} and {} grow together", goes, factor, other);
  }
  return trend ? fmt::format("{} along the pull, the more so the higher {}", goes, factor)
               : fmt::format("{} with {}", goes, factor);
}

std::string location_table(const DiscoveryPage& page) {
  std::vector<std::vector<std::string>> rows;
  for (const Location& location : page.found.locations) {
    // What noise alone may give is shown only so far that a reader sees how it goes on.
    if (rows.size() == 10 || (rows.size() >= 3 && location.p_value > 0.05)) break;
    rows.push_back(
        {seen_in(location), location.segment,
         fmt::format("{}{:.1f}", location.statistic < 0.0 ? "−" : "+", std::abs(location.statistic)),
         p_text(location.p_value)});
  }
  if (rows.empty()) return "";
  const std::size_t all = page.found.locations.size();
  return "<h3>Places of the gap</h3>\n" +
         table({"Measured force, against the model", "Stretch of the pull", "Statistic", "p, family-wise"},
               rows) +
         fmt::format(
             "<p>The statistic is standard normal where nothing is missing; p is the share of campaigns of "
             "noise "
             "alone in which the largest of all is as large.{}</p>\n",
             all > rows.size() ? fmt::format(" {} weaker places are left out.", all - rows.size()) : "");
}

// ---- maps

struct MapChoice {
  std::size_t across = 0, down = 0;
  double excess = 0.0;  ///< squared statistics of the fields, less their number
  std::vector<MatrixField> fields;
};

MapChoice map_of(const DiscoveryPage& page, std::size_t across, std::size_t down, std::string_view segment) {
  MapChoice map{across, down, 0.0, {}};
  const Levels &x = page.levels[across], &y = page.levels[down];
  for (std::size_t row = 0; row < y.count(); ++row)
    for (std::size_t column = 0; column < x.count(); ++column) {
      const WeightedMean mean = mean_of(
          page.gap, page.gap.gap,
          weights_of(page.gap, segment, [&](std::size_t i) { return x.of[i] == column && y.of[i] == row; }));
      map.fields.push_back({mean.value, mean.noise, mean.cells});
      if (mean.cells > 0 && mean.noise > 0.0) map.excess += std::pow(mean.value / mean.noise, 2) - 1.0;
    }
  return map;
}

/// Where the strongest place of the gap is along the pull; the whole pull where nothing is beyond noise.
std::string segment_of_maps(const DiscoveryPage& page) {
  if (page.found.campaign.stretches < 2 || page.found.locations.empty()) return "whole pull";
  const Location& strongest = page.found.locations.front();
  return strongest.p_value < 0.05 ? strongest.segment : "whole pull";
}

/// Values of the levels; where ranges would run into one another, their means.
std::vector<std::string> column_names(const Levels& levels, double width) {
  const double room = 0.8 * width / static_cast<double>(levels.count());
  const auto fits = [&](const std::string& text) { return 7.0 * static_cast<double>(text.size()) < room; };
  if (std::ranges::all_of(levels.text, fits)) return levels.text;
  std::vector<std::string> names;
  for (const double at : levels.at) names.push_back(plain_number(at, 3));
  return names;
}

std::string of_segment(std::string_view segment) {
  if (segment == "start") return "over the start of the pull";
  if (segment == "steady") return "over the steady part of the pull";
  if (segment == "trend") return "in the second half of the pull, less that in the first";
  return "over the whole pull";
}

/// A round number that most fields stay below.
double full_colour(const std::vector<MapChoice>& maps) {
  double largest = 0.02;  // fainter gaps than 2 % need no strong colours
  for (const MapChoice& map : maps)
    for (const MatrixField& field : map.fields)
      if (field.cells > 0) largest = std::max(largest, std::abs(field.value));
  const double decade = std::pow(10.0, std::floor(std::log10(largest)));
  for (const double step : {1.0, 2.0, 3.0, 5.0})
    if (step * decade >= 0.8 * largest) return step * decade;
  return 10.0 * decade;
}

std::string maps(const DiscoveryPage& page) {
  const std::string segment = segment_of_maps(page);
  std::vector<MapChoice> choices;
  std::size_t factors = 0;
  while (factors < page.levels.size() && page.levels[factors].name != "slip") ++factors;
  for (std::size_t a = 0; a < factors; ++a)
    for (std::size_t b = a + 1; b < factors; ++b) {
      const bool wide = page.levels[a].count() > page.levels[b].count();
      choices.push_back(map_of(page, wide ? a : b, wide ? b : a, segment));
    }
  if (choices.empty()) return "";
  std::ranges::stable_sort(choices, std::greater{}, &MapChoice::excess);
  const std::size_t all = choices.size(), shown = std::min<std::size_t>(all, 6);
  choices.resize(shown);
  const double full = full_colour(choices);
  std::vector<std::string> figures;
  for (const MapChoice& map : choices) {
    const Levels &x = page.levels[map.across], &y = page.levels[map.down];
    const auto empty = std::ranges::count(map.fields, 0, &MatrixField::cells);
    figures.push_back(figure(
        draw(MatrixPicture{fmt::format("Gap over {} and {}, in per cent of the force", x.name, y.name),
                           x.title(), y.title(), column_names(x, half_width), y.text, map.fields, full,
                           half_width}),
        fmt::format("{} against {}.{}", y.capital(), x.name,
                    empty == 0
                        ? std::string()
                        : fmt::format(" {} of {} pairs were never measured.", empty, map.fields.size()))));
  }
  std::string out = fmt::format(
      "<h3>Maps of the gap</h3>\n<p>Measured force over that of the fitted baseline, in per cent, mean {}. "
      "Bold: beyond "
      "noise (95 %); pale: noise alone may give it; a dot: not measured together. {}Held-out conditions are "
      "not in "
      "it.</p>\n",
      of_segment(segment),
      all > shown ? fmt::format("The {} pairs of factors with most in them, of {}. ", shown, all) : "");
  for (std::size_t k = 0; k < figures.size(); k += 2)
    out += pair(figures[k], k + 1 < figures.size() ? figures[k + 1] : "");
  return out;
}

// ---- along the slip

/// The factor that the strongest place speaks of; none where that is all conditions alike.
const Levels* strongest_factor(const std::vector<Levels>& levels, const std::vector<Location>& locations) {
  for (const Location& location : locations) {
    const auto found = std::ranges::find(levels, first_factor(location), &Levels::name);
    if (found != levels.end()) return &*found;
    if (location.factor == "all conditions" && location.p_value < 0.05) return nullptr;
  }
  return nullptr;
}

std::string slip_figure(const DiscoveryPage& page) {
  if (page.found.campaign.stretches < 2)
    return "<p>The table has one line a pull: how the gap runs along the slip cannot be seen.</p>\n";
  const std::vector<Levels> few = all_levels(page.gap, 5);
  const Levels& slip = few.back();
  const Levels* factor = strongest_factor(few, page.found.locations);
  LineChart chart;
  chart.x = {"Slip", "mm", Scale::logarithmic};
  chart.y = {"Measured force over the model's, less 1", "%"};
  chart.width = full_width;
  chart.height = 340.0;
  chart.label_room = 150.0;
  chart.label =
      fmt::format("Gap along the slip{}{}", factor != nullptr ? ", by level of " : ", of all conditions",
                  factor != nullptr ? factor->name : "");
  Ribbon noise{slip.at, std::vector<double>(slip.count(), 0.0), std::vector<double>(slip.count(), 0.0)};
  const std::size_t count = factor != nullptr ? factor->count() : 1;
  for (std::size_t level = 0; level < count; ++level) {
    Series line{factor != nullptr
                    ? fmt::format("{}{}{}", factor->text[level], factor->unit == "°" ? "" : " ", factor->unit)
                    : "all conditions",
                {},
                {}};
    for (std::size_t k = 0; k < slip.count(); ++k) {
      const WeightedMean mean =
          mean_of(page.gap, page.gap.gap, weights_of(page.gap, "whole pull", [&](std::size_t i) {
                    return slip.of[i] == k && (factor == nullptr || factor->of[i] == level);
                  }));
      if (mean.cells == 0) continue;
      line.x.push_back(slip.at[k]);
      line.y.push_back(100.0 * std::expm1(mean.value));
      noise.high[k] = std::max(noise.high[k], 196.0 * mean.noise);
      noise.low[k] = -noise.high[k];
    }
    chart.series.push_back(std::move(line));
  }
  chart.ribbons.push_back(std::move(noise));
  return "<h3>Along the pull</h3>\n" +
         figure(draw(chart), fmt::format("The gap along the slip, {}. The band is what noise alone would "
                                         "give the level with the fewest "
                                         "pulls (95 %). Lines that lie level and apart: the effect is there "
                                         "from the start. Lines that "
                                         "bend: it comes or goes with slip or time.",
                                         factor != nullptr
                                             ? fmt::format("by {}, the factor it hangs on most", factor->name)
                                             : std::string("of all conditions together, which share it")));
}

}  // namespace

std::string where_section(const DiscoveryPage& page) {
  const bool gap = page.found.decision.answer != discover::Answer::no_gap;
  return section(gap ? "Where model and measurement part" : "Where they could have parted",
                 location_table(page) + maps(page) + slip_figure(page));
}

}  // namespace heddle::pipeline
