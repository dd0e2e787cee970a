#include "mesoscale/solid/homogenise.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "mesoscale/solid/macro_load.h"

namespace heddle::mesoscale::solid {

namespace {

struct Energies {
  Matrix6 energy;  // products of the whole fields [J]
  SolverSummary solver;
  HomogenisationChecks checks;
  std::size_t memory;
  std::vector<Vector6> held;  // work of held stresses on the whole fields [J/K] or [J]
};

// What a solver says of its load cases, from number `first` on.
void add_to(SolverSummary& all, const SolverSummary& part, int first, int cases) {
  for (int l = 0; l < cases; ++l) {
    all.iterations[first + l] = part.iterations[l];
    all.residual[first + l] = part.residual[l];
  }
  if (all.reason.empty() || !part.converged) all.reason = part.reason;
  all.converged = all.converged && part.converged;
}

// Numbers of load cases `first` on, from where they stand in a solver's field.
void put(Matrix6& all, int row, int column, int cases, const Matrix6& part) {
  all.block(row, column, cases, cases) = part.topLeftCorner(cases, cases);
}

// u . K u of all load cases where they were solved two at a time, and only those within a pair were seen.
// Across pairs u_a . K u_b = u_a . f_b up to the residual of b.
void fill_across_pairs(Matrix6& stored, const Matrix6& work) {
  for (int a = 0; a < loads; ++a)
    for (int b = 0; b < loads; ++b)
      if (a / pair_of_loads != b / pair_of_loads) stored(a, b) = work(b, a);
}

Energies solve(const ElasticCell& cell, Faces faces, const MacroLoad& load, const SolverOptions& options,
               std::span<const HeldStress> held) {
  const int cases = options.cases;
  const CellSolver solver(cell, faces, mean_stiffness(cell), cases);
  const Matrix6 macro = macro_energy(cell, load);
  Matrix6 work, stored = Matrix6::Zero();  // f_a . u_b and u_a . K u_b
  Energies result;
  result.solver.converged = true;
  result.held.assign(held.size(), Vector6::Zero());
  Field force = solver.field(), u;
  const auto forces_from = [&](int first) {
    std::fill(force.begin(), force.end(), 0.0);
    add_forces(cell, load, solver, force, first);
  };
  for (int first = 0; first < loads; first += cases) {
    CaseNumbers scale{};
    for (int l = 0; l < cases; ++l) scale[l] = macro(first + l, first + l);
    forces_from(first);
    add_to(result.solver, solver.solve(force, u, scale, options), first, cases);
    for (int other = 0; other < loads; other += cases) {
      forces_from(other);
      put(work, other, first, cases, gram(force, u, solver.plane(), cases));
    }
    solver.multiply(u, force);
    put(stored, first, first, cases, gram(u, force, solver.plane(), cases));
    for (std::size_t cause = 0; cause < held.size(); ++cause)
      result.held[cause].segment(first, cases) =
          held_work(cell, load, u, solver, first, held[cause]).head(cases);
  }
  if (cases == pair_of_loads) fill_across_pairs(stored, work);
  const Matrix6 energy = macro - work - work.transpose() + stored;
  const Matrix6 from_stress = macro - work;
  result.energy = 0.5 * (energy + energy.transpose());
  for (int l = 0; l < loads; ++l)
    result.checks.hill_mandel =
        std::max(result.checks.hill_mandel, std::abs(energy(l, l) - from_stress(l, l)) / energy(l, l));
  result.checks.asymmetry = (from_stress - from_stress.transpose()).norm() / from_stress.norm();
  result.memory = solver.memory();
  return result;
}

std::vector<std::size_t> voxels_of_materials(const ElasticCell& cell) {
  std::vector<std::size_t> number(cell.stiffness.size(), 0);
  for (const std::uint16_t m : cell.material) ++number[m];
  return number;
}

Matrix6 reuss(const ElasticCell& cell) {
  const std::vector<std::size_t> number = voxels_of_materials(cell);
  Matrix6 compliance = Matrix6::Zero();
  for (std::size_t m = 0; m < number.size(); ++m) {
    if (number[m] == 0) continue;
    if (cell.stiffness[m].isZero(0.0)) return Matrix6::Zero();
    compliance += static_cast<double>(number[m]) * cell.stiffness[m].inverse();
  }
  return (compliance / static_cast<double>(cell.voxels())).inverse();
}

std::vector<Vector6> per(double size, std::vector<Vector6> works) {
  for (Vector6& work : works) work /= size;
  return works;
}

}  // namespace

Matrix6 mean_stiffness(const ElasticCell& cell) {
  const std::vector<std::size_t> number = voxels_of_materials(cell);
  Matrix6 sum = Matrix6::Zero();
  for (std::size_t m = 0; m < number.size(); ++m) sum += static_cast<double>(number[m]) * cell.stiffness[m];
  return sum / static_cast<double>(cell.voxels());
}

PeriodicStiffness periodic_stiffness(const ElasticCell& cell, const SolverOptions& options,
                                     std::span<const HeldStress> held) {
  const Energies found = solve(cell, Faces::periodic, unit_strains(), options, held);
  return {found.energy / cell.edges.determinant(),
          mean_stiffness(cell),
          reuss(cell),
          per(cell.edges.determinant(), found.held),
          found.solver,
          found.checks,
          found.memory};
}

void PlateStiffness::set_parts() {
  a = all.topLeftCorner<3, 3>();
  b = all.topRightCorner<3, 3>();
  d = all.bottomRightCorner<3, 3>();
}

PlateStiffness plate_stiffness(const ElasticCell& cell, const SolverOptions& options,
                               std::span<const HeldStress> held) {
  const MacroLoad load = unit_plate_loads();
  const Energies found = solve(cell, Faces::free, load, options, held);
  const double area = cell.edges.determinant() / cell.edges(2, 2);
  PlateStiffness plate;
  plate.all = found.energy / area;
  plate.set_parts();
  plate.upper = macro_energy(cell, load) / area;
  plate.held = per(area, found.held);
  plate.solver = found.solver;
  plate.checks = found.checks;
  plate.memory = found.memory;
  return plate;
}

}  // namespace heddle::mesoscale::solid
