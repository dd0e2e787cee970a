// The film equation against bearings with known answers.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include <fmt/format.h>

#include "core/problem.h"
#include "mesoscale/reynolds.h"
#include "mesoscale/root.h"
#include "tests/derivative_check.h"

using namespace heddle;
using namespace heddle::mesoscale;
using Eigen::Vector2d;
using heddle::test::derivative_gap;
using std::numbers::pi;

namespace {

constexpr double viscosity = 65.0, speed = 16.67e-3;  // of the paper's baseline, in a film of 9 um
const FilmFluid newtonian{.consistency = viscosity, .index = 1.0};
const FilmFluid thinning{};  // n = 0.38

// An infinitely long bearing of length L along x: n elements, then one that holds air.
struct Slider {
  double length;
  std::function<double(double)> gap;  // of x in [0, L]

  FilmMap map(int n, int rows = 1) const {
    const double dx = length / n;
    return film_map(
        n + 1, rows, {length + dx, 0.0}, {0.0, rows * dx},
        [&](double x, double) { return gap(std::min(x * (length + dx), length)); },
        [&](int column, int) { return column > 0 && column < n; });
  }
  /// Means over the repeat turned into means over the bearing.
  double per_length(double mean, int n) const { return mean * (n + 1) / n; }
};

double orders(double coarse, double middle) {
  return std::log2(std::abs(coarse / middle));
}

// Print what a test measured: shown by ./heddle test -R NAME -V.
template <class... Values>
void show(fmt::format_string<Values...> text, Values&&... values) {
  fmt::print(text, std::forward<Values>(values)...);
}

const Slider taper{4e-3, [](double x) { return 40e-6 - 20e-6 * x / 4e-3; }};

}  // namespace

TEST_CASE("a linear slider carries 6 eta U L^2 / h^2 (ln K - 2 (K - 1) / (K + 1)) / (K - 1)^2", "[film]") {
  const double K = 2.0, h2 = 20e-6, L = taper.length, unit = viscosity * speed * L / h2;
  const double load = 6.0 * unit / h2 / ((K - 1) * (K - 1)) * (std::log(K) - 2.0 * (K - 1) / (K + 1));
  const double drag = unit / (L * (K - 1)) * (4.0 * std::log(K) - 6.0 * (K - 1) / (K + 1));
  const double flow = speed * 2.0 * h2 / (1.0 + 1.0 / K) / 2.0;  // q = U h*/2, h* = 2 h1 h2 / (h1 + h2)
  double error[3], drag_error[3];
  for (int k = 0; k < 3; ++k) {
    const int n = 16 << k;
    const FilmPressure film = solve_reynolds(taper.map(n), newtonian, {speed, 0.0});
    REQUIRE(film.converged);
    error[k] = taper.per_length(film.load, n) / load - 1.0;
    drag_error[k] = taper.per_length(film.traction.x(), n) / drag - 1.0;
    CHECK(film.intake * (n + 1) * L / n == Approx(flow).epsilon(2e-3));
    CHECK(film.outflow == Approx(film.intake).epsilon(1e-10));
  }
  show(
      "linear slider: load off by {:.2e} {:.2e} {:.2e}, orders {:.2f} {:.2f}; drag off by {:.2e}, orders "
      "{:.2f} {:.2f}\n",
      error[0], error[1], error[2], orders(error[0], error[1]), orders(error[1], error[2]), drag_error[2],
      orders(drag_error[0], drag_error[1]), orders(drag_error[1], drag_error[2]));
  CHECK(std::abs(error[2]) < 1e-3);
  CHECK(orders(error[1], error[2]) > 1.9);
  CHECK(orders(drag_error[1], drag_error[2]) > 1.9);
  CHECK(std::abs(error[0]) > 4e-3 * std::abs(error[2]));
}

