// Thermal expansion and shrinkage, and the solid of a sheared fabric.
#include "mesoscale/solid/thermal.h"

#include <Eigen/LU>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "mesoscale/solid/solid_cell.h"
#include "mesoscale/solid/woven_solid.h"
#include "sample_cells.h"

using namespace heddle::mesoscale;
using namespace heddle::mesoscale::solid;
using namespace heddle::test;

namespace {

constexpr double degree = std::numbers::pi / 180.0;

Vector6 isotropic_strain(double alpha) {
  Vector6 e = Vector6::Zero();
  e.head<3>().setConstant(alpha);
  return e;
}

double off(const Vector6& a, const Vector6& b) {
  return (a - b).norm() / b.norm();
}

SolidSpec coarse(std::vector<double> angles = {}) {
  SolidSpec spec;
  spec.grid = {.per_pitch = 8, .layers = 6};
  spec.solver.tolerance = 1e-9;
  spec.shear_angles = std::move(angles);
  return spec;
}

// The plate matrix of the same ply in axes turned by an angle about 3.
Matrix6 plate_turned(const Matrix6& plate, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  Eigen::Matrix3d strain;  // old strains 11, 22, 12 (engineering) of the new ones
  strain << c * c, s * s, -c * s, s * s, c * c, c * s, 2.0 * c * s, -2.0 * c * s, c * c - s * s;
  Matrix6 both = Matrix6::Zero();
  both.topLeftCorner<3, 3>() = both.bottomRightCorner<3, 3>() = strain;
  return both.transpose() * plate * both;
}

}  // namespace

TEST_CASE("a tow without contrast expands as its parts do, and without resin as its fibre",
          "[solid][thermal]") {
  const IsotropicPhase one{10e9, 0.3};
  const FreeStrain same = schapery(one, 3e-5, one, 3e-5, 0.6);
  CHECK(same.axial == Approx(3e-5).epsilon(1e-14));
  CHECK(same.transverse == Approx(3e-5).epsilon(1e-14));
  const FreeStrain fibre = schapery(glass, 5e-6, polypropylene, 1.2e-4, 1.0);
  CHECK(fibre.axial == Approx(5e-6));
  CHECK(fibre.transverse == Approx(5e-6));
  // The fibre holds the tow lengthwise; crosswise the resin, held too, bulges.
  const FreeStrain tow = schapery(glass, 5e-6, polypropylene, 1.2e-4, 0.6);
  CHECK(tow.axial < 1e-5);
  CHECK(tow.transverse > 0.4 * 1.2e-4);
}

TEST_CASE("layers of a laminate strain so that the whole has its stiffness", "[solid][thermal]") {
  const std::vector<double> share{0.3, 0.7};
  const std::vector<Matrix6> c{stiffness(polypropylene), rotated(tow_stiffness(), turn_to({1.0, 0.5, 0.2}))};
  const Eigen::Vector3d normal = Eigen::Vector3d(0.3, -0.2, 0.9).normalized();
  const std::vector<Matrix6> layer = layer_strains(share, c, normal);
  Matrix6 strain = Matrix6::Zero(), stress = strain;
  for (std::size_t n = 0; n < 2; ++n) {
    strain += share[n] * layer[n];
    stress += share[n] * c[n] * layer[n];
  }
  CHECK((strain - Matrix6::Identity()).norm() < 1e-12);
  CHECK(heddle::test::gap(stress, laminate(share, c, normal)) < 1e-12);
}

TEST_CASE("what expands alike everywhere is free of stress: the cell expands as its parts",
          "[solid][thermal]") {
  const double alpha = 4e-5;
  const SampleCell cell = random_cell({5, 6, 4}, tow_and_resin(), 3);
  HeldStress held;
  for (const Matrix6& c : cell.stiffness) held.push_back(c * isotropic_strain(alpha));
  const std::vector<HeldStress> causes{held};
  const PeriodicStiffness stack = periodic_stiffness(cell.view(), {.tolerance = 1e-10}, causes);
  CHECK(off(free_strain(stack.stiffness, stack.held[0]), isotropic_strain(alpha)) < 1e-9);
  const PlateStiffness plate = plate_stiffness(cell.view(), {.tolerance = 1e-10}, causes);
  Vector6 stretch = Vector6::Zero();
  stretch.head<2>().setConstant(alpha);
  // In the norm of the strains: curvatures of a plate 1 mm thick are of the order of strain / mm.
  CHECK((free_strain(plate.all, plate.held[0]) - stretch).head<3>().norm() < 1e-9 * alpha);
  CHECK((free_strain(plate.all, plate.held[0]) - stretch).tail<3>().norm() < 1e-6 * alpha / 1e-3);
}

