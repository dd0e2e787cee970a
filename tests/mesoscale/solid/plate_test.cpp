#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <catch2/catch.hpp>
#include <cmath>

#include "sample_cells.h"

using namespace heddle::mesoscale::solid;
using namespace heddle::test;

namespace {

PlateStiffness solved(const SampleCell& cell, double tolerance = 1e-9) {
  PlateStiffness plate = plate_stiffness(cell.view(), {.tolerance = tolerance});
  REQUIRE(plate.solver.converged);
  return plate;
}

// In-plane stiffness of a ply whose faces carry no stress: 33, 23, 13 condensed out.
Eigen::Matrix3d plane_stress(const Matrix6& c) {
  Eigen::Matrix3d along, across, mixed;
  constexpr int in[3] = {0, 1, 5}, out[3] = {2, 3, 4};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      along(i, j) = c(in[i], in[j]);
      across(i, j) = c(out[i], out[j]);
      mixed(i, j) = c(out[i], in[j]);
    }
  return along - mixed.transpose() * across.inverse() * mixed;
}

struct Ply {
  double thickness;
  Matrix6 stiffness;
};

Matrix6 classical_lamination(const std::vector<Ply>& plies) {
  double height = 0.0;
  for (const Ply& ply : plies) height += ply.thickness;
  double z = -0.5 * height;
  Matrix6 abd = Matrix6::Zero();
  for (const Ply& ply : plies) {
    const double top = z + ply.thickness;
    const Eigen::Matrix3d q = plane_stress(ply.stiffness);
    abd.topLeftCorner<3, 3>() += (top - z) * q;
    abd.topRightCorner<3, 3>() += (top * top - z * z) / 2.0 * q;
    abd.bottomLeftCorner<3, 3>() += (top * top - z * z) / 2.0 * q;
    abd.bottomRightCorner<3, 3>() += (top * top * top - z * z * z) / 3.0 * q;
    z = top;
  }
  return abd;
}

// A, B and D have different units: each against its own size.
double gap_of_parts(const Matrix6& found, const Matrix6& expected) {
  const double a = expected.topLeftCorner<3, 3>().norm(), d = expected.bottomRightCorner<3, 3>().norm();
  const Matrix6 difference = found - expected;
  return std::max({difference.topLeftCorner<3, 3>().norm() / a,
                   difference.bottomRightCorner<3, 3>().norm() / d,
                   difference.topRightCorner<3, 3>().norm() / std::sqrt(a * d)});
}

// The same cell with a layer of voids: periodic in z it is a plate with free faces.
SampleCell with_void_layer(const SampleCell& cell) {
  SampleCell padded = cell;
  const double voxel = cell.edges(2, 2) / cell.count[2];
  padded.count[2] += 1;
  padded.edges(2, 2) += voxel;
  padded.stiffness.push_back(Matrix6::Zero());
  padded.material.insert(padded.material.end(), static_cast<std::size_t>(cell.count[0]) * cell.count[1],
                         static_cast<std::uint16_t>(cell.stiffness.size()));
  return padded;
}

}  // namespace

TEST_CASE("a homogeneous plate has A = Q H and D = Q H^3 / 12, in one iteration", "[solid][plate]") {
  const Matrix6 c = rotated(tow_stiffness(), turn_to({1.0, 0.4, 0.0}));
  const double height = 0.5e-3;
  const PlateStiffness plate = solved(uniform_cell({6, 5, 8}, box(1e-3, 2e-3, height), c));
  CHECK(plate.solver.most_iterations() == 1);
  // Trilinear voxels let the faces curve only by pieces: the curvature of the thickness by Poisson's effect
  // is met to the square of the voxel over the thickness.
  CHECK(gap(plate.a, height * plane_stress(c)) < 1e-12);
  CHECK(plate.b.norm() < 1e-12 * std::sqrt(plate.a.norm() * plate.d.norm()));
}

