#include "macroscale/stamping.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "macroscale/ledger.h"
#include "macroscale/punch_profile.h"
#include "macroscale/quality.h"
#include "macroscale/scene.h"
#include "macroscale/solve.h"
#include "macroscale/system.h"
#include "macroscale/tool_set.h"

namespace heddle::macroscale {

namespace {

constexpr int punch = 0, die = 1, binder = 2;  // order of the tools in the scene

// Die and binder stand where they have closed on a flat blank, so that its midplane is at z = 0 and the punch
// touches it at t = 0 whatever the binder force.
Scene stamping_scene(const StampingSpec& spec, const mesoscale::FabricProperties& fabric,
                     const friction::Model& friction) {
  Scene scene;
  scene.blank = make_blank(outline_of(spec.blank), spec.blank.spacing, spec.blank.orientation);
  scene.fabric = &fabric;
  scene.friction = &friction;
  const double half = 0.5 * fabric.thickness;
  const TouchingTools tools = touching_tools(spec, fabric.thickness, SolveOptions{}.largest_increment);
  const double pressure = spec.process.binder_force / binder_area(spec);
  const double closed = half - approach_at(fabric.compaction.curves().front(), pressure);
  scene.tools = {{Role::punch, raised(tools.punch, half), Motion::driven, 0.0, 0.0},
                 {Role::die, raised(tools.die, -closed), Motion::fixed, 0.0, 0.0},
                 {Role::binder, raised(tools.binder, closed), Motion::loaded, spec.process.binder_force,
                  spec.binder.mass}};
  scene.blank_temperature = spec.process.blank_temperature;
  scene.tool_temperature = spec.process.tool_temperature;
  // Smoothing follows the punch speed, so a rate-free law stays rate-free; creep while sticking is below
  // 2e-4 of the stroke.
  scene.slip_smoothing = std::max(2e-4 * mean_speed(spec.process), 1e-6);
  scene.mass_scaling = spec.artefact.mass_scaling;
  scene.stabilisation = spec.artefact.stabilisation;
  scene.shear_rate = spec.shear_rate;
  scene.contact_pressure = spec.contact_pressure;
  return scene;
}

// Equilibrium under the binder force before the punch moves. Only the edges of the rings are off balance, so
// residuals are small from the start and the tolerance must be as well.
StepSummary close_binder(System& system, const SolveOptions& options, State& state) {
  SolveOptions closing = options;
  closing.frictionless = true;
  closing.force_tolerance = 1e-6;
  closing.relative_tolerance = 1e-6;
  State end;
  StepData step;
  const StepSummary summary = advance(system, state, 1.0, state.tool_z, {}, closing, end, step);
  if (!summary.converged) return summary;
  state = std::move(end);
  state.v.setZero();
  state.time = 0.0;
  return summary;
}

void add_to_history(HistoryRow& row, const StepAccount& account) {
  const StepLedger& l = account.ledger;
  row.work_punch += l.work_driven;
  row.work_binder += l.work_loaded;
  row.energy_tow += l.tow;
  row.energy_shear += l.shear;
  row.energy_bending += l.bending;
  row.energy_twist += l.twist;
  row.energy_compaction += l.compaction;
  row.energy_kinetic += l.kinetic;
  row.friction_punch += l.friction[punch];
  row.friction_die += l.friction[die];
  row.friction_binder += l.friction[binder];
  row.dissipation_shear_rate += l.shear_rate;
  row.dissipation_artefact += l.artefact;
  row.dissipation_numerical += l.numerical;
  row.ledger_residual = ledger_residual(row);
  row.friction_work_outside += l.friction_outside;
  row.punch_force = account.forces.on_tool[punch].z();
  row.die_force = account.forces.on_tool[die].z();
  row.binder_force = account.forces.on_tool[binder].z();
  row.force_balance = std::max(row.force_balance, account.forces.imbalance);
}

void finish_row(HistoryRow& row, const BlankState& blank, const State& state, const Scene& scene) {
  row.time = state.time;
  row.punch_displacement = -state.tool_z[punch];
  row.draw_in_max = largest_draw_in(scene.blank, state);
  row.shear_angle_max = 0.0;
  for (double angle : blank.shear_angle) row.shear_angle_max = std::max(row.shear_angle_max, std::abs(angle));
  row.tow_strain_max = 0.0;
  for (const auto& strain : blank.tow_strain)
    row.tow_strain_max = std::max({row.tow_strain_max, strain[0], strain[1]});
}

// Parts of one step: no more tool motion at once than contact can follow.
int parts_of_step(const StampingSpec& spec, double thickness, double spacing) {
  const double limit = std::min({0.5 * spec.die.fillet, thickness, 1.25 * spacing});
  return std::max(1, static_cast<int>(std::ceil(spec.process.stroke / spec.process.steps / limit - 1e-9)));
}

class Run {
 public:
  Run(const StampingSpec& spec, const mesoscale::FabricProperties& fabric, const friction::Model& friction,
      const StampingObserver& observe)
      : spec_(spec),
        observe_(observe),
        scene_(stamping_scene(spec, fabric, friction)),
        system_(scene_),
        state_(initial_state(scene_)) {}
  Run(const Run&) = delete;  // the system points at the scene
  Run& operator=(const Run&) = delete;

