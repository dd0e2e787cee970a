#include "macroscale/stamping.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

#include "macroscale/checkpoint.h"
#include "macroscale/closing.h"
#include "macroscale/history_row.h"
#include "macroscale/ledger.h"
#include "macroscale/punch_profile.h"
#include "macroscale/quality.h"
#include "macroscale/release.h"
#include "macroscale/scene.h"
#include "macroscale/solve.h"
#include "macroscale/stack.h"
#include "macroscale/stamping_scene.h"
#include "macroscale/system.h"
#include "macroscale/whole_blank.h"

namespace heddle::macroscale {

namespace {

constexpr int punch = 0;  // in the scene; die and binder may be several tools

// Parts of one step: no more tool motion at once than contact can follow.
int parts_of_step(const StampingSpec& spec, double thickness, double spacing) {
  const double limit = std::min({0.5 * spec.die.fillet, thickness, 1.25 * spacing});
  return std::max(1, static_cast<int>(std::ceil(spec.process.stroke / spec.process.steps / limit - 1e-9)));
}

// Creep while sticking grows with the time at rest: as little over the dwell as over the stroke, 2e-4 of it
// at most.
double smoothing_of_dwell(const ProcessSpec& process, double of_stroke) {
  return std::min(of_stroke, 2e-4 * process.stroke / process.press.dwell);
}

// A part of a step is tried in so many pieces before parts of the sheet may pass through each other. Creases
// narrower than a cell do, however short the step: that is told (self_crossings), and the run goes on.
constexpr long insistence = 16;

// How a step, or the whole run, ended.
enum class Ending { done, failed, stopped };

std::vector<std::pair<std::string, double>> terms_of(const PotentialTerms& p) {
  return {{"inertia", p.inertia},   {"tow", p.tow},
          {"shear", p.shear},       {"shear_rate", p.rate},
          {"tow_rate", p.tow_rate}, {"bending", p.bending},
          {"twist", p.twist},       {"compaction", p.compaction + p.compaction_plies},
          {"loads", p.loads},       {"stabilisation", p.stabilisation}};
}

// Residuals and energies of the last iterate, sorted by what is a number and what is not.
void describe_iterate(StampingFailure& failure, const System& system, const StepData& attempt) {
  const Eigen::VectorXd& x = attempt.iterate;
  const Eigen::VectorXd g = system.gradient(attempt, x);
  const int nodes = system.scene().blank.nodes();
  const auto add = [&](int unknown, double residual, const std::array<double, 3>& position) {
    if (std::isfinite(residual))
      failure.worst.push_back({name_of(system, unknown), residual, position});
    else
      failure.not_finite.push_back("residual of " + name_of(system, unknown));
  };
  for (int i = 0; i < nodes; ++i) {
    const double residual = g.segment<3>(3 * i).norm();
    failure.residual.push_back(std::isfinite(residual) ? residual : -1.0);
    add(3 * i, residual, {x[3 * i], x[3 * i + 1], x[3 * i + 2]});
  }
  for (int k = 0; k < static_cast<int>(system.scene().tools.size()); ++k)
    for (int u = 0; u < unknowns_of(system.scene().tools[k]); ++u)
      add(system.unknown_of(k) + u, std::abs(g[system.unknown_of(k) + u]),
          {0.0, 0.0, system.pose(attempt, x, k).z});
  constexpr std::size_t shown = 10;
  std::stable_sort(failure.worst.begin(), failure.worst.end(),
                   [](const auto& a, const auto& b) { return a.residual > b.residual; });
  failure.worst.resize(std::min(failure.worst.size(), shown));
  for (const auto& [name, value] : terms_of(system.potential(attempt, x))) {
    if (std::isfinite(value))
      failure.energies.emplace_back(name, value);
    else
      failure.not_finite.push_back("energy of " + name);
  }
}

// A piece's failure in the blank that its files show. Worst nodes keep their places, which are in the piece.
void show_whole(StampingFailure& failure) {
  WholeBlank whole = whole_of(failure.blank);
  std::vector<double> residual;
  for (const int n : whole.node) residual.push_back(failure.residual[static_cast<std::size_t>(n)]);
  for (StampingFailure::Unknown& unknown : failure.worst)
    for (std::size_t n = 0; n < whole.node.size(); ++n)
      if (unknown.position == whole.state.position[n]) unknown.name = fmt::format("node {}", n);
  failure.blank = std::move(whole.state);
  failure.residual = std::move(residual);
}

// Whether the press has the eight symmetries of the square that a blank may have.
bool is_symmetric(const StampingSpec& spec) {
  const PressSpec& press = spec.process.press;
  const bool straight = press.punch_offset[0] == 0.0 && press.punch_offset[1] == 0.0;
  return straight && press.binder_tilt == 0.0 && spec.binder.sectors == 1;
}

// What a checkpoint says of the run, as its result.
void take_over(StampingResult& result, const StampingSpec& spec, const Blank& blank,
               const mesoscale::FabricProperties& fabric, StampingCheckpoint at) {
  const double last_table_pressure = fabric.compaction.curves().front().y().back();  // of every trellis angle
  StampingSummary& s = result.summary;
  s.nodes = blank.nodes();
  s.spacing = blank.spacing;
  s.rejected_steps = at.rejected_steps;
  s.newton_iterations = at.newton_iterations;
  s.factorisations = at.factorisations;
  s.falling_branch = at.falling_branch;
  s.pressure_max = at.peak_pressure;
  s.crush_share = at.peak_pressure / last_table_pressure;
  s.friction_swing = at.peak_swing;
  if (blank.plies() > 1) s.stack = stack_summary(blank, at);
  if (spec.self_contact) {
    const bool met = at.state.coupling.quad.size() > ply_points(blank).size();
    s.self_contact =
        SelfContactSummary{.met = met, .patterns = at.patterns, .pairing_share = pairing_share(at)};
  }
  result.history = std::move(at.history);
  result.hold = std::move(at.hold);
  s.release = std::move(at.release);
  result.final_state = at.blank.symmetry == Symmetry::none ? std::move(at.blank) : whole_of(at.blank).state;
  summarise(result, blank, at.state, at.peak_force_balance);
  if (!is_symmetric(spec)) s.symmetry_gap_shear = s.symmetry_gap_draw_in = -1.0;
}

void refuse(const std::string& fault) {
  if (!fault.empty()) throw std::invalid_argument("the checkpoint is not of this run: " + fault);
}

// A run that was complete: no tools, no laws, no equations.
StampingResult result_of(const StampingSpec& spec, const mesoscale::FabricProperties& fabric,
                         const StampingCheckpoint& last) {
  const Blank blank = stamping_blank(spec, fabric);
  refuse(fault_of(last, blank, spec.contact_sites, all_steps(spec.process), state_sizes(spec)));
  StampingResult result;
  result.summary.completed = true;
  take_over(result, spec, blank, fabric, last);
  return result;
}

class Run {
 public:
  Run(const StampingSpec& spec, const mesoscale::FabricProperties& fabric, const friction::Model& friction,
      const StampingControl& control)
      : spec_(spec), control_(control), scene_(stamping_scene(spec, fabric, friction)), system_(scene_) {
    options_.stop = control.stop;
    // A nodal residual is small beside the binder's share of a node as well: under 5 N a millinewton is not.
    options_.force_tolerance =
        std::min(options_.force_tolerance, 1e-2 * spec.process.applied_binder_force() /
                                               (images(spec.blank.symmetry) * scene_.blank.nodes()));
    if (spec.process.press.gravity)
      options_.force_tolerance = std::min(options_.force_tolerance, 1e-2 * mean_weight(scene_));
    now_.state = initial_state(scene_);
    now_.blank = blank_state(system_, now_.state, nullptr);
  }
  Run(const Run&) = delete;  // the system points at the scene
  Run& operator=(const Run&) = delete;

