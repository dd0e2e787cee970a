// What a film costs: the pressure under one repeat of Table 1 at touch, on 32 to 256 samples, from coarse to
// fine as a study solves it.
//
//     benchmark_film
//
// CPU seconds and wall seconds, the better of three; two cores. Prints, judges nothing.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <ctime>

#include "mesoscale/film.h"

using namespace heddle::mesoscale;

int main() {
  const FabricGeometry fabric = fabric_geometry(WeaveSpec{}, CellState::as_woven);
  fmt::print("samples  resin  iterations on the finest grid  CPU s  wall s  load_Pa\n");
  for (const int samples : {32, 64, 128, 256}) {
    FilmSpec spec;
    spec.samples = samples;
    const FilmBearing bearing(fabric, {3.2e6, 5.0}, 0.0, spec);
    double cpu = 1e300, wall = 1e300;
    FilmPressure film;
    for (int repeat = 0; repeat < 3; ++repeat) {
      const auto start = std::chrono::steady_clock::now();
      const std::clock_t ticks = std::clock();
      film = bearing.film(0.0, {16.67e-3, 0.0});
      cpu = std::min(cpu, static_cast<double>(std::clock() - ticks) / CLOCKS_PER_SEC);
      wall = std::min(wall, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
    }
    fmt::print("{:>7} {:>6.3f} {:>10} {:>26.2f} {:>7.2f} {:>9.0f}{}\n", samples, film.resin_share,
               film.iterations, cpu, wall, film.load,
               film.converged ? "" : "  not converged: " + film.reason);
  }
}
