#include "pipeline/commands.h"

#include <cmath>
#include <iostream>

#include <fmt/format.h>

#include "core/units.h"
#include "macroscale/advice.h"
#include "macroscale/punch_profile.h"
#include "pipeline/cache.h"
#include "pipeline/case.h"
#include "pipeline/coupon_report.h"
#include "pipeline/findings.h"
#include "pipeline/friction_rig_stage.h"
#include "pipeline/grid_error_stage.h"
#include "pipeline/indicator_outputs.h"
#include "pipeline/interrupt.h"
#include "pipeline/orientation.h"
#include "pipeline/part_stiffness.h"
#include "pipeline/resumption.h"
#include "pipeline/run_folder.h"
#include "pipeline/solid_stage.h"
#include "pipeline/solid_store.h"
#include "pipeline/stack_report.h"
#include "pipeline/stage_keys.h"
#include "pipeline/stage_store.h"
#include "pipeline/stages.h"
#include "pipeline/stamping_stage.h"
#include "pipeline/threads.h"
#include "pipeline/voxel_export.h"

namespace heddle::pipeline {

namespace {

namespace fs = std::filesystem;

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
    return CellStage{analyse_cell(*a_case.cell, a_case.fabric), weave_pictures(*a_case.cell)};
  });
  findings.cell = std::move(stage.result);
  findings.pictures = std::move(stage.pictures);
  const mesoscale::FabricProperties& fabric = findings.cell->fabric;
  folder.write("mesoscale/fabric.json", fabric_json(fabric, in_words(a_case.fabric)));
  folder.write("mesoscale/contact.csv",
               contact_csv(fabric.contact, contact_pressures(), fabric.contact.log_fraction.parameter()));
  if (!fabric.facing.empty()) folder.write("mesoscale/ply_facing.csv", ply_facing_csv(fabric.facing));
  if (!fabric.contact.drag.empty())
    folder.write("mesoscale/drag_direction.csv", drag_direction_csv(fabric.contact.drag));
  folder.write("mesoscale/picture_frame.csv", picture_frame_csv(fabric));
  folder.write("mesoscale/bias_extension.csv", bias_extension_csv(fabric));
  const CellBodies bodies = cell_bodies(*a_case.cell);
  folder.write("mesoscale/tows.stl", tows_stl(bodies.tows.mesh));
  folder.write("mesoscale/tows.vtu", tows_vtu(bodies.tows, bodies.warps));
  folder.write("mesoscale/cell.vti", vti(bodies.voxels));
  folder.write("mesoscale/cell.h5", voxels_hdf5(bodies.voxels));
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
  const auto acting = macroscale::with_effects(findings.cell->fabric, a_case.stamping->effects);
  findings.indicators = macroscale::largest(macroscale::indicators(blank, acting), blank);
  if (findings.indicators.empty()) return;  // the binder never closed
  folder.write("macroscale/indicators.csv", indicators_csv(findings.indicators));
  folder.log(indicator_line(findings.indicators));
  findings.folds = macroscale::find_folds(blank, findings.cell->fabric.thickness);
  if (a_case.stamping->thermal && findings.stamping->summary.completed && findings.solid &&
      findings.solid->sheared.size() >= 2)
    folder.write("macroscale/part_stiffness.csv",
                 part_stiffness_csv(part_stiffness(blank, findings.solid->sheared)));
}

// The companion run on the coarser grid, of a stamping that came to its end.
void run_grid_error(const Case& a_case, const RunOptions& options, RunFolder& folder, const Cache& cache,
                    Findings& findings) {
  if (!a_case.grid_error || !findings.stamping || !findings.stamping->summary.completed) return;
  findings.grid_error = run_grid_error_stage(
      *a_case.stamping, findings.cell->fabric, findings.friction->model, *findings.stamping, folder, cache,
      inputs_of(ChainStage::grid_error, a_case).key(), InterruptGuard::interrupted, options.quiet);
}

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
  const int steps = a_case.stamping ? macroscale::all_steps(a_case.stamping->process) : 0;
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