  // A value that is not finite ends the run like any other failure: what was reached is kept.
  StampingResult result() {
    Ending ending = Ending::failed;
    try {
      ending = drive();
      if (ending == Ending::done) ending = hold();
      if (ending == Ending::done) ending = release();
    } catch (const NumericalError& error) {
      reason_ = error.what();
      kind_ = FailureKind::not_finite;
    }
    if (ending == Ending::stopped) return stop();
    if (ending == Ending::failed) return fail();
    keep(now_, true);
    result_.summary.completed = true;
    return finish();
  }

 private:
  Ending drive() {
    const Ending begun = control_.resume_from ? resume(*control_.resume_from) : begin();
    if (begun != Ending::done) return begun;
    double spacing = 0.0;
    for (int k = 0; k < scene_.blank.plies(); ++k)
      for (const double along : scene_.blank.ply(k).spacing) spacing = std::max(spacing, along);
    const int parts = parts_of_step(spec_, scene_.fabric->thickness, spacing);
    while (now_.step < all_steps(spec_.process)) {
      const Ending ending = advance_to(now_.step + 1, parts);
      if (ending != Ending::done) return ending;
    }
    return Ending::done;
  }

  Ending begin() {
    const StepSummary closed = close_binder(scene_, system_, options_, now_.state, attempt_);
    if (Ending ending = begun(closed, "closing the binder"); ending != Ending::done) return ending;
    if (spec_.process.press.gravity) {
      const StepSummary settled = settle(scene_, system_, options_, now_.state, attempt_);
      if (Ending ending = begun(settled, "sagging"); ending != Ending::done) return ending;
    }
    now_.blank = blank_state(system_, now_.state, nullptr);
    finish_row(now_.row, now_.blank, now_.state, system_);
    show_and_keep();
    return Ending::done;
  }