TEST_CASE("the bending stiffness of a homogeneous plate converges with the square of the layers",
          "[solid][plate]") {
  const Matrix6 c = stiffness(polypropylene);
  const double height = 0.5e-3;
  const Eigen::Matrix3d expected = height * height * height / 12.0 * plane_stress(c);
  std::vector<double> error;
  for (const int layers : {2, 4, 8, 16})
    error.push_back(gap(solved(uniform_cell({2, 2, layers}, box(1e-3, 1e-3, height), c)).d, expected));
  for (std::size_t n = 1; n < error.size(); ++n)
    CHECK(std::log2(error[n - 1] / error[n]) == Approx(2.0).margin(0.02));
}

TEST_CASE("layers without Poisson coupling across are classical lamination to 1e-8", "[solid][plate]") {
  // C13 = C23 = 0: no thickness to curve, and the voxels hold the exact solution.
  const auto ply = [](double e1, double e2, double nu, double g) {
    Matrix6 c = Matrix6::Zero();
    const double m = 1.0 / (1.0 - nu * nu * e2 / e1);
    c(0, 0) = m * e1;
    c(1, 1) = m * e2;
    c(0, 1) = c(1, 0) = m * nu * e2;
    c(2, 2) = 5e9;
    c(3, 3) = c(4, 4) = 2e9;
    c(5, 5) = g;
    return c;
  };
  const Matrix6 first = ply(40e9, 6e9, 0.3, 2e9), second = rotated(first, turn_to({1.0, 1.0, 0.0}));
  const SampleCell cell = filled_cell({4, 4, 6}, box(1e-3, 1e-3, 0.6e-3), {first, second},
                                      [](int, int, int k) { return k < 2 ? 0 : 1; });
  CHECK(gap_of_parts(solved(cell).all, classical_lamination({{0.2e-3, first}, {0.4e-3, second}})) < 1e-8);
}

TEST_CASE("stretching of layered plates is classical lamination to 1e-8", "[solid][plate]") {
  const Matrix6 tow = tow_stiffness(), across = rotated(tow, turn_to({0.0, 1.0, 0.0})),
                resin = stiffness(polypropylene);
  const SampleCell cell =
      filled_cell({4, 4, 8}, box(1e-3, 1e-3, 0.4e-3), {tow, across, resin}, [](int, int, int k) {
        return k < 3 ? 0 : k < 6 ? 1 : 2;
      });
  const Matrix6 expected = classical_lamination({{0.15e-3, tow}, {0.15e-3, across}, {0.1e-3, resin}});
  const PlateStiffness plate = solved(cell);
  CHECK(gap(plate.a, expected.topLeftCorner<3, 3>()) < 1e-8);
  CHECK(gap(plate.a, 1.01 * expected.topLeftCorner<3, 3>()) > 1e-3);  // the check can fail
}

TEST_CASE("a cross-ply of straight tows converges to classical lamination with order two", "[solid][plate]") {
  const Matrix6 tow = tow_stiffness(), across = rotated(tow, turn_to({0.0, 1.0, 0.0}));
  const Matrix6 expected = classical_lamination({{0.25e-3, tow}, {0.25e-3, across}});
  std::vector<double> error;
  for (const int layers : {4, 8, 16})
    error.push_back(gap_of_parts(solved(filled_cell({2, 2, layers}, box(1e-3, 1e-3, 0.5e-3), {tow, across},
                                                    [&](int, int, int k) { return 2 * k < layers ? 0 : 1; }))
                                     .all,
                                 expected));
  CHECK(error.back() < 2e-3);
  for (std::size_t n = 1; n < error.size(); ++n)
    CHECK(std::log2(error[n - 1] / error[n]) == Approx(2.0).margin(0.05));
}

