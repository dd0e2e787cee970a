// An inextensible net on a sphere, against its exact solution: V7 of the verification plan.
#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <vector>

#include <Eigen/Geometry>

#include "macroscale/solve.h"
#include "tests/macroscale/quasi_static.h"
#include "tests/macroscale/sample_fabric.h"

using namespace heddle::macroscale;
using Eigen::Vector3d;
using Eigen::VectorXd;
using heddle::test::make_fabric;
using heddle::test::observed_order;
using heddle::test::run_at_rest;

namespace {

constexpr double shear_modulus = 1.0;                 // dPsi/ds / s [N/m]
constexpr double inextensible = 1e7 * shear_modulus;  // EA per width [N/m]
constexpr double degrees = 180.0 / std::numbers::pi;

// Chebyshev net on a unit sphere whose two axis yarns are great circles through the pole, at arc lengths u, v
// from it. The angle pi/2 - g between the yarns obeys g_uv = cos g (Gauss: K = 1); with g = g(s), s = u v,
// that is
//     s g'' + g' = cos g,   g(0) = 0.
// Along the diagonal u = v, a great circle by symmetry, the polar angle grows by sqrt(2 (1 + sin g)) du.
class Fishnet {
 public:
  Fishnet() {
    // g = s - s^3 / 18 + ... starts the integration off the singular point; the next term is below 1e-15.
    const double s0 = 1e-3;
    Y y = {s0 - s0 * s0 * s0 / 18.0, 1.0 - s0 * s0 / 6.0};
    shear_ = {{0.0, 0.0}, {s0, y[0]}};
    const double h = 1e-3;
    for (double s = s0; s < 1.7; s += h) {
      const Y k1 = slope(s, y), k2 = slope(s + 0.5 * h, at(y, k1, 0.5 * h)),
              k3 = slope(s + 0.5 * h, at(y, k2, 0.5 * h)), k4 = slope(s + h, at(y, k3, h));
      for (std::size_t c = 0; c < y.size(); ++c)
        y[c] += h / 6.0 * (k1[c] + 2.0 * k2[c] + 2.0 * k3[c] + k4[c]);
      shear_.push_back({s + h, y[0]});
    }
  }

  /// Shear angle [rad] at s = u v; linear between points 1e-3 apart.
  double shear(double s) const {
    if (!(s >= 0.0 && s < shear_.back()[0])) throw std::out_of_range("no yarn angle tabulated there");
    const auto right = std::upper_bound(shear_.begin(), shear_.end(), s,
                                        [](double value, const auto& point) { return value < point[0]; });
    const auto left = right - 1;
    const double share = (s - (*left)[0]) / ((*right)[0] - (*left)[0]);
    return (*left)[1] + share * ((*right)[1] - (*left)[1]);
  }

  /// Polar angle [rad] of the diagonal's point u = v = arc: Simpson's rule.
  double polar(double arc) const {
    constexpr int n = 400;
    const auto f = [&](double u) { return std::sqrt(2.0 * (1.0 + std::sin(shear(u * u)))); };
    double sum = f(0.0) + f(arc);
    for (int k = 1; k < n; ++k) sum += (k % 2 == 1 ? 4.0 : 2.0) * f(arc * k / n);
    return sum * arc / (3.0 * n);
  }

