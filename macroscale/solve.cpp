#include "macroscale/solve.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <tbb/parallel_for.h>
#include <Eigen/Geometry>

#include "core/problem.h"
#include "friction/hersey.h"

namespace heddle::macroscale {

namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

friction::Context context_of(const Scene& scene, double pressure, double shear_angle) {
  friction::Context context;
  context.pressure = pressure;
  context.fabric_temperature = scene.blank_temperature;
  context.tool_temperature = scene.tool_temperature;
  if (scene.contact_pressure == ContactPressure::real) {
    const auto floored = friction::floored(pressure);
    const auto area = scene.fabric->contact.evaluate(floored.value, shear_angle);
    context.area_fraction = area.fraction;
    context.area_slope = area.slope * floored.slope;
  }
  return context;
}

// Slip direction against the warp, both in the tangent plane of the contact [rad]; 0 at rest.
double slip_angle(const Scene& scene, const VectorXd& x, int node, const Vector3d& normal,
                  const Vector3d& v) {
  const Blank& blank = scene.blank;
  const auto [i, j] = blank.grid[node];
  const auto neighbour = [&](int line) {
    const int n = line < 0 || line > blank.nu ? -1 : blank.node(line, j);
    return n < 0 ? node : n;
  };
  const int before = neighbour(i - 1), after = neighbour(i + 1);
  const Vector3d tow = x.segment<3>(3 * after) - x.segment<3>(3 * before);
  const Vector3d warp = tow - normal.dot(tow) * normal, slip = v - normal.dot(v) * normal;
  return std::atan2(normal.dot(warp.cross(slip)), warp.dot(slip));
}

using FrictionPoints = std::vector<std::vector<FrictionPoint>>;

// Loads, normals and contexts of all points at x: what the next pass holds.
FrictionPoints freeze(const System& system, const StepData& step, const VectorXd& x,
                      const std::vector<double>& shear_angle) {
  const Scene& scene = system.scene();
  const int nodes = scene.blank.nodes();
  FrictionPoints points(scene.tools.size(), std::vector<FrictionPoint>(nodes));
  if (step.frictionless || !scene.friction) return points;
  for (int k = 0; k < static_cast<int>(scene.tools.size()); ++k)
    tbb::parallel_for(0, nodes, [&, k](int i) {
      const auto [d, contact] = system.tool_contact(step, x, k, i);
      FrictionPoint& point = points[k][i];
      point.memory = step.start->memory[k][i];
      if (contact.pressure <= 0.0) return;
      point.load = contact.pressure * scene.blank.node_area[i];
      // A distance interpolated from samples has a gradient of length about 1: slip needs a true projection.
      point.normal = d.normal.normalized();
      point.context = context_of(scene, contact.pressure, shear_angle[i]);
      point.context.time_step = step.dt;
      point.context.slip_angle =
          slip_angle(scene, x, i, point.normal, system.relative_velocity(step, x, k, i));
    });
  return points;
}

// Sum over all points of the size of the change of the friction force between two frozen sets, over the sum
// of its size: loads, normals and coefficients all count. 1 where all contact was lost.
double lag_residual(const System& system, const StepData& step, const VectorXd& x,
                    const FrictionPoints& before, const FrictionPoints& after) {
  const FrictionSettings settings = system.friction_settings();
  double change = 0.0, sum = 0.0;
  for (int k = 0; k < static_cast<int>(after.size()); ++k)
    for (int i = 0; i < static_cast<int>(after[k].size()); ++i) {
      if (after[k][i].load == 0.0 && before[k][i].load == 0.0) continue;
      const Vector3d v = system.relative_velocity(step, x, k, i);
      const auto force = [&](const FrictionPoint& p) -> Vector3d {
        return p.load > 0.0 ? friction_force(settings, p, v) : Vector3d::Zero();
      };
      const Vector3d now = force(after[k][i]);
      change += (now - force(before[k][i])).norm();
      sum += now.norm();
    }
  if (sum > 0.0) return change / sum;
  return change > 0.0 ? 1.0 : 0.0;
}

double mean_contact_force(const System& system, const StepData& step, const VectorXd& x) {
  const Scene& scene = system.scene();
  double sum = 0.0;
  int touching = 0;
  for (int k = 0; k < static_cast<int>(scene.tools.size()); ++k)
    for (int i = 0; i < scene.blank.nodes(); ++i) {
      const double p = system.tool_contact(step, x, k, i).normal.pressure;
      if (p <= 0.0) continue;
      sum += p * scene.blank.node_area[i];
      ++touching;
    }
  return touching > 0 ? sum / touching : 0.0;
}

struct Largest {
  double value;
  int unknown;
};

Largest largest(const VectorXd& g) {
  Eigen::Index at = 0;
  const double value = g.cwiseAbs().maxCoeff(&at);
  return {value, static_cast<int>(at)};
}

void demand_finite(const System& system, const VectorXd& values, const char* quantity, double time) {
  if (values.allFinite()) return;
  for (Eigen::Index k = 0; k < values.size(); ++k)
    if (!std::isfinite(values[k]))
      throw NumericalError(fmt::format("{} of {} (component {}) is not finite at t = {:.6g} s", quantity,
                                       name_of(system, static_cast<int>(k)), k % 3, time));
}

// The first node whose distance to a tool is not known because it lies too deep inside or off the room that
// the tool's distances cover, in words; "" if there is none. Contact has no energy there.
std::string node_beyond_tools(const System& system, const StepData& step, const VectorXd& x) {
  const Scene& scene = system.scene();
  for (int k = 0; k < static_cast<int>(scene.tools.size()); ++k)
    for (int i = 0; i < scene.blank.nodes(); ++i) {
      if (std::isfinite(system.tool_contact(step, x, k, i).surface.distance)) continue;
      const Vector3d at = 1e3 * x.segment<3>(3 * i);
      return fmt::format(
          "node {} at ({:.3g}, {:.3g}, {:.3g}) mm is deeper in the {} or further off it than its distances "
          "are known",
          i, at.x(), at.y(), at.z(), name_of(scene.tools[k].role));
    }
  return "";
}

// Newton direction. The unfiltered Hessian is tried where the last iteration took a full step (its quadratic
// tail is worth a failed factorisation now and then), then the projected one, then a growing shift.
struct Direction {
  bool found = false;
  VectorXd dx;
  bool exact = false;
};

Direction newton_direction(System& system, const StepData& step, const VectorXd& x, const VectorXd& g,
                           bool try_exact) {
  Direction direction;
  const auto attempt = [&](Filter filter, double shift) {
    system.assemble(step, x, filter, shift);
    if (!system.solver().factorise()) return false;
    direction.dx = -g;
    system.solver().solve({direction.dx.data(), static_cast<std::size_t>(direction.dx.size())});
    direction.found = direction.dx.allFinite();
    return direction.found;
  };
  if (try_exact && attempt(Filter::none, 0.0)) {
    direction.exact = true;
    return direction;
  }
  if (attempt(Filter::positive, 0.0)) return direction;
  const double scale = system.largest_diagonal();
  for (double shift = 1e-6 * scale; shift <= scale; shift *= 10.0)
    if (attempt(Filter::positive, shift)) return direction;
  return direction;
}

// Steps along the factors of the last iteration, as long as each halves the residual: a back-substitution
// costs a fraction of a factorisation, and far below the tolerance the result no longer depends on the
// iteration at which a search happened to end. (Slopes to small parameters are taken as differences of runs.)
void polish(System& system, const StepData& step, VectorXd& x, VectorXd g, StepSummary& summary) {
  constexpr int most = 3;
  for (int k = 0; k < most; ++k) {
    VectorXd trial = -g;
    system.solver().solve({trial.data(), static_cast<std::size_t>(trial.size())});
    trial += x;
    g = system.gradient(step, trial);
    const Largest left = largest(g);
    if (!(left.value < 0.5 * summary.residual)) return;
    x = std::move(trial);
    summary.residual = left.value;
    summary.worst = name_of(system, left.unknown);
  }
}

struct Pass {
  bool converged = false;
  std::string reason;
  bool stopped = false;
};

// Newton with line search at frozen friction loads.
Pass minimise(System& system, const StepData& step, VectorXd& x, const SolveOptions& options,
              double tolerance, StepSummary& summary) {
  bool full_step = true;
  if (std::string lost = node_beyond_tools(system, step, x); !lost.empty()) return {false, std::move(lost)};
  VectorXd g = system.gradient(step, x);
  double energy = system.potential(step, x).total();
  for (int iteration = 0; iteration <= options.newton_limit; ++iteration) {
    if (options.stop && options.stop()) return {false, "stopped from outside", true};
    demand_finite(system, g, "residual force", step.start->time + step.dt);
    const Largest worst = largest(g);
    summary.residual = worst.value;
    summary.worst = name_of(system, worst.unknown);
    if (worst.value <= tolerance) {
      if (iteration > 0) polish(system, step, x, g, summary);
      return {true, "converged"};
    }
    if (iteration == options.newton_limit) break;

    Direction direction = newton_direction(system, step, x, g, full_step);
    if (!direction.found) return {false, "no descent direction: the matrix stays indefinite under any shift"};
    ++summary.newton_iterations;
    const double size = direction.dx.cwiseAbs().maxCoeff();
    if (size > options.largest_increment) direction.dx *= options.largest_increment / size;
    const double slope = g.dot(direction.dx);

    double alpha = 1.0;
    bool accepted = false;
    std::string lost;  // the node that kept the last trial from having an energy
    for (int k = 0; k < options.line_search_limit; ++k, alpha *= 0.5) {
      const VectorXd trial = x + alpha * direction.dx;
      const double trial_energy = system.potential(step, trial).total();
      const double change = trial_energy - energy + system.friction_difference(step, x, trial);
      const double rounding = 1e-13 * (std::abs(energy) + 1.0);
      if (std::isfinite(change) && change <= 1e-4 * alpha * slope + rounding) {
        x = trial;
        energy = trial_energy;
        accepted = true;
        break;
      }
      if (!std::isfinite(change)) lost = node_beyond_tools(system, step, trial);
    }
    if (!accepted) {
      if (direction.exact) {  // the exact direction may climb where the potential is not convex: project and
                              // try again
        full_step = false;
        continue;
      }
      return {worst.value <= 10.0 * tolerance, lost.empty() ? "line search found no decrease" : lost};
    }
    const double moved = alpha * direction.dx.cwiseAbs().maxCoeff();
    full_step = alpha == 1.0 && size <= options.largest_increment;
    g = system.gradient(step, x);
    if (moved < options.stagnation && direction.exact && alpha < 1.0) {
      full_step = false;  // hardly a step along the exact direction: project before giving up
      continue;
    }
    if (moved < options.stagnation) {
      const Largest left = largest(g);
      summary.residual = left.value;
      if (left.value <= 10.0 * tolerance) return {true, "converged"};
      return {false, fmt::format("stagnated with a residual of {:.3g} N at {}", left.value,
                                 name_of(system, left.unknown))};
    }
  }
  return {false, fmt::format("{} Newton iterations left a residual of {:.3g} N at {}", options.newton_limit,
                             summary.residual, summary.worst)};
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
    end.tool_z[k] = system.tool_position(step, x, k);
  end.corner_angle.resize(start.corner_angle.size());
  for (std::size_t q = 0; q < scene.blank.quads.size(); ++q) {
    const auto corners = corners_of(scene.blank.quads[q]);
    for (std::size_t k = 0; k < 4; ++k) {
      const Corner& c = corners[k];
      end.corner_angle[4 * q + k] =
          corner_angle(end.node(c.along_warp) - end.node(c.node), end.node(c.along_weft) - end.node(c.node));
    }
  }
  end.memory = start.memory;
}

void accept(const System& system, const StepData& step, const VectorXd& x, State& end) {
  place(system, step, x, end);
  const Scene& scene = system.scene();
  if (step.frictionless || !scene.friction) return;
  const FrictionSettings settings = system.friction_settings();
  for (int k = 0; k < static_cast<int>(scene.tools.size()); ++k)
    for (int i = 0; i < scene.blank.nodes(); ++i) {
      const FrictionPoint& point = step.friction[k][i];
      friction::ContactState& memory = end.memory[k][i];
      if (point.load == 0.0) continue;
      const double speed = slip_velocity(point, system.relative_velocity(step, x, k, i)).norm();
      const auto law = law_at(settings, point, speed);
      memory = law.state;
      memory.slip += speed * step.dt;
      memory.dwell += step.dt;
      const Vector3d v = system.relative_velocity(step, x, k, i);
      memory.work_per_area += friction_force(settings, point, v).dot(v) * step.dt / scene.blank.node_area[i];
    }
}

// What makes a converged state unusable, or "": a corner that closed or turned over, fabric pressed beyond
// its table.
std::string fault_of(const System& system, const StepData& step, const State& end) {
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
        return fmt::format("the corner at node {} closed or turned over (shear {:.1f} deg)", c.node,
                           end.corner_angle[4 * q + k] * 180.0 / std::numbers::pi);
    }
  }
  for (int k = 0; k < static_cast<int>(scene.tools.size()); ++k)
    for (int i = 0; i < scene.blank.nodes(); ++i) {
      const double approach = system.tool_contact(step, end.x, k, i).normal.approach;
      if (approach > system.compaction().x().back())
        return fmt::format(
            "node {} is pressed {:.3f} mm into the {}, beyond the compaction table ({:.3f} mm)", i,
            1e3 * approach, name_of(scene.tools[k].role), 1e3 * system.compaction().x().back());
    }
  return "";
}

}  // namespace