  Ending begun(const StepSummary& summary, const char* what) {
    if (summary.stopped) return Ending::stopped;
    if (summary.converged) return Ending::done;
    reason_ = fmt::format("{}: {}", what, summary.reason);
    kind_ = summary.kind;
    return Ending::failed;
  }

  Ending resume(const StampingCheckpoint& checkpoint) {
    refuse(fault_of(checkpoint, scene_.blank, scene_.contact_sites, all_steps(spec_.process),
                    state_sizes(spec_)));
    if (scene_.heat.has_value() == checkpoint.state.heat.empty())
      refuse(scene_.heat ? "it has no temperatures" : "it has temperatures");
    if (scene_.shear_friction.on() == checkpoint.state.shear_memory.empty())
      refuse("friction between tows is on in one and off in the other");
    now_ = checkpoint;
    whole_ = now_;
    return Ending::done;
  }

  // One nominal step, in equal parts of stroke. A part that fails is halved; after a pair that went well the
  // halves are joined again.
  Ending advance_to(int step, int parts) {
    now_.row.newton_iterations = now_.row.lag_iterations = 0;
    now_.row.force_balance = 0.0;
    const bool dwells = step > spec_.process.steps;
    if (dwells) scene_.slip_smoothing = smoothing_of_dwell(spec_.process, scene_.slip_smoothing);
    long pieces = dwells ? 1 : parts, done = 0;
    while (done < pieces) {
      const double share = static_cast<double>(done + 1) / static_cast<double>(pieces);
      const double next = time_at_step(spec_.process, step, share);
      options_.may_cross = pieces >= insistence * parts;
      const Ending ending = advance_part(next - now_.state.time, next);
      if (ending == Ending::stopped) return ending;
      if (ending == Ending::done) {
        ++done;
        if (pieces > parts && done % 2 == 0) {
          done /= 2;
          pieces /= 2;
        }
        continue;
      }
      ++now_.rejected_steps;
      pieces *= 2;
      done *= 2;
      if (next - now_.state.time < 2e-7) {
        reason_ = fmt::format("step {} of {} (punch at {:.2f} mm): {}; the time step fell below 1e-7 s", step,
                              all_steps(spec_.process), -1e3 * now_.state.tool_z[punch], reason_);
        return Ending::failed;
      }
    }
    now_.step = step;
    close_row();
    show_and_keep();
    return Ending::done;
  }