 private:
  using Y = std::array<double, 2>;
  static Y slope(double s, const Y& y) { return {y[1], (std::cos(y[0]) - y[1]) / s}; }
  static Y at(const Y& y, const Y& k, double step) { return {y[0] + step * k[0], y[1] + step * k[1]}; }
  std::vector<std::array<double, 2>> shear_;  ///< s, g
};

struct Drape {
  double shear_error = 0.0;  ///< largest over all cells [rad]
  double shear_rms = 0.0;    ///< its root mean square [rad]
  double polar_error = 0.0;  ///< largest over the diagonal [rad]
  double tow_strain = 0.0;   ///< largest [-]
  double net_gap = 0.0;  ///< largest distance of a node from its place in the stepwise net, in spacings [-]
};

Vector3d on_sphere(double polar, double azimuth, double radius) {
  return radius *
         Vector3d(std::sin(polar) * std::cos(azimuth), std::sin(polar) * std::sin(azimuth), -std::cos(polar));
}

// Kinematic draping, as KinDrape and its kin do it: chords of length h on a sphere about the origin, pole
// below. The axis yarns step along great circles; every other knot is where the two about its neighbours
// meet, on the far side of the knot they come from. Knot (i, j) at i (cells + 1) + j.
std::vector<Vector3d> stepwise_net(int cells, double h, double radius) {
  const double turn = 2.0 * std::asin(0.5 * h / radius);
  std::vector<Vector3d> knots((cells + 1) * (cells + 1));
  const auto knot = [&](int i, int j) -> Vector3d& { return knots[i * (cells + 1) + j]; };
  for (int k = 0; k <= cells; ++k) {
    knot(k, 0) = on_sphere(k * turn, 0.0, radius);
    knot(0, k) = on_sphere(k * turn, 0.5 * std::numbers::pi, radius);
  }
  for (int i = 1; i <= cells; ++i)
    for (int j = 1; j <= cells; ++j) {
      // x . a = x . b = R^2 - h^2 / 2 and |x| = R.
      const Vector3d &a = knot(i - 1, j), &b = knot(i, j - 1), &from = knot(i - 1, j - 1),
                     across = a.cross(b);
      const Vector3d middle = (radius * radius - 0.5 * h * h) / (radius * radius + a.dot(b)) * (a + b);
      const double rest = radius * radius - middle.squaredNorm();
      if (!(rest > 0.0)) throw std::out_of_range("the net cannot go on there");
      const Vector3d side = std::sqrt(rest / across.squaredNorm()) * across;
      knot(i, j) = side.dot(middle - from) > 0.0 ? Vector3d(middle + side) : Vector3d(middle - side);
    }
  return knots;
}

// Errors of a quarter net on a sphere of `radius` about the origin, pole below.
Drape compare(const Blank& blank, const State& state, double radius, const Fishnet& exact) {
  Drape result;
  const double h = blank.spacing[0];
  for (int i = 0; i < blank.nu; ++i)
    for (int j = 0; j < blank.nv; ++j) {
      double angle = 0.0;
      for (const Corner& c : corners_of(blank.quads[i * blank.nv + j])) {
        const Vector3d a = state.node(c.along_warp) - state.node(c.node),
                       b = state.node(c.along_weft) - state.node(c.node);
        angle += 0.25 * c.sign * corner_angle(a, b);
        result.tow_strain =
            std::max({result.tow_strain, std::abs(a.norm() / h - 1.0), std::abs(b.norm() / h - 1.0)});
      }
      const double expected = exact.shear((i + 0.5) * (j + 0.5) * h * h / (radius * radius));
      result.shear_error = std::max(result.shear_error, std::abs(angle - expected));
      result.shear_rms += (angle - expected) * (angle - expected) / static_cast<double>(blank.quads.size());
    }
  result.shear_rms = std::sqrt(result.shear_rms);
  for (int i = 1; i <= blank.nu; ++i) {
    const Vector3d x = state.node(blank.node(i, i));
    const double polar = std::atan2(std::hypot(x.x(), x.y()), -x.z());
    result.polar_error = std::max(result.polar_error, std::abs(polar - exact.polar(i * h / radius)));
  }
  const auto net = stepwise_net(blank.nu, h, radius);
  for (int i = 0; i <= blank.nu; ++i)
    for (int j = 0; j <= blank.nv; ++j)
      result.net_gap =
          std::max(result.net_gap, (state.node(blank.node(i, j)) - net[i * (blank.nv + 1) + j]).norm() / h);
  return result;
}

// A quarter of the net, 0.96 R along each yarn, pressed onto a sphere by a pressure towards its centre: pole
// pinned, axis yarns held in their planes, no friction. The sphere starts flat and is curved in equal parts;
// each part starts from where the last two parts point to.
Drape drape(int cells, double tow_stiffness, const Fishnet& exact) {
  const double radius = 0.07, pressure = 2e3, side = 0.96 * radius;
  const int parts = 8;
  const auto fabric = make_fabric({.tow_stiffness = tow_stiffness,
                                   .shear_stiffness = shear_modulus,
                                   .bending = 1e-9,
                                   .contact_stiffness = 5e9});
  Scene scene;
  scene.blank = make_blank({side, side}, side / cells * (1.0 + 1e-9));
  scene.fabric = &fabric;
  scene.shear_rate = false;
  const Blank& blank = scene.blank;
  scene.tools.resize(1);
  scene.held.assign(3 * blank.nodes(), 0);
  scene.load.assign(3 * blank.nodes(), 0.0);
  for (int k = 0; k <= cells; ++k) {
    scene.held[3 * blank.node(0, k)] = 1;
    scene.held[3 * blank.node(k, 0) + 1] = 1;
  }
  System system(scene);
  State state = initial_state(scene);
  // Each node as distance from the pole along the sphere times direction [m]: now and one part ago.
  using Places = std::vector<Eigen::Vector2d>;
  Places now, before;
  for (const Vector3d& r : blank.reference) now.emplace_back(r.x() + 0.5 * side, r.y() + 0.5 * side);
  before = now;
  SolveOptions options;
  options.force_tolerance = 1e-8;
  options.relative_tolerance = 0.0;
  options.newton_limit = 300;
  const double offset = 0.5 * fabric.thickness - approach_at(fabric.compaction.curves().front(), pressure);
  double bent = radius;
  run_at_rest(
      system, state, 100.0, parts,
      [&](double share) {
        bent = radius / share;
        const double tool = bent - offset;  // the midplane comes to rest at `bent`
        scene.tools[0] = {Role::punch, HemisphereShape{{0.0, 0.0, -tool}, tool}, Motion::fixed, 0.0, 0.0};
        for (int n = 0; n < blank.nodes(); ++n) {
          const Eigen::Vector2d place = 2.0 * now[n] - before[n];
          const Vector3d x = on_sphere(place.norm() / bent, std::atan2(place.y(), place.x()), bent);
          for (int c = 0; c < 3; ++c) {
            state.x[3 * n + c] = scene.held[3 * n + c] ? 0.0 : x[c];
            scene.load[3 * n + c] = -pressure * blank.node_area[n] * x[c] / bent;
          }
        }
      },
      {},
      [&](const StepData&, const State& end) {
        before = now;
        for (int n = 0; n < blank.nodes(); ++n) {
          const Vector3d x = end.node(n);
          const double across = std::hypot(x.x(), x.y());
          if (across > 0.0) now[n] = bent * std::atan2(across, -x.z()) / across * x.head<2>();
        }
      },
      options);
  return compare(blank, state, radius, exact);
}

}  // namespace

