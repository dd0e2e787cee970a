#include "macroscale/newton.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/problem.h"

namespace heddle::macroscale {

namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

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
std::string node_beyond_tools(const System& system, const Position& position) {
  const Scene& scene = system.scene();
  for (int k = 0; k < static_cast<int>(scene.tools.size()); ++k)
    for (int i = 0; i < system.contacts(); ++i) {
      if (std::isfinite(position.contacts[k][i].distance)) continue;
      const Vector3d at = 1e3 * at_point(system.contact_points()[i], position.x);
      return fmt::format(
          "{} at ({:.3g}, {:.3g}, {:.3g}) mm is deeper in the {} or further off it than its distances "
          "are known",
          name_of_contact(system, i), at.x(), at.y(), at.z(), name_of(scene.tools[k].role));
    }
  return "";
}

// A Newton direction and the Hessian it was made of.
struct Direction {
  bool found = false;
  VectorXd dx;
  Filter filter = Filter::none;
  int factorisations = 0;  ///< tried for it
};

// The Hessian asked for; projected where the exact one is not positive definite, then with a growing shift.
Direction newton_direction(System& system, const StepData& step, const Position& at, const VectorXd& g,
                           Filter filter) {
  Direction direction;
  const auto attempt = [&](Filter kind, double shift) {
    system.assemble(step, at, kind, shift);
    ++direction.factorisations;
    if (!system.solver().factorise()) return false;
    direction.dx = -g;
    system.solver().solve({direction.dx.data(), static_cast<std::size_t>(direction.dx.size())});
    direction.filter = kind;
    direction.found = direction.dx.allFinite();
    return direction.found;
  };
  if (attempt(filter, 0.0)) return direction;
  if (filter == Filter::none) {
    filter = Filter::positive;
    if (attempt(filter, 0.0)) return direction;
  }
  const double scale = system.largest_diagonal();
  for (double shift = 1e-6 * scale; shift <= scale; shift *= 10.0)
    if (attempt(filter, shift)) return direction;
  return direction;
}

struct LineSearch {
  double alpha = 0.0;  ///< 0 = no decrease found
  std::string lost;    ///< the node that kept a trial from having an energy, in words
};

// Armijo's rule by halving. Moves `at` and energy along dx where it holds; `trial` is room to work in.
LineSearch search(const System& system, const StepData& step, const SolveOptions& options, const VectorXd& dx,
                  double slope, Position& at, Position& trial, double& energy) {
  LineSearch found;
  double alpha = 1.0;
  for (int k = 0; k < options.line_search_limit; ++k, alpha *= 0.5) {
    system.evaluate(step, at.x + alpha * dx, trial);
    const double trial_energy = system.potential(step, trial).total();
    const double change = trial_energy - energy + system.friction_difference(step, at, trial);
    const double rounding = 1e-13 * (std::abs(energy) + 1.0);
    if (std::isfinite(change) && change <= 1e-4 * alpha * slope + rounding) {
      std::swap(at, trial);
      energy = trial_energy;
      found.alpha = alpha;
      return found;
    }
    if (!std::isfinite(change)) found.lost = node_beyond_tools(system, trial);
  }
  return found;
}

// Which Hessian to take next. Exact while full steps succeed (its quadratic tail is worth a failed
// factorisation now and then), projected after a shortened one. Where slip turns round, friction has a kink
// that the tangent does not see coming, and steps over hundreds of kinks shrink to nothing: then the bounding
// Hessian crosses all of them at once, for as many iterations as it was needed before, doubled.
class Choice {
 public:
  explicit Choice(bool rubs) : rubs_(rubs) {}
  Filter filter() const { return filter_; }

  void after(Filter used, double alpha, bool capped) {
    constexpr double poor = 0.1;
    if (used == Filter::bounding) {
      if (--left_ <= 0 && alpha == 1.0) filter_ = Filter::positive;
    } else if (alpha < poor && rubs_) {
      bound();
    } else {
      filter_ = alpha == 1.0 && !capped ? Filter::none : Filter::positive;
    }
  }
  // After a step that led nowhere. Whether there is a Hessian left to try.
  bool fall_back(Filter used) {
    if (used == Filter::none) {
      filter_ = Filter::positive;
      return true;
    }
    if (used == Filter::bounding || !rubs_) return false;
    bound();
    return true;
  }