  // Tools closed and still after the stroke until no melt is left: heat alone goes on, through contacts as
  // they are. Steps grow with the time scales of what is left.
  Ending hold() {
    if (!scene_.heat || spec_.process.hold == 0.0 || !now_.hold.empty()) return Ending::done;
    const double begin = now_.state.time, end = begin + spec_.process.hold;
    const double longest = spec_.process.hold / 100.0;
    HeatRow row = heat_row(scene_, now_.state.heat, begin);
    for (double step = std::min(0.01, longest); row.time < end && row.frozen_through < 1.0;
         step = std::min(1.1 * step, longest)) {
      if (control_.stop && control_.stop()) return Ending::stopped;
      const double time = end - row.time < 1.5 * step ? end : row.time + step;
      hold_heat(system_, time - row.time, now_.state);
      row = heat_row(scene_, now_.state.heat, time);
      now_.hold.push_back(row);
    }
    now_.blank.heat = heat_fields(scene_, now_.state.heat);
    now_.blank.time = row.time;
    return Ending::done;
  }

  // Punch and binder go up at once, and the blank comes to rest on the die. Not a step of the run: a run that
  // is interrupted here does all of it again.
  Ending release() {
    if (!spec_.process.press.release || now_.release) return Ending::done;
    Released released = release_blank(scene_, system_, now_.state, now_.row, options_);
    now_.newton_iterations += released.summary.newton_iterations;
    now_.factorisations += released.summary.factorisations;
    if (Ending ending = begun(released.summary, "release"); ending != Ending::done) return ending;
    now_.peak_force_balance = std::max(now_.peak_force_balance, released.release.row.force_balance);
    now_.release = released.release;
    now_.blank = std::move(released.blank);
    return Ending::done;
  }

  void close_row() {
    now_.blank = blank_state(system_, now_.state, &last_step_);
    last_step_ = {};  // hundreds of bytes a node that nothing reads any more
    start_ = {};
    finish_row(now_.row, now_.blank, now_.state, system_);
    now_.history.push_back(now_.row);
  }

  // The observer comes first: what it writes belongs to the step that a checkpoint says is done.
  void show_and_keep() {
    if (control_.observe) control_.observe(now_.step, all_steps(spec_.process), now_.row, now_.blank);
    whole_ = now_;
    keep(now_, false);
  }

  void keep(const StampingCheckpoint& checkpoint, bool last) const {
    if (control_.keep) control_.keep(checkpoint, last);
  }

  Ending advance_part(double dt, double time) {
    State end;
    std::vector<double> tool_z = now_.state.tool_z;
    tool_z[punch] = -stroke_at_time(spec_.process, time);
    const int patterns = system_.patterns();
    const StepSummary summary = advance(system_, now_.state, dt, tool_z, {}, options_, end, attempt_);
    now_.patterns += system_.patterns() - patterns;
    now_.newton_iterations += summary.newton_iterations;
    now_.factorisations += summary.factorisations;
    now_.row.newton_iterations += summary.newton_iterations;
    now_.row.lag_iterations += summary.lag_iterations;
    if (summary.stopped) return Ending::stopped;
    if (!summary.converged) {
      reason_ = summary.reason;
      kind_ = summary.kind;
      return Ending::failed;
    }
    const StepAccount books = account(system_, attempt_, end);
    add_to_history(now_.row, books, scene_);
    now_.pairing += images(scene_.blank.symmetry) * std::abs(books.ledger.pairing);
    now_.peak_pressure = std::max(now_.peak_pressure, largest_pressure(system_, attempt_, end));
    if (summary.swings) now_.peak_swing = std::max(now_.peak_swing, summary.lag_residual);
    now_.falling_branch |= on_falling_branch(system_, attempt_, end);
    now_.peak_force_balance = std::max(now_.peak_force_balance, now_.row.force_balance);
    end.time = time;
    advance_heat(system_, now_.state, end);
    start_ = std::move(now_.state);
    now_.state = std::move(end);
    last_step_ = std::move(attempt_);
    last_step_.start = &start_;
    return Ending::done;
  }

  // Parts of a step are not kept: the step is done again, with the same bits.
  StampingResult stop() {
    result_.summary.stopped = true;
    result_.summary.failure = "stopped from outside";
    const bool begun = !whole_.state.memory.empty();
    if (begun) {
      now_ = std::move(whole_);
      keep(now_, true);
    }
    return finish();
  }