TEST_CASE("sliding the other way the same wedge breaks everywhere and carries nothing", "[film]") {
  const FilmPressure film = solve_reynolds(taper.map(32), newtonian, {-speed, 0.0});
  CHECK(film.converged);
  CHECK(film.load == 0.0);
  CHECK(film.ruptured_share == Approx(film.resin_share));
  const FilmPressure unbroken =
      solve_reynolds(taper.map(32), newtonian, {-speed, 0.0}, {.rupture = Rupture::never});
  CHECK(unbroken.load == Approx(-solve_reynolds(taper.map(32), newtonian, {speed, 0.0}).load).epsilon(1e-9));
}

TEST_CASE("a Rayleigh step is met to rounding", "[film]") {
  const double L = 4e-3, h1 = 37.3e-6, h2 = 20e-6, riser = 0.75;
  const Slider step{L, [&](double x) { return x < riser * L ? h1 : h2; }};
  const double peak = 6.0 * viscosity * speed * (h1 - h2) /
                      (std::pow(h1, 3) / (riser * L) + std::pow(h2, 3) / ((1.0 - riser) * L));
  const int n = 16;
  const FilmPressure film = solve_reynolds(step.map(n), newtonian, {speed, 0.0});
  CHECK(step.per_length(film.load, n) == Approx(0.5 * peak).epsilon(1e-10));
  CHECK(*std::max_element(film.pressure.begin(), film.pressure.end()) == Approx(peak).epsilon(1e-10));
  // A riser off the grid line is another bearing: the answer above is not an accident of the form.
  const Slider off{L, [&](double x) { return x < 0.6 * L ? h1 : h2; }};
  CHECK(std::abs(off.per_length(solve_reynolds(off.map(n), newtonian, {speed, 0.0}).load, n) / (0.5 * peak) -
                 1.0) > 1e-3);
}

namespace {

// h = c (1 + e cos t) over one turn, p = 0 where the gap is widest; angles from there.
struct CosineWedge {
  double e;
  double length = 4e-3, c = 20e-6;
  double h(double angle) const { return c * (1.0 + e * std::cos(angle)); }
  Slider slider() const {
    return {length, [this](double x) { return h(2.0 * pi * x / length); }};
  }
  double unit() const { return 6.0 * viscosity * speed * length / (2.0 * pi) / (c * c); }

  // Integrals over t from 0 to `end` of (h - h_end) / h^3, by midpoints fine enough for 1e-8: pressure at the
  // end of a film that breaks there (p' = 0), and by parts its integral.
  struct Sums {
    double pressure = 0.0, integral = 0.0;
  };
  Sums to(double end) const {
    const int n = 20000;
    const double step = end / n;
    Sums sums;
    for (int k = 0; k < n; ++k) {
      const double t = step * (k + 0.5), H = 1.0 + e * std::cos(t);
      const double slope = unit() * step * e * (std::cos(t) - std::cos(end)) / (H * H * H);
      sums.pressure += slope;
      sums.integral += (end - t) * slope;
    }
    return sums;
  }
  /// Where the film breaks: p = p' = 0 (Swift and Stieber).
  double break_angle() const {
    double low = pi, high = 1.999 * pi;
    for (int k = 0; k < 50; ++k) {
      const double middle = 0.5 * (low + high);
      (to(middle).pressure > 0.0 ? low : high) = middle;
    }
    return 0.5 * (low + high);
  }
  double load() const { return to(break_angle()).integral / (2.0 * pi); }
};

}  // namespace

