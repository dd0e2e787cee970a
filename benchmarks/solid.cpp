// What the homogenisation of a cell costs beside its bare limits of the same run: the product of the
// stiffness with one block of load cases alone, and FFTW's transforms of three fields there and back alone.
//
//     benchmark_solid [largest grid of the growth study, 128]
//
// 1. weave_64.raw, fully periodic, against 1.3 x iterations x 6 x (bare product + bare pair of transforms).
// 2. One iteration at 192 x 192 x 48 and the full A, B, D of the consolidated weave at 128 x 128 x 32.
// 3. The same weave as cubes of voxels, 32^3 and finer: iterations, order of convergence, a straight line
// through the times.
//
// CPU seconds of all threads: on a shared machine wall time measures the neighbours. Prints, judges nothing;
// appends a row to benchmarks/results/solid.csv.
#include <fftw3.h>
#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>
#include <random>

#include "mesoscale/solid/macro_load.h"
#include "mesoscale/solid/solid_cell.h"

using namespace heddle::mesoscale;
using namespace heddle::mesoscale::solid;
namespace fs = std::filesystem;

namespace {

double cpu_now() {
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

double best_cpu(int repeats, const std::function<void()>& work) {
  double best = std::numeric_limits<double>::infinity();
  for (int k = 0; k < repeats; ++k) {
    const double start = cpu_now();
    work();
    best = std::min(best, cpu_now() - start);
  }
  return best;
}

// Three real fields to their waves and back, one thread, plans estimated as ours are [s].
double bare_transforms(std::array<int, 3> count, int repeats) {
  const int dims[3] = {count[2], count[1], count[0]};
  const int real = count[0] * count[1] * count[2], complex = count[2] * count[1] * (count[0] / 2 + 1);
  double* in = fftw_alloc_real(3 * static_cast<std::size_t>(real));
  fftw_complex* out = fftw_alloc_complex(3 * static_cast<std::size_t>(complex));
  std::fill_n(in, 3 * static_cast<std::size_t>(real), 1.0);
  const fftw_plan there =
      fftw_plan_many_dft_r2c(3, dims, 3, in, nullptr, 1, real, out, nullptr, 1, complex, FFTW_ESTIMATE);
  const fftw_plan back =
      fftw_plan_many_dft_c2r(3, dims, 3, out, nullptr, 1, complex, in, nullptr, 1, real, FFTW_ESTIMATE);
  const double seconds = best_cpu(repeats, [&] {
    fftw_execute(there);
    fftw_execute(back);
  });
  fftw_destroy_plan(there);
  fftw_destroy_plan(back);
  fftw_free(in);
  fftw_free(out);
  return seconds;
}

struct Limits {
  double product;     // K u of one load case [s]
  double transforms;  // of one load case [s]
  double sum() const { return product + transforms; }
};

Limits bare_limits(const ElasticCell& cell, Faces faces, int repeats) {
  const CellSolver solver(cell, faces, mean_stiffness(cell));
  Field u = solver.field(), f = solver.field();
  std::mt19937 generator(1);
  for (double& value : u) value = std::uniform_real_distribution<double>(-1.0, 1.0)(generator);
  return {best_cpu(repeats, [&] { solver.multiply(u, f); }) / loads, bare_transforms(cell.count, repeats)};
}

VoxelFileSpec weave_64() {
  VoxelFileSpec spec{fs::path(HEDDLE_SOURCE_DIR) / "tests/mesoscale/data/weave_64.raw",
                     {64, 64, 64},
                     {10.78e-3, 10.78e-3, 1.65e-3},
                     AxisOrder::x_fastest,
                     Faces::periodic,
                     {}};
  spec.phases[0] = {1667e6, 557e6};
  for (int tow = 1; tow <= 4; ++tow) spec.phases[tow] = {8000e6, 4000e6};
  return spec;
}

struct SampledCell {
  VoxelCell cell;
  std::vector<Matrix6> stiffness;
  double sampling;  // [s]
  ElasticCell view() const { return elastic_cell(cell, stiffness); }
};

SampledCell sampled(int per_pitch, int layers, Mixing mixing) {
  const WeaveSpec weave;
  const FabricGeometry fabric = fabric_geometry(weave, CellState::consolidated);
  SampledCell result;
  const double start = cpu_now();
  result.cell = sample(unit_cell(fabric, 0.0), fabric.thickness, {per_pitch, layers, mixing});
  result.sampling = cpu_now() - start;
  const SolidSpec spec;
  const auto tow = [&](std::size_t i) {
    return stiffness(
        chamis({weave.fibre_modulus, spec.fibre_poisson}, spec.resin, fabric.crossing.tow[i].fibre_fraction));
  };
  const std::array phases{stiffness(spec.resin), tow(0), tow(1)};
  result.stiffness = content_stiffness(result.cell, phases);
  return result;
}

double voxels_of(const ElasticCell& cell) {
  return static_cast<double>(cell.voxels());
}

// [s], iterations and the ratio to the limit of the house.
std::array<double, 3> reference_cell() {
  const ReadVoxels read = read_voxels(weave_64());
  const std::vector<Matrix6> c = content_stiffness(read.cell, read.phases);
  const ElasticCell cell = elastic_cell(read.cell, c);
  const Limits limits = bare_limits(cell, Faces::periodic, 7);
  PeriodicStiffness result;
  const auto wall = std::chrono::steady_clock::now();
  const double first = best_cpu(1, [&] { result = periodic_stiffness(cell); });
  const double walled = std::chrono::duration<double>(std::chrono::steady_clock::now() - wall).count();
  const double seconds = std::min(first, best_cpu(4, [&] { result = periodic_stiffness(cell); }));
  const int iterations = result.solver.most_iterations();
  const double limit = 1.3 * iterations * loads * limits.sum();
  fmt::print("weave_64, fully periodic, all six load cases (FANS 0.6.2: 4.3 to 5.8 CPU s on one core)\n");
  fmt::print("  bare product {:.2f} ms, bare transforms {:.2f} ms a load case\n", 1e3 * limits.product,
             1e3 * limits.transforms);
  fmt::print(
      "  {:.2f} CPU s (first call {:.2f}, {:.2f} s wall), {} iterations; limit {:.2f} s, {:.2f} of it\n",
      seconds, first, walled, iterations, limit, seconds / limit);
  fmt::print("  C11 {:.3f}, C33 {:.3f} MPa\n\n", 1e-6 * result.stiffness(0, 0),
             1e-6 * result.stiffness(2, 2));
  return {seconds, static_cast<double>(iterations), seconds / limit};
}

// Mvoxel/s of one iteration of one load case, and its ratio to the bare transforms.
std::array<double, 2> iteration_speed() {
  const SampledCell sample = sampled(96, 48, Mixing::laminate);
  const ElasticCell cell = sample.view();
  const Limits limits = bare_limits(cell, Faces::free, 3);
  const CellSolver solver(cell, Faces::free, mean_stiffness(cell));
  const MacroLoad load = unit_plate_loads();
  Field force = solver.field(), u;
  const auto run = [&](int iterations) {
    std::fill(force.begin(), force.end(), 0.0);
    add_forces(cell, load, solver, force);
    return best_cpu(1, [&] {
      solver.solve(force, u, {1, 1, 1, 1, 1, 1}, {.tolerance = 0.0, .max_iterations = iterations});
    });
  };
  const double few = run(1), more = run(6);
  const double seconds = (more - few) / 5.0 / loads;
  fmt::print("192 x 192 x 48, plate: one iteration of one load case {:.1f} ms = {:.1f} Mvoxel/s a core\n",
             1e3 * seconds, 1e-6 * voxels_of(cell) / seconds);
  fmt::print(
      "  bare product {:.1f} ms, bare transforms {:.1f} ms: {:.2f} of their sum, {:.2f} of the transforms\n",
      1e3 * limits.product, 1e3 * limits.transforms, seconds / limits.sum(), seconds / limits.transforms);
  const CellSolver pair(cell, Faces::free, mean_stiffness(cell), pair_of_loads);
  fmt::print(
      "  memory {:.0f} bytes a voxel for the block of six, {:.0f} for two; sampler {:.1f} Mvoxel/s\n\n",
      static_cast<double>(solver.memory()) / voxels_of(cell),
      static_cast<double>(pair.memory()) / voxels_of(cell), 1e-6 * voxels_of(cell) / sample.sampling);
  return {1e-6 * voxels_of(cell) / seconds, seconds / limits.transforms};
}

struct GrowthRow {
  double voxels, seconds, a11, d11;
  int iterations;
};

std::vector<GrowthRow> growth(int largest, Mixing mixing) {
  fmt::print("consolidated weave, plate, {} voxels at interfaces\n",
             mixing == Mixing::laminate ? "mixed" : "plain");
  fmt::print("{:>15} {:>10} {:>10} {:>12} {:>12} {:>10} {:>8}\n", "grid", "iterations", "CPU s", "A11/H GPa",
             "D11 N mm", "B/voxel", "kinds");
  std::vector<GrowthRow> rows;
  for (int per_pitch = 16; 2 * per_pitch <= largest; per_pitch *= 2) {
    const SampledCell sample = sampled(per_pitch, 2 * per_pitch, mixing);
    const ElasticCell cell = sample.view();
    PlateStiffness plate;
    const double seconds = best_cpu(1, [&] { plate = plate_stiffness(cell); });
    const double thickness = cell.edges(2, 2);
    rows.push_back({voxels_of(cell), seconds, 1e-9 * plate.a(0, 0) / thickness, 1e3 * plate.d(0, 0),
                    plate.solver.most_iterations()});
    fmt::print("{:>15} {:>10} {:>10.2f} {:>12.4f} {:>12.4f} {:>10.0f} {:>8}\n",
               fmt::format("{}x{}x{}", cell.count[0], cell.count[1], cell.count[2]), rows.back().iterations,
               seconds, rows.back().a11, rows.back().d11, static_cast<double>(plate.memory) / voxels_of(cell),
               cell.stiffness.size());
  }
  for (std::size_t n = 2; n < rows.size(); ++n)
    fmt::print("  observed order from grids {} to {}: A11 {:.2f}, D11 {:.2f}\n", n - 1, n + 1,
               std::log2(std::abs((rows[n - 1].a11 - rows[n - 2].a11) / (rows[n].a11 - rows[n - 1].a11))),
               std::log2(std::abs((rows[n - 1].d11 - rows[n - 2].d11) / (rows[n].d11 - rows[n - 1].d11))));
  if (rows.size() >= 3) {
    // Seconds an iteration against voxels, both as logarithms: a slope of 1 is linear cost.
    double sx = 0, sy = 0, sxx = 0, sxy = 0;
    const double n = static_cast<double>(rows.size());
    for (std::size_t k = 0; k < rows.size(); ++k) {
      const double x = std::log(rows[k].voxels), y = std::log(rows[k].seconds / rows[k].iterations);
      sx += x, sy += y, sxx += x * x, sxy += x * y;
    }
    fmt::print("  seconds an iteration grow with voxels to the power {:.3f}\n",
               (n * sxy - sx * sy) / (n * sxx - sx * sx));
  }
  fmt::print("\n");
  return rows;
}

// CPU s with six load cases side by side.
double full_plate() {
  double with_six = 0.0;
  for (const int cases : {loads, pair_of_loads}) {
    const SolverOptions options{.cases = cases};
    const double start = cpu_now();
    const SampledCell sample = sampled(64, 32, Mixing::laminate);
    const PlateStiffness plate = plate_stiffness(sample.view(), options);
    const double seconds = cpu_now() - start;
    if (cases == loads) with_six = seconds;
    fmt::print(
        "A, B, D at 128 x 128 x 32 with sampling, {} load cases side by side: {:.1f} CPU s, {} iterations, "
        "{:.0f} "
        "bytes a voxel\n",
        cases, seconds, plate.solver.most_iterations(),
        static_cast<double>(plate.memory) / voxels_of(sample.view()));
  }
  fmt::print("\n");
  return with_six;
}

}  // namespace

int main(int argc, char** argv) {
  const int largest = argc > 1 ? std::atoi(argv[1]) : 128;
  const auto reference = reference_cell();
  const auto speed = iteration_speed();
  const double plate = full_plate();
  const auto rows = growth(largest, Mixing::laminate);
  growth(largest, Mixing::dominant);

  const fs::path file = fs::path(HEDDLE_SOURCE_DIR) / "benchmarks/results/solid.csv";
  const bool fresh = !fs::exists(file);
  std::ofstream out(file, std::ios::app);
  if (fresh)
    out << "weave_64_cpu_s,weave_64_iterations,weave_64_over_limit,iteration_Mvoxel_s_192x192x48,iteration_"
           "over_transforms,"
           "abd_128x128x32_cpu_s,largest_grid,iterations_at_largest\n";
  out << fmt::format("{:.2f},{:.0f},{:.2f},{:.1f},{:.2f},{:.1f},{},{}\n", reference[0], reference[1],
                     reference[2], speed[0], speed[1], plate, largest, rows.back().iterations);
}