  StampingResult fail() {
    describe_failure();
    if (!whole_.state.memory.empty()) keep(whole_, true);
    result_.summary.failure = reason_;
    // Parts of a step that were accepted before its rest failed belong to the history.
    const double recorded = now_.history.empty() ? 0.0 : now_.history.back().time;
    if (now_.state.time > recorded) close_row();
    return finish();
  }

  void describe_failure() {
    StampingFailure failure;
    failure.kind = kind_;
    failure.reason = reason_;
    failure.step = whole_.state.memory.empty() ? 0 : now_.step + 1;
    if (attempt_.start && attempt_.iterate.size() > 0) {
      failure.time_step = attempt_.dt;
      failure.time = attempt_.start->time + attempt_.dt;
      try {
        failure.blank = blank_state(system_, state_at_iterate(system_, attempt_), nullptr);
        describe_iterate(failure, system_, attempt_);
        if (failure.blank.symmetry != Symmetry::none) show_whole(failure);
      } catch (const NumericalError& error) {  // the law itself has no value there: that is worth saying
        failure.not_finite.push_back(error.what());
      }
    }
    result_.failure = std::move(failure);
  }

  StampingResult finish() {
    take_over(result_, spec_, scene_.blank, *scene_.fabric, std::move(now_));
    return std::move(result_);
  }

  const StampingSpec& spec_;
  const StampingControl& control_;
  Scene scene_;
  System system_;
  SolveOptions options_;
  StampingCheckpoint now_;    ///< moves on with every part of a step
  StampingCheckpoint whole_;  ///< after the last whole step; empty until the binder has closed
  State start_;               ///< of last_step_
  StepData last_step_;        ///< the last part that was accepted, until its step has its row
  StepData attempt_;          ///< the last one tried
  std::string reason_;
  FailureKind kind_ = FailureKind::search;
  StampingResult result_;
};

}  // namespace

Outline outline_of(const BlankSpec& blank) {
  constexpr double chord = 2e-5;  // of the radius: the area falls short by 3e-5
  Outline outline = blank.shape == BlankShape::rectangle ? rectangle(blank.size)
                    : blank.shape == BlankShape::circle  ? circle(blank.radius, chord * blank.radius)
                                                         : blank.polygon;
  for (const RoundHole& hole : blank.holes)
    if (hole.radius > 0.0)  // others are named by check()
      outline.holes.push_back(circle(hole.radius, 1e-3 * hole.radius, hole.centre).outer);
  return polygon(std::move(outline.outer), std::move(outline.holes));
}

StampingResult run_stamping(const StampingSpec& spec, const mesoscale::FabricProperties& fabric,
                            const friction::Model& friction, const StampingObserver& observe) {
  return run_stamping(spec, fabric, friction, StampingControl{.observe = observe});
}

StampingResult run_stamping(const StampingSpec& spec, const mesoscale::FabricProperties& handed_over,
                            const friction::Model& friction, const StampingControl& control) {
  Problems problems = check(spec);
  const Problems of_fabric = mesoscale::check(handed_over);
  problems.insert(problems.end(), of_fabric.begin(), of_fabric.end());
  if (!problems.empty()) throw InputError(std::move(problems));
  const mesoscale::FabricProperties fabric = with_effects(handed_over, spec.effects);
  if (spec.thermal) {
    const Problems of_heat = thermal::check_films(*spec.thermal, fabric.areal_density);
    problems.insert(problems.end(), of_heat.begin(), of_heat.end());
  }
  if (!problems.empty()) throw InputError(std::move(problems));
  const StampingCheckpoint* from = control.resume_from;
  const bool held = spec.process.hold == 0.0 || (from && !from->hold.empty());
  const bool released = !spec.process.press.release || (from && from->release);
  if (from && from->step == all_steps(spec.process) && held && released) {
    if (control.keep) control.keep(*from, true);
    return result_of(spec, fabric, *from);
  }
  for (const auto* file : {&spec.punch.file, &spec.die.file, &spec.binder.file})
    if (*file && !(*file)->loaded) throw std::logic_error("run_stamping: a tool file was not loaded");
  return Run(spec, fabric, friction, control).result();
}

}  // namespace heddle::macroscale
