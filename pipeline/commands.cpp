#include "pipeline/commands.h"

#include <cmath>
#include <iostream>
#include <memory>
#include <numbers>

#include <fmt/format.h>
#include <tbb/global_control.h>

#include "core/progress.h"
#include "pipeline/case.h"
#include "pipeline/export_vtu.h"
#include "pipeline/orientation.h"
#include "pipeline/report.h"
#include "pipeline/run_folder.h"
#include "pipeline/stages.h"

namespace heddle::pipeline {

namespace {

namespace fs = std::filesystem;

constexpr double degrees = 180.0 / std::numbers::pi;
constexpr int frames = 20;  // of the blank, over the stroke

/// What the stages of one run have found so far.
struct Findings {
  std::optional<mesoscale::CellResult> cell;
  std::optional<WeavePictures> pictures;
  std::optional<FrictionStage> friction;
  std::optional<macroscale::StampingResult> stamping;
};

fs::path output_folder(const RunOptions& options, const Case& a_case) {
  return options.output.empty() ? fs::path("out") / a_case.name : options.output;
}

std::unique_ptr<tbb::global_control> limit_threads(int threads) {
  if (threads <= 0) return nullptr;
  return std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism, threads);
}

void refuse_resume(const RunOptions& options) {
  if (options.resume)
    throw InputError(
        {{"run.resume", "--resume", "", "is not in this version", "Run the case again without it."}});
}

std::vector<double> contact_pressures() {
  std::vector<double> p;
  for (int k = 0; k <= 24; ++k) p.push_back(1e3 * std::pow(10.0, k / 8.0));
  return p;
}

void run_cell(const Case& a_case, RunFolder& folder, Findings& findings) {
  if (!a_case.cell) return;
  findings.cell = folder.stage("mesoscale", [&] { return mesoscale::analyse(*a_case.cell); });
  findings.pictures = weave_pictures(*a_case.cell);
  const mesoscale::FabricProperties& fabric = findings.cell->fabric;
  folder.write("mesoscale/fabric.json", fabric_json(fabric));
  folder.write("mesoscale/contact.csv",
               contact_csv(fabric.contact, contact_pressures(), fabric.contact.log_fraction.parameter()));
  folder.write("mesoscale/tows.stl", tows_stl(findings.pictures->tows));
  const auto& s = findings.cell->summary;
  folder.log(fmt::format(
      "mesoscale: {:.4f} kg/m2, crimp {:.4f} %, gap closure {:.3f} deg, contact fraction {:.3f} % at 0.05 mm",
      s.areal_density, 100.0 * s.crimp[0], degrees * s.gap_closure_angle, 100.0 * s.contact_area_fraction));
}

void run_friction(const Case& a_case, RunFolder& folder, Findings& findings) {
  if (!a_case.friction) return;
  findings.friction = folder.stage("friction", [&] {
    return run_friction_stage(a_case, findings.cell ? &findings.cell->fabric : nullptr);
  });
  if (!findings.friction->test.empty())
    folder.write("friction/friction_test.csv", friction_test_csv(findings.friction->test));
  folder.write("friction/curve.csv", curve_csv(findings.friction->curve));
  for (const std::string& note : findings.friction->notes) folder.log("friction: " + note);
}

// Writes frames of the blank and the history as the run goes: what ends it, they are there.
class BlankSeries {
 public:
  BlankSeries(const RunFolder& folder, int steps)
      : folder_(folder), every_(std::max(1, steps / frames)), steps_(steps) {}

  void add(int step, const macroscale::HistoryRow& row, const macroscale::BlankState& blank) {
    if (step > 0) history_.push_back(row);
    if (step % every_ != 0 && step != steps_) return;
    folder_.write("macroscale/history.csv", history_csv(history_));
    const std::string name = fmt::format("blank_{:04d}.vtu", step);
    folder_.write("macroscale/" + name, vtu(mesh_of(blank)));
    series_.push_back({blank.time, name});
    folder_.write("macroscale/blank.pvd", pvd(series_));
  }

