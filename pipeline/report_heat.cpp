#include "pipeline/report_heat.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/units.h"
#include "pipeline/chart.h"
#include "pipeline/page.h"
#include "pipeline/report_figures.h"

namespace heddle::pipeline {

namespace {

std::vector<double> in_celsius(std::vector<double> kelvin) {
  for (double& value : kelvin) value -= zero_celsius;
  return kelvin;
}

/// Both faces on one scale, so that they can be compared.
ColourScale scale_of(const std::vector<double>& top, const std::vector<double>& bottom) {
  const auto [a, b] = std::minmax_element(top.begin(), top.end());
  const auto [c, d] = std::minmax_element(bottom.begin(), bottom.end());
  const double low = std::min(*a, *c), high = std::max(*b, *d);
  return {low, high > low ? high : low + 1.0, "Surface", "°C", ColourMap::angle};
}

std::vector<macroscale::HeatRow> rows_of(const ReportInput& input) {
  std::vector<macroscale::HeatRow> rows;
  for (const macroscale::HistoryRow& row : input.history)
    if (row.heat) rows.push_back(*row.heat);
  rows.insert(rows.end(), input.hold.begin(), input.hold.end());
  return rows;
}

template <class Value>
std::vector<double> column(const std::vector<macroscale::HeatRow>& rows, Value value) {
  std::vector<double> out;
  for (const auto& row : rows) out.push_back(value(row));
  return out;
}

LineChart chart_of(std::string label, Axis y, std::vector<Series> series) {
  LineChart chart;
  chart.label = std::move(label);
  chart.x = {"Time", "s"};
  chart.y = std::move(y);
  chart.series = std::move(series);
  chart.width = half_width;
  chart.height = 300.0;
  chart.label_room = 96.0;
  return chart;
}

}  // namespace

std::string heat_section(const ReportInput& input) {
  const auto rows = rows_of(input);
  if (rows.size() < 2 || !input.blank || input.blank->heat.top.empty()) return "";
  const auto top = in_celsius(input.blank->heat.top), bottom = in_celsius(input.blank->heat.bottom);
  const ColourScale scale = scale_of(top, bottom);
  const auto time = column(rows, [](const auto& r) { return r.time; });
  const auto celsius = [&](double macroscale::HeatRow::*member) {
    return column(rows, [&](const auto& r) { return r.*member - zero_celsius; });
  };
  const auto percent = [&](double macroscale::HeatRow::*member) {
    return column(rows, [&](const auto& r) { return 100.0 * r.*member; });
  };
  using Row = macroscale::HeatRow;
  Axis share{"Share", "%"};
  share.low = 0.0;
  return pair(figure(top_picture(*input.blank, top, scale,
                                 "Temperature of the upper face at the end, seen from above"),
                     "Temperature of the upper face at the end, which punch and binder touch."),
              figure(top_picture(*input.blank, bottom, scale,
                                 "Temperature of the lower face at the end, seen from above"),
                     "The same of the lower face, which the die touches. What no tool touches cools in air "
                     "alone.")) +
         pair(figure(draw(chart_of("Temperatures of the blank against time", {"Temperature", "°C"},
                                   {{"Mean", time, celsius(&Row::mean_temperature)},
                                    {"Coldest face", time, celsius(&Row::coldest_face)}})),
                     "Mean of the whole blank, and the coldest place of its faces."),
              figure(draw(chart_of("Shares of the blank that have frozen or crystallised against time", share,
                                   {{"A face frozen", time, percent(&Row::frozen_faces)},
                                    {"No melt left", time, percent(&Row::frozen_through)},
                                    {"Crystallised", time, percent(&Row::crystallised)}})),
                     "Shares of the blank's area with a face, or the whole thickness, below the freezing "
                     "temperature; and of the crystals that form in the end."));
}

std::vector<Verdict> heat_verdicts(const macroscale::HeatSummary& heat) {
  const auto percent = [](double share) { return significant(100.0 * share, 3) + " %"; };
  std::string text =
      fmt::format("At the end the blank is at {:.0f} °C in the mean, {:.0f} °C at the coldest face; ",
                  heat.last.mean_temperature - zero_celsius, heat.last.coldest_face - zero_celsius);
  text +=
      heat.first_face
          ? fmt::format(
                "a first face froze after {} s, {} of the area has a frozen face and {} has no melt left.",
                significant(*heat.first_face, 3), percent(heat.last.frozen_faces),
                percent(heat.last.frozen_through))
          : std::string("no face has frozen.");
  std::vector<Verdict> out{{Tone::note, std::move(text)}};
  constexpr double limit = 1e-8;  // the balance holds to rounding; more is a fault of the program
  out.push_back({heat.residual_share <= limit ? Tone::holds : Tone::fails,
                 fmt::format("Heat content and heat through the faces agree to {:.1e} of what went through.",
                             heat.residual_share)});
  return out;
}

}  // namespace heddle::pipeline