  // A value that is not finite ends the run like any other failure: what was reached is kept.
  StampingResult result() {
    describe();
    try {
      return drive();
    } catch (const NumericalError& error) {
      return fail(error.what());
    }
  }

 private:
  StampingResult drive() {
    const StepSummary closed = close_binder(system_, options_, state_);
    if (!closed.converged) return fail("closing the binder: " + closed.reason);
    const BlankState blank = blank_state(system_, state_, nullptr);
    finish_row(row_, blank, state_, scene_);
    if (observe_) observe_(0, spec_.process.steps, row_, blank);
    const int parts = parts_of_step(spec_, scene_.fabric->thickness,
                                    std::max(scene_.blank.spacing[0], scene_.blank.spacing[1]));
    for (int step = 1; step <= spec_.process.steps; ++step)
      if (!advance_to(step, parts)) return fail(reason_);
    result_.summary.completed = true;
    return finish();
  }

  void describe() {
    result_.summary.nodes = scene_.blank.nodes();
    result_.summary.spacing = scene_.blank.spacing;
  }

  // One nominal step, in equal parts of stroke; a part that fails is halved, and the rest goes on with the
  // halves.
  bool advance_to(int step, int parts) {
    row_.newton_iterations = row_.lag_iterations = 0;
    row_.force_balance = 0.0;
    const double stroke = spec_.process.stroke / spec_.process.steps;
    long pieces = parts, done = 0;
    while (done < pieces) {
      const double share = static_cast<double>(done + 1) / static_cast<double>(pieces);
      const double next = time_at_stroke(spec_.process, stroke * (step - 1 + share));
      if (advance_part(next - state_.time, next)) {
        ++done;
        continue;
      }
      ++result_.summary.rejected_steps;
      pieces *= 2;
      done *= 2;
      if (next - state_.time < 2e-7) {
        reason_ = fmt::format("step {} of {} (punch at {:.2f} mm): {}; the time step fell below 1e-7 s", step,
                              spec_.process.steps, -1e3 * state_.tool_z[punch], reason_);
        return false;
      }
    }
    const BlankState blank = close_row();
    if (observe_) observe_(step, spec_.process.steps, row_, blank);
    return true;
  }

  BlankState close_row() {
    BlankState blank = blank_state(system_, state_, &last_step_);
    finish_row(row_, blank, state_, scene_);
    result_.history.push_back(row_);
    return blank;
  }

  bool advance_part(double dt, double time) {
    State end;
    std::vector<double> tool_z = state_.tool_z;
    tool_z[punch] = -stroke_at_time(spec_.process, time);
    StepData step;
    const StepSummary summary = advance(system_, state_, dt, tool_z, {}, options_, end, step);
    result_.summary.newton_iterations += summary.newton_iterations;
    row_.newton_iterations += summary.newton_iterations;
    row_.lag_iterations += summary.lag_iterations;
    if (!summary.converged) {
      reason_ = summary.reason;
      return false;
    }
    add_to_history(row_, account(system_, step, end));
    result_.summary.falling_branch |= on_falling_branch(system_, step, end);
    peak_force_balance_ = std::max(peak_force_balance_, row_.force_balance);
    end.time = time;
    start_ = std::move(state_);
    state_ = std::move(end);
    last_step_ = std::move(step);
    last_step_.start = &start_;
    return true;
  }

  StampingResult fail(const std::string& why) {
    result_.summary.failure = why;
    // Parts of a step that were accepted before its rest failed belong to the history.
    const double recorded = result_.history.empty() ? 0.0 : result_.history.back().time;
    if (state_.time > recorded) close_row();
    return finish();
  }

  StampingResult finish() {
    result_.final_state = blank_state(system_, state_, result_.history.empty() ? nullptr : &last_step_);
    summarise(result_, scene_.blank, state_, peak_force_balance_);
    return std::move(result_);
  }

  const StampingSpec& spec_;
  const StampingObserver& observe_;
  Scene scene_;
  System system_;
  SolveOptions options_;
  State state_, start_;
  StepData last_step_;
  HistoryRow row_;
  double peak_force_balance_ = 0.0;
  std::string reason_;
  StampingResult result_;
};

}  // namespace

Outline outline_of(const BlankSpec& blank) {
  constexpr double chord = 2e-5;  // of the radius: the area falls short by 3e-5
  Outline outline = blank.shape == BlankShape::rectangle ? rectangle(blank.size)
                    : blank.shape == BlankShape::circle  ? circle(blank.radius, chord * blank.radius)
                                                         : blank.polygon;
  for (const RoundHole& hole : blank.holes)
    outline.holes.push_back(circle(hole.radius, 1e-3 * hole.radius, hole.centre).outer);
  return outline;
}

StampingResult run_stamping(const StampingSpec& spec, const mesoscale::FabricProperties& fabric,
                            const friction::Model& friction, const StampingObserver& observe) {
  Problems problems = check(spec);
  const Problems of_fabric = mesoscale::check(fabric);
  problems.insert(problems.end(), of_fabric.begin(), of_fabric.end());
  if (!problems.empty()) throw InputError(std::move(problems));
  const StampingSpec loaded = with_tools_loaded(spec);
  return Run(loaded, fabric, friction, observe).result();
}

}  // namespace heddle::macroscale