 private:
  void bound() {
    filter_ = Filter::bounding;
    left_ = patience_;
    patience_ = std::min(2 * patience_, 16);
  }
  bool rubs_;
  Filter filter_ = Filter::none;
  int patience_ = 1, left_ = 0;
};

}  // namespace

void polish(System& system, const StepData& step, VectorXd& x, StepSummary& summary) {
  constexpr int most = 3;
  Position& at = system.room().at;
  system.evaluate(step, x, at);
  VectorXd g = system.gradient(step, at);
  for (int k = 0; k < most; ++k) {
    VectorXd trial = -g;
    system.solver().solve({trial.data(), static_cast<std::size_t>(trial.size())});
    trial += x;
    system.evaluate(step, trial, at);
    g = system.gradient(step, at);
    const Largest left = largest(g);
    if (!(left.value < 0.5 * summary.residual)) return;
    x = std::move(trial);
    summary.residual = left.value;
    summary.worst = name_of(system, left.unknown);
  }
}

Pass minimise(System& system, const StepData& step, VectorXd& x, const SolveOptions& options,
              double tolerance, StepSummary& summary) {
  auto& [at, trial] = system.room();
  system.evaluate(step, x, at);
  if (std::string lost = node_beyond_tools(system, at); !lost.empty())
    return {false, std::move(lost), false, FailureKind::lost_tool};
  const bool rubs = system.scene().friction && !step.frictionless;
  // Slip is resolved to a share of what the smoothing of friction lets creep in a step.
  const double least = rubs ? std::min(options.stagnation, 1e-3 * system.scene().slip_smoothing * step.dt)
                            : options.stagnation;
  Choice choice(rubs);
  VectorXd g = system.gradient(step, at);
  double energy = system.potential(step, at).total();
  for (int iteration = 0;; ++iteration) {
    if (options.stop && options.stop()) return {false, "stopped from outside", true};
    demand_finite(system, g, "residual force", step.start->time + step.dt);
    const Largest worst = largest(g);
    summary.residual = worst.value;
    summary.worst = name_of(system, worst.unknown);
    if (worst.value <= tolerance) return {true, "converged"};
    if (iteration == options.newton_limit)
      return {false, fmt::format("{} Newton iterations left a residual of {:.3g} N at {}",
                                 options.newton_limit, summary.residual, summary.worst)};

    Direction direction = newton_direction(system, step, at, g, choice.filter());
    if (!direction.found)
      return {false, "no descent direction: the matrix stays indefinite under any shift", false,
              FailureKind::indefinite};
    ++summary.newton_iterations;
    summary.factorisations += direction.factorisations;
    const double size = direction.dx.cwiseAbs().maxCoeff();
    const bool capped = size > options.largest_increment;
    if (capped) direction.dx *= options.largest_increment / size;
    const LineSearch found =
        search(system, step, options, direction.dx, g.dot(direction.dx), at, trial, energy);
    if (found.alpha == 0.0) {
      if (choice.fall_back(direction.filter)) continue;
      if (found.lost.empty()) return {worst.value <= 10.0 * tolerance, "line search found no decrease"};
      return {worst.value <= 10.0 * tolerance, found.lost, false, FailureKind::lost_tool};
    }
    choice.after(direction.filter, found.alpha, capped);
    x = at.x;
    g = system.gradient(step, at);
    if (found.alpha * direction.dx.cwiseAbs().maxCoeff() >= least) continue;
    const Largest left = largest(g);
    if (left.value <= tolerance || choice.fall_back(direction.filter)) continue;
    summary.residual = left.value;
    if (left.value <= 10.0 * tolerance) return {true, "converged"};
    return {false, fmt::format("stagnated with a residual of {:.3g} N at {}", left.value,
                               name_of(system, left.unknown))};
  }
}

}  // namespace heddle::macroscale
