// What one Newton iteration of a stamping costs beside what it cannot do without: factorising and solving the
// same matrix with nothing round it, in the same run. Tools by their numbers, Table 1's fabric, the power law
// of Table 4, the stroke of the shipped case.
//
//     benchmark_stamping [--threads N] [SPACING_MM[:STEPS[:LAST]]]...      default: 2 threads, 8.9 6.4 4.5
//
// STEPS for the stroke (default 100), of which the run ends after LAST. Pieces are the best of several
// repeats on the state at 7/10 of what is run, CHOLMOD's own factorisation and ours in turns. "An iteration"
// is what one costs whose full step is accepted: all laws looked up at the trial, its energy, gradient and
// Hessian, factor and solve; "the run" divides all by the iterations, friction updates, polishing, ledger and
// pictures included. Prints a few lines a spacing, beside the goals, and the fitted growth of cost with the
// nodes; appends to benchmarks/results/stamping.csv; judges nothing.
#include <fmt/format.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "benchmarks/measure.h"
#include "core/sparse_solver.h"
#include "macroscale/checkpoint.h"
#include "macroscale/solve.h"
#include "macroscale/stamping.h"
#include "macroscale/stamping_scene.h"
#include "macroscale/system.h"
#include "mesoscale/cell_spec.h"

using namespace heddle;
using namespace heddle::macroscale;
using namespace heddle::benchmark;

