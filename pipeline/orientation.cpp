#include "pipeline/orientation.h"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <numeric>

#include <fmt/format.h>

#include "core/progress.h"
#include "core/units.h"
#include "macroscale/punch_profile.h"
#include "pipeline/cache.h"
#include "pipeline/chart.h"
#include "pipeline/export_vtu.h"
#include "pipeline/interrupt.h"
#include "pipeline/page.h"
#include "pipeline/report_figures.h"
#include "pipeline/run_folder.h"
#include "pipeline/stage_keys.h"
#include "pipeline/stages.h"
#include "pipeline/stamping_record.h"

namespace heddle::pipeline {

namespace {

std::string angle_text(double angle) {
  // Converted angles are whole degrees up to rounding.
  return fmt::format("{:.6g}", degrees * angle);
}

std::string id_of(double angle) {
  std::string id = angle_text(angle) + "_deg";
  std::replace(id.begin(), id.end(), '.', 'p');
  return id;
}

// ---- numbers

// Slope of the least-squares line and range of some results over their angles.
Sensitivity sensitivity_of(std::string quantity, std::string unit, const std::vector<double>& angle,
                           const std::vector<double>& value) {
  Sensitivity s{std::move(quantity), std::move(unit)};
  if (value.empty()) return s;
  const double n = static_cast<double>(value.size());
  const double mean_x = std::accumulate(angle.begin(), angle.end(), 0.0) / n,
               mean_y = std::accumulate(value.begin(), value.end(), 0.0) / n;
  double xx = 0.0, xy = 0.0;
  for (std::size_t k = 0; k < value.size(); ++k) {
    xx += (angle[k] - mean_x) * (angle[k] - mean_x);
    xy += (angle[k] - mean_x) * (value[k] - mean_y);
  }
  if (xx > 0.0) s.per_degree = xy / xx;
  const auto [low, high] = std::minmax_element(value.begin(), value.end());
  if (mean_y != 0.0) s.range = (*high - *low) / mean_y;
  return s;
}

std::vector<OrientedBlank> stamped(const OrientationFindings& findings) {
  std::vector<OrientedBlank> blanks;
  std::copy_if(findings.blanks.begin(), findings.blanks.end(), std::back_inserter(blanks),
               [](const OrientedBlank& blank) { return blank.result.summary.completed; });
  return blanks;
}

// ---- the page

std::string signed_number(double value, int digits) {
  if (value == 0.0) return "0";
  return (value < 0.0 ? "\u2212" : "+") + significant(std::abs(value), digits);
}

std::string percent(double share) {
  return share < 5e-6 ? "0 %" : significant(100.0 * share, 2) + " %";
}

std::string pictures(const OrientationFindings& findings) {
  // One scale for all, or the colours would not compare.
  double largest = 0.0;
  for (const OrientedBlank& blank : findings.blanks)
    for (const double angle : blank.result.final_state.shear_angle)
      largest = std::max(largest, std::abs(angle));
  std::vector<std::string> figures;
  for (const OrientedBlank& blank : findings.blanks)
    figures.push_back(
        figure(top_picture(blank.result.final_state, largest),
               fmt::format("Warp at {}° to x{}.", angle_text(blank.angle),
                           blank.result.summary.completed ? "" : " (stopped before the end of the stroke)")));
  return pairs(figures);
}

Canvas force_chart_of(const std::vector<OrientedBlank>& blanks) {
  LineChart chart;
  chart.label = "Punch force against stroke for each orientation";
  chart.x = {"Punch displacement", "mm"};
  chart.y = {"Punch force", "N"};
  for (const OrientedBlank& blank : blanks) {
    Series series{angle_text(blank.angle) + "°", {}, {}};
    for (const auto& row : blank.result.history) {
      series.x.push_back(1e3 * row.punch_displacement);
      series.y.push_back(row.punch_force);
    }
    chart.series.push_back(std::move(series));
  }
  chart.width = half_width;
  chart.height = 340.0;
  chart.label_room = 56.0;
  return draw(chart);
}

Canvas edge_chart_of(const std::vector<OrientedBlank>& blanks) {
  LineChart chart;
  chart.label = "Draw-in along the edge of the blank for each orientation";
  chart.x = {"Direction from the punch axis, from x", "°"};
  chart.y = {"Draw-in", "mm"};
  for (const OrientedBlank& blank : blanks) {
    std::vector<std::array<double, 2>> points;
    for (const auto& edge : blank.result.final_state.edge) {
      double direction = degrees * std::atan2(edge.reference[1], edge.reference[0]);
      if (direction < 0.0) direction += 360.0;
      points.push_back({direction, 1e3 * edge.draw_in});
    }
    std::sort(points.begin(), points.end());
    Series series{angle_text(blank.angle) + "°", {}, {}};
    for (const auto& [direction, draw_in] : points) {
      series.x.push_back(direction);
      series.y.push_back(draw_in);
    }
    chart.series.push_back(std::move(series));
  }
  chart.width = half_width;
  chart.height = 340.0;
  chart.label_room = 56.0;
  return draw(chart);
}

std::string blank_table(const std::vector<OrientedBlank>& blanks) {
  std::vector<std::vector<std::string>> rows;
  for (const OrientedBlank& blank : blanks) {
    const auto& s = blank.result.summary;
    rows.push_back({angle_text(blank.angle) + "°", significant(s.peak_punch_force, 4),
                    fmt::format("{:.2f}", degrees * s.shear_angle_max), significant(1e3 * s.draw_in_max, 4),
                    significant(1e3 * s.draw_in_rays[0], 4), significant(1e3 * s.draw_in_rays[1], 4),
                    percent(s.energy_residual_max), fmt::format("{}", s.newton_iterations)});
  }
  return table({"Warp to x", "Peak force, N", "Largest shear, °", "Largest draw-in, mm", "at 0°, mm",
                "at 45°, mm", "Energy residual", "Newton"},
               rows);
}

std::string sensitivity_table(const std::vector<Sensitivity>& all) {
  std::vector<std::vector<std::string>> rows;
  for (const Sensitivity& s : all)
    rows.push_back(
        {s.quantity,
         std::abs(s.per_degree) < 1e-12 ? "0" : signed_number(s.per_degree, 3) + " " + s.unit + "/°",
         percent(s.range)});
  return table({"Result", "Change per degree (line through all angles)", "Range over its mean"}, rows);
}

std::string sample_table(const std::vector<FrictionTestRow>& samples) {
  std::vector<std::vector<std::string>> rows;
  for (const FrictionTestRow& s : samples)
    rows.push_back({angle_text(s.orientation) + "°", significant(1e3 * s.velocity, 3),
                    significant(s.normal_force, 4), fmt::format("{:.4f}", s.friction_coefficient),
                    significant(s.pull_force, 5)});
  return table({"Warp to the pull", "Speed, mm/s", "Normal force, N", "μ of the law", "Pull 2 μ N, N"}, rows);
}

// ---- the runs

// The stamping of one blank under the key of its inputs: a list that was interrupted goes on with the next.
std::string key_of(const Case& a_case, double angle) {
  StageInputs inputs = inputs_of(ChainStage::macroscale, a_case);
  inputs.inputs.push_back({"orientation_study.blank", shortest(angle)});
  return inputs.key();
}

macroscale::StampingResult stamp_or_find(const macroscale::StampingSpec& spec,
                                         const mesoscale::FabricProperties& fabric,
                                         const friction::Model& model,
                                         const macroscale::StampingObserver& observe, const std::string& key,
                                         const Cache& cache, bool& reused) {
  macroscale::StampingControl control;
  const auto found = cache.find(key, read_stamping_record);
  reused = found && found->complete();
  if (reused) control.resume_from = &found->at;
  control.observe = observe;
  control.stop = InterruptGuard::interrupted;
  control.keep = [&](const macroscale::StampingCheckpoint& checkpoint, bool last) {
    if (reused || !last || checkpoint.step != macroscale::all_steps(spec.process)) return;
    StampingRecord record{key, "orientation study", macroscale::all_steps(spec.process), checkpoint, {}};
    cache.store(key, bytes_of(record));
  };
  return macroscale::run_stamping(spec, fabric, model, control);
}

OrientedBlank stamp(const Case& a_case, double angle, const mesoscale::FabricProperties& fabric,
                    const friction::Model& model, RunFolder& folder, const Cache& cache, bool quiet) {
  OrientedBlank blank;
  blank.id = id_of(angle);
  blank.angle = angle;
  macroscale::StampingSpec spec = *a_case.stamping;
  spec.blank.orientation = angle;
  Progress progress("blank at " + angle_text(angle) + " deg", macroscale::all_steps(spec.process),
                    progress_style_of_standard_error(quiet), std::cerr);
  const auto observe = [&](int step, int, const macroscale::HistoryRow& row, const macroscale::BlankState&) {
    progress.update(step,
                    fmt::format("punch {:.1f} mm, {:.0f} N", 1e3 * row.punch_displacement, row.punch_force));
  };
  blank.result = folder.stage("blank_" + blank.id, [&](bool& reused) {
    return stamp_or_find(spec, fabric, model, observe, key_of(a_case, angle), cache, reused);
  });
  progress.finish();
  if (blank.result.summary.stopped) return blank;
  const std::string place = "cases/" + blank.id + "/";
  SummaryRecord record;
  record.stamping = blank.result.summary;
  folder.write(place + "summary.json", summary_json(record));
  folder.write(place + "history.csv", history_csv(blank.result.history));
  folder.write(place + "blank.vtu", vtu(mesh_of(blank.result.final_state)));
  folder.log(fmt::format("blank at {} deg: {} steps, {} Newton iterations, peak {:.1f} N{}",
                         angle_text(angle), blank.result.summary.steps,
                         blank.result.summary.newton_iterations, blank.result.summary.peak_punch_force,
                         blank.result.summary.completed ? "" : ", stopped: " + blank.result.summary.failure));
  return blank;
}

// The baseline pull of the paper's Table 2: 1500 N at 16.6 mm/s, tools at 85 degC, fabric at 180 degC.
FrictionTestRow pull(const Case& a_case, double angle, const mesoscale::FabricProperties& fabric,
                     const friction::Model& model) {
  friction::FrictionTestRow row;
  row.name = id_of(angle);
  row.velocity = 16.6e-3;
  row.normal_force = 1500.0;
  row.orientation = angle;
  const FrictionSpec& friction = *a_case.friction;
  const auto law = friction::run_friction_test(model, row, friction.rig, area_function(friction, &fabric));
  FrictionTestRow sample;
  sample.name = row.name;
  sample.velocity = row.velocity;
  sample.normal_force = row.normal_force;
  sample.tool_temperature = row.tool_temperature;
  sample.fabric_temperature = row.fabric_temperature;
  sample.orientation = angle;
  sample.friction_coefficient = law.mu;
  sample.pull_force = law.pull_force;
  return sample;
}

std::string note_on_friction(const friction::Model& model) {
  const std::string paper =
      " The paper pulled samples from 0/90 to 90/0 and found relatively no effect of orientation (section "
      "2).";
  if (!friction::is_on(model.effects.orientation))
    return "The effect `orientation` is off, so mu is the same at every angle by construction." + paper;
  if (model.effects.orientation->form != friction::Orientation::Form::tows)
    return "The effect `orientation` follows the trellis: samples that are not sheared feel nothing of it." +
           paper;
  return fmt::format("The effect `orientation` is on: mu grows by {:g} sin^2(2 theta) of itself.",
                     model.effects.orientation->amplitude) +
         paper;
}

void print(const OrientationFindings& findings) {
  fmt::print("{:<12}{:>12}{:>14}{:>14}{:>12}{:>10}\n", "warp to x", "peak N", "max shear deg", "draw-in mm",
             "residual", "Newton");
  for (const OrientedBlank& blank : findings.blanks) {
    const auto& s = blank.result.summary;
    fmt::print("{:<12}{:>12.1f}{:>14.2f}{:>14.2f}{:>12.1e}{:>10}{}\n", angle_text(blank.angle) + " deg",
               s.peak_punch_force, degrees * s.shear_angle_max, 1e3 * s.draw_in_max, s.energy_residual_max,
               s.newton_iterations, s.completed ? "" : "  stopped");
  }
  for (const Sensitivity& s : sensitivities(findings))
    fmt::print("{:<24}{:>12.4g} {}/deg, range {:.2f} % of its mean\n", s.quantity, s.per_degree, s.unit,
               100.0 * s.range);
  for (const std::string& note : findings.notes) fmt::print("{}\n", note);
}

}  // namespace

std::vector<Sensitivity> sensitivities(const OrientationFindings& findings) {
  std::vector<double> angle, force, shear, draw_in, sample_angle, mu;
  for (const OrientedBlank& blank : stamped(findings)) {
    angle.push_back(degrees * blank.angle);
    force.push_back(blank.result.summary.peak_punch_force);
    shear.push_back(degrees * blank.result.summary.shear_angle_max);
    draw_in.push_back(1e3 * blank.result.summary.draw_in_max);
  }
  for (const FrictionTestRow& sample : findings.samples) {
    sample_angle.push_back(degrees * sample.orientation);
    mu.push_back(sample.friction_coefficient);
  }
  return {sensitivity_of("Peak punch force", "N", angle, force),
          sensitivity_of("Largest shear angle", "deg", angle, shear),
          sensitivity_of("Largest draw-in", "mm", angle, draw_in),
          sensitivity_of("Friction coefficient", "", sample_angle, mu)};
}

std::string orientation_table_csv(const std::vector<OrientedBlank>& blanks) {
  std::string out =
      "case,orientation_deg,completed,peak_punch_force_N,shear_angle_max_deg,draw_in_max_mm,draw_in_0_deg_mm,"
      "draw_in_45_deg_mm,draw_in_90_deg_mm,draw_in_135_deg_mm,draw_in_180_deg_mm,draw_in_225_deg_mm,"
      "draw_in_270_deg_mm,draw_in_315_deg_mm,energy_residual_max,force_balance_residual_max,nodes,steps,"
      "rejected_steps,newton_iterations\n";
  for (const OrientedBlank& blank : blanks) {
    const auto& s = blank.result.summary;
    out += fmt::format("{},{},{},{},{},{}", blank.id, angle_text(blank.angle), s.completed ? 1 : 0,
                       shortest(s.peak_punch_force), shortest(degrees * s.shear_angle_max),
                       shortest(1e3 * s.draw_in_max));
    for (const double draw_in : s.draw_in_rays) out += "," + shortest(1e3 * draw_in);
    out += fmt::format(",{},{},{},{},{},{}\n", shortest(s.energy_residual_max),
                       shortest(s.force_balance_residual_max), s.nodes, s.steps, s.rejected_steps,
                       s.newton_iterations);
  }
  return out;
}

std::string orientation_html(const OrientationFindings& findings) {
  std::string out = page_head(findings.name);
  out += fmt::format(
      "<header>\n<p class=\"kind\">heddle · Orientation study</p>\n<h1>{}</h1>\n<p "
      "class=\"lead\">{}</p>\n</header>\n",
      escape(findings.name), escape(findings.description));
  out += "<section>\n<h2>What orientation changes</h2>\n" + sensitivity_table(sensitivities(findings)) +
         "</section>\n";
  if (!findings.blanks.empty()) {
    out +=
        "<section>\n<h2>The formed blanks</h2>\n<p>Each from above, coloured by the size of its shear angle "
        "on "
        "one scale; white lines follow tows, the dashed line is the flat blank. The tows shear where they "
        "run at "
        "45° to the radius, so the four lobes turn with the tows while the outline stays.</p>\n" +
        pictures(findings) + "</section>\n<section>\n<h2>Force and draw-in</h2>\n<div class=\"pair\">\n" +
        figure(force_chart_of(findings.blanks), "Punch force over the stroke, one line an orientation.") +
        figure(
            edge_chart_of(findings.blanks),
            "Draw-in at the end of the stroke, around the edge of the blank. Corners, which have no inward "
            "direction, are left out.") +
        "</div>\n" + blank_table(findings.blanks) + "</section>\n";
  }
  if (!findings.samples.empty())
    out += "<section>\n<h2>Friction samples</h2>\n" + sample_table(findings.samples) + "</section>\n";
  out += "<section>\n<h2>What it rests on</h2>\n" + list(findings.notes) + "</section>\n";
  return out + page_foot(
                   "Written by heddle. Numbers: table.csv, friction/friction_test.csv and cases/ in the same "
                   "folder.");
}

int run_orientation_study(const RunOptions& options, Case a_case) {
  const Cache known(options.cache,
                    [](const std::string&) {});  // what is wrong with it is said when it is used
  const auto& angles = a_case.orientation_study->blanks;
  const bool all_known = std::all_of(angles.begin(), angles.end(), [&](double angle) {
    const auto found = known.find(key_of(a_case, angle), read_stamping_record);
    return found && found->complete();
  });
  if (!all_known) load_tools(a_case);
  RunFolder folder(a_case, output_folder(options, a_case.name), options.force);
  const Cache cache(options.cache, [&](const std::string& line) { folder.log(line); });
  const InterruptGuard guard;
  const auto cell =
      folder.stage("mesoscale", [&](bool&) { return analyse_cell(*a_case.cell, a_case.fabric); });
  folder.write("mesoscale/fabric.json", fabric_json(cell.fabric, in_words(a_case.fabric)));
  const FrictionStage friction =
      folder.stage("friction", [&](bool&) { return run_friction_stage(a_case, &cell.fabric); });

  OrientationFindings findings;
  findings.name = a_case.name;
  findings.description =
      fmt::format("A {} blank of {} weave cut with its warp at {} angles to x, stamped {:g} mm deep.",
                  blank_in_words(a_case.stamping->blank), a_case.cell->weave.pattern,
                  a_case.orientation_study->blanks.size(), 1e3 * a_case.stamping->process.stroke);
  for (const double angle : a_case.orientation_study->blanks) {
    findings.blanks.push_back(
        stamp(a_case, angle, cell.fabric, friction.model, folder, cache, options.quiet));
    if (findings.blanks.back().result.summary.stopped) {
      folder.write_log();
      std::cerr << fmt::format(
          "heddle: interrupted at the blank of {} deg; the same command goes on with it: {} of {} blanks {} "
          "in "
          "the cache\n",
          angle_text(angle), findings.blanks.size() - 1, angles.size(),
          options.cache.empty() ? "would be" : "are");
      return exit_failed;
    }
    folder.write("table.csv", orientation_table_csv(findings.blanks));
  }
  folder.stage("friction_samples", [&](bool&) {
    for (const double angle : a_case.orientation_study->friction)
      findings.samples.push_back(pull(a_case, angle, cell.fabric, friction.model));
    return 0;
  });
  folder.write("friction/friction_test.csv", friction_test_csv(findings.samples));
  findings.notes.push_back(note_on_friction(friction.model));
  findings.notes.push_back(
      fmt::format("Node spacing is at most {:g} mm here: angles compare with one another; the shipped case "
                  "gives the force "
                  "itself at 4.5 mm.",
                  1e3 * a_case.stamping->blank.spacing));
  findings.notes.insert(findings.notes.end(), friction.notes.begin(), friction.notes.end());
  findings.notes.insert(findings.notes.end(), a_case.notes.begin(), a_case.notes.end());
  folder.write("report.html", orientation_html(findings));
  folder.close(a_case, {{"study", case_hash(a_case)}});

  print(findings);
  fmt::print("results                 {}\n", folder.path().string());
  int code = exit_done;
  for (const OrientedBlank& blank : findings.blanks)
    if (!blank.result.summary.completed) {
      std::cerr << fmt::format("heddle: the blank at {} deg stopped: {}\n  cases/{} holds what it reached.\n",
                               angle_text(blank.angle), blank.result.summary.failure, blank.id);
      code = exit_failed;
    }
  return code;
}

}  // namespace heddle::pipeline