 private:
  const RunFolder& folder_;
  int every_, steps_;
  std::vector<SeriesFrame> series_;
  std::vector<macroscale::HistoryRow> history_;
};

void run_stamping(const Case& a_case, RunFolder& folder, Findings& findings, bool quiet) {
  if (!a_case.stamping) return;
  const int steps = a_case.stamping->process.steps;
  Progress progress("stamping", steps, progress_style_of_standard_error(quiet), std::cerr);
  BlankSeries series(folder, steps);
  const auto observe = [&](int step, int, const macroscale::HistoryRow& row,
                           const macroscale::BlankState& blank) {
    series.add(step, row, blank);
    const std::string note =
        fmt::format("punch {:.1f} mm, {:.0f} N", 1e3 * row.punch_displacement, row.punch_force);
    progress.update(step, note);
    folder.log(fmt::format("stamping: step {}: {}, {} Newton iterations", step, note, row.newton_iterations));
  };
  findings.stamping = folder.stage("macroscale", [&] {
    return macroscale::run_stamping(*a_case.stamping, findings.cell->fabric, findings.friction->model,
                                    observe);
  });
  progress.finish();
  folder.write("macroscale/history.csv", history_csv(findings.stamping->history));
  if (!findings.stamping->summary.completed) {
    folder.write("macroscale/blank_last.vtu", vtu(mesh_of(findings.stamping->final_state)));
    folder.log("stamping stopped: " + findings.stamping->summary.failure);
  }
}

std::string description_of(const Case& a_case) {
  if (!a_case.stamping) return a_case.cell ? "One unit cell of the weave." : "The friction test.";
  const auto& s = *a_case.stamping;
  return fmt::format(
      "A {} blank of {} weave stamped {:.0f} mm deep into a hemisphere of {:.0f} mm radius "
      "in {:.2f} s.",
      blank_in_words(s.blank), a_case.cell->weave.pattern, 1e3 * s.process.stroke, 1e3 * s.punch.radius,
      s.process.time / s.process.speed_scale);
}

std::vector<Condition> conditions_of(const Case& a_case) {
  if (!a_case.stamping) return {};
  const auto& s = *a_case.stamping;
  return {
      {"Binder force", fmt::format("{:g} N", s.process.binder_force)},
      {"Tool temperature", fmt::format("{:g} degC", s.process.tool_temperature - 273.15)},
      {"Blank temperature", fmt::format("{:g} degC", s.process.blank_temperature - 273.15)},
      {"Stroke",
       fmt::format("{:g} mm in {:g} s", 1e3 * s.process.stroke, s.process.time / s.process.speed_scale)},
      {"Blank", fmt::format("{}, warp at {:g} deg", blank_in_words(s.blank), degrees * s.blank.orientation)},
      {"Steps", fmt::format("{} of equal stroke", s.process.steps)}};
}

HeightField report_height(const mesoscale::HeightField& h) {
  HeightField field;
  field.nx = field.ny = h.n;
  field.spacing_x = std::hypot(h.along_warp[0], h.along_warp[1]) / h.n;
  field.spacing_y = std::hypot(h.along_weft[0], h.along_weft[1]) / h.n;
  field.height = h.top;
  return field;
}

std::vector<SectionLine> report_section(const std::vector<mesoscale::Outline>& outlines) {
  std::vector<SectionLine> lines;
  for (const auto& outline : outlines)
    lines.push_back({outline.tow == mesoscale::TowDirection::warp ? SectionKind::warp : SectionKind::weft,
                     outline.points});
  return lines;
}

ReportInput report_input(const Case& a_case, const Findings& findings) {
  ReportInput input;
  input.name = a_case.name;
  input.description = description_of(a_case);
  input.conditions = conditions_of(a_case);
  if (findings.cell) {
    input.cell = findings.cell->summary;
    input.fabric = findings.cell->fabric;
    input.height = report_height(findings.pictures->height);
    input.section = report_section(findings.pictures->section);
  }
  if (findings.friction) {
    input.friction_test = findings.friction->test;
    input.friction_curve = findings.friction->curve;
    input.notes = findings.friction->notes;
  }
  if (findings.stamping) {
    input.stamping = findings.stamping->summary;
    input.history = findings.stamping->history;
    input.blank = findings.stamping->final_state;
    input.artefact = a_case.stamping->artefact;
  }
  input.notes.insert(input.notes.end(), a_case.notes.begin(), a_case.notes.end());
  return input;
}

void write_findings(const Case& a_case, RunFolder& folder, const Findings& findings) {
  SummaryRecord record;
  if (findings.cell) record.cell = findings.cell->summary;
  if (findings.cell && a_case.stamping)
    record.contact_area_fraction_binder =
        findings.cell->fabric.contact.evaluate(mean_binder_pressure(*a_case.stamping), 0.0).fraction;
  if (findings.stamping) record.stamping = findings.stamping->summary;
  folder.write("summary.json", summary_json(record));
  folder.write("report.html", report_html(report_input(a_case, findings)));
  folder.close(a_case);
}

void print_cell(const mesoscale::CellSummary& s) {
  fmt::print("areal density        {:.4f} kg/m^2\n", s.areal_density);
  fmt::print("crimp                {:.3f} % warp, {:.3f} % weft\n", 100.0 * s.crimp[0], 100.0 * s.crimp[1]);
  fmt::print("gap closure          {:.2f} deg\n", degrees * s.gap_closure_angle);
  fmt::print("locking              {:.1f} deg (shear tangent 10 times that at 20 deg)\n",
             degrees * s.locking_angle);
  fmt::print("contact fraction     {:.2f} % of one face at 0.05 mm\n", 100.0 * s.contact_area_fraction);
  fmt::print("tow fibre fraction   {:.3f}\n", s.tow_fibre_volume_fraction);
}

void print_friction(const FrictionStage& stage) {
  fmt::print("{:<24}{:>9}{:>12}{:>11}{:>9}{:>12}{:>9}\n", "pull", "mu", "force N", "measured", "error",
             "paper", "error");
  const auto percent = [](const std::optional<double>& e) {
    return e ? fmt::format("{:+.1f} %", 100.0 * *e) : std::string();
  };
  const auto force = [](const std::optional<double>& f) {
    return f ? fmt::format("{:.0f}", *f) : std::string();
  };
  double square = 0.0, paper_square = 0.0;
  int measured = 0, of_paper = 0;
  for (const FrictionTestRow& row : stage.test) {
    const auto error = error_of_model(row), paper = error_of_paper(row);
    fmt::print("{:<24}{:>9.4f}{:>12.1f}{:>11}{:>9}{:>12}{:>9}\n", row.name, row.friction_coefficient,
               row.pull_force, force(row.measured_force), percent(error), force(row.paper_force),
               percent(paper));
    if (error) square += *error * *error, ++measured;
    if (paper) paper_square += *paper * *paper, ++of_paper;
  }
  if (measured > 0) fmt::print("RMS error {:.2f} %", 100.0 * std::sqrt(square / measured));
  if (of_paper > 0)
    fmt::print(", the paper's own model {:.2f} %", 100.0 * std::sqrt(paper_square / of_paper));
  if (measured > 0) fmt::print("\n");
  for (const std::string& note : stage.notes) fmt::print("{}\n", note);
}

void print_stamping(const macroscale::StampingSummary& s) {
  fmt::print("peak punch force     {:.1f} N\n", s.peak_punch_force);
  fmt::print("largest shear angle  {:.2f} deg\n", degrees * s.shear_angle_max);
  fmt::print("largest draw-in      {:.2f} mm\n", 1e3 * s.draw_in_max);
  fmt::print("energy residual      {:.2e} of the punch work\n", s.energy_residual_max);
  fmt::print("force balance        {:.2e} of the punch force\n", s.force_balance_residual_max);
  fmt::print("steps                {} ({} tried again with half the step), {} Newton iterations, {} nodes\n",
             s.steps, s.rejected_steps, s.newton_iterations, s.nodes);
}

// What the report says that a reader of the terminal must not miss.
void print_attention(const ReportInput& input) {
  for (const Verdict& verdict : verdicts(input))
    if (verdict.tone == Tone::attention || verdict.tone == Tone::fails)
      fmt::print("attention            {}\n", verdict.text);
}

// Advice that fits where it stopped.
std::string advice_for(const macroscale::StampingSummary& summary, int steps) {
  if (summary.steps == 0)
    return "The binder did not close or the first step failed: check binder_force, the tools and the blank's "
           "spacing.";
  return fmt::format("Try smaller steps (--set process.steps={}), or look at the last state for a fold.",
                     2 * steps);
}

enum class Part { all, weave, friction };

Case read_part(const RunOptions& options, Part part) {
  Case a_case = read_case(options.file, options.assignments);
  if (part != Part::all) a_case.stamping.reset();
  if (part == Part::weave) a_case.friction.reset(), a_case.friction_test.reset();
  const bool empty = part == Part::weave ? !a_case.cell : part == Part::friction ? !a_case.friction : false;
  if (empty)
    throw InputError({{"case.part", part == Part::weave ? "weave" : "friction", "",
                       "is missing, and this command needs it",
                       part == Part::weave ? "Add `weave:`; configs/unit_cell.yaml shows one."
                                           : "Add `friction:`; configs/friction_test.yaml shows one.",
                       options.file.string()}});
  return a_case;
}

int run_part(const RunOptions& options, Part part) {
  refuse_resume(options);
  const Case a_case = read_part(options, part);
  const auto threads = limit_threads(options.threads);
  if (part == Part::all && a_case.orientation_study) return run_orientation_study(options, a_case);
  RunFolder folder(a_case, output_folder(options, a_case), options.force);
  Findings findings;
  for (const std::string& note : a_case.notes) folder.log("note: " + note);
  run_cell(a_case, folder, findings);
  run_friction(a_case, folder, findings);
  run_stamping(a_case, folder, findings, options.quiet);
  write_findings(a_case, folder, findings);

  if (findings.cell && part != Part::friction) print_cell(findings.cell->summary);
  if (findings.friction && !findings.stamping) print_friction(*findings.friction);
  if (findings.stamping) print_stamping(findings.stamping->summary);
  print_attention(report_input(a_case, findings));
  fmt::print("results              {}\n", folder.path().string());
  if (!findings.stamping || findings.stamping->summary.completed) return exit_done;
  std::cerr << fmt::format(
      "heddle: stamping stopped: {}\n  {} holds the history, the last state (macroscale/blank_last.vtu) and "
      "the report so far.\n  {}\n",
      findings.stamping->summary.failure, folder.path().string(),
      advice_for(findings.stamping->summary, a_case.stamping->process.steps));
  return exit_failed;
}

}  // namespace

int run_case(const RunOptions& options) {
  return run_part(options, Part::all);
}
int weave_case(const RunOptions& options) {
  return run_part(options, Part::weave);
}
int friction_case(const RunOptions& options) {
  return run_part(options, Part::friction);
}

}  // namespace heddle::pipeline