TEST_CASE("an unbroken cosine wedge follows Sommerfeld's pressure, second order in the spacing", "[film]") {
  const CosineWedge wedge{0.6};
  double error[3];
  for (int k = 0; k < 3; ++k) {
    const int n = 32 << k;
    const FilmPressure film =
        solve_reynolds(wedge.slider().map(n), newtonian, {speed, 0.0}, {.rupture = Rupture::never});
    double worst = 0.0, peak = 0.0;
    for (int j = 0; j <= n; ++j) {
      const double t = 2.0 * pi * j / n, H = 1.0 + wedge.e * std::cos(t);
      const double exact =
          wedge.unit() * wedge.e * (1.0 + H) * std::sin(t) / ((2.0 + wedge.e * wedge.e) * H * H);
      worst = std::max(worst, std::abs(film.pressure[j] - exact));
      peak = std::max(peak, exact);
    }
    error[k] = worst / peak;
  }
  show("Sommerfeld: pressure off by {:.2e} {:.2e} {:.2e} of the peak, orders {:.2f} {:.2f}\n", error[0],
       error[1], error[2], orders(error[0], error[1]), orders(error[1], error[2]));
  CHECK(error[2] < 2e-3);
  CHECK(orders(error[1], error[2]) > 1.8);
}

TEST_CASE("a cosine wedge breaks where pressure and slope vanish together", "[film]") {
  const CosineWedge wedge{GENERATE(0.01, 0.6)};
  const double exact = wedge.break_angle(), load = wedge.load();
  if (wedge.e == 0.01)
    CHECK(exact == Approx(4.4934).margin(0.02));  // tan t = t for a shallow wedge: 257.45 deg
  double error[5], rate = 0.0;
  for (int k = 0; k < 5; ++k) {
    const int n = 32 << k;
    const FilmPressure film = solve_reynolds(wedge.slider().map(n), newtonian, {speed, 0.0});
    REQUIRE(film.converged);
    int last = 0;
    for (int j = 0; j < n; ++j)
      if (film.pressure[j] > 0.0) last = j;
    CHECK(2.0 * pi * last / n == Approx(exact).margin(2.5 * 2.0 * pi / n));
    error[k] = wedge.slider().per_length(film.load, n) / load - 1.0;
    rate -= 0.1 * (k - 2) * std::log2(std::abs(error[k]));  // slope of the least-squares line
    // Half-Sommerfeld (the unbroken film cut off at zero) carries less and lets no film beyond the throat.
    const FilmPressure unbroken =
        solve_reynolds(wedge.slider().map(n), newtonian, {speed, 0.0}, {.rupture = Rupture::never});
    double half = 0.0;
    for (const double p : unbroken.pressure)
      half += std::max(p, 0.0) / static_cast<double>(unbroken.pressure.size());
    CHECK(half < film.load);
    CHECK(last > n / 2);
  }
  show(
      "cosine wedge e = {}: breaks at {:.2f} deg; load off by {:.2e} {:.2e} {:.2e} {:.2e} {:.2e}, order "
      "{:.2f}\n",
      wedge.e, exact * 180 / pi, error[0], error[1], error[2], error[3], error[4], rate);
  CHECK(std::abs(error[4]) < 1e-4);
  CHECK(rate > 1.7);  // single steps scatter with where between two nodes the film breaks
}

TEST_CASE("a power-law film without a wedge is Couette flow", "[film]") {
  const double h = 70e-6;
  const Slider plain{4e-3, [&](double) { return h; }};
  const int n = 8;
  const FilmPressure film = solve_reynolds(plain.map(n, 3), thinning, {0.6 * speed, 0.8 * speed});
  const double stress = thinning.consistency * std::pow(speed / h, thinning.index);
  CHECK(film.load == Approx(0.0).margin(1e-9 * stress));
  CHECK(plain.per_length(film.traction.x(), n) == Approx(0.6 * stress).epsilon(1e-6));
  CHECK(plain.per_length(film.traction.y(), n) == Approx(0.8 * stress).epsilon(1e-6));
  CHECK(stress == Approx(54.3e3).epsilon(0.01));  // 51 kPa with n = 0.37 (literature, section 2.2)
}