namespace {

// The shortest of several repeats, wall and CPU each.
Time best_of(int repeats, const std::function<void()>& work) {
  Time best{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  for (int k = 0; k < repeats; ++k) {
    const Time t = time_of(work);
    best = {std::min(best.wall, t.wall), std::min(best.cpu, t.cpu)};
  }
  return best;
}

friction::Model table4_law() {
  friction::Model model;
  model.law = friction::HerseyPower{0.325, 0.136};
  return model;
}

// Conjugate gradients on the matrix in hand with the factor of another one: how many iterations, how long.
struct Stale {
  int iterations = 0;
  Time time;
};

// The pieces of one Newton iteration [s], and CHOLMOD's factorisation and solution of the same matrix.
struct Pieces {
  Time assemble, factorise, solve, gradient, energy, bare_factorise, bare_solve;
  std::vector<Stale> stale;  ///< matrix of the end of a step, factors of a tenth before and of its start
};

double sum(const Pieces& p, double Time::*clock) {
  return p.assemble.*clock + p.factorise.*clock + p.solve.*clock + p.gradient.*clock + p.energy.*clock;
}
double bare(const Pieces& p, double Time::*clock) {
  return p.bare_factorise.*clock + p.bare_solve.*clock;
}

// A x from the lower triangle.
Eigen::VectorXd times(SparseSolver& solver, const Eigen::VectorXd& x) {
  const SymmetricPattern& pattern = solver.pattern();
  const auto values = solver.values();
  Eigen::VectorXd y = Eigen::VectorXd::Zero(x.size());
  for (int j = 0; j < pattern.size; ++j) {
    int k = pattern.column_start[j];
    double sum = values[k] * x[j];  // the diagonal comes first
    for (++k; k < pattern.column_start[j + 1]; ++k) {
      sum += values[k] * x[pattern.row[k]];
      y[pattern.row[k]] += values[k] * x[j];
    }
    y[j] += sum;
  }
  return y;
}

Stale conjugate_gradients(SparseSolver& solver, const Eigen::VectorXd& right, double reduction) {
  constexpr int most = 200;
  Stale stale;
  stale.time = time_of([&] {
    const auto precondition = [&](Eigen::VectorXd r) {
      solver.solve({r.data(), static_cast<std::size_t>(r.size())});
      return r;
    };
    Eigen::VectorXd x = Eigen::VectorXd::Zero(right.size()), r = right, z = precondition(r), p = z;
    double rz = r.dot(z);
    while (stale.iterations < most && r.norm() > reduction * right.norm()) {
      ++stale.iterations;
      const Eigen::VectorXd ap = times(solver, p);
      const double alpha = rz / p.dot(ap);
      x += alpha * p;
      r -= alpha * ap;
      z = precondition(r);
      const double next = r.dot(z);
      p = z + next / rz * p;
      rz = next;
    }
  });
  return stale;
}

// One more step from a checkpoint, and each piece by itself on the system it leaves.
Pieces pieces_at(const StampingSpec& spec, const mesoscale::FabricProperties& fabric,
                 const friction::Model& law, const StampingCheckpoint& checkpoint) {
  const Scene scene = stamping_scene(spec, fabric, law);
  System system(scene);
  State end;
  StepData step;
  std::vector<double> tool_z = checkpoint.state.tool_z;
  const double dt = spec.process.time / spec.process.steps;
  for (std::size_t k = 0; k < tool_z.size(); ++k)
    if (scene.tools[k].motion == Motion::driven) tool_z[k] -= spec.process.stroke / spec.process.steps;
  advance(system, checkpoint.state, dt, tool_z, {}, {}, end, step);

  const int repeats = system.size() > 100000 ? 3 : 7;
  Pieces p;
  Eigen::VectorXd right(system.size());
  const auto span = [&] { return std::span(right.data(), static_cast<std::size_t>(right.size())); };
  Position before, at;
  system.evaluate(step, checkpoint.state.x, before);
  system.evaluate(step, step.iterate, at);
  p.assemble = best_of(repeats, [&] { system.assemble(step, at, Filter::none); });
  system.assemble(step, at, Filter::positive);
  const auto values = system.solver().values();
  SparseSolver cholmod(system.solver().pattern(), Factorisation::cholmod);
  std::copy(values.begin(), values.end(), cholmod.values().begin());
  p.factorise = p.bare_factorise = {1e9, 1e9};
  for (int k = 0; k < repeats; ++k) {  // in turns: what else the machine does meets both
    const Time bare = time_of([&] { cholmod.factorise(); }),
               ours = time_of([&] { system.solver().factorise(); });
    p.bare_factorise = {std::min(p.bare_factorise.wall, bare.wall), std::min(p.bare_factorise.cpu, bare.cpu)};
    p.factorise = {std::min(p.factorise.wall, ours.wall), std::min(p.factorise.cpu, ours.cpu)};
  }
  right.setOnes();
  p.bare_solve = best_of(repeats, [&] { cholmod.solve(span()); });
  right.setOnes();
  p.solve = best_of(repeats, [&] { system.solver().solve(span()); });
  p.gradient = best_of(repeats, [&] { right = system.gradient(step, at); });
  double energy = 0.0;
  p.energy = best_of(repeats, [&] {
    system.evaluate(step, step.iterate, at);  // where all laws are looked up, once a trial
    energy += system.potential(step, at).total() + system.friction_difference(step, before, at);
  });
  if (!std::isfinite(energy)) fmt::print("the energy is not finite\n");
  // The factor of a tenth of the step back, as if of the Newton iteration before, and of the step's start.
  for (const double back : {0.1, 1.0}) {
    Position there;
    system.evaluate(step, step.iterate + back * (checkpoint.state.x - step.iterate), there);
    system.assemble(step, there, Filter::positive);
    if (!system.solver().factorise()) continue;
    right = system.gradient(step, there);
    system.assemble(step, at, Filter::positive);
    p.stale.push_back(conjugate_gradients(system.solver(), right, 1e-3));
  }
  return p;
}

struct Measured {
  int nodes;
  double cpu;
};

// Exponent of cost ~ nodes^e by least squares of the logarithms.
double growth(const std::vector<Measured>& runs) {
  double n = 0, x = 0, y = 0, xx = 0, xy = 0;
  for (const Measured& run : runs) {
    const double a = std::log(run.nodes), b = std::log(run.cpu);
    n += 1, x += a, y += b, xx += a * a, xy += a * b;
  }
  return (n * xy - x * y) / (n * xx - x * x);
}

// What is run: a spacing, the steps of the stroke, and how many of them.
struct Task {
  double spacing = 0.0;
  int steps = 100, last = 100;
};

Task task_of(const std::string& text) {
  Task task;
  std::size_t at = 0;
  task.spacing = 1e-3 * std::stod(text, &at);
  if (at < text.size()) {
    std::size_t length = 0;
    task.steps = std::stoi(text.substr(at + 1), &length);
    at += 1 + length;
  }
  task.last = at < text.size() ? std::stoi(text.substr(at + 1)) : task.steps;
  return task;
}

// Goals of the solver on two cores: nodes up to which each holds, steps, seconds.
struct Goal {
  int nodes, steps;
  double must, aim;
};
constexpr Goal goals[] = {{6000, 100, 60.0, 60.0}, {22000, 60, 180.0, 90.0}, {110000, 100, 2700.0, 1800.0}};

void print_goal(int nodes, const Task& task, const Time& time) {
  for (const Goal& goal : goals) {
    if (nodes > goal.nodes) continue;
    if (nodes < goal.nodes / 2 || task.steps != goal.steps) return;
    if (task.last == task.steps)
      fmt::print(
          "  goal {:.0f} s, aim {:.0f} s on two cores: {:.0f} s, of which the processor worked {:.0f} CPU "
          "s\n",
          goal.must, goal.aim, time.wall, time.cpu);
    else
      fmt::print("  goal {:.0f} s, aim {:.0f} s on two cores; {} of {} steps: {:.0f} s, {:.0f} CPU s\n",
                 goal.must, goal.aim, task.last, task.steps, time.wall, time.cpu);
    return;
  }
}

// A run and its pieces: printed, and a row of the table.
struct Outcome {
  Measured measured;
  bool written;
};

Outcome measure(const Task& task, const mesoscale::FabricProperties& fabric, const friction::Model& law,
                int threads) {
  StampingSpec spec;
  spec.blank.spacing = task.spacing;
  spec.process.steps = task.steps;
  StampingCheckpoint at;
  int done = 0;
  StampingControl control;
  control.keep = [&](const StampingCheckpoint& c, bool) {
    done = c.step;
    if (c.step == 7 * task.last / 10) at = c;
  };
  control.stop = [&] { return done >= task.last && task.last < task.steps; };
  StampingResult result;
  const Time whole = time_of([&] { result = run_stamping(spec, fabric, law, control); });
  const StampingSummary& s = result.summary;
  if (!s.completed && !s.stopped) fmt::print("the run failed: {}\n", s.failure);
  const double memory = peak_megabytes();  // before the second factor of the comparison
  const Pieces p = pieces_at(spec, fabric, law, at);
  constexpr auto cpu = &Time::cpu, wall = &Time::wall;
  const double run = whole.cpu / s.newton_iterations;
  const double ours = p.factorise.cpu, others = p.assemble.cpu + p.gradient.cpu + p.energy.cpu;
  fmt::print(
      "{} nodes, {} of {} steps: {} Newton iterations, {} factorisations, {:.1f} s, {:.1f} CPU s, {:.0f} MB\n"
      "  bare CHOLMOD: factor {:.1f} + solve {:.1f} ms; ours: {:.1f} (CPU; {:.2f} of CHOLMOD's time at the "
      "clock) + "
      "{:.1f} ms\n"
      "  an iteration {:.1f} ms = {:.2f} x bare by CPU time, {:.2f} x at the clock on {} threads; the run "
      "{:.1f} ms "
      "= {:.2f} x\n"
      "  assembly {:.2f}, gradient {:.2f}, energy {:.2f} of our factorisation, together {:.2f} (goal 0.5)\n",
      s.nodes, done, task.steps, s.newton_iterations, s.factorisations, whole.wall, whole.cpu, memory,
      1e3 * p.bare_factorise.cpu, 1e3 * p.bare_solve.cpu, 1e3 * ours,
      p.factorise.wall / p.bare_factorise.wall, 1e3 * p.solve.cpu, 1e3 * sum(p, cpu),
      sum(p, cpu) / bare(p, cpu), sum(p, wall) / bare(p, wall), threads, 1e3 * run, run / bare(p, cpu),
      p.assemble.cpu / ours, p.gradient.cpu / ours, p.energy.cpu / ours, others / ours);
  for (const Stale& stale : p.stale)
    fmt::print(
        "  conjugate gradients to 1e-3 on the factor of {} the step back: {} iterations{}, {:.2f} x "
        "factorise + solve\n",
        &stale == &p.stale.front() ? "a tenth of" : "all", stale.iterations,
        stale.iterations == 200 ? " (and stopped)" : "", stale.time.cpu / (p.factorise.cpu + p.solve.cpu));
  print_goal(s.nodes, task, whole);
  const std::string row = fmt::format(
      "{},{},{},{},{},{},{},{:.1f},{:.1f},{:.2f},{:.2f},{:.2f},{:.2f},{:.2f},{:.3f},{:.3f},{:.3f},{:.3f},{:."
      "3f},"
      "{:.3f},{:.0f}",
      today(), threads, s.nodes, task.steps, done, s.newton_iterations, s.factorisations, whole.wall,
      whole.cpu, 1e3 * p.bare_factorise.cpu, 1e3 * p.bare_solve.cpu, 1e3 * ours, 1e3 * p.solve.cpu,
      1e3 * sum(p, cpu), sum(p, cpu) / bare(p, cpu), sum(p, wall) / bare(p, wall), run / bare(p, cpu),
      p.assemble.cpu / ours, p.gradient.cpu / ours, p.energy.cpu / ours, memory);
  const bool written = append_row(
      "stamping",
      "date,threads,nodes,steps,steps_done,newton_iterations,factorisations,wall_s,cpu_s,bare_factorise_ms,"
      "bare_solve_ms,factorise_ms,solve_ms,iteration_ms,iteration_over_bare,iteration_over_bare_wall,run_"
      "over_bare,"
      "assemble_over_factorise,gradient_over_factorise,energy_over_factorise,peak_memory_MB",
      row);
  return {{s.nodes, sum(p, cpu)}, written};
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<Task> tasks;
  int threads = 2;
  for (int k = 1; k < argc; ++k) {
    if (std::string(argv[k]) == "--threads" && k + 1 < argc)
      threads = std::stoi(argv[++k]);
    else
      tasks.push_back(task_of(argv[k]));
  }
  if (tasks.empty()) tasks = {task_of("8.9"), task_of("6.4"), task_of("4.5")};
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                  static_cast<std::size_t>(threads));
  const mesoscale::FabricProperties fabric = mesoscale::analyse(mesoscale::CellSpec{}).fabric;
  const friction::Model law = table4_law();
  std::vector<Measured> runs;
  fmt::print("{}, {} threads\n", blas_name(), threads);
  for (const Task& task : tasks) {
    const Outcome outcome = measure(task, fabric, law, threads);
    std::fflush(stdout);
    if (!outcome.written) return 1;
    runs.push_back(outcome.measured);
  }
  if (runs.size() > 1) fmt::print("CPU time of an iteration grows as nodes^{:.2f}\n", growth(runs));
}
