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

Energies solve(const ElasticCell& cell, Faces faces, const MacroLoad& load, const SolverOptions& options,
               std::span<const HeldStress> held) {
  const CellSolver solver(cell, faces, mean_stiffness(cell));
  const Matrix6 macro = macro_energy(cell, load);
  std::array<double, loads> scale;
  for (int l = 0; l < loads; ++l) scale[l] = macro(l, l);

  Field force = solver.field(), u;
  add_forces(cell, load, solver, force);
  Energies result;
  result.solver = solver.solve(force, u, scale, options);

  std::fill(force.begin(), force.end(), 0.0);
  add_forces(cell, load, solver, force);
  const Matrix6 work = gram(force, u, solver.plane());
  solver.multiply(u, force);
  const Matrix6 stored = gram(u, force, solver.plane());
  const Matrix6 energy = macro - work - work.transpose() + stored;
  const Matrix6 from_stress = macro - work;
  result.energy = 0.5 * (energy + energy.transpose());
  for (int l = 0; l < loads; ++l)
    result.checks.hill_mandel =
        std::max(result.checks.hill_mandel, std::abs(energy(l, l) - from_stress(l, l)) / energy(l, l));
  result.checks.asymmetry = (from_stress - from_stress.transpose()).norm() / from_stress.norm();
  result.memory = solver.memory();
  for (const HeldStress& stress : held)
    result.held.push_back(held_work(cell, load, u, solver.plane(), solver.planes(), stress));
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
