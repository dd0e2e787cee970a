#include "macroscale/pull_out.h"

#include <algorithm>
#include <cmath>

#include "macroscale/friction_lag.h"
#include "macroscale/ledger.h"
#include "macroscale/scene.h"
#include "macroscale/solve.h"
#include "macroscale/system.h"

namespace heddle::macroscale {

namespace {

CurvedPlateShape plate_of(const PullOutSpec& spec, const mesoscale::FabricProperties& fabric, bool up) {
  return {.path = *spec.bend, .start = -0.5 * spec.bend->arcs(), .gap = fabric.thickness, .up = up};
}

// What the holder grips: the last line of nodes, or, where the grid runs at an angle, all within a cell of
// the edge.
std::vector<int> leading_edge(const Blank& blank, const PullOutSpec& spec) {
  std::vector<int> nodes;
  const double grip = spec.orientation == 0.0 ? 1e-9 : std::max(blank.spacing[0], blank.spacing[1]);
  for (int i = 0; i < blank.nodes(); ++i)
    if (blank.reference[i].x() >= 0.5 * spec.size[0] - grip) nodes.push_back(i);
  return nodes;
}

Scene pull_out_scene(const PullOutSpec& spec, const mesoscale::FabricProperties& fabric,
                     const friction::Model& friction) {
  Scene scene;
  const double half_length = 0.5 * spec.size[0], half_width = 0.5 * spec.size[1];
  // Along its tows the sample is a whole grid; at an angle to them it is cut out.
  if (spec.orientation == 0.0)
    scene.blank = make_blank(spec.size, spec.spacing);
  else
    scene.blank = make_blank(Outline{.outer = {{-half_length, -half_width},
                                               {half_length, -half_width},
                                               {half_length, half_width},
                                               {-half_length, half_width}},
                                     .holes = {}},
                             spec.spacing, spec.orientation);
  scene.fabric = &fabric;
  scene.friction = &friction;
  const double half = 0.5 * fabric.thickness;
  Shape lower = PlaneShape{{0, 0, -half}, {0, 0, 1}}, upper = PlaneShape{{0, 0, half}, {0, 0, -1}};
  if (spec.bend) {
    lower = plate_of(spec, fabric, true);
    upper = plate_of(spec, fabric, false);
  }
  scene.tools = {{Role::die, lower, Motion::fixed, 0.0, 0.0},
                 {Role::binder, upper, Motion::loaded, spec.normal_force, spec.plate_mass}};
  scene.blank_temperature = spec.fabric_temperature;
  scene.tool_temperature = spec.tool_temperature;
  scene.slip_smoothing = std::max(2e-4 * spec.speed, 1e-6);
  scene.contact_pressure = spec.contact_pressure;
  scene.contact_sites = spec.contact_sites;
  scene.held.assign(3 * scene.blank.nodes(), 0);
  for (const int node : leading_edge(scene.blank, spec)) {
    scene.held[3 * node] = 1;      // pulled along x
    scene.held[3 * node + 1] = 1;  // the holder keeps its width
  }
  return scene;
}

// Uniform closing: every node sinks by the same approach, the plate by twice that.
void close_plates(const System& system, State& state, const PullOutSpec& spec) {
  if (spec.bend) {
    const auto& plate = std::get<CurvedPlateShape>(system.scene().tools[0].shape);
    for (int i = 0; i < system.scene().blank.nodes(); ++i) {
      const Eigen::Vector3d r = system.scene().blank.reference[i];
      state.x.segment<3>(3 * i) = place_on(plate, r.x() - plate.start) + Eigen::Vector3d(0.0, r.y(), 0.0);
    }
  }
  const double approach = approach_at(system.compaction(), spec.normal_force / (spec.size[0] * spec.size[1]));
  for (auto& of_tool : state.memory) std::fill(of_tool.begin(), of_tool.end(), spec.memory);
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

  const std::vector<int> gripped = leading_edge(scene.blank, spec);
  const Eigen::VectorXd laid = state.x;
  const auto pull = [&](double time, Eigen::VectorXd& x) {
    for (const int node : gripped) {
      x[3 * node] = laid[3 * node] + spec.speed * time;
      x[3 * node + 1] = laid[3 * node + 1];
    }
  };
  PullOutResult result;
  result.nu = scene.blank.nu;
  result.nv = scene.blank.nv;
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
      result.lower_pressure = nodal_pressure(system, step, 0);
      result.upper_pressure = nodal_pressure(system, step, 1);
      for (const double lower : result.lower_pressure)
        result.pressure_spread = std::max(result.pressure_spread, std::abs(lower / mean - 1.0));
      for (const double angle : end.corner_angle)
        result.shear_angle_max = std::max(result.shear_angle_max, std::abs(angle));
    }
    state = std::move(end);
  }
  result.steady_force = result.force.back();
  result.completed = true;
  return result;
}

}  // namespace heddle::macroscale