TEST_CASE("a power-law film under pressure alone is plane Poiseuille flow", "[film]") {
  const double h = 50e-6, gradient = 3e8, n = thinning.index;
  const FilmFlow flow = film_flow(thinning, h, {0.0, 0.0}, {gradient, 0.0}, {0.0, 0.0});
  const double exact = 2.0 * n / (2.0 * n + 1.0) * std::pow(0.5 * h, 2.0 + 1.0 / n) *
                       std::pow(gradient / thinning.consistency, 1.0 / n);
  show("power-law Poiseuille: flux off by {:.1e}\n", flow.pressure_flux.x() / exact - 1.0);
  CHECK(flow.pressure_flux.x() == Approx(exact).epsilon(2e-4));  // eight points across a change of sign
  CHECK(flow.middle_stress.norm() < 1e-9 * gradient * h);
}

TEST_CASE("a sheared power-law film gives way to pressure n times as easily across as along", "[film]") {
  const double h = 30e-6, n = thinning.index;
  const Vector2d sliding(speed, 0.0);
  const FilmFlow flow = film_flow(thinning, h, sliding, {0.0, 0.0}, drag_stress(thinning, h, sliding));
  const double across = h * h * h / (12.0 * thinning.viscosity(speed / h));
  CHECK(flow.conductance(1, 1) == Approx(across).epsilon(1e-6));
  CHECK(flow.conductance(0, 0) == Approx(across / n).epsilon(1e-6));
  CHECK(std::abs(flow.conductance(0, 1)) < 1e-9 * across);
}

TEST_CASE("flux is the slope of the potential and conductance that of the flux", "[film][derivative]") {
  const FilmFluid fluid = GENERATE(newtonian, thinning);
  const double h = 30e-6;
  const Vector2d sliding(speed, 0.3 * speed), direction(0.8, 0.6);
  const double couette = drag_stress(fluid, h, sliding).norm() / h;
  const Vector2d gradient = couette * GENERATE(0.1, 3.0, 20.0) * Vector2d(0.9, -0.4);
  const auto at = [&](double x) {
    return film_flow(fluid, h, sliding, gradient + x * direction, drag_stress(fluid, h, sliding));
  };
  const auto potential = [&](double x) { return at(x).potential; };
  const auto flux = [&](double x) { return at(x).pressure_flux.dot(direction); };
  const double slope = flux(0.0), second = direction.dot(at(0.0).conductance * direction);
  const double scale = gradient.norm();
  CHECK(derivative_gap(potential, 0.0, scale, slope) < 1e-6);
  CHECK(derivative_gap(potential, 0.0, scale, 1.01 * slope) > 1e-4);
  CHECK(derivative_gap(flux, 0.0, scale, second) < 1e-6);
  CHECK(derivative_gap(flux, 0.0, scale, 1.01 * second) > 1e-4);
}

namespace {

// Plane power-law film by closed forms: the stress is T + s G, integrals of |t|^(1/n) sgn t and of its
// moment.
struct PlaneFilm {
  double n = thinning.index, m = thinning.consistency;
  double rate(double t) const { return std::copysign(std::pow(std::abs(t) / m, 1.0 / n), t); }
  double first(double t) const { return std::abs(t) * std::abs(rate(t)) / (1.0 / n + 1.0); }  // int rate
  double second(double t) const { return first(t) * t / (1.0 / n + 2.0); }                    // int first