TEST_CASE("V7: the fishnet equation gives the published shear of a net on a sphere",
          "[macroscale][verification]") {
  const Fishnet exact;
  // Independent values of the same equation, at s = u v / R^2.
  for (const auto& [s, shear] : std::vector<std::array<double, 2>>{
           {0.25, 14.27}, {0.5, 28.26}, {0.75, 41.68}, {1.0, 54.32}, {1.25, 66.00}, {1.5, 76.63}})
    CHECK(exact.shear(s) * degrees == Approx(shear).margin(0.006));
  // Along the diagonal: polar angle [deg], arc of each yarn over R, shear [deg].
  for (const auto& [polar, arc, shear] : std::vector<std::array<double, 3>>{{10, 0.1232, 0.87},
                                                                            {20, 0.2445, 3.42},
                                                                            {30, 0.3625, 7.52},
                                                                            {40, 0.4763, 12.96},
                                                                            {50, 0.5855, 19.51},
                                                                            {60, 0.6901, 26.95},
                                                                            {70, 0.7904, 35.04},
                                                                            {80, 0.8870, 43.59},
                                                                            {90, 0.9806, 52.43}}) {
    CHECK(exact.shear(arc * arc) * degrees == Approx(shear).margin(0.012));
    CHECK(exact.polar(arc) * degrees == Approx(polar).margin(0.012));
  }
}

