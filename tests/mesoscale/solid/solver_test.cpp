#include "mesoscale/solid/cell_solver.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <complex>
#include <numbers>
#include <random>

#include <tbb/global_control.h>

#include "core/problem.h"
#include "mesoscale/solid/pencil_fft.h"
#include "sample_cells.h"

using namespace heddle::mesoscale::solid;
using namespace heddle::test;

namespace {

// Random displacements whose mean is zero, which a solver can find again.
Field random_field(const CellSolver& solver) {
  Field u = solver.field();
  std::mt19937 generator(3);
  std::uniform_real_distribution<double> number(-1.0, 1.0);
  for (double& value : u) value = number(generator);
  const auto node = static_cast<std::size_t>(3 * solver.cases());
  for (std::size_t c = 0; c < node; ++c) {
    double mean = 0.0;
    for (std::size_t n = c; n < u.size(); n += node)
      mean += u[n] * static_cast<double>(node) / static_cast<double>(u.size());
    for (std::size_t n = c; n < u.size(); n += node) u[n] -= mean;
  }
  return u;
}

double largest_gap(const Field& a, const Field& b) {
  double gap = 0.0;
  for (std::size_t n = 0; n < a.size(); ++n) gap = std::max(gap, std::abs(a[n] - b[n]));
  return gap;
}

Eigen::Matrix3d sheared_box(int nx, int ny, int nz) {
  Eigen::Matrix3d edges;
  edges << 1.0 * nx, 0.4 * ny, 0.0, 0.0, 1.2 * ny, 0.0, 0.0, 0.0, 0.5 * nz;
  return 1e-4 * edges;
}

}  // namespace

TEST_CASE("transforms of any length give the sums that define them", "[solid][fft]") {
  const int length = GENERATE(1, 2, 5, 36, 64, 65, 67, 72, 80, 96, 192);
  const int width = 3, stride = 4;
  const PencilFft fft(length, width, stride);
  Field data(static_cast<std::size_t>(2 * length * stride), 0.0);
  for (std::size_t n = 0; n < data.size(); ++n) data[n] = std::sin(1.0 + 3.7 * static_cast<double>(n));
  const Field before = data;
  fft.forward(data.data());
  double worst = 0.0;
  for (int place = 0; place < length; ++place) {
    const int k = fft.waves()[static_cast<std::size_t>(place)];
    std::complex<double> sum = 0.0;
    for (int n = 0; n < length; ++n) {
      const auto at = static_cast<std::size_t>(2 * (n * stride + 1));
      sum += std::polar(1.0, -2.0 * std::numbers::pi * k * n / length) *
             std::complex<double>(before[at], before[at + 1]);
    }
    const auto at = static_cast<std::size_t>(2 * (place * stride + 1));
    worst = std::max(worst, std::abs(sum - std::complex<double>(data[at], data[at + 1])));
  }
  CHECK(worst < 1e-12 * length);
  fft.backward(data.data());
  for (int n = 0; n < length; ++n)
    for (int s = 0; s < 2 * width; ++s) {
      const auto at = static_cast<std::size_t>(2 * n * stride + s);
      worst = std::max(worst, std::abs(data[at] / length - before[at]));
    }
  CHECK(worst < 1e-12 * length);
}

TEST_CASE("a homogeneous cell is inverted in one step, periodic or with free faces", "[solid][solver]") {
  const auto faces = GENERATE(Faces::periodic, Faces::free);
  // Odd, even, long enough to be split, one voxel thin.
  const auto count =
      GENERATE(std::array{5, 4, 3}, std::array{8, 6, 9}, std::array{72, 3, 4}, std::array{4, 72, 1});
  // Monoclinic on an oblique lattice.
  const Matrix6 c = rotated(tow_stiffness(), turn_to({1.0, 0.5, 0.0}));
  const SampleCell cell = uniform_cell(count, sheared_box(count[0], count[1], count[2]), c);
  const CellSolver solver(cell.view(), faces, c, GENERATE(loads, pair_of_loads));
  const Field expected = random_field(solver);
  Field force = solver.field(), u;
  const auto energy = solver.multiply(expected, force);
  const SolverSummary summary = solver.solve(force, u, energy, {.tolerance = 1e-8});
  CHECK(summary.converged);
  CHECK(summary.most_iterations() == 1);
  CHECK(largest_gap(u, expected) < 1e-10);
}

