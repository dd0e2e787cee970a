#include "mesoscale/solid/solid_cell.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "mesoscale/solid/woven_solid.h"

namespace heddle::mesoscale::solid {

namespace {

constexpr double balance_tolerance = 1e-3;

void check_range(Problems& problems, RuleId id, const std::string& key, const std::string& value, bool holds,
                 const std::string& rule, const std::string& way_out) {
  if (!holds) problems.push_back({std::move(id), key, value, rule, way_out});
}

}  // namespace

double BalancePair::gap() const {
  const double larger = std::max(std::abs(first), std::abs(second));
  return larger > 0.0 ? std::abs(first - second) / larger : 0.0;
}

std::vector<BalancePair> balance_of(const SolidResult& result) {
  std::vector<BalancePair> pairs;
  if (!result.balanced) return pairs;
  if (result.stack) {
    const Matrix6& c = result.stack->stiffness;
    pairs.push_back({"C11", "C22", c(0, 0), c(1, 1), "MPa", 1e-6});
    pairs.push_back({"C13", "C23", c(0, 2), c(1, 2), "MPa", 1e-6});
    pairs.push_back({"G13", "G23", c(4, 4), c(3, 3), "MPa", 1e-6});
  }
  if (result.plate) {
    pairs.push_back({"A11", "A22", result.plate->a(0, 0), result.plate->a(1, 1), "N/mm", 1e-3});
    pairs.push_back({"D11", "D22", result.plate->d(0, 0), result.plate->d(1, 1), "N mm", 1e3});
  }
  return pairs;
}

std::vector<BalancePair> imbalances(const SolidResult& result) {
  std::vector<BalancePair> found;
  std::copy_if(result.balance.begin(), result.balance.end(), std::back_inserter(found),
               [](const BalancePair& pair) { return !(pair.gap() <= balance_tolerance); });
  return found;
}

Problems check(const SolidSpec& spec) {
  Problems problems;
  check_range(problems, "*.range"_family.of("solid.per_pitch"), "solid.per_pitch",
              std::to_string(spec.grid.per_pitch), spec.grid.per_pitch >= 4 && spec.grid.per_pitch <= 512,
              "must lie between 4 and 512", "32 voxels a pitch are enough for a first look.");
  check_range(problems, "*.range"_family.of("solid.layers"), "solid.layers", std::to_string(spec.grid.layers),
              spec.grid.layers >= 2 && spec.grid.layers <= 512, "must lie between 2 and 512",
              "32 layers are enough for a first look.");
  check_range(problems, "*.range"_family.of("solid.fibre_poisson"), "solid.fibre_poisson",
              fmt::format("{:g}", spec.fibre_poisson), spec.fibre_poisson > -1.0 && spec.fibre_poisson < 0.5,
              "must lie between -1 and 0.5", "Glass has 0.22.");
  check_range(problems, "*.range"_family.of("solid.resin_poisson"), "solid.resin_poisson",
              fmt::format("{:g}", spec.resin.poisson), spec.resin.poisson > -1.0 && spec.resin.poisson < 0.49,
              "must lie between -1 and 0.49", "Polypropylene has 0.40. Trilinear voxels lock near 0.5.");
  check_range(problems, "*.range"_family.of("solid.resin_modulus"), "solid.resin_modulus",
              fmt::format("{:g} GPa", 1e-9 * spec.resin.modulus),
              spec.resin.modulus > 0.0 && spec.resin.modulus <= 1e12,
              "must satisfy 0 < resin_modulus <= 1000 GPa", "Polypropylene has 1.5 GPa.");
  check_range(problems, "*.range"_family.of("solid.fibre_expansion"), "solid.fibre_expansion",
              fmt::format("{:g} 1/K", spec.fibre_expansion), std::abs(spec.fibre_expansion) <= 1e-2,
              "must lie between -0.01 and 0.01 1/K", "E-glass has 5e-6 1/K.");
  check_range(problems, "*.range"_family.of("solid.resin_expansion"), "solid.resin_expansion",
              fmt::format("{:g} 1/K", spec.resin_expansion), std::abs(spec.resin_expansion) <= 1e-2,
              "must lie between -0.01 and 0.01 1/K", "Polypropylene has about 1.2e-4 1/K.");
  // Beyond, the cell is drawn out so far that its voxels no longer resolve it.
  constexpr double most = 60.5 * std::numbers::pi / 180.0;
  for (const double angle : spec.shear_angles)
    check_range(problems, "*.range"_family.of("solid.shear_angles"), "solid.shear_angles",
                fmt::format("{:g} deg", angle * 180.0 / std::numbers::pi), std::abs(angle) <= most,
                "must lie between -60 and 60 deg", "Write [0 deg, 15 deg, 30 deg, 45 deg].");
  return problems;
}

namespace {

ShearedSolid sheared_solid(const FabricGeometry& fabric, double angle, double fibre_modulus,
                           const SolidSpec& spec) {
  const PressedFabric at_angle = pressed(fabric, angle);
  const WovenSolid solid = woven_solid(fabric.weave, at_angle, fibre_modulus, spec);
  const ElasticCell cell = elastic_cell(solid.cell, solid.stiffness);
  const PlateStiffness plate = plate_stiffness(cell, spec.solver, solid.held);
  const PeriodicStiffness stack = periodic_stiffness(cell, spec.solver, solid.held);
  ShearedSolid result;
  result.shear_angle = angle;
  result.thickness = at_angle.thickness;
  result.fibre_fraction =
      std::max(at_angle.crossing.tow[0].fibre_fraction, at_angle.crossing.tow[1].fibre_fraction);
  result.converged = plate.solver.converged && stack.solver.converged;
  result.plate = plate.all;
  result.stack = stack.stiffness;
  for (std::size_t cause = 0; cause < held_causes; ++cause) {
    result.plate_held[cause] = plate.held[cause];
    result.stack_held[cause] = stack.held[cause];
  }
  return result;
}

LaminateSolid laminate_of(const FabricGeometry& fabric, const PlateStiffness& ply, double fibre_modulus,
                          const SolidSpec& spec) {
  const StackedFabric stack = consolidated_stack(fabric, 0.0, spec.stack.shifts());
  const WovenSolid solid = woven_solid(stack, fibre_modulus, spec);
  const PlateStiffness plate = plate_stiffness(elastic_cell(solid.cell, solid.stiffness), spec.solver);
  LaminateSolid result;
  result.plies = spec.stack.plies;
  result.thickness = stack.stack.thickness;
  result.swelling = stack.swelling;
  result.fibre_fraction =
      std::max(stack.crossing.tow[0].fibre_fraction, stack.crossing.tow[1].fibre_fraction);
  const std::vector<double> shares = phase_shares(solid.cell, 3);
  result.tow_share = shares[warp_phase] + shares[weft_phase];
  result.converged = plate.solver.converged;
  result.plate = plate.all;
  result.apart = laminated(ply.all, fabric.thickness, spec.stack.plies);
  return result;
}

}  // namespace

Matrix6 laminated(const Matrix6& ply, double thickness, int plies) {
  // Middles stand at z, evenly about that of the laminate, so the sum of z is nothing:
  // D = sum(D1 + z^2 A1), and B = sum(B1).
  const double n = plies, squares = thickness * thickness * n * (n * n - 1.0) / 12.0;
  Matrix6 all = n * ply;
  all.bottomRightCorner<3, 3>() += squares * ply.topLeftCorner<3, 3>();
  return all;
}

Vector6 free_strain(const Matrix6& stiffness, const Vector6& held) {
  return stiffness.llt().solve(held);
}

SolidResult analyse(const WeaveSpec& weave, const SolidSpec& spec) {
  if (Problems problems = check(spec); !problems.empty()) throw InputError(std::move(problems));
  const FabricGeometry fabric = fabric_geometry(weave, CellState::consolidated);
  const WovenSolid solid = woven_solid(fabric.weave, pressed(fabric, 0.0), weave.fibre_modulus, spec);
  const ElasticCell cell = elastic_cell(solid.cell, solid.stiffness);
  SolidResult result;
  result.tow = solid.tows;
  result.balanced = fabric.crossing.balanced() && alike_both_ways(fabric.weave);
  result.voxels = solid.cell.count;
  result.thickness = fabric.thickness;
  const std::vector<double> shares = phase_shares(solid.cell, 3);
  result.tow_share = shares[warp_phase] + shares[weft_phase];
  result.different_voxels = solid.cell.contents.size();
  result.plate = plate_stiffness(cell, spec.solver, solid.held);
  result.stack = periodic_stiffness(cell, spec.solver, solid.held);
  result.balance = balance_of(result);
  for (const double angle : spec.shear_angles)
    result.sheared.push_back(sheared_solid(fabric, angle, weave.fibre_modulus, spec));
  if (spec.stack.plies > 1) result.laminate = laminate_of(fabric, *result.plate, weave.fibre_modulus, spec);
  return result;
}

Ply ply(const WeaveSpec& weave, double shear_angle, const SolidSpec& spec) {
  if (Problems problems = check(spec); !problems.empty()) throw InputError(std::move(problems));
  const FabricGeometry fabric = fabric_geometry(weave, CellState::consolidated);
  const PressedFabric at_angle = pressed(fabric, shear_angle);
  const WovenSolid solid = woven_solid(fabric.weave, at_angle, weave.fibre_modulus, spec);
  return {at_angle.thickness, plate_stiffness(elastic_cell(solid.cell, solid.stiffness), spec.solver)};
}

SolidResult analyse(const VoxelFileSpec& spec, SolverOptions solver) {
  solver.cases = spec.cases;
  const ReadVoxels read = read_voxels(spec);
  const std::vector<Matrix6> c = content_stiffness(read.cell, read.phases);
  SolidResult result;
  result.voxels = read.cell.count;
  result.thickness = read.cell.edges(2, 2);
  result.different_voxels = read.cell.contents.size();
  if (spec.faces == Faces::free)
    result.plate = plate_stiffness(elastic_cell(read.cell, c), solver);
  else
    result.stack = periodic_stiffness(elastic_cell(read.cell, c), solver);
  result.balance = balance_of(result);
  return result;
}

}  // namespace heddle::mesoscale::solid
