#include "macroscale/release.h"

#include <algorithm>

#include "macroscale/history_row.h"
#include "macroscale/ledger.h"
#include "macroscale/quality.h"
#include "macroscale/tool_drive.h"

namespace heddle::macroscale {

namespace {

// What sticks on the die creeps by less than 0.05 mm in the whole time.
constexpr double least_smoothing = 1e-6;  // [m/s]

bool stays(const Tool& tool) {
  return tool.role == Role::die;
}

// Energy of the fabric pressed by a tool [J].
double pressed_by(const System& system, const State& state, int k) {
  StepData now;
  now.start = &state;
  now.dt = 1.0;
  if (system.scene().compaction_follows_shear)
    now.contact_shear =
        contact_shear_angle(system.scene().blank, system.scene().contact_sites, state.corner_angle);
  const Pose pose = system.pose(state, k);
  double energy = 0.0;
  for (int i = 0; i < system.contacts(); ++i)
    energy += system.contact_area(now, i) *
              system.contact_at(now, at_point(system.contact_points()[i], state.x), k, i, pose).normal.energy;
  return energy;
}

// A tool that leaves faster than the fabric follows takes exactly what the fabric below it had stored, and so
// do its springs; what moved comes to rest.
void book_departure(HistoryRow& row, const System& system, const State& state) {
  const Scene& scene = system.scene();
  for (int k = 0; k < static_cast<int>(scene.tools.size()); ++k) {
    const Tool& tool = scene.tools[k];
    if (stays(tool)) continue;
    const double all = images(scene.blank.symmetry);
    const double pressed = all * pressed_by(system, state, k);
    double sprung = 0.0;
    for (int u = 0; u < unknowns_of(tool); ++u) {
      const double unknown = state.x[system.unknown_of(k) + u];
      sprung += all * (u == 0 ? drive_at(tool, unknown) : tilt_drive_at(tool, unknown)).spring_energy;
    }
    (tool.role == Role::punch ? row.work_punch : row.work_binder) -= pressed + sprung;
    row.energy_compaction -= pressed;
    row.energy_press -= sprung;
  }
  row.dissipation_numerical += row.energy_kinetic;
  row.energy_kinetic = 0.0;
}

// The scene without the tools that left, and the blank in it as it was.
Scene without_press(const Scene& scene) {
  Scene left = scene;
  std::erase_if(left.tools, [](const Tool& tool) { return !stays(tool); });
  left.slip_smoothing = std::min(left.slip_smoothing, least_smoothing);
  return left;
}

State without_press(const Scene& scene, const State& state) {
  State left = state;
  left.x = state.x.head(3 * scene.blank.nodes()).eval();
  left.v = Eigen::VectorXd::Zero(left.x.size());
  left.tool_z.clear();
  left.memory.clear();
  for (std::size_t k = 0; k < scene.tools.size(); ++k) {
    if (!stays(scene.tools[k])) continue;
    left.tool_z.push_back(state.tool_z[k]);
    left.memory.push_back(state.memory[k]);
  }
  if (state.memory.size() > scene.tools.size()) left.memory.push_back(state.memory.back());  // between plies
  return left;
}

double largest_way(const Blank& blank, const State& from, const State& to) {
  double largest = 0.0;
  for (int i = 0; i < blank.nodes(); ++i) largest = std::max(largest, (to.node(i) - from.node(i)).norm());
  return largest;
}

}  // namespace

Released release_blank(const Scene& scene, const System& system, const State& state, HistoryRow row,
                       const SolveOptions& options) {
  constexpr double first = 0.01, longest = 20.0;  // [s]
  constexpr double shortest = 1e-5;               // [s]
  Released released;
  book_departure(row, system, state);
  row.newton_iterations = row.lag_iterations = 0;
  row.force_balance = 0.0;
  const Scene left = without_press(scene);
  System free(left);
  State now = without_press(scene, state);
  StepData step;
  // No tool presses any more: what is left is judged by itself, not by contact forces.
  SolveOptions by_itself = options;
  by_itself.force_tolerance = std::min(options.force_tolerance, 1e-5);
  by_itself.relative_tolerance = 0.0;
  int iterations = 0, factorisations = 0;
  for (double dt = first; dt <= longest && dt >= shortest;) {
    State end;
    released.summary = advance(free, now, dt, now.tool_z, {}, by_itself, end, step);
    iterations += released.summary.newton_iterations;
    factorisations += released.summary.factorisations;
    if (released.summary.stopped) break;
    if (!released.summary.converged) {
      dt *= 0.25;
      continue;
    }
    add_to_history(row, account(free, step, end), left);
    row.dissipation_numerical += row.energy_kinetic;
    row.energy_kinetic = 0.0;
    row.newton_iterations += released.summary.newton_iterations;
    row.lag_iterations += released.summary.lag_iterations;
    now = std::move(end);
    now.v.setZero();
    dt *= 2.0;
  }
  released.summary.newton_iterations = iterations;
  released.summary.factorisations = factorisations;
  released.blank = blank_state(free, now, nullptr);
  measure_blank(row, released.blank, now, left);
  row.ledger_residual = ledger_residual(row);
  row.punch_displacement = row.punch_deflection = row.binder_tilt = 0.0;
  released.release = {row, largest_way(left.blank, state, now)};
  return released;
}

}  // namespace heddle::macroscale
