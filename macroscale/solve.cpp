#include "macroscale/solve.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <fmt/format.h>
#include <Eigen/Geometry>

#include "macroscale/friction_lag.h"
#include "macroscale/newton.h"
#include "macroscale/self_contact.h"

namespace heddle::macroscale {

std::vector<double> corner_angles(const Blank& blank, const State& state) {
  std::vector<double> angle(4 * blank.quads.size());
  for (std::size_t q = 0; q < blank.quads.size(); ++q) {
    const auto corners = corners_of(blank.quads[q]);
    for (std::size_t k = 0; k < 4; ++k) {
      const Corner& c = corners[k];
      angle[4 * q + k] = corner_angle(state.node(c.along_warp) - state.node(c.node),
                                      state.node(c.along_weft) - state.node(c.node));
    }
  }
  return angle;
}

namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

// What nodal residuals are measured by: how hard nodes press on the tools in the mean, and all of them on the
// tools that are driven.
struct ContactScale {
  double mean = 0.0, driven = 0.0;  ///< [N]
};

ContactScale contact_scale(const System& system, const StepData& step, const VectorXd& x) {
  const Scene& scene = system.scene();
  ContactScale scale;
  double sum = 0.0;
  int touching = 0;
  for (int k = 0; k < static_cast<int>(scene.tools.size()); ++k)
    for (int i = 0; i < system.contacts(); ++i) {
      const double p = system.tool_contact(step, x, k, i).normal.pressure;
      if (p <= 0.0) continue;
      sum += p * system.contact_area(step, i);
      if (scene.tools[k].motion == Motion::driven || scene.tools[k].motion == Motion::sprung)
        scale.driven += p * system.contact_area(step, i);
      ++touching;
    }
  // A node feels as many contact points as there are for one node.
  if (touching > 0)
    scale.mean = sum / touching * (static_cast<double>(system.contacts()) / scene.blank.nodes());
  return scale;
}

// A share of the mean nodal contact force. Where much binder force rubs little (mu near zero), residuals far
// below it still add up to the punch force: then a hundredth of that, spread over the nodes, counts, down to
// a fiftieth of the first.
double residual_limit(const SolveOptions& options, const ContactScale& scale, int nodes) {
  double relative = options.relative_tolerance * scale.mean;
  if (scale.driven > 0.0) relative = std::clamp(1e-2 * scale.driven / nodes, 0.02 * relative, relative);
  return std::max(options.force_tolerance, relative);
}

// Positions, velocities and angles at the end of a step that reached x; contact remembers what it did before.
void place(const System& system, const StepData& step, const VectorXd& x, State& end) {
  const Scene& scene = system.scene();
  const State& start = *step.start;
  end.time = start.time + step.dt;
  end.x = x;
  end.v = (x - start.x) / step.dt;
  end.tool_z.resize(scene.tools.size());
  for (int k = 0; k < static_cast<int>(scene.tools.size()); ++k)
    end.tool_z[k] = scene.tools[k].motion == Motion::sprung ? step.tool_z[k] : system.pose(step, x, k).z;
  end.corner_angle = corner_angles(scene.blank, end);
  end.shear_memory = start.shear_memory;
  for (std::size_t k = 0; k < end.shear_memory.size(); ++k)
    end.shear_memory[k] = sheared_to(scene.shear_friction, scene.fabric->shear_stress, start.shear_memory[k],
                                     std::sin(end.corner_angle[k]));
  end.memory = start.memory;
  if (!step.pairs.empty()) {
    end.memory.resize(scene.tools.size() + 1);
    end.memory.back().resize(std::max(end.memory.back().size(), step.pairs.size()));
  }
  end.coupling = system.coupling();
  end.heat = start.heat;
}

void accept(const System& system, const StepData& step, const VectorXd& x, State& end) {
  place(system, step, x, end);
  const Scene& scene = system.scene();
  if (step.frictionless || !scene.friction) return;
  for (int k = 0; k < system.friction_rows(step); ++k) {
    const FrictionSettings settings = system.friction_settings(k);
    for (int i = 0; i < system.points_in_row(step, k); ++i) {
      const FrictionPoint& point = step.friction[k][i];
      friction::ContactState& memory = end.memory[k][i];
      if (point.load == 0.0) continue;
      const double speed = slip_velocity(point, system.velocity_in_row(step, x, k, i)).norm();
      const auto law = law_at(settings, point, speed);
      memory = law.state;
      memory.slip += speed * step.dt;
      memory.dwell += step.dt;
      const Vector3d v = system.velocity_in_row(step, x, k, i);
      memory.work_per_area +=
          friction_force(settings, point, v).dot(v) * step.dt / system.area_in_row(step, k, i);
    }
  }
}

// What makes a converged state unusable, or "": a corner that closed or turned over, fabric pressed beyond
// its table.
struct Fault {
  std::string reason;
  FailureKind kind = FailureKind::search;
};

Fault fault_of(const System& system, const StepData& step, const State& end, bool may_cross) {
  const Scene& scene = system.scene();
  constexpr double closed = 89.0 * std::numbers::pi / 180.0;
  for (std::size_t q = 0; q < scene.blank.quads.size(); ++q) {
    const auto corners = corners_of(scene.blank.quads[q]);
    for (std::size_t k = 0; k < 4; ++k) {
      const Corner& c = corners[k];
      const auto normal = [&](const State& s) {
        return (s.node(c.along_warp) - s.node(c.node)).cross(s.node(c.along_weft) - s.node(c.node)).eval();
      };
      if (std::abs(end.corner_angle[4 * q + k]) > closed || normal(end).dot(normal(*step.start)) < 0.0)
        return {fmt::format("the corner at node {} closed or turned over (shear {:.1f} deg)", c.node,
                            end.corner_angle[4 * q + k] * 180.0 / std::numbers::pi),
                FailureKind::folded};
    }
  }
  for (int k = 0; k < static_cast<int>(scene.tools.size()); ++k)
    for (int i = 0; i < system.contacts(); ++i) {
      const double approach = system.tool_contact(step, end.x, k, i).normal.approach;
      if (approach > 0.5 * scene.fabric->thickness)
        return {fmt::format("{} is pressed {:.3f} mm into the {}, through the middle of the fabric",
                            name_of_contact(system, i), 1e3 * approach, name_of(scene.tools[k].role)),
                FailureKind::pressed_through};
    }
  for (std::size_t k = 0; k < step.pairs.size(); ++k)
    if (const double approach = system.contact_of_plies(step.pairs[k], end.x).approach;
        approach > 0.5 * step.pairs[k].rest) {
      const PlyPoint& point = system.ply_points()[k];
      const bool folded = point.against == scene.blank.ply_of_quad(point.quad);
      if (folded && may_cross) continue;
      return {fmt::format("cell {} is pressed {:.3f} mm into {}, through its middle", point.quad,
                          1e3 * approach, folded ? "another part of the sheet" : "the next ply"),
              folded ? FailureKind::folded : FailureKind::pressed_through};
    }
  if (may_cross) return {};
  return {passage_of(system, step, end), FailureKind::folded};
}

}  // namespace

