// What one Newton iteration of a stamping costs beside what it cannot do without: factorising and solving the
// same matrix with nothing round it, in the same run. Tools by their numbers, Table 1's fabric, the power law
// of Table 4, the stroke of the shipped case.
//
//     benchmark_stamping [spacing in mm]...      default: 8.9 6.4 4.5
//
// One thread, CPU seconds; pieces are the best of several repeats on the state at 7/10 of the stroke, where
// the punch, the die's fillet and the binder all touch. Prints a line a spacing and the fitted growth of cost
// with the nodes, appends to benchmarks/results/stamping.csv, judges nothing.
#include <fmt/format.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <limits>
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

double best_cpu(int repeats, const std::function<void()>& work) {
  double best = std::numeric_limits<double>::infinity();
  for (int k = 0; k < repeats; ++k) best = std::min(best, time_of(work).cpu);
  return best;
}

friction::Model table4_law() {
  friction::Model model;
  model.law = friction::HerseyPower{0.325, 0.136};
  return model;
}

// CPU seconds of the pieces of one Newton iteration.
struct Pieces {
  double assemble = 0.0, factorise = 0.0, solve = 0.0, gradient = 0.0, energy = 0.0, lag = 0.0;
  double limit() const { return factorise + solve; }
};

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

  constexpr int repeats = 7;
  Pieces p;
  Eigen::VectorXd right(system.size());
  Position before, at;
  system.evaluate(step, checkpoint.state.x, before);
  system.evaluate(step, step.iterate, at);
  p.assemble = best_cpu(repeats, [&] { system.assemble(step, at, Filter::none); });
  system.assemble(step, at, Filter::positive);
  p.factorise = best_cpu(repeats, [&] { system.solver().factorise(); });
  p.solve = best_cpu(repeats, [&] {
    right.setOnes();
    system.solver().solve({right.data(), static_cast<std::size_t>(right.size())});
  });
  p.gradient = best_cpu(repeats, [&] { right = system.gradient(step, at); });
  double sum = 0.0;
  p.energy = best_cpu(repeats, [&] {
    system.evaluate(step, step.iterate, at);  // where all laws are looked up, once a trial
    sum += system.potential(step, at).total() + system.friction_difference(step, before, at);
  });
  if (!std::isfinite(sum)) fmt::print("the energy is not finite\n");
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

}  // namespace

int main(int argc, char** argv) {
  std::vector<double> spacings;
  for (int k = 1; k < argc; ++k) spacings.push_back(1e-3 * std::atof(argv[k]));
  if (spacings.empty()) spacings = {8.9e-3, 6.4e-3, 4.5e-3};
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  const mesoscale::FabricProperties fabric = mesoscale::analyse(mesoscale::CellSpec{}).fabric;
  const friction::Model law = table4_law();
  std::vector<Measured> runs;
  fmt::print("{}\n", blas_name());
  for (const double spacing : spacings) {
    StampingSpec spec;
    spec.blank.spacing = spacing;
    StampingCheckpoint at;
    StampingControl control;
    control.keep = [&](const StampingCheckpoint& c, bool) {
      if (c.step == 7 * spec.process.steps / 10) at = c;
    };
    StampingResult result;
    const Time whole = time_of([&] { result = run_stamping(spec, fabric, law, control); });
    const Pieces p = pieces_at(spec, fabric, law, at);
    const StampingSummary& s = result.summary;
    const double iteration = whole.cpu / s.newton_iterations;
    const double outside = 1.0 - p.limit() / iteration;
    fmt::print(
        "{} nodes: {} Newton iterations, {} factorisations, {:.1f} CPU s\n"
        "  {:.1f} ms an iteration = {:.2f} x bare factor + solve ({:.1f} + {:.1f} ms)\n"
        "  assembly {:.2f}, gradient {:.2f}, energy {:.2f} of the factorisation; all but factor and solve "
        "{:.0f} %; {:.0f} MB\n",
        s.nodes, s.newton_iterations, s.factorisations, whole.cpu, 1e3 * iteration, iteration / p.limit(),
        1e3 * p.factorise, 1e3 * p.solve, p.assemble / p.factorise, p.gradient / p.factorise,
        p.energy / p.factorise, 100.0 * outside, peak_megabytes());
    runs.push_back({s.nodes, whole.cpu});
    const std::string row =
        fmt::format("{},{},{},{},{:.2f},{:.3f},{:.3f},{:.3f},{:.3f},{:.3f},{:.3f},{:.3f},{:.0f}", today(),
                    s.nodes, s.newton_iterations, s.factorisations, whole.cpu, 1e3 * iteration,
                    iteration / p.limit(), 1e3 * p.factorise, 1e3 * p.solve, p.assemble / p.factorise,
                    p.gradient / p.factorise, p.energy / p.factorise, peak_megabytes());
    if (!append_row("stamping",
                    "date,nodes,newton_iterations,factorisations,cpu_s,iteration_ms,iteration_over_bare,"
                    "factorise_ms,solve_ms,"
                    "assemble_over_factorise,gradient_over_factorise,energy_over_factorise,peak_memory_MB",
                    row))
      return 1;
  }
  if (runs.size() > 1) fmt::print("CPU time of a run grows as nodes^{:.2f}\n", growth(runs));
}
