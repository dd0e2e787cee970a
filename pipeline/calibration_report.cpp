#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/units.h"
#include "pipeline/calibration_record.h"
#include "pipeline/chart.h"
#include "pipeline/page.h"
#include "pipeline/report_figures.h"

namespace heddle::pipeline {

namespace {

using friction::FittedNumber;
using friction::Scatter;

std::string percent(double share) {
  return fmt::format("{:.3g} %", 100.0 * share);
}

const char* plural(int count) {
  return count == 1 ? "" : "s";
}

/// The interval of a number is that of its prior.
bool prior_decides(const FittedNumber& number) {
  return number.prior && number.sd && *number.sd > 0.9 * number.prior->sd;
}

// ---- what the numbers say

Verdict freedom_verdict(const CalibrationFindings& findings) {
  const friction::CouponFit& fit = findings.fit;
  const std::string counts = fmt::format(
      "{} numbers fitted to {} samples under {} conditions{}", fit.numbers.size(),
      findings.data.samples.size(), findings.data.conditions,
      fit.from_priors > 0 ? fmt::format(" and {} prior{}", fit.from_priors, plural(fit.from_priors)) : "");
  if (fit.saturated())
    return {Tone::attention,
            counts +
                ": saturated. As many numbers as measurements meet every one of them exactly, whatever "
                "the law; no scatter can be stated from this fit, and no form be tested."};
  return {Tone::note,
          fmt::format("{}: {} degree{} of freedom left; RMS error {:.2f} %.", counts, fit.degrees_of_freedom,
                      plural(fit.degrees_of_freedom), 100.0 * fit.rms_error)};
}

Verdict sample_verdict(const CalibrationFindings& findings) {
  const Scatter& sample = findings.fit.noise.sample;
  switch (sample.source) {
    case Scatter::Source::replicates:
      return {Tone::note, fmt::format("Samples scatter by {} ({} degrees of freedom, from replicates).",
                                      percent(sample.sd), sample.degrees_of_freedom)};
    case Scatter::Source::residuals:
      return {Tone::attention,
              fmt::format("No condition was pulled twice on one day: the scatter of samples, {}, is what the "
                          "fit leaves over ({} degree{} of freedom). It cannot be told from a law of the "
                          "wrong form; replicates would.",
                          percent(sample.sd), sample.degrees_of_freedom, plural(sample.degrees_of_freedom))};
    case Scatter::Source::given:
      return {Tone::note, fmt::format("The scatter of samples was given: {}.", percent(sample.sd))};
    default:
      return {Tone::attention,
              "No condition was pulled twice on one day and no degree of freedom is left: how samples "
              "scatter is not known, so no interval is stated. Give calibrate.noise.sample for one."};
  }
}

Verdict day_verdict(const CalibrationFindings& findings) {
  const Scatter& day = findings.fit.noise.day;
  switch (day.source) {
    case Scatter::Source::anchors:
      return {Tone::note, fmt::format("Days differ by {} (from one condition repeated on {} days).",
                                      percent(day.sd), day.degrees_of_freedom + 1)};
    case Scatter::Source::given:
      return {Tone::note, day.sd > 0.0 ? fmt::format("Days differ by {}, as given.", percent(day.sd))
                                       : "Days were taken to be alike, as asked."};
    default:
      return {Tone::attention,
              fmt::format("How much days differ is assumed, {}: {}. It widens what only the level of the "
                          "forces tells; one condition repeated on three days would measure it.",
                          percent(day.sd),
                          findings.data.has_days() ? "no condition was repeated on three days"
                                                   : "the table has no day_id")};
  }
}

/// Residual scatter against replicate scatter.
std::optional<Verdict> form_verdict(const CalibrationFindings& findings) {
  const friction::CouponFit& fit = findings.fit;
  if (fit.noise.sample.source != Scatter::Source::replicates || fit.degrees_of_freedom <= 0) return {};
  double squares = 0.0;
  for (const friction::CouponResidual& row : fit.rows)
    squares += row.weight * row.standardised * row.standardised;
  const double ratio = std::sqrt(squares / std::max(fit.degrees_of_freedom, 1));
  if (ratio < 1.3)
    return Verdict{Tone::holds, fmt::format("What the fit leaves over is {:.2f} times the scatter of "
                                            "replicates: nothing asks for another law.",
                                            ratio)};
  return Verdict{Tone::attention,
                 fmt::format("What the fit leaves over is {:.2f} times the scatter of replicates: the law "
                             "misses something, or samples are mislabelled. See the residuals.",
                             ratio)};
}

void add_number_verdicts(const CalibrationFindings& findings, std::vector<Verdict>& verdicts) {
  for (const friction::Confusion& confusion : findings.fit.confusions) {
    const bool held = std::ranges::any_of(findings.fit.numbers, [&](const FittedNumber& number) {
      return number.prior && std::ranges::count(confusion.keys, number.key) > 0;
    });
    verdicts.push_back(
        {Tone::attention, confusion.words + (held && confusion.total ? " A prior decides." : "")});
  }
  for (std::size_t k = 0; k < findings.fit.numbers.size(); ++k) {
    const FittedNumber& number = findings.fit.numbers[k];
    if (number.at_bound)
      verdicts.push_back({Tone::attention, fmt::format("{} ended at its bound, {}.", number.key,
                                                       quantity_text(number.value, number.unit, 4))});
    if (prior_decides(number))
      verdicts.push_back(
          {Tone::note, fmt::format("{} is what its prior says: the data narrow it by {:.0f} %.", number.key,
                                   100.0 * std::max(0.0, 1.0 - *number.sd / number.prior->sd))});
    if (findings.plate_area && findings.plate_area->moves[k])
      verdicts.push_back(
          {Tone::attention,
           fmt::format("{} is fixed only by the assumed plate area: it is {} at {:g} m^2 and {} at {:g} m^2.",
                       number.key, quantity_text(findings.plate_area->low.numbers[k].value, number.unit, 4),
                       findings.rig.plate_area_band[0],
                       quantity_text(findings.plate_area->high.numbers[k].value, number.unit, 4),
                       findings.rig.plate_area_band[1])});
  }
}

void add_soundness(const CalibrationFindings& findings, std::vector<Verdict>& verdicts) {
  const friction::CouponFit& fit = findings.fit;
  const bool converged = fit.summary.converged;
  verdicts.push_back({converged ? Tone::holds : Tone::fails,
                      converged
                          ? fmt::format("The search converged in {} iterations.", fit.summary.iterations)
                          : fmt::format("The search did not converge: {}. The values are not the best ones.",
                                        fit.summary.reason)});
  const bool exact =
      std::ranges::all_of(fit.numbers, [](const FittedNumber& number) { return number.exact_slope; });
  if (!exact)
    verdicts.push_back({fit.worst_difference < 1e-4 ? Tone::holds : Tone::attention,
                        fmt::format("Slopes taken by differences agree at two step sizes to {:.1g} of mu per "
                                    "relative change.",
                                    fit.worst_difference)});
  const auto far =
      std::ranges::count_if(fit.rows, [](const friction::CouponResidual& row) { return row.weight < 0.5; });
  if (far > 0)
    verdicts.push_back(
        {Tone::attention,
         fmt::format("{} of {} rows lie so far off that they count less than half.", far, fit.rows.size())});
}

// ---- the page

std::string interval_text(const FittedNumber& number) {
  if (!number.interval) return "–";
  return fmt::format("{} to {}", quantity_text((*number.interval)[0], number.unit, 4),
                     quantity_text((*number.interval)[1], number.unit, 4));
}

std::string number_table(const CalibrationFindings& findings) {
  std::vector<std::string> head{"Number", "Value", "Standard deviation",
                                fmt::format("{:g} % interval", 100.0 * findings.spec.confidence)};
  head.push_back("Fixed by");
  std::vector<std::vector<std::string>> rows;
  for (std::size_t k = 0; k < findings.fit.numbers.size(); ++k) {
    const FittedNumber& number = findings.fit.numbers[k];
    const std::string unit = number.unit == "degC" ? "K" : number.unit;  // a difference of temperatures
    std::vector<std::string> row{number.key, quantity_text(number.value, number.unit, 5),
                                 number.sd ? quantity_text(*number.sd, unit, 2) : "–", interval_text(number)};
    const bool by_area = findings.plate_area && findings.plate_area->moves[k];
    row.push_back(number.at_bound         ? "its bound"
                  : !number.told_apart    ? (number.sd ? "prior" : "nothing alone")
                  : prior_decides(number) ? "its prior"
                  : by_area               ? "data and plate area"
                                          : "data");
    rows.push_back(std::move(row));
  }
  return table(head, rows);
}

std::string plate_area_table(const CalibrationFindings& findings) {
  if (!findings.plate_area) return "";
  const auto area = [&](double value) { return fmt::format("{:g} m²", value); };
  std::vector<std::vector<std::string>> rows;
  for (std::size_t k = 0; k < findings.fit.numbers.size(); ++k) {
    const FittedNumber& number = findings.fit.numbers[k];
    rows.push_back({number.key, quantity_text(findings.plate_area->low.numbers[k].value, number.unit, 4),
                    quantity_text(number.value, number.unit, 4),
                    quantity_text(findings.plate_area->high.numbers[k].value, number.unit, 4)});
  }
  return "<h3>The same fit with other plates</h3>\n" +
         table({"Number", area(findings.rig.plate_area_band[0]), area(findings.rig.plate_area),
                area(findings.rig.plate_area_band[1])},
               rows);
}

std::string correlation_table(const friction::CouponFit& fit) {
  if (fit.correlation.rows() < 2) return "";
  std::vector<std::string> head{""};  // last names: whole keys would not stand side by side
  for (const std::string& key : fit.keys) head.push_back(key.substr(key.rfind('.') + 1));
  std::vector<std::vector<std::string>> rows;
  for (Eigen::Index i = 0; i < fit.correlation.rows(); ++i) {
    std::vector<std::string> row{fit.keys[static_cast<std::size_t>(i)]};
    for (Eigen::Index j = 0; j < fit.correlation.cols(); ++j)
      row.push_back(fit.correlation(j, j) == 0.0 || fit.correlation(i, i) == 0.0
                        ? "–"
                        : fmt::format("{:.2f}", fit.correlation(i, j)));
    rows.push_back(std::move(row));
  }
  return "<h3>Correlation</h3>\n" + table(head, rows);
}

/// Room left and right of the first and the last dot. A logarithmic axis over less than a factor of five
/// would have one tick or none.
void widen(Axis& axis, double low, double high) {
  if (high < 5.0 * low) axis.scale = Scale::linear;
  const bool log = axis.scale == Scale::logarithmic;
  const double reach = log          ? 0.06 * std::log(high / low)
                       : high > low ? 0.06 * (high - low)
                                    : std::max(0.1 * std::abs(low), 1.0);
  axis.low = log ? low * std::exp(-reach) : low - reach;
  axis.high = log ? high * std::exp(reach) : high + reach;
}

/// Residuals in per cent of the force against one of the conditions, a colour a day.
Canvas residual_chart(const CalibrationFindings& findings, Axis axis, const auto& abscissa) {
  LineChart chart;
  chart.label = fmt::format("Residuals of ln F against {}", axis.quantity);
  chart.x = std::move(axis);
  chart.y = {"Model over measured force, less 1", "%"};
  chart.width = half_width;
  chart.height = 300.0;
  double low = 1e300, high = -1e300, largest = 0.0;
  const bool days = findings.data.days.size() > 1 && findings.data.days.size() <= 6;
  std::vector<Series> dots(days ? findings.data.days.size() : 1);
  for (std::size_t d = 0; d < dots.size(); ++d) {
    dots[d].dots = true;
    if (days) dots[d].name = findings.data.days[d];
  }
  for (std::size_t i = 0; i < findings.data.rows.size(); ++i) {
    const friction::CouponRow& row = findings.data.rows[i];
    const double x = abscissa(i), y = 100.0 * std::expm1(findings.fit.rows[i].log_error);
    dots[days ? row.day : 0].x.push_back(x);
    dots[days ? row.day : 0].y.push_back(y);
    low = std::min(low, x);
    high = std::max(high, x);
    largest = std::max(largest, std::abs(y));
  }
  widen(chart.x, low, high);
  const double top = std::max(1.1 * largest, 1e-3);
  chart.y.low = -top;
  chart.y.high = top;
  chart.series = std::move(dots);
  chart.label_room = days ? 90.0 : 16.0;
  return draw(chart);
}

/// mu of law and measurements over the Hersey number, at the temperatures of the first row.
std::string hersey_figure(const CalibrationFindings& findings) {
  if (findings.fit.rows.front().hersey <= 0.0) return "";
  LineChart chart;
  chart.label = "Measured friction coefficient and law against Hersey number";
  chart.x = {"Hersey number", "", Scale::logarithmic};
  chart.y = {"Friction coefficient", ""};
  chart.width = half_width;
  chart.height = 300.0;
  chart.label_room = 84.0;
  Series measured{"measured", {}, {}, true}, model{"model", {}, {}, true};
  double low = 1e300, high = 0.0;
  for (std::size_t i = 0; i < findings.data.rows.size(); ++i) {
    const double hersey = findings.fit.rows[i].hersey;
    low = std::min(low, hersey);
    high = std::max(high, hersey);
    measured.x.push_back(hersey);
    measured.y.push_back(friction::measured_coefficient(findings.data.rows[i], findings.spec.faces));
    model.x.push_back(hersey);
    model.y.push_back(findings.fit.rows[i].mu);
  }
  widen(chart.x, low, high);
  chart.series = {std::move(measured), std::move(model)};
  return figure(draw(chart),
                "Friction coefficient of each pull against its Hersey number, measured and by the fitted "
                "model. Pulls at other tool temperatures stand off by the effect of temperature.");
}

std::string residual_figures(const CalibrationFindings& findings) {
  const auto& rows = findings.data.rows;
  const std::string words =
      "Dots on a slope or a curve say that the law does not follow this condition; dots about zero, that it "
      "does.";
  const auto chart = [&](const Axis& axis, const auto& abscissa) {
    return figure(residual_chart(findings, axis, abscissa),
                  fmt::format("Against {}. {}", axis.quantity, words));
  };
  return pair(chart({"pull speed", "mm/s", Scale::logarithmic},
                    [&](std::size_t i) { return 1e3 * rows[i].pull.velocity; }),
              chart({"normal force", "N", Scale::logarithmic},
                    [&](std::size_t i) { return rows[i].pull.normal_force; })) +
         pair(chart({"tool temperature", "°C"},
                    [&](std::size_t i) { return rows[i].pull.tool_temperature - zero_celsius; }),
              hersey_figure(findings));
}

std::string day_table(const CalibrationFindings& findings) {
  if (findings.fit.day_shifts.size() < 2) return "";
  std::vector<std::vector<std::string>> rows;
  for (std::size_t d = 0; d < findings.fit.day_shifts.size(); ++d)
    rows.push_back({findings.data.days[d], fmt::format("{:+.2f} %", 100.0 * findings.fit.day_shifts[d])});
  return "<h3>Days</h3>\n" + table({"Day", "Shift of the force"}, rows);
}

}  // namespace

std::string quantity_text(double value, const std::string& unit, int digits) {
  // The round number nearest in the unit of the configuration.
  const double zero = read_quantity("0 " + unit, unit).value, one = read_quantity("1 " + unit, unit).value;
  return fmt::format("{}{}{}", significant((value - zero) / (one - zero), digits), unit.empty() ? "" : " ",
                     unit);
}

std::vector<Verdict> calibration_verdicts(const CalibrationFindings& findings) {
  std::vector<Verdict> verdicts{freedom_verdict(findings)};
  add_soundness(findings, verdicts);
  verdicts.push_back(sample_verdict(findings));
  verdicts.push_back(day_verdict(findings));
  if (auto form = form_verdict(findings)) verdicts.push_back(*form);
  add_number_verdicts(findings, verdicts);
  if (!findings.plate_area_given)
    verdicts.push_back({Tone::attention, fmt::format("The case gives no plate area; {:g} m^2 is assumed.",
                                                     findings.rig.plate_area)});
  return verdicts;
}

std::string calibration_html(const CalibrationFindings& findings) {
  std::string out = page_head(findings.name);
  out += fmt::format(
      "<header>\n<p class=\"kind\">heddle · Calibration</p>\n<h1>{}</h1>\n<p class=\"lead\">The {} law, "
      "fitted "
      "to {}.</p>\n</header>\n",
      escape(findings.name), escape(findings.law), escape(findings.data_file));
  out += verdict_list(calibration_verdicts(findings));
  out += section("What was found", number_table(findings) + plate_area_table(findings) +
                                       correlation_table(findings.fit) + day_table(findings));
  out += section("What is left over", residual_figures(findings));
  out += section("What it rests on", list(findings.notes));
  return out +
         page_foot(
             "Written by heddle. Numbers: calibration.json, calibration/numbers.csv and "
             "calibration/residuals.csv in the same folder; patched.yaml is the case with these numbers.");
}

}  // namespace heddle::pipeline
