#include "macroscale/closing.h"

#include <utility>

#include "macroscale/press.h"

namespace heddle::macroscale {

namespace {

// Velocities are taken out after each step; the sum of the iterations is that of all.
StepSummary rest(System& system, const SolveOptions& options, double dt, int steps, State& state,
                 StepData& step) {
  StepSummary summary;
  int iterations = 0;
  for (int k = 0; k < steps; ++k) {
    State end;
    summary = advance(system, state, dt, state.tool_z, {}, options, end, step);
    iterations += summary.newton_iterations;
    if (!summary.converged) break;
    state = std::move(end);
    state.v.setZero();
    state.time = 0.0;
  }
  summary.newton_iterations = iterations;
  return summary;
}

}  // namespace

// The fabric is pressed through its thickness and stays where it was laid, held in its plane as the friction
// to come would hold it. (Free, it would drift along tools whose surfaces are triangles; held by friction,
// the start of a run would move with the lag of the friction.) Only the edges of the rings are off balance,
// so residuals are small from the start and the tolerance must be as well.
StepSummary close_binder(Scene& scene, System& system, const SolveOptions& options, State& state,
                         StepData& step) {
  constexpr double dt = 0.02;  // [s]
  constexpr int steps = 4;     // each leaves about a third of the motion of the one before
  SolveOptions closing = options;
  closing.frictionless = true;
  closing.force_tolerance = 1e-6;
  closing.relative_tolerance = 1e-6;
  const std::vector<double> load = std::exchange(scene.load, {});
  const std::vector<char> planes = std::exchange(scene.held, std::vector<char>(3 * scene.blank.nodes(), 0));
  for (int i = 0; i < scene.blank.nodes(); ++i) scene.held[3 * i] = scene.held[3 * i + 1] = 1;
  const StepSummary summary = rest(system, closing, dt, steps, state, step);
  scene.held = planes;
  scene.load = load;
  return summary;
}

// Steps so long that inertia does not count: an equilibrium, then what the inertia of the step before left of
// it. The punch stands where it would touch the flat blank, so nothing keeps the sag from hanging free.
StepSummary settle(Scene& scene, System& system, const SolveOptions& options, State& state, StepData& step) {
  constexpr double dt = 10.0;  // [s]
  constexpr int steps = 3;
  SolveOptions settling = options;
  settling.frictionless = true;
  settling.force_tolerance = 1e-6 * mean_weight(scene);
  settling.relative_tolerance = 0.0;
  const std::vector<char> planes = scene.held;
  scene.held.resize(3 * scene.blank.nodes(), 0);
  for (int k = 0; k < static_cast<int>(scene.tools.size()); ++k) {
    if (scene.tools[k].role != Role::binder) continue;
    for (int i = 0; i < scene.blank.nodes(); ++i)
      if (system.contact_at(state.node(i), k, system.pose(state, k)).normal.pressure > 0.0)
        scene.held[3 * i] = scene.held[3 * i + 1] = 1;
  }
  const StepSummary summary = rest(system, settling, dt, steps, state, step);
  scene.held = planes;
  return summary;
}

std::vector<double> weight_of_fabric(const Scene& scene) {
  std::vector<double> load(3 * scene.blank.nodes(), 0.0);
  for (int i = 0; i < scene.blank.nodes(); ++i)
    load[3 * i + 2] = -standard_gravity * scene.fabric->areal_density * scene.blank.node_area[i];
  return load;
}

double mean_weight(const Scene& scene) {
  double area = 0.0;
  for (const double a : scene.blank.node_area) area += a;
  return standard_gravity * scene.fabric->areal_density * area / scene.blank.nodes();
}

}  // namespace heddle::macroscale
