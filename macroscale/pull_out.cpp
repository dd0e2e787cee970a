#include "macroscale/pull_out.h"

#include <algorithm>
#include <cmath>

#include "macroscale/ledger.h"
#include "macroscale/scene.h"
#include "macroscale/solve.h"
#include "macroscale/system.h"

namespace heddle::macroscale {

namespace {

Scene pull_out_scene(const PullOutSpec& spec, const mesoscale::FabricProperties& fabric,
                     const friction::Model& friction) {
  Scene scene;
  scene.blank = make_blank(spec.size, spec.spacing);
  scene.fabric = &fabric;
  scene.friction = &friction;
  const double half = 0.5 * fabric.thickness;
  scene.tools = {{Role::die, PlaneShape{{0, 0, -half}, {0, 0, 1}}, Motion::fixed, 0.0, 0.0},
                 {Role::binder, PlaneShape{{0, 0, half}, {0, 0, -1}}, Motion::loaded, spec.normal_force,
                  spec.plate_mass}};
  scene.blank_temperature = spec.fabric_temperature;
  scene.tool_temperature = spec.tool_temperature;
  scene.slip_smoothing = std::max(2e-4 * spec.speed, 1e-6);
  scene.contact_pressure = spec.contact_pressure;
  scene.held.assign(3 * scene.blank.nodes(), 0);
  for (int j = 0; j <= scene.blank.nv; ++j) {
    scene.held[3 * scene.blank.node(scene.blank.nu, j)] = 1;      // pulled along x
    scene.held[3 * scene.blank.node(scene.blank.nu, j) + 1] = 1;  // the holder keeps its width
  }
  return scene;
}

// Uniform closing: every node sinks by the same approach, the plate by twice that.
void close_plates(const System& system, State& state, const PullOutSpec& spec) {
  const double approach = approach_at(system.compaction(), spec.normal_force / (spec.size[0] * spec.size[1]));
  for (int i = 0; i < system.scene().blank.nodes(); ++i) state.x[3 * i + 2] -= approach;
  state.x[3 * system.scene().blank.nodes()] = -2.0 * approach;
  state.tool_z[1] = -2.0 * approach;
}

}  // namespace

PullOutResult run_pull_out(const PullOutSpec& spec, const mesoscale::FabricProperties& fabric,
                           const friction::Model& friction) {
  const Scene scene = pull_out_scene(spec, fabric, friction);
  System system(scene);
  State state = initial_state(scene);
  close_plates(system, state, spec);

  const auto pull = [&](double time, Eigen::VectorXd& x) {
    for (int j = 0; j <= scene.blank.nv; ++j) {
      const int node = scene.blank.node(scene.blank.nu, j);
      x[3 * node] = scene.blank.reference[node].x() + spec.speed * time;
      x[3 * node + 1] = scene.blank.reference[node].y();
    }
  };
  PullOutResult result;
  const double dt = spec.travel / spec.speed / spec.steps;
  const SolveOptions options;
  for (int k = 0; k < spec.steps; ++k) {
    State end;
    StepData step;
    const StepSummary summary = advance(system, state, dt, state.tool_z, pull, options, end, step);
    if (!summary.converged) {
      result.failure = summary.reason;
      return result;
    }
    const StepAccount books = account(system, step, end);
    result.travel.push_back(spec.speed * end.time);
    result.force.push_back(books.forces.by_supports.x());
    if (k + 1 == spec.steps) {
      const double mean = spec.normal_force / (spec.size[0] * spec.size[1]);
      for (const FrictionPoint& point : step.friction[0])
        result.pressure_spread =
            std::max(result.pressure_spread, std::abs(point.context.pressure / mean - 1.0));
    }
    state = std::move(end);
  }
  result.steady_force = result.force.back();
  result.completed = true;
  return result;
}

}  // namespace heddle::macroscale