std::string name_of(const System& system, int unknown) {
  const int nodes = system.scene().blank.nodes();
  return unknown < 3 * nodes ? fmt::format("node {}", unknown / 3)
                             : fmt::format("loaded tool {}", unknown - 3 * nodes);
}

State state_at_iterate(const System& system, const StepData& step) {
  State state;
  place(system, step, step.iterate, state);
  return state;
}

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
  const std::vector<double> shear_angle = nodal_shear_angle(system.scene().blank, state.corner_angle);
  StepData old_place = step;
  old_place.tool_z = state.tool_z;
  step.friction = freeze(system, old_place, state.x, shear_angle);

  step.iterate = step.target;
  VectorXd& x = step.iterate;
  if (prescribe) prescribe(state.time + dt, x);
  StepSummary summary;
  const double tolerance = std::max(
      options.force_tolerance, options.relative_tolerance * mean_contact_force(system, old_place, state.x));
  const bool rubs = system.scene().friction && !step.frictionless;
  const auto update = [&] {
    FrictionPoints next = freeze(system, step, x, shear_angle);
    summary.lag_residual = lag_residual(system, step, x, step.friction, next);
    return next;
  };
  for (int lag = 0; lag < options.lag_limit_iterations; ++lag) {
    ++summary.lag_iterations;
    const bool first = rubs && lag == 0;
    Pass pass = minimise(system, step, x, options, first ? tolerance * options.first_pass_factor : tolerance,
                         summary);
    if (!pass.converged) {
      summary.reason = pass.reason;
      summary.stopped = pass.stopped;
      return summary;
    }
    if (!rubs) break;
    FrictionPoints next = update();
    if (first && summary.lag_residual < options.lag_tolerance) {
      pass = minimise(system, step, x, options, tolerance, summary);
      if (!pass.converged) {
        summary.reason = pass.reason;
        summary.stopped = pass.stopped;
        return summary;
      }
      next = update();
    }
    if (summary.lag_residual < options.lag_tolerance) break;
    if (lag + 1 < options.lag_limit_iterations) step.friction = std::move(next);
  }
  if (summary.lag_residual > options.lag_limit) {
    summary.reason = fmt::format("friction loads still move by {:.1f} % after {} updates",
                                 100.0 * summary.lag_residual, summary.lag_iterations);
    return summary;
  }
  accept(system, step, x, end);
  summary.reason = fault_of(system, step, end);
  summary.converged = summary.reason.empty();
  if (summary.converged) summary.reason = "converged";
  return summary;
}

}  // namespace heddle::macroscale
