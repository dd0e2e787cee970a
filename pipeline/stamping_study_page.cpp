// The page of a study of stampings: what binder force, punch speed and the model do to force and strains.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/units.h"
#include "pipeline/chart.h"
#include "pipeline/page.h"
#include "pipeline/report_figures.h"
#include "pipeline/stamping_study.h"

namespace heddle::pipeline {

namespace {

using Runs = std::vector<const StudiedStamping*>;

std::string speed_name(double scale) {
  return fmt::format("{:g} V", scale);
}

LineChart half_chart(std::string label, Axis x, Axis y, double label_room) {
  LineChart chart;
  chart.label = std::move(label);
  chart.x = std::move(x);
  chart.y = std::move(y);
  chart.width = half_width;
  chart.height = 330.0;
  chart.label_room = label_room;
  return chart;
}

Series force_over_stroke(const StudiedStamping& run, std::string name) {
  Series series{std::move(name), {}, {}};
  for (const StudiedStep& step : run.steps) {
    series.x.push_back(1e3 * step.stroke);
    series.y.push_back(step.force);
  }
  return series;
}

Canvas force_chart_of(const Runs& runs, const std::string& label,
                      const std::function<std::string(const StudiedStamping&)>& name) {
  LineChart chart = half_chart(label, {"Punch displacement", "mm"}, {"Punch force", "N"}, 84.0);
  for (const StudiedStamping* run : runs) chart.series.push_back(force_over_stroke(*run, name(*run)));
  return draw(chart);
}

// ---- binder force

Canvas binder_chart(const Runs& runs, const BinderLine& line) {
  LineChart chart = half_chart("Peak punch force over binder force, and the straight line through the points",
                               {"Binder force", "kN"}, {"Peak punch force", "N"}, 84.0);
  chart.y.low = 0.0;
  Series points{"", {}, {}, true}, straight{"line", {}, {}};
  for (const StudiedStamping* run : runs) {
    points.x.push_back(1e-3 * run->binder_force);
    points.y.push_back(run->peak()->force);
    straight.x.push_back(1e-3 * run->binder_force);
    straight.y.push_back(line.intercept + line.slope * run->binder_force);
  }
  chart.series = {std::move(straight), std::move(points)};
  return draw(chart);
}

std::string binder_section(const StampingStudyFindings& findings) {
  const auto line = binder_line(findings);
  if (!line) return "";
  const Runs runs = over_binder_force(findings);
  std::vector<std::vector<std::string>> rows;
  for (const StudiedStamping* run : runs)
    rows.push_back({fmt::format("{:g} N", run->binder_force), significant(run->peak()->force, 4),
                    significant_or_dash(run->grid_error, 2),
                    fmt::format("{:.2f}", run->peak()->force / runs.front()->peak()->force),
                    fmt::format("{:.2f}", degrees * run->peak()->shear),
                    fmt::format("{:.4f}", 100.0 * run->peak()->tow_strain),
                    significant(1e3 * run->peak()->draw_in, 4)});
  return section(
      "Binder force",
      pair(figure(force_chart_of(runs, "Punch force over the stroke for each binder force",
                                 [](const auto& run) { return fmt::format("{:g} N", run.binder_force); }),
                  "Punch force over the stroke, one line a binder force."),
           figure(binder_chart(runs, *line),
                  fmt::format("Peak force. The line: {} N + {} of the binder force; it misses a point by "
                              "{:.1f} % at most.",
                              significant(line->intercept, 3), significant(line->slope, 3),
                              100.0 * line->largest_miss))) +
          table({"Binder force", "Peak force, N", "its grid error, N", "of the first", "Largest shear, °",
                 "Tow strain, %", "Draw-in, mm"},
                rows));
}

// ---- speed

Canvas over_speed_chart(const StampingStudyFindings& findings, const std::string& label, Axis y,
                        double (*value)(const StudiedStep&), bool relative) {
  LineChart chart = half_chart(label, {"Speed, over V", "", Scale::logarithmic}, std::move(y), 130.0);
  for (const StudyModel& model : findings.spec.models) {
    const Runs runs = over_speed(findings, model.name);
    if (runs.size() < 2) continue;
    Series series{model.name, {}, {}};
    double base = 1.0;
    for (const StudiedStamping* run : runs)
      if (relative && run->speed_scale == findings.speed_scale) base = 0.01 * value(*run->peak());
    for (const StudiedStamping* run : runs) {
      series.x.push_back(run->speed_scale);
      series.y.push_back(value(*run->peak()) / base);
    }
    chart.series.push_back(std::move(series));
  }
  return draw(chart);
}

std::string speed_table(const StampingStudyFindings& findings) {
  std::vector<std::vector<std::string>> rows;
  for (const StudyModel& model : findings.spec.models)
    for (const StudiedStamping* run : over_speed(findings, model.name)) {
      const StudiedStep& peak = *run->peak();
      rows.push_back({model.name + ", " + speed_name(run->speed_scale), significant(peak.force, 5),
                      significant_or_dash(run->grid_error, 2), fmt::format("{:.2f}", 1e3 * peak.stroke),
                      fmt::format("{:.3f}", degrees * peak.shear),
                      fmt::format("{:.4f}", 100.0 * peak.tow_strain), significant(peak.work, 4),
                      fmt::format("{:.1f} %", 100.0 * peak.friction / peak.work),
                      fmt::format("{:.1f} %", 100.0 * peak.shear_rate / peak.work)});
    }
  return table({"Model and speed", "Peak force, N", "its grid error, N", "at, mm", "Largest shear, °",
                "Tow strain, %", "Work, J", "by friction", "by shear rate"},
               rows);
}

std::string signature_table(const StampingStudyFindings& findings) {
  std::vector<std::vector<std::string>> rows;
  for (const SpeedSignature& s : speed_signatures(findings)) {
    const auto ratio = s.ratio();
    rows.push_back({fmt::format("{}, about {}", s.model, speed_name(s.speed)),
                    fmt::format("{:+.2f} %", 100.0 * s.rise_low()),
                    fmt::format("{:+.2f} %", 100.0 * s.rise_high()),
                    ratio ? fmt::format("{:.2f}", *ratio) : "below noise"});
  }
  if (rows.empty()) return "";
  return "<p>Signature: rise from V to 2V over the rise from V/2 to V. A resistance that grows as the n-th "
         "power of speed gives "
         "2<sup>n</sup>: 4 for inertia, 2 for damping, near 1 for a weak power. Rises below 0.1 % of the "
         "force are what "
         "grid and tolerance leave.</p>\n" +
         table({"Model", "V/2 to V", "V to 2V", "Signature"}, rows);
}

std::string speed_section(const StampingStudyFindings& findings) {
  if (findings.spec.speed_scales.size() < 2) return "";
  std::string body;
  body +=
      pair(figure(over_speed_chart(
                      findings, "Peak punch force over speed for each model, in per cent of that at V",
                      {"Peak force, of that at V", "%"}, [](const StudiedStep& s) { return s.force; }, true),
                  "Peak force over speed, in per cent of the same model at V."),
           figure(over_speed_chart(
                      findings, "Peak punch force over speed for each model", {"Peak force", "N"},
                      [](const StudiedStep& s) { return s.force; }, false),
                  "The same in newtons."));
  body += pair(
      figure(over_speed_chart(
                 findings,
                 "Largest shear angle at peak force over speed for each model, in per cent of that at V",
                 {"Shear angle, of that at V", "%"}, [](const StudiedStep& s) { return s.shear; }, true),
             "Largest shear angle when the force is largest, in per cent of the same model at V."),
      figure(over_speed_chart(
                 findings,
                 "Largest tow strain at peak force over speed for each model, in per cent of that at V",
                 {"Tow strain, of that at V", "%"}, [](const StudiedStep& s) { return s.tow_strain; }, true),
             "Largest tow strain when the force is largest, in per cent of the same model at V."));
  std::vector<std::string> curves;
  for (const StudyModel& model : findings.spec.models) {
    const Runs runs = over_speed(findings, model.name);
    if (runs.size() < 2) continue;
    curves.push_back(figure(force_chart_of(runs, "Punch force over the stroke for each speed, " + model.name,
                                           [](const auto& run) { return speed_name(run.speed_scale); }),
                            "Model " + model.name + ": force over the stroke."));
  }
  return section("Punch speed", body + pairs(curves) + speed_table(findings) + signature_table(findings));
}

// ---- models against each other

std::string model_section(const StampingStudyFindings& findings) {
  if (findings.spec.models.size() < 2) return "";
  std::vector<double> scales = findings.spec.speed_scales;
  if (scales.empty()) scales.push_back(findings.speed_scale);
  std::sort(scales.begin(), scales.end());
  std::vector<std::string> head{"Peak force over that of the case as given"};
  for (const double scale : scales) head.push_back(speed_name(scale));
  std::vector<std::vector<std::string>> rows;
  const Runs own = over_speed(findings, findings.spec.models.front().name);
  for (std::size_t m = 1; m < findings.spec.models.size(); ++m) {
    rows.push_back({findings.spec.models[m].name});
    const Runs runs = over_speed(findings, findings.spec.models[m].name);
    for (const double scale : scales) {
      const auto at = [&](const Runs& all) {
        return std::find_if(all.begin(), all.end(),
                            [&](const auto* run) { return run->speed_scale == scale; });
      };
      const auto a = at(runs), b = at(own);
      rows.back().push_back(a == runs.end() || b == own.end()
                                ? "–"
                                : fmt::format("{:.4f}", (*a)->peak()->force / (*b)->peak()->force));
    }
  }
  std::vector<std::string> charts;
  for (const double scale : scales) {
    Runs runs;
    for (const StudyModel& model : findings.spec.models)
      for (const StudiedStamping* run : over_speed(findings, model.name))
        if (run->speed_scale == scale) runs.push_back(run);
    LineChart chart = half_chart("Punch force over the stroke for each model at " + speed_name(scale),
                                 {"Punch displacement", "mm"}, {"Punch force", "N"}, 130.0);
    for (const StudiedStamping* run : runs) chart.series.push_back(force_over_stroke(*run, run->model));
    charts.push_back(figure(draw(chart), "Every model at " + speed_name(scale) + "."));
  }
  std::vector<Condition> models;
  for (const StudyModel& model : findings.spec.models)
    models.push_back({model.name, model.assignments.empty()
                                      ? "the case as given"
                                      : fmt::format("{}", fmt::join(model.assignments, "; "))});
  return section("Models against each other", facts_table(models) + pairs(charts) + table(head, rows));
}

}  // namespace

std::string stamping_study_html(const StampingStudyFindings& findings) {
  std::string out = page_head(findings.name + ": a study of stampings");
  out += fmt::format("<header>\n<h1>{}</h1>\n<p class=\"lead\">{}</p>\n</header>\n", escape(findings.name),
                     escape(findings.description));
  std::vector<std::string> notes = findings.notes;
  for (const StudiedStamping& s : findings.stampings)
    if (s.status != CaseStatus::done)
      notes.insert(notes.begin(), s.id + " is not done and left out: " + s.message);
  out += binder_section(findings) + speed_section(findings) + model_section(findings) +
         variation_sections(findings) + section("What it rests on", list(notes));
  return out + page_foot(
                   "Written by heddle. Numbers: table.csv and table.h5 in the same folder; each stamping in "
                   "cases/.");
}

}  // namespace heddle::pipeline
