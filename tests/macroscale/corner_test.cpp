#include <catch2/catch.hpp>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include <random>

#include "macroscale/corner_element.h"
#include "macroscale/corner_filter.h"
#include "tests/derivative_check.h"
#include "tests/macroscale/sample_fabric.h"

using namespace heddle::macroscale;
using Eigen::Vector3d;
using heddle::test::derivative_gap;
using heddle::test::make_fabric;
using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

namespace {

const heddle::mesoscale::FabricProperties& fabric() {
  static const auto made = make_fabric({.rate_consistency = 5.0});
  return made;
}

CornerLaw law_with_rate() {
  CornerLaw law;
  law.fabric = &fabric();
  law.area = 0.25 * 20e-6;
  law.length_warp = 4e-3;
  law.length_weft = 5e-3;
  law.rate_consistency = 5.0;
  law.rate_index = 0.38;
  law.time_step = 4e-3;
  return law;
}

struct Pose {
  Vector3d a, b;
  double before;
};

Pose pose(int kind) {
  switch (kind) {
    case 0:
      return {{4.01e-3, 0, 0}, {1.2e-3, 4.88e-3, 0.1e-3}, 0.2};  // stretched, sheared, opening
    case 1:
      return {
          {3.9e-3, 0.2e-3, 0.7e-3}, {-2.5e-3, 4.2e-3, 0}, -0.5};  // compressed warp, sheared the other way
    default:
      return {{3.7e-3, 0, 0.3e-3}, {3.6e-3, 3.4e-3, 0}, 0.8};  // near locking, slack: indefinite
  }
}

double energy_of(const CornerLaw& law, const Vector6& y, double before) {
  return corner_energy(law, y.head<3>(), y.tail<3>(), before).total();
}

Vector6 gradient_of(const CornerLaw& law, const Vector6& y, double before) {
  const auto g = corner_gradient(law, y.head<3>(), y.tail<3>(), before);
  Vector6 v;
  v << g.a(), g.b();
  return v;
}

Matrix6 hessian_of(const CornerLaw& law, const Vector6& y, double before, Filter filter) {
  const auto h = corner_hessian(law, y.head<3>(), y.tail<3>(), before, filter);
  Matrix6 m;
  m << h.aa, h.ab, h.ab.transpose(), h.bb;
  return m;
}

template <class Matrix>
Matrix nearest_positive(const Matrix& m) {
  const Eigen::SelfAdjointEigenSolver<Matrix> e(m);
  return e.eigenvectors() * e.eigenvalues().cwiseMax(0.0).asDiagonal() * e.eigenvectors().transpose();
}

}  // namespace

TEST_CASE("corner forces are the slope of the corner energy, stiffness the slope of the forces",
          "[macroscale][corner][derivative]") {
  const CornerLaw law = law_with_rate();
  const Pose p = pose(GENERATE(0, 1, 2));
  Vector6 y;
  y << p.a, p.b;
  const Vector6 g = gradient_of(law, y, p.before);
  const Matrix6 h = hessian_of(law, y, p.before, Filter::none);
  CHECK((h - h.transpose()).norm() < 1e-12 * h.norm());
  Vector6 d;
  d << 0.3, -0.7, 0.5, -0.2, 0.6, 0.4;
  const auto energy = [&](double t) { return energy_of(law, y + t * d, p.before); };
  const double slope = g.dot(d);
  CHECK(derivative_gap(energy, 0.0, 1e-3, slope) < 1e-6);
  CHECK(derivative_gap(energy, 0.0, 1e-3, 1.01 * slope) > 1e-4);
  for (int k = 0; k < 6; ++k) {
    const auto force = [&](double t) { return gradient_of(law, y + t * d, p.before)[k]; };
    const double tangent = h.row(k).dot(d);
    CHECK(derivative_gap(force, 0.0, 1e-3, tangent) < 1e-5);
    CHECK(derivative_gap(force, 0.0, 1e-3, 1.01 * tangent) > 1e-4);
  }
}