TEST_CASE("two isotropic phases expand as Levin's formula says, whatever their arrangement",
          "[solid][thermal]") {
  // Exact: alpha* = <alpha> + (alpha1 - alpha2) / (1/K1 - 1/K2) (3 S* : 1 - <1/K> 1), Rosen and Hashin 1970.
  const IsotropicPhase a = glass, b = polypropylene;
  const double alpha_a = 5e-6, alpha_b = 1.2e-4;
  const SampleCell cell = random_cell({6, 5, 7}, {stiffness(a), stiffness(b)}, 11);
  const std::vector<HeldStress> causes{
      {cell.stiffness[0] * isotropic_strain(alpha_a), cell.stiffness[1] * isotropic_strain(alpha_b)}};
  const PeriodicStiffness found = periodic_stiffness(cell.view(), {.tolerance = 1e-10}, causes);
  double share = 0.0;
  for (const auto m : cell.material) share += m == 0 ? 1.0 : 0.0;
  share /= static_cast<double>(cell.material.size());
  const double mean_alpha = share * alpha_a + (1.0 - share) * alpha_b;
  const double mean_soft = share / a.bulk() + (1.0 - share) / b.bulk();
  const Vector6 squeezed = found.stiffness.inverse() * isotropic_strain(1.0);
  const Vector6 expected = isotropic_strain(mean_alpha) + (alpha_a - alpha_b) /
                                                              (1.0 / a.bulk() - 1.0 / b.bulk()) *
                                                              (3.0 * squeezed - isotropic_strain(mean_soft));
  CHECK(off(free_strain(found.stiffness, found.held[0]), expected) < 1e-8);
  CHECK(off(1.01 * expected, expected) > 1e-3);
}

TEST_CASE("a layered cell presses as the laminate of its layers", "[solid][thermal]") {
  const std::vector<Matrix6> c{stiffness(polypropylene), rotated(tow_stiffness(), turn_to({1.0, 0.6, 0.0}))};
  const int axis = GENERATE(0, 1, 2);
  const SampleCell cell = filled_cell({8, 8, 8}, box(1e-3, 2e-3, 0.5e-3), c, [&](int i, int j, int k) {
    return std::array{i, j, k}[static_cast<std::size_t>(axis)] < 3 ? 0 : 1;
  });
  Vector6 tow = Vector6::Zero();
  tow << 7e-6, 6e-5, 6e-5, 0.0, 0.0, 2e-5;
  const HeldStress held{c[0] * isotropic_strain(1.2e-4), c[1] * tow};
  const std::vector<HeldStress> causes{held};
  const PeriodicStiffness found = periodic_stiffness(cell.view(), {.tolerance = 1e-10}, causes);
  const std::vector<double> share{3.0 / 8.0, 5.0 / 8.0};
  const std::vector<Matrix6> layer = layer_strains(share, c, Eigen::Vector3d::Unit(axis));
  const Vector6 expected =
      share[0] * layer[0].transpose() * held[0] + share[1] * layer[1].transpose() * held[1];
  CHECK(off(found.held[0], expected) < 1e-8);
  CHECK(off(share[0] * held[0] + share[1] * held[1], expected) > 1e-2);  // the mean would not do
}

TEST_CASE("a sheet of tow and resin that expand alike does so at every trellis angle",
          "[solid][thermal][shear]") {
  SolidSpec spec = coarse({0.0, 25.0 * degree, -45.0 * degree});
  spec.fibre_expansion = spec.resin_expansion = 2e-5;
  const SolidResult result = analyse(WeaveSpec{}, spec);
  REQUIRE(result.sheared.size() == 3);
  for (const ShearedSolid& s : result.sheared) {
    CHECK(s.converged);
    CHECK(off(free_strain(s.stack, s.stack_held[expansion]), isotropic_strain(2e-5)) < 1e-8);
    CHECK(off(free_strain(s.stack, s.stack_held[shrinkage]), isotropic_strain(1.0)) > 0.1);  // glass holds
  }
}

