#include "pipeline/stamping_study.h"

#include <algorithm>
#include <cmath>
#include <iostream>

#include <fmt/format.h>

#include "core/csv.h"
#include "core/hdf5_file.h"
#include "core/units.h"
#include "macroscale/whole_blank.h"
#include "pipeline/painter.h"
#include "pipeline/run_folder.h"
#include "pipeline/stage_keys.h"
#include "pipeline/stages.h"
#include "pipeline/stamping_record.h"

namespace heddle::pipeline {

namespace {

namespace fs = std::filesystem;

const std::string given = "given";

// ---- which stampings

std::string number_in_id(double value) {
  std::string text = shortest(value);
  std::replace(text.begin(), text.end(), '.', 'p');
  std::erase(text, '+');
  return text;
}

struct PlannedStamping {
  StudiedStamping of;
  std::vector<std::string> assignments;
};

// Every model at every speed, then the case as given at every binder force; none twice.
std::vector<PlannedStamping> plan(const StampingStudySpec& spec, const Case& a_case,
                                  const std::vector<std::string>& assignments) {
  const macroscale::ProcessSpec& process = a_case.stamping->process;
  std::vector<PlannedStamping> all;
  const auto add = [&](const StudyModel& model, double binder_force, double speed_scale) {
    const std::string id =
        fmt::format("{}_{}N_{}V", model.name, number_in_id(binder_force), number_in_id(speed_scale));
    if (std::any_of(all.begin(), all.end(), [&](const PlannedStamping& p) { return p.of.id == id; })) return;
    PlannedStamping planned{{id, model.name, binder_force, speed_scale}, assignments};
    planned.assignments.insert(planned.assignments.end(), model.assignments.begin(), model.assignments.end());
    planned.assignments.push_back("process.binder_force=" + write_quantity(binder_force, "N"));
    planned.assignments.push_back("process.punch.speed_scale=" + write_quantity(speed_scale, ""));
    all.push_back(std::move(planned));
  };
  const std::vector<double> own_speed{process.speed_scale};
  for (const StudyModel& model : spec.models)
    for (const double scale : spec.speed_scales.empty() ? own_speed : spec.speed_scales)
      add(model, process.binder_force, scale);
  for (const double force : spec.binder_forces) add(spec.models.front(), force, process.speed_scale);
  if (!spec.variations.empty()) add(spec.models.front(), process.binder_force, process.speed_scale);
  for (std::size_t k = 0; k < spec.variations.size(); ++k)
    for (const std::vector<std::string>& values : combinations(spec.variations[k])) {
      PlannedStamping planned{{id_of(spec.variations[k], values), given}, assignments};
      planned.of.variation = static_cast<int>(k);
      for (std::size_t i = 0; i < values.size(); ++i)
        planned.assignments.push_back(spec.variations[k][i].key + "=" + values[i]);
      all.push_back(std::move(planned));
    }
  return all;
}

// What a stamping of the study has for the keys that vary, and for those that every study does.
void take_values(StudiedStamping& stamping, const Case& a_case, const std::vector<std::string>& keys) {
  for (const std::string& key : keys) {
    const Setting* setting = a_case.settings.find(key);
    stamping.values.push_back(setting ? resolved_value(*setting) : "");
  }
  stamping.binder_force = a_case.stamping->process.binder_force;
  stamping.speed_scale = a_case.stamping->process.speed_scale;
}

// Before anything runs: a wrong key of the last model must not cost the stampings of the others.
void demand_readable(const RunOptions& options, const std::vector<std::string>& keys,
                     std::vector<PlannedStamping>& all) {
  Problems problems;
  std::string last;
  for (PlannedStamping& planned : all) {
    if (keys.empty() && planned.of.model == last) continue;  // its keys are the same at every speed
    last = planned.of.model;
    try {
      take_values(planned.of, read_case(options.file, planned.assignments), keys);
    } catch (const InputError& error) {
      for (Problem problem : error.problems()) {
        if (problem.file.starts_with("--set"))
          problem.file = planned.of.variation < 0 ? "stamping_study.models, " + planned.of.model
                                                  : "stamping_study.vary, " + planned.of.id;
        problems.push_back(std::move(problem));
      }
    }
  }
  if (!problems.empty()) throw InputError(std::move(problems));
}

// ---- what they came to

std::vector<StudiedStep> steps_in(const fs::path& file) {
  std::vector<StudiedStep> steps;
  if (!fs::exists(file)) return steps;
  const CsvTable table = read_csv(file);
  const auto column = [&](const std::string& name) {
    const auto found = std::find(table.header.cells.begin(), table.header.cells.end(), name);
    if (found == table.header.cells.end())
      throw std::logic_error("history.csv has no column " + name);  // we wrote it
    return static_cast<std::size_t>(found - table.header.cells.begin());
  };
  const std::size_t stroke = column("punch_displacement_mm"), force = column("punch_force_N"),
                    shear = column("shear_angle_max_deg"), strain = column("tow_strain_max"),
                    draw_in = column("draw_in_max_mm"), work = column("work_punch_J"),
                    rate = column("dissipation_shear_rate_J");
  const std::array<std::size_t, 4> friction{column("friction_punch_J"), column("friction_die_J"),
                                            column("friction_binder_J"), column("friction_plies_J")};
  for (const CsvRow& row : table.rows) {
    const auto value = [&](std::size_t k) { return std::stod(row.cells[k]); };
    StudiedStep step{1e-3 * value(stroke),
                     value(force),
                     value(shear) / degrees,
                     value(strain),
                     1e-3 * value(draw_in),
                     value(work),
                     0.0,
                     value(rate)};
    for (const std::size_t k : friction) step.friction += value(k);
    steps.push_back(step);
  }
  return steps;
}

double result_of(const CaseRecord& record, const std::string& name, double otherwise = 0.0) {
  for (const auto& [key, value] : record.results)
    if (key == name) return value;
  return otherwise;
}

void take(StudiedStamping& stamping, const CaseRecord& record, const fs::path& folder) {
  stamping.status = record.status;
  stamping.message = record.message;
  if (record.status == CaseStatus::bad_input) return;
  stamping.steps = steps_in(folder / "cases" / stamping.id / "macroscale/history.csv");
  stamping.energy_residual_max = result_of(record, "macroscale.energy_residual_max");
  stamping.outside_calibration = result_of(record, "macroscale.friction_work_outside_calibration");
  stamping.force_balance_residual_max = result_of(record, "macroscale.force_balance_residual_max");
  stamping.grid_error = result_of(record, "macroscale.grid_error.punch_force_N", std::nan(""));
  const fs::path checkpoint = folder / "cases" / stamping.id / checkpoint_name;
  if (stamping.steps.empty() || !fs::exists(checkpoint)) return;
  const std::string bytes = read_file(checkpoint);
  const StampingRecord kept = read_stamping_record(Hdf5Reader(bytes));
  if (!kept.frames.empty()) {
    const macroscale::BlankState blank = macroscale::whole_of(kept.frames.back().blank).state;
    if (blank.punch_displacement > 0.0) stamping.shear = shear_place(blank, blank.punch_displacement);
  }
}

std::vector<const StudiedStamping*> done(const StampingStudyFindings& findings, const std::string& model) {
  std::vector<const StudiedStamping*> found;
  for (const StudiedStamping& stamping : findings.stampings)
    if (stamping.model == model && stamping.variation < 0 && stamping.status == CaseStatus::done &&
        stamping.peak())
      found.push_back(&stamping);
  return found;
}

// ---- files and lines

struct Column {
  std::string name;
  double (*value)(const StudiedStamping&, const StudiedStep&);
};

const std::vector<Column>& columns() {
  using S = StudiedStamping;
  using T = StudiedStep;
  static const std::vector<Column> all{
      {"peak_punch_force_N", [](const S&, const T& t) { return t.force; }},
      {"grid_error_punch_force_N", [](const S& s, const T&) { return s.grid_error; }},
      {"stroke_at_peak_mm", [](const S&, const T& t) { return 1e3 * t.stroke; }},
      {"shear_angle_max_deg", [](const S&, const T& t) { return degrees * t.shear; }},
      {"tow_strain_max", [](const S&, const T& t) { return t.tow_strain; }},
      {"draw_in_max_mm", [](const S&, const T& t) { return 1e3 * t.draw_in; }},
      {"work_punch_J", [](const S&, const T& t) { return t.work; }},
      {"work_friction_J", [](const S&, const T& t) { return t.friction; }},
      {"work_shear_rate_J", [](const S&, const T& t) { return t.shear_rate; }},
      {"energy_residual_max", [](const S& s, const T&) { return s.energy_residual_max; }},
      {"force_balance_residual_max", [](const S& s, const T&) { return s.force_balance_residual_max; }},
      {"friction_work_outside_calibration", [](const S& s, const T&) { return s.outside_calibration; }}};
  return all;
}

struct PlaceColumn {
  const char* name;
  double ShearPlace::*member;
  double factor;
};
// At the end of the stroke, not at the peak.
constexpr std::array place_columns{PlaceColumn{"shear_place_flat_radius_mm", &ShearPlace::flat_radius, 1e3},
                                   PlaceColumn{"shear_place_direction_deg", &ShearPlace::direction, degrees},
                                   PlaceColumn{"shear_place_radius_mm", &ShearPlace::radius, 1e3},
                                   PlaceColumn{"shear_place_depth_mm", &ShearPlace::depth, 1e3},
                                   PlaceColumn{"shear_deep_rms_deg", &ShearPlace::deep_rms, degrees},
                                   PlaceColumn{"shear_level_rms_deg", &ShearPlace::level_rms, degrees}};

std::string note_on_calibration(const StampingStudyFindings& findings) {
  double largest = 0.0;
  for (const StudiedStamping& stamping : findings.stampings)
    largest = std::max(largest, stamping.outside_calibration);
  return fmt::format(
      "Up to {:.0f} % of the friction work is done outside the box of the calibration, where the law is "
      "carried on along its last slope.",
      100.0 * largest);
}

void print(const StampingStudyFindings& findings) {
  fmt::print("{:<16}{:>10}{:>8}{:>11}{:>8}{:>11}{:>12}{:>11}{:>11}\n", "model", "binder N", "speed", "peak N",
             "grid N", "shear deg", "tow strain %", "friction J", "rate J");
  for (const StudiedStamping& s : findings.stampings) {
    const StudiedStep* peak = s.peak();
    if (!peak) continue;
    fmt::print("{:<16}{:>10.6g}{:>8.4g}{:>11.2f}{:>8}{:>11.2f}{:>12.4f}{:>11.3f}{:>11.3f}{}\n",
               s.variation < 0 ? s.model : s.id, s.binder_force, s.speed_scale, peak->force,
               significant_or_dash(s.grid_error, 2), degrees * peak->shear, 100.0 * peak->tow_strain,
               peak->friction, peak->shear_rate,
               s.status == CaseStatus::done ? "" : "  " + name_of(s.status));
  }
  for (const SpeedSignature& s : speed_signatures(findings)) {
    const auto ratio = s.ratio();
    fmt::print("{:<16} {:g}V to {:g}V {:+.2f} %, to {:g}V {:+.2f} %, signature {}\n", s.model, 0.5 * s.speed,
               s.speed, 100.0 * s.rise_low(), 2.0 * s.speed, 100.0 * s.rise_high(),
               ratio ? fmt::format("{:.2f}", *ratio) : "below noise");
  }
  if (const auto line = binder_line(findings))
    fmt::print("binder force     peak = {:.1f} N + {:.4f} of the force, R2 {:.5f}, farthest point {:.1f} %\n",
               line->intercept, line->slope, line->r_squared, 100.0 * line->largest_miss);
}

}  // namespace

const StudiedStep* StudiedStamping::peak() const {
  const auto found =
      std::max_element(steps.begin(), steps.end(),
                       [](const StudiedStep& a, const StudiedStep& b) { return a.force < b.force; });
  return found == steps.end() ? nullptr : &*found;
}

std::vector<const StudiedStamping*> over_speed(const StampingStudyFindings& findings,
                                               const std::string& model) {
  auto found = done(findings, model);
  std::erase_if(found, [&](const StudiedStamping* s) { return s->binder_force != findings.binder_force; });
  std::stable_sort(found.begin(), found.end(),
                   [](const auto* a, const auto* b) { return a->speed_scale < b->speed_scale; });
  return found;
}

std::vector<const StudiedStamping*> over_binder_force(const StampingStudyFindings& findings) {
  auto found = done(findings, given);
  std::erase_if(found, [&](const StudiedStamping* s) { return s->speed_scale != findings.speed_scale; });
  std::stable_sort(found.begin(), found.end(),
                   [](const auto* a, const auto* b) { return a->binder_force < b->binder_force; });
  return found;
}

std::vector<const StudiedStamping*> over_variation(const StampingStudyFindings& findings, int variation) {
  std::vector<const StudiedStamping*> found;
  for (const StudiedStamping& stamping : findings.stampings)
    if (stamping.variation == variation && stamping.status == CaseStatus::done && stamping.peak())
      found.push_back(&stamping);
  return found;
}

std::optional<double> SpeedSignature::ratio() const {
  if (std::abs(rise_low()) < noise || std::abs(rise_high()) < noise) return std::nullopt;
  return (force[2] - force[1]) / (force[1] - force[0]);
}

std::vector<SpeedSignature> speed_signatures(const StampingStudyFindings& findings) {
  std::vector<SpeedSignature> signatures;
  for (const StudyModel& model : findings.spec.models) {
    const auto runs = over_speed(findings, model.name);
    const auto at = [&](double scale) -> const StudiedStamping* {
      for (const StudiedStamping* run : runs)
        if (std::abs(run->speed_scale / scale - 1.0) < 1e-9) return run;
      return nullptr;
    };
    for (const StudiedStamping* middle : runs) {
      const StudiedStamping *slow = at(0.5 * middle->speed_scale), *fast = at(2.0 * middle->speed_scale);
      if (slow && fast)
        signatures.push_back({model.name,
                              middle->speed_scale,
                              {slow->peak()->force, middle->peak()->force, fast->peak()->force}});
    }
  }
  return signatures;
}

std::optional<BinderLine> binder_line(const StampingStudyFindings& findings) {
  const auto runs = over_binder_force(findings);
  if (runs.size() < 3) return std::nullopt;
  const double n = static_cast<double>(runs.size());
  double x = 0.0, y = 0.0, xx = 0.0, xy = 0.0, yy = 0.0;
  for (const auto* run : runs) x += run->binder_force / n, y += run->peak()->force / n;
  for (const auto* run : runs) {
    const double dx = run->binder_force - x, dy = run->peak()->force - y;
    xx += dx * dx, xy += dx * dy, yy += dy * dy;
  }
  BinderLine line;
  line.slope = xy / xx;
  line.intercept = y - line.slope * x;
  if (yy > 0.0) line.r_squared = xy * xy / (xx * yy);
  for (const auto* run : runs) {
    const double force = run->peak()->force;
    line.largest_miss = std::max(line.largest_miss,
                                 std::abs(line.intercept + line.slope * run->binder_force - force) / force);
  }
  return line;
}

std::string stamping_table_csv(const StampingStudyFindings& findings) {
  std::string out = "case,model,binder_force_N,speed_scale,status";
  for (const Column& column : columns()) out += "," + column.name;
  for (const PlaceColumn& column : place_columns) out += fmt::format(",{}", column.name);
  for (const std::string& key : findings.keys) out += "," + key;
  out += "\n";
  for (const StudiedStamping& s : findings.stampings) {
    out += fmt::format("{},{},{},{},{}", s.id, s.model, shortest(s.binder_force), shortest(s.speed_scale),
                       name_of(s.status));
    const StudiedStep* peak = s.peak();
    for (const Column& column : columns()) {
      const double value = peak ? column.value(s, *peak) : std::nan("");
      out += "," + (std::isnan(value) ? "" : shortest(value));
    }
    for (const PlaceColumn& column : place_columns)
      out += "," + (s.shear ? shortest(column.factor * (*s.shear).*column.member) : "");
    for (const std::string& value : s.values) out += "," + value;
    out += "\n";
  }
  return out;
}

std::string stamping_table_h5(const StampingStudyFindings& findings) {
  Hdf5Writer file;
  std::string ids, models, statuses;
  std::vector<double> force, scale;
  for (const StudiedStamping& s : findings.stampings) {
    ids += s.id + "\n";
    models += s.model + "\n";
    statuses += name_of(s.status) + "\n";
    force.push_back(s.binder_force);
    scale.push_back(s.speed_scale);
  }
  file.write("/keys/case", ids);
  file.write("/keys/model", models);
  file.write("/keys/binder_force_N", std::span<const double>(force));
  file.write("/keys/speed_scale", std::span<const double>(scale));
  file.write("/results/status", statuses);
  for (const Column& column : columns()) {
    std::vector<double> values;
    for (const StudiedStamping& s : findings.stampings) {
      const StudiedStep* peak = s.peak();
      values.push_back(peak ? column.value(s, *peak) : std::nan(""));
    }
    file.write("/results/" + column.name, std::span<const double>(values));
  }
  for (const PlaceColumn& column : place_columns) {
    std::vector<double> values;
    for (const StudiedStamping& s : findings.stampings)
      values.push_back(s.shear ? column.factor * (*s.shear).*column.member : std::nan(""));
    file.write(fmt::format("/results/{}", column.name), std::span<const double>(values));
  }
  for (std::size_t k = 0; k < findings.keys.size(); ++k) {
    std::string values;
    for (const StudiedStamping& s : findings.stampings) values += s.values[k] + "\n";
    file.write("/keys/" + findings.keys[k], values);
  }
  return file.finish();
}

int study_stampings(const RunOptions& options, const Case& a_case) {
  const StampingStudySpec spec = stamping_study_of(a_case.settings).value();
  std::vector<PlannedStamping> all = plan(spec, a_case, options.assignments);
  const std::vector<std::string> keys = varied_keys(spec);
  demand_readable(options, keys, all);
  const macroscale::ProcessSpec& process = a_case.stamping->process;
  RunFolder folder(a_case, output_folder(options, a_case.name), options.force);
  StampingStudyFindings findings{a_case.name,
                                 fmt::format("{} stampings of a {} blank, {:g} mm deep.", all.size(),
                                             blank_in_words(a_case.stamping->blank), 1e3 * process.stroke),
                                 spec,
                                 process.binder_force,
                                 process.speed_scale,
                                 {},
                                 {},
                                 keys};
  std::vector<ListedCase> list;
  for (const PlannedStamping& planned : all)
    list.push_back({planned.of.id, options.file, planned.assignments});
  const std::vector<CaseRecord> records = folder.stage("study", [&](bool& reused) {
    auto found = run_case_list(list, {.folder = folder.path(),
                                      .cache = options.cache,
                                      .threads = options.threads,
                                      .checkpoint_interval = options.checkpoint_interval,
                                      .quiet = options.quiet});
    reused = std::all_of(found.begin(), found.end(), [](const CaseRecord& r) { return r.run_before; });
    return found;
  });
  for (std::size_t k = 0; k < records.size(); ++k) {
    findings.stampings.push_back(all[k].of);
    take(findings.stampings.back(), records[k], folder.path());
  }
  if (records.back().status == CaseStatus::interrupted) {
    folder.write_log();
    std::cerr << fmt::format("heddle: interrupted in stamping {} of {}; the same command goes on there\n",
                             records.size(), all.size());
    return exit_failed;
  }
  findings.notes.push_back(note_on_calibration(findings));
  findings.notes.insert(findings.notes.end(), a_case.notes.begin(), a_case.notes.end());
  folder.write("table.csv", stamping_table_csv(findings));
  folder.write("table.h5", stamping_table_h5(findings));
  folder.write("report.html", stamping_study_html(findings));
  folder.close(a_case, {{"study", case_hash(a_case)}});
  if (options.print) {
    print(findings);
    fmt::print("results          {}\n", folder.path().string());
  }
  int code = exit_done;
  for (const StudiedStamping& s : findings.stampings)
    if (s.status != CaseStatus::done) {
      std::cerr << fmt::format("heddle: {} {}: {}\n  cases/{} holds what it reached.\n", s.id,
                               name_of(s.status), s.message, s.id);
      code = exit_failed;
    }
  return code;
}

}  // namespace heddle::pipeline