TEST_CASE("conjugate gradients find the displacements of a mixed cell", "[solid][solver]") {
  const auto faces = GENERATE(Faces::periodic, Faces::free);
  const SampleCell cell = random_cell({7, 6, 9}, tow_and_resin(), 5);
  const CellSolver solver(cell.view(), faces, mean_stiffness(cell.view()));
  const Field expected = random_field(solver);
  Field force = solver.field(), u;
  const auto energy = solver.multiply(expected, force);
  const SolverSummary summary = solver.solve(force, u, energy, {.tolerance = 1e-12});
  CHECK(summary.converged);
  CHECK(largest_gap(u, expected) < 1e-9);
  for (const double residual : summary.residual) CHECK(residual < 1e-12);
}

TEST_CASE("load cases two at a time give the stiffness of six side by side in four tenths of the memory",
          "[solid][solver]") {
  const SampleCell cell = random_cell({7, 6, 16}, tow_and_resin(), 5);
  const HeldStress held(cell.view().stiffness.size(), Vector6::Ones());
  const std::array causes{held};
  const SolverOptions six{.tolerance = 1e-9},
      two{.tolerance = 1e-9, .max_iterations = 1000, .cases = pair_of_loads};
  const PeriodicStiffness c6 = periodic_stiffness(cell.view(), six, causes),
                          c2 = periodic_stiffness(cell.view(), two, causes);
  CHECK((c2.stiffness - c6.stiffness).norm() < 1e-9 * c6.stiffness.norm());
  CHECK((c2.held[0] - c6.held[0]).norm() < 1e-9 * c6.held[0].norm());
  CHECK(c2.solver.converged);
  CHECK(c2.solver.iterations == c6.solver.iterations);
  CHECK(c2.checks.hill_mandel < 1e-10);
  const PlateStiffness p6 = plate_stiffness(cell.view(), six, causes),
                       p2 = plate_stiffness(cell.view(), two, causes);
  const Vector6 scale = p6.all.diagonal().cwiseSqrt().cwiseInverse();
  const Matrix6 gap = scale.asDiagonal() * (p2.all - p6.all) * scale.asDiagonal();
  CHECK(gap.norm() < 1e-9);
  CHECK((scale.asDiagonal() * (p2.held[0] - p6.held[0])).norm() <
        1e-9 * (scale.asDiagonal() * p6.held[0]).norm());
  CHECK(p2.solver.iterations == p6.solver.iterations);
  const CellSolver small(cell.view(), Faces::free, mean_stiffness(cell.view()), pair_of_loads),
      large(cell.view(), Faces::free, mean_stiffness(cell.view()));
  CHECK(small.field().size() * 3 == large.field().size());
}

TEST_CASE("too few iterations are a result, not an error", "[solid][solver]") {
  const SampleCell cell = random_cell({6, 6, 6}, tow_and_resin(), 5);
  const PeriodicStiffness result = periodic_stiffness(cell.view(), {.max_iterations = 2});
  CHECK_FALSE(result.solver.converged);
  CHECK(result.solver.reason == "2 iterations were not enough");
  CHECK(result.solver.most_iterations() == 2);
}

TEST_CASE("a number that is not finite is named by load case and iteration", "[solid][solver]") {
  const SampleCell cell = random_cell({4, 4, 4}, tow_and_resin(), 5);
  const CellSolver solver(cell.view(), Faces::periodic, mean_stiffness(cell.view()));
  Field force = solver.field(), u;
  force[loads * 7 + 3] = std::nan("");
  CHECK_THROWS_WITH(solver.solve(force, u, {1, 1, 1, 1, 1, 1}),
                    Catch::Contains("load case") && Catch::Contains("is not finite"));
}

TEST_CASE("a cell of voids alone is refused", "[solid][solver]") {
  const SampleCell cell = uniform_cell({4, 4, 4}, box(1e-3, 1e-3, 1e-3), Matrix6::Zero());
  CHECK_THROWS_AS(periodic_stiffness(cell.view()), heddle::NumericalError);
}

TEST_CASE("one thread and two find the same bits", "[solid][solver]") {
  const SampleCell cell = random_cell({12, 10, 16}, tow_and_resin(), 5);
  const auto solve_on = [&](int threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                    static_cast<std::size_t>(threads));
    return plate_stiffness(cell.view()).all;
  };
  const Matrix6 one = solve_on(1);
  for (int repeat = 0; repeat < 3; ++repeat) CHECK((solve_on(2) - one).cwiseAbs().maxCoeff() == 0.0);
}