TEST_CASE("unsheared, the table of the solid is the solid", "[solid][shear]") {
  const SolidResult result = analyse(WeaveSpec{}, coarse({0.0}));
  CHECK(result.sheared[0].plate == result.plate->all);
  CHECK(result.sheared[0].stack == result.stack->stiffness);
  CHECK(result.sheared[0].plate_held[expansion] == result.plate->held[expansion]);
  CHECK(result.sheared[0].thickness == Approx(result.thickness));
}

TEST_CASE("sheared the other way, the solid is its mirror image", "[solid][shear]") {
  const SolidResult result = analyse(WeaveSpec{}, coarse({30.0 * degree, -30.0 * degree}));
  Matrix6 mirrored = result.sheared[1].plate;
  for (const int i : {2, 5}) {
    mirrored.row(i) *= -1.0;
    mirrored.col(i) *= -1.0;
  }
  const Matrix6& plate = result.sheared[0].plate;
  CHECK(gap(mirrored.topLeftCorner<3, 3>(), plate.topLeftCorner<3, 3>()) < 2e-3);
  CHECK(std::abs(plate(0, 2)) > 0.02 * plate(0, 0));  // there is something to mirror
  for (const HeldCause cause : {expansion, shrinkage}) {
    const Vector6 &there = result.sheared[0].plate_held[cause], &back = result.sheared[1].plate_held[cause];
    CHECK(
        (there - Vector6(back.cwiseProduct((Vector6() << 1, 1, -1, 1, 1, -1).finished()))).head<3>().norm() <
        2e-3 * there.head<3>().norm());
    CHECK(std::abs(there[2]) > 0.005 * there[0]);
  }
}

TEST_CASE("a sheared balanced sheet is symmetric about the bisector of its tows, and stiffer along it",
          "[solid][shear]") {
  const double angle = 30.0 * degree;
  const SolidResult result = analyse(WeaveSpec{}, coarse({angle}));
  // Warp at 0, weft at 60 deg: the bisector lies at 30 deg.
  const Matrix6 turned = plate_turned(result.sheared[0].plate, 0.5 * (0.5 * std::numbers::pi - angle));
  CHECK(std::abs(turned(0, 2)) < 2e-3 * turned(0, 0));
  CHECK(std::abs(turned(1, 2)) < 2e-3 * turned(0, 0));
  CHECK(turned(0, 0) > 1.5 * turned(1, 1));
  CHECK(gap(plate_turned(turned, -0.5 * (0.5 * std::numbers::pi - angle)), result.sheared[0].plate) < 1e-12);
}

TEST_CASE("a sheared sheet of one material has that material's stiffness", "[solid][shear]") {
  SolidSpec spec = coarse({40.0 * degree});
  spec.resin = glass;
  const SolidResult result = analyse(WeaveSpec{}, spec);
  CHECK(gap(result.sheared[0].stack, stiffness(glass)) < 1e-9);
}

namespace {

// Straight tows as wide as their pitch, warps all over and wefts all under, at a trellis angle: no fabric,
// but a laminate of two layers, the warp's at 0 and the weft's at 90 deg less the angle.
PressedFabric straight_tows(double angle, std::array<double, 2> fibre_fraction, double thickness) {
  PressedFabric sheet{};
  sheet.thickness = thickness;
  sheet.crossing.shear_angle = angle;
  for (std::size_t i = 0; i < 2; ++i) {
    TowGeometry& tow = sheet.crossing.tow[i];
    tow.spacing = 2e-3;
    // So full that it is a rectangle: half height t/2 (1 - x^2)^(n/2), n -> 0.
    tow.section = PowerEllipseSection{tow.spacing, 0.5 * thickness, 1e-14};
    tow.path = arc_path(tow.spacing, 0.5 * thickness, 50e-3);
    tow.fibre_fraction = fibre_fraction[i];
  }
  return sheet;
}

// Stiffness of a layer whose faces carry no stress, and what it presses with when held: order 11, 22, 12.
struct FlatLayer {
  Eigen::Matrix3d stiffness;
  Eigen::Vector3d held;
};
FlatLayer flat_layer(const Matrix6& c, const Vector6& held) {
  const Matrix6 soft = c.inverse();
  const Vector6 free = soft * held;
  constexpr std::array in{0, 1, 5};
  Eigen::Matrix3d compliance;
  Eigen::Vector3d strain;
  for (int i = 0; i < 3; ++i) {
    strain[i] = free[in[static_cast<std::size_t>(i)]];
    for (int j = 0; j < 3; ++j)
      compliance(i, j) = soft(in[static_cast<std::size_t>(i)], in[static_cast<std::size_t>(j)]);
  }
  return {compliance.inverse(), compliance.inverse() * strain};
}

}  // namespace

