// What looking for folds, and for parts of the sheet that meet, costs once a step, beside one Newton
// iteration on the same grid (laws, matrix, factors, back-substitution, forces) and beside merely reading the
// positions of all corners of all cells once.
//
//     benchmark_folds [spacing in mm]
//
// Appends a row to benchmarks/results/folds.csv and one to self_contact.csv. Times are processor
// time, the best of many repeats: the machine may be shared.
#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numbers>

#include "benchmarks/measure.h"
#include "macroscale/folds.h"
#include "macroscale/quality.h"
#include "macroscale/self_contact.h"
#include "macroscale/solve.h"
#include "tests/macroscale/sample_fabric.h"

using namespace heddle;
using namespace heddle::macroscale;
using namespace heddle::benchmark;
using Eigen::Vector3d;

namespace {

constexpr double radius = 70e-3, side = 320e-3;  // the shipped punch and blank

// The blank over dome and wall by arc length.
Vector3d formed(const Vector3d& flat) {
  const double s = std::hypot(flat.x(), flat.y()), quarter = 0.5 * std::numbers::pi * radius;
  const double a = std::min(s, quarter) / radius, r = radius * std::sin(a);
  const double z = radius - radius * std::cos(a) + std::max(s - quarter, 0.0);
  return s > 0.0 ? Vector3d(r * flat.x() / s, r * flat.y() / s, z) : Vector3d(0, 0, 0);
}

double best_cpu_seconds(int repeats, const std::function<void()>& work) {
  double best = std::numeric_limits<double>::infinity();
  for (int k = 0; k < repeats; ++k) best = std::min(best, time_of(work).cpu);
  return best;
}

// One pass takes less than a tick of the clock of processor time.
constexpr int passes = 100;

}  // namespace

int main(int argc, char** argv) {
  const double spacing = 1e-3 * (argc > 1 ? std::atof(argv[1]) : 4.5);
  const mesoscale::FabricProperties fabric = test::make_fabric({});
  Scene scene;
  scene.blank = make_blank({side, side}, spacing);
  scene.fabric = &fabric;
  System system(scene);
  State state = initial_state(scene);
  for (int n = 0; n < scene.blank.nodes(); ++n) state.x.segment<3>(3 * n) = formed(scene.blank.reference[n]);
  state.corner_angle = corner_angles(scene.blank, state);
  const BlankState blank = blank_state(system, state, nullptr);

  double sum = 0.0;
  const double look = best_cpu_seconds(20, [&] { sum += find_folds(blank, fabric.thickness).near; });
  const std::vector<PlyPoint> faces = self_points(scene.blank);
  const double meetings = best_cpu_seconds(20, [&] {
    sum += static_cast<double>(
        pair_with_itself(scene.blank, faces, state.x, 3.0 * fabric.thickness, fabric.thickness).size());
  });
  const double bare = best_cpu_seconds(20,
                                       [&] {
                                         for (int pass = 0; pass < passes; ++pass)
                                           for (const auto& quad : blank.quads)
                                             for (const int n : quad)
                                               sum += blank.position[static_cast<std::size_t>(n)][2];
                                       }) /
                      passes;
  StepData step;
  step.start = &state;
  step.dt = 4e-3;
  step.target = state.x;
  step.frictionless = true;
  Position at;
  const double iteration = best_cpu_seconds(5, [&] {
    system.evaluate(step, state.x, at);
    system.assemble(step, at, Filter::positive);
    if (!system.solver().factorise()) std::abort();
    Eigen::VectorXd g = system.gradient(step, at);
    system.solver().solve({g.data(), static_cast<std::size_t>(g.size())});
    sum += g[0];
  });
  fmt::print(
      "{} nodes: folds {:.2f} ms, parts that meet {:.2f} ms, one Newton iteration {:.1f} ms ({:.1f} %), "
      "reading all corners {:.3f} ms\n",
      scene.blank.nodes(), 1e3 * look, 1e3 * meetings, 1e3 * iteration, 100.0 * look / iteration, 1e3 * bare);
  if (!std::isfinite(sum)) return 1;
  append_row("folds", "date,nodes,folds_ms,iteration_ms,bare_read_ms,folds_over_iteration",
             fmt::format("{},{},{:.3f},{:.2f},{:.4f},{:.4f}", today(), scene.blank.nodes(), 1e3 * look,
                         1e3 * iteration, 1e3 * bare, look / iteration));
  append_row("self_contact", "date,nodes,meetings_ms,iteration_ms,meetings_over_iteration",
             fmt::format("{},{},{:.3f},{:.2f},{:.4f}", today(), scene.blank.nodes(), 1e3 * meetings,
                         1e3 * iteration, meetings / iteration));
}