TEST_CASE("filtered corner stiffness has no negative eigenvalue and keeps the positive ones",
          "[macroscale][corner]") {
  const CornerLaw law = law_with_rate();
  const Pose p = pose(2);
  Vector6 y;
  y << p.a, p.b;
  const Matrix6 exact = hessian_of(law, y, p.before, Filter::none),
                filtered = hessian_of(law, y, p.before, Filter::positive);
  const Eigen::SelfAdjointEigenSolver<Matrix6> e(exact), f(filtered);
  REQUIRE(e.eigenvalues()[0] < 0.0);  // else the filter had nothing to do
  CHECK(f.eigenvalues()[0] > -1e-9 * f.eigenvalues()[5]);
  CHECK((filtered - nearest_positive(exact)).norm() < 1e-12 * exact.norm());
}

TEST_CASE("the closed-form filter gives the nearest positive matrix at random corners, as eigenvalues say",
          "[macroscale][corner]") {
  const CornerLaw law = law_with_rate();
  std::mt19937 random(7);
  std::uniform_real_distribution<double> off(-0.6, 0.6), angle(-1.2, 1.2);
  int indefinite = 0;
  double worst = 0.0;
  for (int k = 0; k < 2000; ++k) {
    Vector6 y;
    y << 4e-3 * (1.0 + 0.02 * off(random)), 4e-3 * off(random), 4e-3 * off(random), 5e-3 * off(random),
        5e-3 * (1.0 + 0.3 * off(random)), 5e-3 * off(random);
    const double before = angle(random);
    const Matrix6 exact = hessian_of(law, y, before, Filter::none);
    indefinite += Eigen::SelfAdjointEigenSolver<Matrix6>(exact).eigenvalues()[0] < 0.0;
    const Matrix6 filtered = hessian_of(law, y, before, Filter::positive);
    worst = std::max(worst, (filtered - nearest_positive(exact)).norm() / exact.norm());
  }
  CHECK(indefinite > 300);
  CHECK(worst < 1e-12);
}

TEST_CASE("rings of any size and sign, with couplings missing, are filtered as eigenvalues say",
          "[macroscale][corner]") {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> sign(-1.0, 1.0), power(-6.0, 6.0);
  std::bernoulli_distribution missing(0.2);
  const auto entry = [&] { return missing(random) ? 0.0 : sign(random) * std::pow(10.0, power(random)); };
  double worst = 0.0;
  int by_count[5] = {};
  for (int k = 0; k < 5000; ++k) {
    const CornerRing ring{std::abs(entry()), entry(), std::abs(entry()), entry(),
                          entry(),           entry(), entry(),           entry()};
    const Eigen::Matrix4d m = matrix_of(ring);
    if (m.norm() == 0.0) continue;
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d> e(m);
    ++by_count[(e.eigenvalues().array() < 0.0).count()];
    worst = std::max(worst, (positive_part(ring) - nearest_positive(m)).norm() / m.norm());
  }
  for (int negative : {0, 1, 2}) CHECK(by_count[negative] > 50);
  CHECK(worst < 1e-12);
  const Eigen::Matrix4d identity = positive_part(CornerRing{1.0, 1.0, 1.0, 1.0, 0.0, 0.0, 0.0, 0.0});
  CHECK(identity == Eigen::Matrix4d::Identity());
}

TEST_CASE("a turned corner has the same energy and turned forces", "[macroscale][corner][invariant]") {
  const CornerLaw law = law_with_rate();
  const Pose p = pose(GENERATE(0, 1));
  const Eigen::Matrix3d r = Eigen::AngleAxisd(1.1, Vector3d(1, 2, -1).normalized()).toRotationMatrix();
  CHECK(corner_energy(law, r * p.a, r * p.b, p.before).total() ==
        Approx(corner_energy(law, p.a, p.b, p.before).total()).epsilon(1e-11));
  const auto g = corner_gradient(law, p.a, p.b, p.before),
             turned = corner_gradient(law, r * p.a, r * p.b, p.before);
  CHECK((turned.a() - r * g.a()).norm() < 1e-10 * g.a().norm());
}
