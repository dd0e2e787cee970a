#include "pipeline/commands.h"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <memory>
#include <numbers>

#include <fmt/format.h>

#include "macroscale/advice.h"
#include "pipeline/cache.h"
#include "pipeline/case.h"
#include "pipeline/coupon_report.h"
#include "pipeline/export_vtu.h"
#include "pipeline/friction_rig_stage.h"
#include "pipeline/grid_error_stage.h"
#include "pipeline/indicator_outputs.h"
#include "pipeline/interrupt.h"
#include "pipeline/orientation.h"
#include "pipeline/report.h"
#include "pipeline/run_folder.h"
#include "pipeline/solid_stage.h"
#include "pipeline/solid_store.h"
#include "pipeline/stack_report.h"
#include "pipeline/stage_keys.h"
#include "pipeline/stage_store.h"
#include "pipeline/stages.h"
#include "pipeline/stamping_stage.h"
#include "pipeline/threads.h"

namespace heddle::pipeline {

namespace {

namespace fs = std::filesystem;

constexpr double degrees = 180.0 / std::numbers::pi;

/// What the stages of one run have found so far.
struct Findings {
  std::optional<mesoscale::CellResult> cell;
  std::optional<WeavePictures> pictures;
  std::optional<StackView> stack;
  std::optional<mesoscale::solid::SolidResult> solid;
  std::optional<FrictionStage> friction;
  std::optional<FrictionRigStage> friction_rig;
  std::optional<macroscale::StampingResult> stamping;
  std::optional<macroscale::GridError> grid_error;
  std::vector<macroscale::LargestIndicator> indicators;  ///< of the last state
};

std::vector<double> contact_pressures() {
  std::vector<double> p;
  for (int k = 0; k <= 24; ++k) p.push_back(1e3 * std::pow(10.0, k / 8.0));
  return p;
}

// One stage out of the cache, or run and put there.
template <class Result, class Read, class Work>
Result cached(RunFolder& folder, const Cache& cache, ChainStage stage, const Case& a_case, const Read& read,
              const Work& work) {
  return folder.stage(name_of(stage), [&](bool& reused) -> Result {
    const std::string key = inputs_of(stage, a_case).key();
    if (auto found = cache.find(key, read)) {
      reused = true;
      return std::move(*found);
    }
    Result result = work();
    cache.store(key, bytes_of(result, key));
    return result;
  });
}

void run_cell(const Case& a_case, RunFolder& folder, const Cache& cache, Findings& findings) {
  if (!a_case.cell) return;
  CellStage stage = cached<CellStage>(folder, cache, ChainStage::mesoscale, a_case, read_cell_stage, [&] {
    return CellStage{mesoscale::analyse(*a_case.cell), weave_pictures(*a_case.cell)};
  });
  findings.cell = std::move(stage.result);
  findings.pictures = std::move(stage.pictures);
  const mesoscale::FabricProperties& fabric = findings.cell->fabric;
  folder.write("mesoscale/fabric.json", fabric_json(fabric));
  folder.write("mesoscale/contact.csv",
               contact_csv(fabric.contact, contact_pressures(), fabric.contact.log_fraction.parameter()));
  folder.write("mesoscale/picture_frame.csv", picture_frame_csv(fabric));
  folder.write("mesoscale/bias_extension.csv", bias_extension_csv(fabric));
  folder.write("mesoscale/tows.stl", tows_stl(findings.pictures->tows));
  folder.write("mesoscale/cell.vti", vti(findings.pictures->voxels));
  if (a_case.cell->stack.plies > 1) {
    findings.stack = stack_view(*a_case.cell);
    folder.write("mesoscale/nesting.csv", nesting_csv(*findings.stack));
  }
  const auto& s = findings.cell->summary;
  folder.log(fmt::format(
      "mesoscale: {:.4f} kg/m2, crimp {:.4f} %, gap closure {:.3f} deg, contact fraction {:.3f} % at 0.05 mm",
      s.areal_density, 100.0 * s.crimp[0], degrees * s.gap_closure_angle, 100.0 * s.contact_area_fraction));
}

void run_solid(const Case& a_case, RunFolder& folder, const Cache& cache, Findings& findings) {
  if (!a_case.solid && !a_case.voxels) return;
  findings.solid = cached<mesoscale::solid::SolidResult>(
      folder, cache, ChainStage::solid, a_case, read_solid_result, [&] { return run_solid_stage(a_case); });
  folder.write("mesoscale/stiffness.json", stiffness_json(*findings.solid));
  if (!findings.solid->sheared.empty())
    folder.write("mesoscale/stiffness_by_shear.csv", sheared_csv(findings.solid->sheared));
}

void run_friction(const Case& a_case, RunFolder& folder, const Cache& cache, Findings& findings) {
  if (!a_case.friction) return;
  findings.friction = cached<FrictionStage>(
      folder, cache, ChainStage::friction, a_case, read_friction_stage,
      [&] { return run_friction_stage(a_case, findings.cell ? &findings.cell->fabric : nullptr); });
  if (!findings.friction->test.empty())
    folder.write("friction/friction_test.csv", friction_test_csv(findings.friction->test));
  folder.write("friction/curve.csv", curve_csv(findings.friction->curve));
  for (const std::string& note : findings.friction->notes) folder.log("friction: " + note);
}

// The friction test as a machine.
void run_friction_rig(const Case& a_case, RunFolder& folder, const Cache& cache, Findings& findings) {
  if (!a_case.friction_machine) return;
  findings.friction_rig =
      cached<FrictionRigStage>(folder, cache, ChainStage::friction_rig, a_case, read_friction_rig_stage, [&] {
        return run_friction_rig_stage(a_case, findings.friction->model,
                                      findings.cell ? &findings.cell->fabric : nullptr);
      });
  folder.write("friction/friction_rig.csv", friction_rig_csv(findings.friction_rig->rows));
  folder.write("friction/friction_history.csv", friction_history_csv(findings.friction_rig->history));
  for (const std::string& note : findings.friction_rig->notes) folder.log("friction rig: " + note);
}

void run_stamping(const Case& a_case, RunFolder& folder, const Cache& cache, Findings& findings,
                  StampingStageOptions options) {
  if (!a_case.stamping) return;
  findings.stamping = run_stamping_stage(*a_case.stamping, findings.cell->fabric, findings.friction->model,
                                         folder, cache, std::move(options));
  const macroscale::BlankState& blank = findings.stamping->final_state;
  findings.indicators = macroscale::largest(macroscale::indicators(blank, findings.cell->fabric), blank);
  if (findings.indicators.empty()) return;  // the binder never closed
  folder.write("macroscale/indicators.csv", indicators_csv(findings.indicators));
  folder.log(indicator_line(findings.indicators));
}

// The companion run on the coarser grid, of a stamping that came to its end.
void run_grid_error(const Case& a_case, const RunOptions& options, RunFolder& folder, const Cache& cache,
                    Findings& findings) {
  if (!a_case.grid_error || !findings.stamping || !findings.stamping->summary.completed) return;
  findings.grid_error = run_grid_error_stage(
      *a_case.stamping, findings.cell->fabric, findings.friction->model, *findings.stamping, folder, cache,
      inputs_of(ChainStage::grid_error, a_case).key(), InterruptGuard::interrupted, options.quiet);
}

std::string description_of(const Case& a_case) {
  if (a_case.voxels) return "The stiffness of one cell of voxels.";
  if (!a_case.stamping)
    return a_case.cell && !a_case.friction_machine ? "One unit cell of the weave." : "The friction test.";
  const auto& s = *a_case.stamping;
  const std::string punch = s.punch.file
                                ? "by the punch of " + s.punch.file->source.file.filename().string()
                                : fmt::format("into a hemisphere of {:.0f} mm radius", 1e3 * s.punch.radius);
  return fmt::format("A {} blank of {} weave stamped {:.0f} mm deep {} in {:.2f} s.", blank_in_words(s.blank),
                     a_case.cell->weave.pattern, 1e3 * s.process.stroke, punch,
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

/// The fabric as woven, and sheared to 30 degrees as at the side of a dome.
std::vector<mesoscale::TouchedFace> touched_faces(const mesoscale::CellSpec& spec,
                                                  const mesoscale::FabricProperties& fabric) {
  const mesoscale::FabricGeometry geometry = mesoscale::fabric_geometry(spec);
  const int tows = std::max(geometry.weave.warps, geometry.weave.wefts);
  std::vector<mesoscale::TouchedFace> faces;
  for (const double angle : {0.0, std::numbers::pi / 6.0})
    faces.push_back(mesoscale::touched_face(geometry, fabric.compaction, angle, std::min(24 * tows, 96)));
  return faces;
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
    input.tow_bodies = findings.pictures->bodies;
    // A stamping has enough to show.
    if (!findings.stamping) input.touched = touched_faces(*a_case.cell, findings.cell->fabric);
  }
  input.stack = findings.stack;
  input.solid = findings.solid;
  if (findings.friction) {
    input.friction_test = findings.friction->test;
    input.friction_curve = findings.friction->curve;
    input.notes = findings.friction->notes;
    input.film = findings.friction->model.conduction;
  }
  if (findings.friction_rig) {
    input.friction_rig = findings.friction_rig->rows;
    input.friction_history = findings.friction_rig->history;
    input.plates = findings.friction_rig->plates;
    input.notes.insert(input.notes.end(), findings.friction_rig->notes.begin(),
                       findings.friction_rig->notes.end());
  }
  if (findings.stamping) {
    input.stamping = findings.stamping->summary;
    input.history = findings.stamping->history;
    input.blank = findings.stamping->final_state;
    input.grid_error = findings.grid_error;
    input.artefact = a_case.stamping->artefact;
    input.warnings = indicator_warnings(
        findings.indicators,
        indicator_limits(*a_case.stamping, findings.cell->fabric, findings.stamping->summary.spacing));
  }
  input.notes.insert(input.notes.end(), a_case.notes.begin(), a_case.notes.end());
  return input;
}

// Hash of the inputs of each stage the case asks for.
std::vector<std::pair<std::string, std::string>> stage_hashes(const Case& a_case) {
  std::vector<std::pair<std::string, std::string>> hashes;
  const auto add = [&](ChainStage stage) {
    hashes.emplace_back(name_of(stage), inputs_of(stage, a_case).key());
  };
  if (a_case.cell) add(ChainStage::mesoscale);
  if (a_case.solid || a_case.voxels) add(ChainStage::solid);
  if (a_case.friction) add(ChainStage::friction);
  if (a_case.friction_machine) add(ChainStage::friction_rig);
  if (a_case.stamping) add(ChainStage::macroscale);
  if (a_case.grid_error) add(ChainStage::grid_error);
  return hashes;
}

void write_findings(const Case& a_case, RunFolder& folder, const Findings& findings) {
  SummaryRecord record;
  if (findings.cell) record.cell = findings.cell->summary;
  if (findings.pictures) record.tow_bodies = findings.pictures->bodies;
  if (findings.stack) record.stack = findings.stack->summary;
  if (findings.cell && a_case.stamping)
    record.contact_area_fraction_binder =
        findings.cell->fabric.contact.evaluate(mean_binder_pressure(*a_case.stamping), 0.0).fraction;
  if (findings.stamping) {
    record.stamping = findings.stamping->summary;
    record.grid_error = findings.grid_error;
    record.failure = findings.stamping->failure;
    if (record.failure)
      record.advice = macroscale::advice_for(*record.failure, *a_case.stamping, *record.stamping);
  }
  folder.write("summary.json", summary_json(record, findings.indicators));
  folder.write("report.html", report_html(report_input(a_case, findings)));
  folder.close(a_case, stage_hashes(a_case));
}

void print_cell(const mesoscale::CellSummary& s, const mesoscale::TowBodies& bodies) {
  fmt::print("areal density        {:.4f} kg/m^2\n", s.areal_density);
  fmt::print("crimp                {:.3f} % warp, {:.3f} % weft\n", 100.0 * s.crimp[0], 100.0 * s.crimp[1]);
  fmt::print("gap closure          {:.2f} deg\n", degrees * s.gap_closure_angle);
  fmt::print("locking              {:.1f} deg (shear tangent 10 times that at 20 deg)\n",
             degrees * s.locking_angle);
  fmt::print("contact fraction     {:.2f} % of one face at 0.05 mm\n", 100.0 * s.contact_area_fraction);
  fmt::print("tow fibre fraction   {:.3f}\n", s.tow_fibre_volume_fraction);
  fmt::print("thickness            {:.4f} mm: tows {:.3f}, glass {:.3f}, voids {:.3f} of the sheet\n",
             1e3 * s.thickness, s.tow_share, s.glass_share, std::max(s.void_share, 0.0));
  fmt::print("overlap of tows      {:.3g} mm deep, {:.3g} mm^3 a repeat\n",
             1e3 * std::max(bodies.height_depth, 0.0), 1e9 * bodies.height_volume);
  fmt::print(
      "tows as bodies       {:.2g} % off the closed volume, {:.2g} % of it in two tows ({:.3g} mm voxels)\n",
      100.0 * bodies.volume_error, 100.0 * bodies.overlap_share, 1e3 * bodies.voxel);
}

void print_stack(const mesoscale::StackSummary& s) {
  fmt::print(
      "stack of {} plies     {:.3f} mm nested, {:.3f} mm apart; tows {:.3f}, glass {:.3f}, voids {:.3f}\n",
      s.plies, 1e3 * s.thickness, 1e3 * s.apart, s.shares.tows, s.shares.glass,
      std::max(s.shares.voids, 0.0));
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

void print_friction_rig(const FrictionRigStage& stage) {
  fmt::print("{:<32}{:>9}{:>9}{:>9}{:>9}{:>11}\n", "pull as a machine", "law N", "steady N", "peak N",
             "lost N", "elements N");
  const auto force = [](const std::optional<double>& f) {
    return f ? fmt::format("{:.1f}", *f) : std::string("-");
  };
  for (const FrictionRigRow& row : stage.rows) {
    const auto lost =
        row.normal_force_loss ? std::optional(*row.normal_force_loss * row.normal_force) : std::nullopt;
    fmt::print("{:<32}{:>9.1f}{:>9}{:>9}{:>9}{:>11}\n", row.name, row.law_force, force(row.steady_force),
               force(row.peak_force), force(lost), force(row.element_force));
  }
  for (const std::string& note : stage.notes) fmt::print("{}\n", note);
}

void print_stamping(const macroscale::StampingSummary& s, const std::optional<macroscale::GridError>& grid) {
  const bool known = grid && grid->known;
  const macroscale::GridError e = grid.value_or(macroscale::GridError{});
  const auto error = [&](double value, const char* unit) {
    return known ? fmt::format(" (estimated grid error {:.2g} {})", value, unit) : std::string();
  };
  fmt::print("peak punch force     {:.1f} N{}\n", s.peak_punch_force, error(e.force, "N"));
  fmt::print("largest shear angle  {:.2f} deg{}\n", degrees * s.shear_angle_max,
             error(degrees * e.shear_angle, "deg"));
  fmt::print("largest draw-in      {:.2f} mm{}\n", 1e3 * s.draw_in_max, error(1e3 * e.draw_in, "mm"));
  if (grid && !known) fmt::print("grid error           not known: {}\n", grid->reason);
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

enum class Part { all, weave, friction };

Case read_part(const RunOptions& options, Part part) {
  Case a_case = read_case(options.file, options.assignments);
  if (part != Part::all) a_case.stamping.reset();
  if (part == Part::weave)
    a_case.friction.reset(), a_case.friction_test.reset(), a_case.friction_machine.reset();
  if (part == Part::friction) a_case.solid.reset();
  const bool empty = part == Part::weave      ? !a_case.cell && !a_case.voxels
                     : part == Part::friction ? !a_case.friction
                                              : false;
  if (empty)
    throw InputError({{"case.part"_rule, part == Part::weave ? "weave" : "friction", "",
                       "is missing, and this command needs it",
                       part == Part::weave ? "Add `weave:`; configs/unit_cell.yaml shows one."
                                           : "Add `friction:`; configs/friction_test.yaml shows one.",
                       options.file.string()}});
  return a_case;
}

void print_findings(const Case& a_case, const Findings& findings, Part part, const fs::path& folder) {
  if (findings.cell && part != Part::friction) print_cell(findings.cell->summary, findings.pictures->bodies);
  if (findings.stack && part != Part::friction) print_stack(findings.stack->summary);
  if (findings.solid && part != Part::friction) print_solid(*findings.solid);
  if (findings.friction && !findings.stamping) print_friction(*findings.friction);
  if (findings.friction_rig && !findings.stamping) print_friction_rig(*findings.friction_rig);
  if (findings.stamping) print_stamping(findings.stamping->summary, findings.grid_error);
  print_attention(report_input(a_case, findings));
  fmt::print("results              {}\n", folder.string());
}

// Whether a folder holds the finished results of exactly these inputs: the manifest is written last.
bool holds_all_of(const fs::path& folder, const Case& a_case) {
  for (const char* name : {"manifest.json", "summary.json", "report.html", "resolved.yaml"})
    if (!fs::is_regular_file(folder / name)) return false;
  if (read_file(folder / "resolved.yaml") != resolved_yaml(a_case.settings)) return false;
  const std::string manifest = read_file(folder / "manifest.json");
  for (const auto& [name, hash] : stage_hashes(a_case))
    if (manifest.find(hash) == std::string::npos) return false;
  return true;
}

// What --resume finds in the folder, said on standard error.
struct Resumption {
  Entry entry = Entry::fresh;
  std::optional<StampingRecord> record;
};

Resumption look_for_resumption(const RunOptions& options, const Case& a_case, const fs::path& folder) {
  Resumption found;
  const auto say = [](const std::string& text) { std::cerr << "heddle: " << text << '\n'; };
  if (!options.resume) {
    if (fs::exists(folder / checkpoint_name) && !fs::exists(folder / "manifest.json"))
      say(fmt::format(
          "{} holds a run that was interrupted. It starts from the beginning; --resume would have gone on.",
          folder.string()));
    return found;
  }
  if (a_case.stamping) found.record = checkpoint_in(folder, inputs_of(ChainStage::macroscale, a_case));
  const bool whole = !a_case.stamping || (found.record && found.record->complete());
  if (whole && holds_all_of(folder, a_case)) {
    found.entry = Entry::look;
    say(folder.string() + " is complete: there is nothing left to do");
  } else if (found.record) {
    found.entry = Entry::resume;
    say(fmt::format("going on from step {} of {}", found.record->at.step, found.record->steps));
  } else {
    say(folder.string() + " holds no checkpoint: the run starts from the beginning");
  }
  return found;
}

// A word as a shell takes it.
std::string shell_word(const std::string& word) {
  const std::string plain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-./=,:+%";
  if (!word.empty() && word.find_first_not_of(plain) == std::string::npos) return word;
  std::string quoted = "'";
  for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

std::string command_to_resume(const RunOptions& options) {
  std::string command = "heddle run " + shell_word(options.file.string());
  for (const std::string& assignment : options.assignments) command += " --set " + shell_word(assignment);
  if (!options.output.empty()) command += " -o " + shell_word(options.output.string());
  return command + " --resume";
}

RunEnding say_interrupted(const RunOptions& options, const RunFolder& folder, const Findings& findings,
                          int steps) {
  folder.write_log();
  std::string reason =
      "interrupted before the stamping had closed its binder; there is nothing to go on from";
  if (findings.stamping && fs::exists(folder.path() / checkpoint_name))
    reason = fmt::format("interrupted at step {} of {}", findings.stamping->summary.steps, steps);
  std::cerr << fmt::format("heddle: {}; {}: {}\n", reason,
                           findings.stamping ? "go on with" : "run it again, or", command_to_resume(options));
  return {exit_failed, true, reason};
}

// Whether the stamping need not run.
bool stamped_before(const RunOptions& options, const Case& a_case, const Resumption& resumption) {
  if (resumption.record && resumption.record->complete()) return true;
  const Cache cache(options.cache,
                    [](const std::string&) {});  // what is wrong with it is said when it is used
  const auto record = cache.find(inputs_of(ChainStage::macroscale, a_case).key(), read_stamping_record);
  return record && record->complete();
}

// Whether a stage is left to run that needs the tools: reading them takes seconds.
bool tools_are_needed(const RunOptions& options, const Case& a_case, const fs::path& folder,
                      const Resumption& resumption) {
  if (!a_case.stamping) return false;
  if (!stamped_before(options, a_case, resumption)) return true;
  const Cache cache(options.cache, [](const std::string&) {});
  return a_case.grid_error &&
         !known_grid_error(resumption.entry == Entry::fresh ? fs::path() : folder, cache,
                           inputs_of(ChainStage::grid_error, a_case).key());  // a fresh run clears its folder
}

RunEnding run_part(const RunOptions& options, Part part) {
  Case a_case = read_part(options, part);
  const auto threads = limit_threads(options.threads);
  if (part == Part::all && a_case.orientation_study)
    return {run_orientation_study(options, std::move(a_case)), false, ""};
  const fs::path path = output_folder(options, a_case.name);
  Resumption resumption = look_for_resumption(options, a_case, path);
  // Before the folder is touched: a tool that cannot be used must not cost what an earlier run left.
  if (tools_are_needed(options, a_case, path, resumption)) load_tools(a_case);
  RunFolder folder(a_case, path, options.force, resumption.entry);
  const Cache cache(options.cache, [&](const std::string& line) { folder.log(line); });
  const InterruptGuard guard;
  Findings findings;
  for (const std::string& note : a_case.notes) folder.log("note: " + note);
  const int steps = a_case.stamping ? a_case.stamping->process.steps : 0;
  const auto interrupted_before_stamping = [&] { return a_case.stamping && InterruptGuard::interrupted(); };
  run_cell(a_case, folder, cache, findings);
  run_solid(a_case, folder, cache, findings);
  if (interrupted_before_stamping()) return say_interrupted(options, folder, findings, steps);
  run_friction(a_case, folder, cache, findings);
  run_friction_rig(a_case, folder, cache, findings);
  if (interrupted_before_stamping()) return say_interrupted(options, folder, findings, steps);
  if (a_case.stamping)
    run_stamping(a_case, folder, cache, findings,
                 {.inputs = inputs_of(ChainStage::macroscale, a_case),
                  .resume = std::move(resumption.record),
                  .checkpoint_interval = options.checkpoint_interval,
                  .stop = InterruptGuard::interrupted,
                  .quiet = options.quiet});
  run_grid_error(a_case, options, folder, cache, findings);
  const bool stopped_late = findings.grid_error && InterruptGuard::interrupted();
  if (findings.stamping && (findings.stamping->summary.stopped || stopped_late))
    return say_interrupted(options, folder, findings, steps);
  write_findings(a_case, folder, findings);

  if (options.print) print_findings(a_case, findings, part, folder.path());
  if (!findings.stamping || findings.stamping->summary.completed) return {};
  std::cerr << fmt::format(
      "heddle: stamping stopped: {}\n  {} holds the history, the last state (macroscale/blank_last.vtu), the "
      "attempt that failed (blank_failed.vtu, and `failure` in summary.json) and the report so far.\n  {}\n",
      findings.stamping->summary.failure, folder.path().string(),
      macroscale::advice_for(findings.stamping->failure.value(), *a_case.stamping,
                             findings.stamping->summary));
  return {exit_failed, false, findings.stamping->summary.failure};
}

}  // namespace

fs::path output_folder(const RunOptions& options, const std::string& name) {
  return options.output.empty() ? fs::path("out") / name : options.output;
}

RunEnding run_chain(const RunOptions& options) {
  return run_part(options, Part::all);
}
int run_case(const RunOptions& options) {
  return run_part(options, Part::all).exit_code;
}
int weave_case(const RunOptions& options) {
  return run_part(options, Part::weave).exit_code;
}
int friction_case(const RunOptions& options) {
  return run_part(options, Part::friction).exit_code;
}

}  // namespace heddle::pipeline