TEST_CASE("sheared straight tows are a laminate at the trellis angle, in stiffness and thermal resultants",
          "[solid][thermal][shear]") {
  const double angle = GENERATE(0.0, 20.0, -20.0, 45.0) * degree, height = 0.5e-3;
  const bool one_way = GENERATE(false, true);  // resin in place of the wefts: plies of one direction
  CAPTURE(angle / degree, one_way);
  SolidSpec spec;
  spec.grid = {.per_pitch = 4, .layers = 16};
  spec.solver.tolerance = 1e-10;
  const WeaveMatrix all_over{1, 1, {1}};
  const WovenSolid solid =
      woven_solid(all_over, straight_tows(angle, {0.6, one_way ? 0.0 : 0.5}, height), glass.modulus, spec);
  const PlateStiffness plate =
      plate_stiffness(elastic_cell(solid.cell, solid.stiffness), spec.solver, solid.held);
  REQUIRE(plate.solver.converged);

  const auto layer = [&](double fraction, double direction, HeldCause cause) {
    const FreeStrain free =
        cause == expansion ? schapery(glass, spec.fibre_expansion, spec.resin, spec.resin_expansion, fraction)
                           : schapery(glass, 0.0, spec.resin, 1.0, fraction);
    Vector6 strain = Vector6::Zero();
    strain.head<3>() << free.axial, free.transverse, free.transverse;
    const Matrix6 along = stiffness(chamis(glass, spec.resin, fraction));
    const Eigen::Matrix3d turn = turn_to({std::cos(direction), std::sin(direction), 0.0});
    return flat_layer(rotated(along, turn), rotated(along, turn) * strain_turn(turn) * strain);
  };
  for (const HeldCause cause : {expansion, shrinkage}) {
    const FlatLayer weft = layer(one_way ? 0.0 : 0.5, 0.5 * std::numbers::pi - angle, cause);
    const FlatLayer warp = layer(0.6, 0.0, cause);
    const Eigen::Matrix3d a = 0.5 * height * (warp.stiffness + weft.stiffness);
    // The warp lies on top: the middles of the layers stand at +- H/4.
    const Eigen::Matrix3d b = 0.125 * height * height * (warp.stiffness - weft.stiffness);
    const Eigen::Matrix3d d = height * height * height / 24.0 * (warp.stiffness + weft.stiffness);
    CHECK(gap(plate.a, a) < 1e-8);
    CHECK(gap(plate.held[cause].head<3>(), 0.5 * height * (warp.held + weft.held)) < 1e-8);
    // Bent layers curve across by Poisson's effect, which sixteen voxels follow to a few thousandths.
    CHECK((plate.b - b).norm() < 2e-3 * std::sqrt(a.norm() * d.norm()));
    CHECK(gap(plate.d, d) < 5e-3);
    const Eigen::Vector3d moment = 0.125 * height * height * (warp.held - weft.held);
    CHECK((plate.held[cause].tail<3>() - moment).norm() < 2e-3 * height * plate.held[cause].head<3>().norm());
    CHECK(gap(1.01 * a, plate.a) > 1e-3);  // the check can fail
  }
}

TEST_CASE("pressed after shear, a fabric keeps its glass and has no voids", "[solid][shear]") {
  const FabricGeometry fabric = fabric_geometry(WeaveSpec{}, CellState::consolidated);
  for (const double degrees : {0.0, 20.0, 35.0, 50.0}) {
    const double angle = degrees * degree;
    const PressedFabric sheet = pressed(fabric, angle);
    double glass_volume = 0.0;  // per initial area
    for (const TowGeometry& tow : sheet.crossing.tow)
      glass_volume += tow.fibre_fraction * area(tow.section) * std::cos(angle) / tow.spacing;
    const double woven_in =
        2.0 * fabric.mass.glass_area[0] * (1.0 + fabric.as_woven_crimp[0]) / fabric.crossing.tow[0].spacing;
    CHECK(glass_volume == Approx(woven_in).epsilon(1e-12));
    CHECK(sheet.thickness * std::cos(angle) == Approx(fabric.thickness).epsilon(1e-14));
    CHECK(penetration(unit_cell(fabric.weave, sheet.crossing), 24).depth <= 1e-16);
    CHECK(unit_cell(fabric.weave, sheet.crossing).crown() == Approx(0.5 * sheet.thickness));
  }
}
