#include "mesoscale/solid/solid_cell.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

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
  return problems;
}

SolidResult analyse(const WeaveSpec& weave, const SolidSpec& spec) {
  if (Problems problems = check(spec); !problems.empty()) throw InputError(std::move(problems));
  const FabricGeometry fabric = fabric_geometry(weave, CellState::consolidated);
  const VoxelCell cell = sample(unit_cell(fabric, 0.0), fabric.thickness, spec.grid);
  SolidResult result;
  const auto tow_of = [&](const TowGeometry& geometry) {
    return tow(spec.tow_model, {weave.fibre_modulus, spec.fibre_poisson}, spec.resin,
               geometry.fibre_fraction);
  };
  const std::array tows{tow_of(fabric.crossing.tow[0]), tow_of(fabric.crossing.tow[1])};
  result.tow = tows;
  result.balanced = fabric.crossing.balanced() && alike_both_ways(fabric.weave);
  const std::array phases{stiffness(spec.resin), stiffness(tows[0]), stiffness(tows[1])};
  const std::vector<Matrix6> c = content_stiffness(cell, phases);
  result.voxels = cell.count;
  result.thickness = fabric.thickness;
  const std::vector<double> shares = phase_shares(cell, phases.size());
  result.tow_share = shares[warp_phase] + shares[weft_phase];
  result.different_voxels = cell.contents.size();
  result.plate = plate_stiffness(elastic_cell(cell, c), spec.solver);
  result.stack = periodic_stiffness(elastic_cell(cell, c), spec.solver);
  result.balance = balance_of(result);
  return result;
}

SolidResult analyse(const VoxelFileSpec& spec, const SolverOptions& solver) {
  const ReadVoxels read = read_voxels(spec);
  const std::vector<Matrix6> c = content_stiffness(read.cell, read.phases);
  SolidResult result;
  result.voxels = read.cell.count;
  result.thickness = spec.size[2];
  result.different_voxels = read.cell.contents.size();
  if (spec.faces == Faces::free)
    result.plate = plate_stiffness(elastic_cell(read.cell, c), solver);
  else
    result.stack = periodic_stiffness(elastic_cell(read.cell, c), solver);
  result.balance = balance_of(result);
  return result;
}

}  // namespace heddle::mesoscale::solid