  /// q at gap h, sliding U, gradient G.
  double flow(double h, double U, double G) const {
    const double couette = m * std::pow(U / h, n);
    if (std::abs(G) * h < 1e-9 * couette) return 0.5 * U * h;
    const auto excess = [&](double t) { return (first(t + 0.5 * h * G) - first(t - 0.5 * h * G)) / G - U; };
    const double most = couette + std::abs(G) * h;
    const double t = bracketed_root(-most, excess(-most), most, excess(most), 1e-13 * U, excess);
    const double top = t + 0.5 * h * G, bottom = t - 0.5 * h * G;
    // u(s) = [first(t + s G) - first(bottom)] / G, integrated over s.
    return (second(top) - second(bottom)) / (G * G) - h * first(bottom) / G;
  }
  /// G that lets q through.
  double gradient(double h, double U, double q) const {
    const double scale = 100.0 * m * std::pow(U / h, n) / h;
    const auto missing = [&](double G) { return q - flow(h, U, G); };  // flow falls with G
    return bracketed_root(-scale, missing(-scale), scale, missing(scale), 1e-12 * q, missing);
  }
  /// Mean pressure of a slider without rupture: the flow is the one that brings p back to zero.
  double load(const Slider& slider, int n_points) const {
    const auto run = [&](double q, double& mean) {
      double p = 0.0;
      mean = 0.0;
      for (int k = 0; k < n_points; ++k) {
        const double step =
            gradient(slider.gap((k + 0.5) * slider.length / n_points), speed, q) * slider.length / n_points;
        mean += (p + 0.5 * step) / n_points;
        p += step;
      }
      return p;
    };
    double mean = 0.0;
    const auto lost = [&](double q) { return -run(q, mean); };  // more flow, less pressure at the end
    const double least = 0.4 * speed * slider.gap(slider.length), most = 0.6 * speed * slider.gap(0.0);
    bracketed_root(least, lost(least), most, lost(most), 1e-7 * m, lost);
    return mean;
  }
};

}  // namespace

TEST_CASE("a power-law slider carries what plane films in a row carry", "[film]") {
  const double exact = PlaneFilm{}.load(taper, 100);
  double error[3];
  for (int k = 0; k < 3; ++k) {
    const int n = 16 << k;
    const FilmPressure film = solve_reynolds(taper.map(n), thinning, {speed, 0.0});
    REQUIRE(film.converged);
    error[k] = taper.per_length(film.load, n) / exact - 1.0;
  }
  show("power-law slider: {:.4g} Pa, off by {:.2e} {:.2e} {:.2e}, orders {:.2f} {:.2f}\n", exact, error[0],
       error[1], error[2], orders(error[0], error[1]), orders(error[1], error[2]));
  CHECK(std::abs(error[2]) < 1e-3);
  CHECK(orders(error[0], error[1]) > 1.8);
}

namespace {

// One crown h = h0 + x^2/2R + y^2/2R' in the middle of a parallelogram wide enough to leave it alone.
struct Crown {
  double h0, R, R2;
  double shear = 0.0;
  FilmMap map(int n) const {
    const double half = 12.0 * std::sqrt(2.0 * R * h0);
    const Vector2d first(2 * half, 0.0), second(2 * half * std::sin(shear), 2 * half * std::cos(shear));
    return film_map(
        n, n, first, second,
        [&, first, second](double a, double b) {
          const Vector2d x = (a - 0.5) * first + (b - 0.5) * second;
          return h0 + x.x() * x.x() / (2 * R) + x.y() * x.y() / (2 * R2);
        },
        [n](int i, int j) { return i > 0 && j > 0 && i < n && j < n; });
  }
  /// p = -6 eta U x / ((3 + 2 R/R') h^2) (Kapitza 1955: exact for the unbroken film of an endless crown).
  double exact(const Vector2d& x) const {
    const double h = h0 + x.x() * x.x() / (2 * R) + x.y() * x.y() / (2 * R2);
    return -6.0 * viscosity * speed / (3.0 + 2.0 * R / R2) * x.x() / (h * h);
  }
};

}  // namespace

TEST_CASE("a crown follows Kapitza's pressure on square and sheared grids", "[film]") {
  const double shear = GENERATE(0.0, pi / 6), R2 = GENERATE(7.7e-3, 3e-3);
  const Crown crown{20e-6, 7.36e-3, R2, shear};
  const double reach = std::sqrt(2.0 * crown.R * crown.h0);
  double error[2];
  for (int k = 0; k < 2; ++k) {
    const int n = 64 << k;
    const FilmMap map = crown.map(n);
    const FilmPressure film = solve_reynolds(map, newtonian, {speed, 0.0}, {.rupture = Rupture::never});
    REQUIRE(film.converged);
    double worst = 0.0, peak = 0.0;
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) {
        const Vector2d x =
            (static_cast<double>(j) / n - 0.5) * map.first + (static_cast<double>(i) / n - 0.5) * map.second;
        if (x.norm() > 2.0 * reach) continue;
        worst = std::max(worst, std::abs(film.pressure[i * n + j] - crown.exact(x)));
        peak = std::max(peak, crown.exact(x));
      }
    error[k] = worst / peak;
  }
  show(
      "Kapitza, R'/R = {:.2f}, sheared {:.0f} deg: pressure off by {:.2e} {:.2e} of the peak, order {:.2f}\n",
      R2 / crown.R, shear * 180 / pi, error[0], error[1], orders(error[0], error[1]));
  CHECK(error[1] < 0.02);  // 0.2 % of it is the edge of the area, which cuts off the tail of p ~ 1/r^3
  CHECK(orders(error[0], error[1]) > 1.7);
}

