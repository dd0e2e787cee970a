// Conduction through tool, film and ply against answers known in closed form (Carslaw & Jaeger 1959).
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <numeric>
#include <vector>

#include "friction/film/conduction.h"
#include "tests/friction/heated_film.h"

using namespace heddle::friction;
using heddle::test::HeatedFilm;

namespace {

constexpr double pi = std::numbers::pi;
const Material steel{30.0, 3.74e6}, melt{0.19, 1.98e6};

std::vector<double> middles(const ConductionGrid& grid) {
  std::vector<double> x;
  double left = 0.0;
  for (const double width : grid.width) {
    x.push_back(left + 0.5 * width);
    left += width;
  }
  return x;
}

double largest_gap(const std::vector<double>& a, const std::vector<double>& b) {
  double gap = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) gap = std::max(gap, std::abs(a[i] - b[i]));
  return gap;
}

/// A sine between two ends held at 0, over a tenth of its decay time, in cells and steps of one size.
double error_of_sine(int cells, int steps) {
  const Material unit{1.0, 1.0};
  ConductionGrid grid;
  append_layer(grid, unit, even_widths(1.0, cells));
  std::vector<double> temperature, exact;
  const double time = 0.1;
  for (const double x : middles(grid)) {
    temperature.push_back(std::sin(pi * x));
    exact.push_back(std::sin(pi * x) * std::exp(-pi * pi * time));
  }
  for (int k = 0; k < steps; ++k) conduct(grid, {.left = 0.0, .right = 0.0}, {}, time / steps, temperature);
  return largest_gap(temperature, exact);
}

}  // namespace

TEST_CASE("two half-spaces brought together meet at the temperature their effusivities ask for",
          "[friction][conduction][analytic]") {
  const double time = 0.05, hot = 453.15, cold = 358.15;
  const auto depth = [&](const Material& m) { return 8.0 * std::sqrt(m.diffusivity() * time); };
  const double first = 1e-3;
  std::vector<double> in_tool =
      growing_widths(depth(steel), first * std::sqrt(steel.diffusivity() * time), 1.05);
  std::reverse(in_tool.begin(), in_tool.end());
  ConductionGrid grid;
  append_layer(grid, steel, in_tool);
  append_layer(grid, melt, growing_widths(depth(melt), first * std::sqrt(melt.diffusivity() * time), 1.05));
  const std::size_t n = in_tool.size();
  std::vector<double> temperature(grid.size(), hot);
  std::fill_n(temperature.begin(), n, cold);
  // Steps of 5 % of the time gone by, from a ten-thousandth on.
  double now = 0.0;
  for (double end = 1e-4 * time; now < time; end = std::min(1.05 * end, time)) {
    conduct(grid, {}, {}, end - now, temperature);
    now = end;
  }
  const double e1 = steel.effusivity(), e2 = melt.effusivity();
  const double interface = (e1 * cold + e2 * hot) / (e1 + e2);
  const double flow = flow_to_next(grid, temperature, n - 1);
  const double found = temperature[n] + flow * 0.5 * grid.width[n] / grid.conductivity[n];
  CHECK(found == Approx(interface).margin(1e-3 * (hot - cold)));
  // Profiles: error functions on either side.
  const std::vector<double> x = middles(grid);
  const double face = std::accumulate(in_tool.begin(), in_tool.end(), 0.0);
  std::vector<double> exact;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const Material& m = i < n ? steel : melt;
    const double y = std::abs(x[i] - face) / (2.0 * std::sqrt(m.diffusivity() * time));
    exact.push_back(interface + ((i < n ? cold : hot) - interface) * std::erf(y));
  }
  CHECK(largest_gap(temperature, exact) < 5e-4 * (hot - cold));
  CHECK(largest_gap(temperature, exact) > 1e-9);  // finite volumes, not the formula
}

TEST_CASE("a slab between two held temperatures follows its Fourier series",
          "[friction][conduction][analytic]") {
  const double h = 0.07e-3;
  ConductionGrid grid;
  append_layer(grid, melt, even_widths(h, 100));
  std::vector<double> temperature(100, 0.0);
  const double settling = h * h / melt.diffusivity();
  double now = 0.0;
  for (const double share : {0.01, 0.05, 0.2, 1.0}) {
    const int steps = 400;
    const double step = (share * settling - now) / steps;
    for (int k = 0; k < steps; ++k) conduct(grid, {.left = 1.0, .right = 0.0}, {}, step, temperature);
    now = share * settling;
    std::vector<double> exact;
    for (const double x : middles(grid)) {
      double sum = 1.0 - x / h;
      for (int m = 1; m < 200; ++m)
        sum -= 2.0 / (m * pi) * std::sin(m * pi * x / h) * std::exp(-m * m * pi * pi * share);
      exact.push_back(sum);
    }
    CAPTURE(share);
    CHECK(largest_gap(temperature, exact) < 5e-4);
  }
  // Settled: a straight line, and the flow k/h.
  CHECK(flow_through_left(grid, {.left = 1.0}, temperature) == Approx(melt.conductivity / h).epsilon(1e-3));
}