std::string name_of(const System& system, int unknown) {
  const std::vector<Tool>& tools = system.scene().tools;
  for (int k = 0; k < static_cast<int>(tools.size()); ++k) {
    const int place = unknown - system.unknown_of(k);
    if (system.unknown_of(k) < 0 || place < 0 || place >= unknowns_of(tools[k])) continue;
    return fmt::format("{} (tool {}){}", name_of(tools[k].role), k, place == 0 ? "" : ", its tilt");
  }
  return fmt::format("node {}", unknown / 3);
}

std::string name_of_contact(const System& system, int point) {
  return system.scene().contact_sites == ContactSites::nodes ? fmt::format("node {}", point)
                                                             : fmt::format("cell {}", point / 4);
}

State state_at_iterate(const System& system, const StepData& step) {
  State state;
  place(system, step, step.iterate, state);
  return state;
}

// Share of the way to new friction loads below which it is not cut.
constexpr double least_share = 1.0 / 32.0;

StepSummary advance(System& system, const State& state, double dt, const std::vector<double>& tool_z,
                    const std::function<void(double, VectorXd&)>& prescribe, const SolveOptions& options,
                    State& end, StepData& step) {
  step = StepData{};
  step.frictionless = options.frictionless;
  step.dt = dt;
  step.start = &state;
  step.target = state.x + dt * state.v;
  step.tool_z = tool_z;

  // Friction loads of the start: at the tools' old places, where the state is in equilibrium.
  const Scene& scene = system.scene();
  const std::vector<double> shear_angle =
      contact_shear_angle(scene.blank, scene.contact_sites, state.corner_angle);
  if (scene.compaction_follows_shear) step.contact_shear = shear_angle;
  system.pair(step);
  StepData old_place = step;
  old_place.tool_z = state.tool_z;
  step.friction = freeze(system, old_place, state.x, shear_angle);

  step.iterate = step.target;
  VectorXd& x = step.iterate;
  if (prescribe) prescribe(state.time + dt, x);
  StepSummary summary;
  const double tolerance =
      residual_limit(options, contact_scale(system, old_place, state.x), system.scene().blank.nodes());
  const bool rubs = system.scene().friction && !step.frictionless;
  const auto search = [&](double limit) {
    const Pass pass = minimise(system, step, x, options, limit, summary);
    summary.reason = pass.reason;
    summary.kind = pass.kind;
    summary.stopped = pass.stopped;
    return pass.converged;
  };
  double share = 1.0;  // of the way to the new loads; less once they swing
  LagChange change;
  for (int lag = 0;; ++lag) {
    ++summary.lag_iterations;
    const bool first = rubs && lag == 0;
    if (!search(first ? tolerance * options.first_pass_factor : tolerance)) return summary;
    if (!rubs) break;
    const double before = lag > 0 ? change.relative : std::numeric_limits<double>::infinity();
    FrictionPoints next = freeze(system, step, x, shear_angle);
    change = lag_change(system, step, x, step.friction, next);
    if (first && change.relative < options.lag_tolerance) {
      if (!search(tolerance)) return summary;
      next = freeze(system, step, x, shear_angle);
      change = lag_change(system, step, x, step.friction, next);
    }
    summary.lag_residual = change.relative;
    if (change.relative < options.lag_tolerance || lag + 1 >= options.lag_limit_iterations) break;
    if (lag >= 2 && change.largest <= tolerance) break;
    if (change.relative > 0.8 * before) {
      // What swings however little the loads are moved is contact that comes and goes: its mean is the
      // answer.
      summary.swings = share == least_share && share * change.relative < options.lag_tolerance;
      if (summary.swings) break;
      share = std::max(0.5 * share, least_share);
    }
    step.friction = share == 1.0 ? std::move(next)
                                 : blend(system, step, step.friction, std::move(next), share, shear_angle);
  }
  if (summary.lag_residual > options.lag_limit && change.largest > tolerance && !summary.swings) {
    summary.reason = fmt::format("friction loads still move by {:.1f} % after {} updates",
                                 100.0 * summary.lag_residual, summary.lag_iterations);
    summary.kind = FailureKind::friction_loads;
    return summary;
  }
  if (summary.newton_iterations > 0) polish(system, step, x, summary);
  accept(system, step, x, end);
  const Fault fault = fault_of(system, step, end, options.may_cross);
  summary.reason = fault.reason;
  summary.kind = fault.kind;
  summary.converged = summary.reason.empty();
  if (summary.converged) summary.reason = "converged";
  return summary;
}

}  // namespace heddle::macroscale