TEST_CASE("all work of the tool turns to heat in the film, broken or not", "[film]") {
  const FilmFluid fluid = GENERATE(newtonian, thinning);
  const Crown crown{10e-6, 7.36e-3, 7.7e-3, 0.3};
  const Vector2d sliding(speed * std::cos(0.4), speed * std::sin(0.4));
  const FilmPressure film = solve_reynolds(crown.map(64), fluid, sliding);
  REQUIRE(film.converged);
  CHECK(film.residual <= 1e-8);
  CHECK(film.ruptured_share > 0.3);
  CHECK(film.dissipation == Approx(film.traction.dot(sliding)).epsilon(1e-7));
  CHECK(film.intake + film.voids == Approx(film.outflow).epsilon(1e-10));
  CHECK(film.intake > 0.0);
  CHECK(film.voids > 0.0);
  CHECK(*std::min_element(film.pressure.begin(), film.pressure.end()) == 0.0);
  // Half-Sommerfeld is no solution: cut off, the unbroken film does not conserve mass where it ends.
  FilmPressure cut = solve_reynolds(crown.map(64), fluid, sliding, {.rupture = Rupture::never});
  for (double& p : cut.pressure) p = std::max(p, 0.0);
  const FilmPressure judged = solve_reynolds(crown.map(64), fluid, sliding, {.iterations = 0}, cut.pressure);
  CHECK_FALSE(judged.converged);
  CHECK(judged.residual > 1e-3);
  CHECK_FALSE(judged.reason.empty());
}

TEST_CASE("the answer does not depend on where the search starts", "[film]") {
  const Crown crown{10e-6, 7.36e-3, 7.7e-3};
  const FilmMap map = crown.map(48);
  const FilmPressure one = solve_reynolds(map, thinning, {speed, 0.0});
  const FilmPressure other =
      solve_reynolds(map, thinning, {speed, 0.0}, {}, std::vector<double>(map.wet.size(), 1e5));
  REQUIRE(one.converged);
  REQUIRE(other.converged);
  CHECK(other.load == Approx(one.load).epsilon(1e-7));
  CHECK(other.traction.x() == Approx(one.traction.x()).epsilon(1e-9));
}

TEST_CASE("pressure scales with eta U, and with U^n in a power-law film", "[film]") {
  const FilmFluid fluid = GENERATE(newtonian, thinning);
  const FilmMap map = Crown{10e-6, 7.36e-3, 7.7e-3}.map(32);
  const double ratio =
      solve_reynolds(map, fluid, {2.5 * speed, 0.0}).load / solve_reynolds(map, fluid, {speed, 0.0}).load;
  CHECK(ratio == Approx(std::pow(2.5, fluid.index)).epsilon(1e-6));
}

TEST_CASE("a closed film is refused: nothing fixes the level of its pressure", "[film]") {
  FilmMap map = Crown{10e-6, 7.36e-3, 7.7e-3}.map(16);
  std::fill(map.wet.begin(), map.wet.end(), uint8_t{1});
  try {
    solve_reynolds(map, newtonian, {speed, 0.0});
    FAIL("accepted");
  } catch (const InputError& error) {
    CHECK(error.problems().front().id == "film.fill.closed");
  }
}
