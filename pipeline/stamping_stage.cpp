#include "pipeline/stamping_stage.h"

#include <algorithm>
#include <iostream>

#include <fmt/format.h>

#include "core/progress.h"
#include "macroscale/punch_profile.h"
#include "macroscale/whole_blank.h"
#include "pipeline/export_vtu.h"
#include "pipeline/indicator_outputs.h"

namespace heddle::pipeline {

namespace {

constexpr int frames = 20;            // of the blank, over the stroke
constexpr int checkpoint_steps = 10;  // the most between two checkpoints, where writing them is cheap

// Everything written while the punch moves: what ends the run, it is there.
class StampingFiles {
 public:
  StampingFiles(RunFolder& folder, const Cache& cache, const StampingStageOptions& options,
                const mesoscale::FabricProperties& fabric, int steps)
      : folder_(folder),
        cache_(cache),
        fabric_(fabric),
        interval_(options.checkpoint_interval),
        every_(std::max(1, steps / frames)),
        last_kept_(Progress::steady_seconds()) {
    record_.key = options.inputs.key();
    record_.inputs = options.inputs.text();
    record_.steps = steps;
  }

  // Files of the steps that were done before.
  void restore(StampingRecord record) {
    history_ = record.at.history;
    for (StampingRecord::Frame& frame : record.frames) add_frame(frame.step, std::move(frame.blank));
    record_.at = std::move(record.at);
  }

  void add(int step, const macroscale::HistoryRow& row, const macroscale::BlankState& blank) {
    if (step > 0) history_.push_back(row);
    if (step % every_ == 0 || step == record_.steps) add_frame(step, blank);
  }

  // A checkpoint after so many steps or so much time, whichever is first, and always the last one. The time
  // it takes is below one per cent of the run's, whatever the size of the blank; results do not depend on
  // when it is.
  void keep(const macroscale::StampingCheckpoint& checkpoint, bool last) {
    const double now = Progress::steady_seconds(), passed = now - last_kept_;
    ++steps_since_;
    const bool due = passed >= interval_ || steps_since_ >= checkpoint_steps;
    const bool cheap = interval_ == 0.0 || passed >= 100.0 * cost_;
    if (!last && !(due && cheap)) return;
    steps_since_ = 0;
    record_.at = checkpoint;
    const std::string bytes = bytes_of(record_);
    folder_.write_durably(checkpoint_name, bytes);
    if (last && record_.complete() && !from_cache_) cache_.store(record_.key, bytes);
    last_kept_ = Progress::steady_seconds();
    cost_ = last_kept_ - now;
  }

  void is_from_cache() { from_cache_ = true; }

 private:
  void add_frame(int step, macroscale::BlankState blank) {
    folder_.write("macroscale/history.csv", history_csv(history_));
    const std::string name = fmt::format("blank_{:04d}.vtu", step);
    const bool all = blank.symmetry == macroscale::Symmetry::none;
    folder_.write("macroscale/" + name,
                  vtu(all ? mesh_with_indicators(blank, fabric_)
                          : mesh_with_indicators(macroscale::whole_of(blank).state, fabric_)));
    series_.push_back({blank.time, name});
    folder_.write("macroscale/blank.pvd", pvd(series_));
    record_.frames.push_back({step, std::move(blank)});
  }

  RunFolder& folder_;
  const Cache& cache_;
  const mesoscale::FabricProperties& fabric_;
  double interval_;
  int every_;
  int steps_since_ = 0;            // the last checkpoint
  double last_kept_, cost_ = 0.0;  // [s]
  bool from_cache_ = false;
  std::vector<SeriesFrame> series_;
  std::vector<macroscale::HistoryRow> history_;
  StampingRecord record_;
};

// The blank where the last attempt ended, with what was out of balance at each node.
QuadMesh mesh_of_failure(const macroscale::StampingFailure& failure) {
  QuadMesh mesh = mesh_of(failure.blank);
  if (!failure.residual.empty()) mesh.point_data.push_back({"residual_N", 1, failure.residual});
  return mesh;
}

void write_failure(const macroscale::StampingResult& result, const mesoscale::FabricProperties& fabric,
                   RunFolder& folder) {
  folder.write("macroscale/blank_last.vtu", vtu(mesh_with_indicators(result.final_state, fabric)));
  folder.log("stamping stopped: " + result.summary.failure);
  if (!result.failure || result.failure->blank.position.empty()) return;
  try {
    folder.write("macroscale/blank_failed.vtu", vtu(mesh_of_failure(*result.failure)));
  } catch (const OutputError& error) {  // positions that are no numbers have no picture
    folder.log(fmt::format("macroscale/blank_failed.vtu is not written: {}", error.what()));
  }
}

}  // namespace

macroscale::StampingResult run_stamping_stage(const macroscale::StampingSpec& spec,
                                              const mesoscale::FabricProperties& fabric,
                                              const friction::Model& friction, RunFolder& folder,
                                              const Cache& cache, StampingStageOptions options) {
  const int steps = macroscale::all_steps(spec.process);
  // Files show the load of the tows that were stamped.
  const mesoscale::FabricProperties acting = macroscale::with_effects(fabric, spec.effects);
  StampingFiles files(folder, cache, options, acting, steps);
  std::optional<StampingRecord> from;
  const auto work = [&](bool& reused) {
    from = cache.find(options.inputs.key(), read_stamping_record);
    if (from && from->complete())
      files.is_from_cache();
    else
      from = std::move(options.resume);
    macroscale::StampingCheckpoint start;
    if (from) {
      start = from->at;
      files.restore(std::move(*from));
      folder.log(fmt::format("stamping: {} of {} steps were done before", start.step, steps));
    }
    reused = from && start.step == steps;
    const int to_do = steps - start.step;
    Progress progress(from && to_do > 0 ? fmt::format("stamping from step {}", start.step) : "stamping",
                      to_do, progress_style_of_standard_error(options.quiet || reused), std::cerr);
    macroscale::StampingControl control;
    control.observe = [&](int step, int, const macroscale::HistoryRow& row,
                          const macroscale::BlankState& blank) {
      files.add(step, row, blank);
      const std::string note =
          fmt::format("punch {:.1f} mm, {:.0f} N", 1e3 * row.punch_displacement, row.punch_force);
      progress.update(step - start.step, note);
      folder.log(
          fmt::format("stamping: step {}: {}, {} Newton iterations", step, note, row.newton_iterations));
    };
    control.keep = [&](const macroscale::StampingCheckpoint& c, bool last) { files.keep(c, last); };
    control.stop = options.stop;
    control.resume_from = from ? &start : nullptr;
    return macroscale::run_stamping(spec, fabric, friction, control);
  };
  macroscale::StampingResult result = folder.stage("macroscale", work);
  folder.write("macroscale/history.csv", history_csv(result.history));
  if (!result.hold.empty()) {
    folder.write("macroscale/hold.csv", hold_csv(result.hold));
    if (!result.summary.release)
      folder.write("macroscale/blank_held.vtu", vtu(mesh_with_indicators(result.final_state, acting)));
  }
  if (result.summary.release) {
    folder.write("macroscale/release.csv", history_csv(std::vector{result.summary.release->row}));
    folder.write("macroscale/blank_released.vtu", vtu(mesh_with_indicators(result.final_state, acting)));
  }
  if (!result.summary.completed && !result.summary.stopped) write_failure(result, acting, folder);
  return result;
}

}  // namespace heddle::pipeline