TEST_CASE("V7: an inextensible net pressed onto a sphere finds the fishnet, with errors of second order",
          "[macroscale][verification]") {
  const Fishnet exact;
  const Drape coarse = drape(8, inextensible, exact), fine = drape(16, inextensible, exact);
  const double order_shear = observed_order(coarse.shear_rms, fine.shear_rms),
               order_polar = observed_order(coarse.polar_error, fine.polar_error);
  WARN("V7, h = R/8.3, R/16.7: shear off by "
       << degrees * coarse.shear_error << ", " << degrees * fine.shear_error << " deg at most, rms order "
       << order_shear << "; polar angle by " << degrees * coarse.polar_error << ", "
       << degrees * fine.polar_error << " deg, order " << order_polar << "; tow strain " << fine.tow_strain);
  CHECK(fine.shear_error * degrees < 1.0);
  CHECK(fine.polar_error * degrees < 1.0);
  CHECK(order_shear > 1.5);
  CHECK(order_polar == Approx(2.0).margin(0.2));
  // The same knots by geometry alone.
  WARN("V7, stepwise net of kinematic draping: nodes off by " << coarse.net_gap << ", " << fine.net_gap
                                                              << " spacings at most");
  CHECK(fine.net_gap < 1e-3);
  CHECK(drape(8, 1e3 * shear_modulus, exact).net_gap > 0.01);  // of tows that stretch: the check can fail
}

TEST_CASE(
    "V7: the stepwise net of kinematic draping follows the fishnet equation, with errors of second order",
    "[macroscale][verification]") {
  const Fishnet exact;
  std::vector<double> gaps;
  for (const int cells : {24, 48}) {
    const double h = 0.96 / cells;
    const auto net = stepwise_net(cells, h, 1.0);
    double gap = 0.0;
    for (int i = 1; i <= cells; ++i) {
      const Vector3d& x = net[i * (cells + 2)];
      gap = std::max(gap, std::abs(std::atan2(std::hypot(x.x(), x.y()), -x.z()) - exact.polar(i * h)));
    }
    gaps.push_back(gap);
  }
  WARN("V7, stepwise net: polar angle off by " << degrees * gaps[0] << ", " << degrees * gaps[1]
                                               << " deg, order " << observed_order(gaps[0], gaps[1]));
  CHECK(gaps[1] * degrees < 0.05);
  CHECK(observed_order(gaps[0], gaps[1]) == Approx(2.0).margin(0.2));
}

// Shear is held back by the last half tow at a free edge alone, whose stretch grows as that tow narrows.
TEST_CASE("V7: tows a thousand times as stiff as the shear are not inextensible: the check can fail",
          "[macroscale][verification]") {
  const Fishnet exact;
  const double off = drape(12, 1e3 * shear_modulus, exact).shear_error * degrees;
  CAPTURE(off);
  CHECK(off > 1.0);
}

TEST_CASE("V7: at h = R/50 the shear of the net on the sphere is met within one degree",
          "[macroscale][verification][slow]") {
  const Fishnet exact;
  const Drape d = drape(48, inextensible, exact);
  WARN("V7, h = R/50: shear off by " << degrees * d.shear_error << " deg at most, " << degrees * d.shear_rms
                                     << " deg rms, polar angle by " << degrees * d.polar_error
                                     << " deg, tow strain " << d.tow_strain);
  CHECK(d.shear_error * degrees < 1.0);
  CHECK(d.polar_error * degrees < 1.0);
}