TEST_CASE("the error of conduction falls with the square of cell width and of time step",
          "[friction][conduction][convergence]") {
  // Each refined alone, far below the error of the other.
  const double space = std::log2(error_of_sine(10, 4000) / error_of_sine(20, 4000));
  const double space2 = std::log2(error_of_sine(20, 4000) / error_of_sine(40, 4000));
  const auto in_time = [](int steps) {
    return std::abs(error_of_sine(800, steps) - error_of_sine(800, 4000));
  };
  const double time = std::log2(in_time(4) / in_time(8)), time2 = std::log2(in_time(8) / in_time(16));
  CAPTURE(space, space2, time, time2);
  CHECK(space == Approx(2.0).margin(0.1));
  CHECK(space2 == Approx(2.0).margin(0.05));
  CHECK(time == Approx(2.0).margin(0.15));
  CHECK(time2 == Approx(2.0).margin(0.1));
}

TEST_CASE("no heat is lost between tool, film and ply, and a source adds what it gives",
          "[friction][conduction][invariant]") {
  ConductionGrid grid;
  append_layer(grid, steel, growing_widths(1e-3, 1e-6, 1.2));
  const std::size_t first = grid.size();
  append_layer(grid, melt, widths_from_both_faces(0.07e-3, 1e-7, 1.2), 5e-4);
  const std::size_t count = grid.size() - first;
  append_layer(grid, {0.35, 2.37e6}, even_widths(0.5e-3, 30));
  std::vector<double> temperature(grid.size(), 80.0), source(grid.size(), 0.0);
  std::fill_n(temperature.begin(), first, 0.0);
  const double before = heat_in(grid, temperature, 0, grid.size());
  for (int k = 0; k < 50; ++k) conduct(grid, {}, {}, 2e-3, temperature);
  CHECK(heat_in(grid, temperature, 0, grid.size()) == Approx(before).epsilon(1e-12));
  CHECK(heat_in(grid, temperature, 0, first) > 0.1 * before * 0.07e-3);  // and some has moved
  std::fill_n(source.begin() + static_cast<std::ptrdiff_t>(first), count, 1e7);
  for (int k = 0; k < 50; ++k) conduct(grid, {}, source, 2e-3, temperature);
  CHECK(heat_in(grid, temperature, 0, grid.size()) - before == Approx(1e7 * 0.07e-3 * 0.1).epsilon(1e-9));
}

TEST_CASE("a film that conducts well warms through a resistance as a lump",
          "[friction][conduction][analytic]") {
  const double h = 0.07e-3, resistance = 1e-3;
  ConductionGrid grid;
  const Material copper{400.0, 3.4e6};
  append_layer(grid, {1e6, 1e12}, even_widths(1e-3, 2));  // a tool that keeps its temperature
  append_layer(grid, copper, even_widths(h, 4), resistance);
  std::vector<double> temperature(grid.size(), 0.0);
  std::fill_n(temperature.begin(), 2, 1.0);
  const double time = resistance * copper.heat_capacity * h;
  for (int k = 0; k < 200; ++k) conduct(grid, {}, {}, time / 200, temperature);
  CHECK(temperature.back() == Approx(1.0 - std::exp(-1.0)).epsilon(1e-3));
}

TEST_CASE("a sheared film between held walls settles at the temperature and stress of Nahme",
          "[friction][conduction][analytic]") {
  const double h = 0.07e-3, beta = 0.025, cold = 200.0;
  for (const double na : {0.1, 2.0, 20.0}) {
    HeatedFilm film{.ends = {.left = 0.0, .right = 0.0}, .count = 80, .index = 1.0};
    append_layer(film.grid, melt, even_widths(h, 80));
    film.consistency = [=](double t) { return cold * std::exp(-beta * t); };
    film.speed = std::sqrt(na * melt.conductivity / (beta * cold));
    film.temperature.assign(80, 0.0);
    for (int k = 0; k < 4000; ++k) film.step(5e-4 * h * h / melt.diffusivity());
    const double x = na / 8.0, hottest = *std::max_element(film.temperature.begin(), film.temperature.end());
    CAPTURE(na);
    CHECK(beta * hottest == Approx(std::log1p(x)).epsilon(1e-3));
    CHECK(film.stress() / (cold * film.speed / h) ==
          Approx(std::asinh(std::sqrt(x)) / std::sqrt(x * (1.0 + x))).epsilon(5e-4));
    // What is dissipated leaves through the walls.
    const double leaving = -flow_through_left(film.grid, film.ends, film.temperature) -
                           flow_through_right(film.grid, film.ends, film.temperature);
    CHECK(leaving == Approx(film.stress() * film.speed).epsilon(1e-4));
  }
}
