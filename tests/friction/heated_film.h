#pragma once

#include <cmath>
#include <functional>
#include <vector>

#include "friction/film/conduction.h"

namespace heddle::test {

/// A film of a power-law fluid, tau = m(T) g^n, sheared between its two faces at speed U while heat flows
/// through it and its surroundings: the stress is the same all through the film, the rate is not, and what is
/// dissipated heats the place where it is dissipated. The whole problem, against which reduced models are
/// measured.
struct HeatedFilm {
  friction::ConductionGrid grid = {};
  friction::ConductionEnds ends = {};
  std::size_t first = 0, count = 0;                            ///< cells of the film
  std::function<double(double temperature)> consistency = {};  ///< m(T) [Pa s^n]
  double index = 1.0;                                          ///< n
  double speed = 0.0;                                          ///< U [m/s]
  std::vector<double> temperature = {};                        ///< of every cell [K]

  /// tau [Pa]: U = Int (tau/m)^(1/n) dy.
  double stress() const {
    double slip = 0.0;
    for (std::size_t i = first; i < first + count; ++i)
      slip += grid.width[i] * std::pow(consistency(temperature[i]), -1.0 / index);
    return std::pow(speed / slip, index);
  }

  /// One time step, the dissipation taken at its start.
  void step(double time_step) {
    const double tau = stress();
    std::vector<double> source(grid.size(), 0.0);
    for (std::size_t i = first; i < first + count; ++i)
      source[i] = tau * std::pow(tau / consistency(temperature[i]), 1.0 / index);
    friction::conduct(grid, ends, source, time_step, temperature);
  }
};

}  // namespace heddle::test