TEST_CASE("free faces by elimination are free faces by a layer of voids", "[solid][plate]") {
  const SampleCell cell = random_cell({8, 6, 5}, tow_and_resin(), 4);
  const SampleCell padded = with_void_layer(cell);
  const PeriodicStiffness periodic = periodic_stiffness(padded.view(), {.tolerance = 1e-10});
  REQUIRE(periodic.solver.converged);
  const PlateStiffness plate = solved(cell, 1e-10);
  constexpr int in[3] = {0, 1, 5};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      const double of_periodic = periodic.stiffness(in[i], in[j]) * padded.edges(2, 2);
      CHECK(std::abs(plate.a(i, j) - of_periodic) < 1e-6 * plate.a(0, 0));
    }
  // Free faces carry nothing across, and the elimination needs fewer steps.
  CHECK(std::abs(periodic.stiffness(2, 2)) < 1e-6 * periodic.stiffness(0, 0));
  CHECK(plate.solver.most_iterations() < periodic.solver.most_iterations());
}

TEST_CASE("plates lie below the bound of fields that do not fluctuate, and are stable",
          "[solid][plate][bound]") {
  const unsigned seed = GENERATE(1U, 2U, 3U);
  const PlateStiffness plate = solved(random_cell({6, 5, 4}, tow_and_resin(), seed), 1e-7);
  const double length = 0.3e-3;  // makes curvatures strains, so that eigenvalues compare
  const Vector6 scale = (Vector6() << 1, 1, 1, 1 / length, 1 / length, 1 / length).finished();
  const auto smallest = [&](const Matrix6& m) {
    return Eigen::SelfAdjointEigenSolver<Matrix6>(scale.asDiagonal() * m * scale.asDiagonal())
        .eigenvalues()
        .minCoeff();
  };
  CHECK(smallest(plate.all) > 0.0);
  CHECK(smallest(plate.upper - plate.all) > -1e-10 * plate.a.norm());
  CHECK(plate.checks.hill_mandel < 1e-10);
  CHECK(plate.checks.asymmetry < 1e-6);
}

TEST_CASE("a plate scales with its thickness: A by one power, B by two, D by three", "[solid][plate]") {
  const SampleCell cell = random_cell({6, 5, 4}, tow_and_resin(), 2);
  SampleCell larger = cell;
  larger.edges *= 3.0;
  const PlateStiffness base = solved(cell), scaled = solved(larger);
  CHECK(gap(scaled.a, 3.0 * base.a) < 1e-10);
  CHECK(gap(scaled.b, 9.0 * base.b) < 1e-9);
  CHECK(gap(scaled.d, 27.0 * base.d) < 1e-10);
}

TEST_CASE("a plate turned upside down changes the sign of B", "[solid][plate]") {
  const std::vector<Matrix6> c{stiffness(polypropylene), tow_stiffness()};
  const auto pattern = [](int i, int j, int k) { return (i * i + 3 * j + 2 * k) % 7 < 3 ? 1 : 0; };
  const SampleCell cell = filled_cell({6, 6, 4}, box(1e-3, 1e-3, 0.5e-3), c, pattern);
  const SampleCell turned = filled_cell({6, 6, 4}, box(1e-3, 1e-3, 0.5e-3), c,
                                        [&](int i, int j, int k) { return pattern(i, j, 3 - k); });
  const PlateStiffness up = solved(cell), down = solved(turned);
  CHECK(up.b.norm() > 1e-4 * std::sqrt(up.a.norm() * up.d.norm()));
  CHECK(gap(down.a, up.a) < 1e-9);
  CHECK(gap(down.b, -up.b) < 1e-7);
  CHECK(gap(down.d, up.d) < 1e-9);
}

TEST_CASE("a homogeneous plate on an oblique lattice is the upright one", "[solid][plate]") {
  Eigen::Matrix3d edges;
  edges << 1.0, 0.5, 0.0, 0.0, 0.9, 0.0, 0.0, 0.0, 0.4;
  const Matrix6 c = rotated(tow_stiffness(), turn_to({1.0, 0.4, 0.0}));
  const PlateStiffness oblique = solved(uniform_cell({4, 4, 4}, 1e-3 * edges, c));
  const PlateStiffness upright = solved(uniform_cell({4, 4, 4}, box(1e-3, 1e-3, 0.4e-3), c));
  CHECK(gap(oblique.a, upright.a) < 1e-12);
  CHECK(gap(oblique.d, upright.d) < 1e-12);
}
