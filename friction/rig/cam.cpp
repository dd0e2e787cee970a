#include "friction/rig/cam.h"

#include <cmath>

namespace heddle::friction {

GapState closed_gap(double pressure, double film_thickness) {
  return {.pressure = pressure, .film_thickness = film_thickness, .tow_flattening = 0.0};
}

namespace {

struct Rates {
  double film, tows;  ///< dh/dt, dc/dt [m/s]
};

Rates rates(const CamGap& cam, const GapState& start, const GapState& now) {
  const double h = now.film_thickness, h0 = start.film_thickness;
  const double share = cam.tow_relaxation / (1.0 - cam.tow_relaxation);
  // Under a held gap c ends at r p0/K, and the rate towards it is (1 + K C)/tau_c = 1/relaxation_time.
  const double creep_time = cam.relaxation_time * (1.0 + share);
  return {.film = -0.5 * cam.squeeze_rate * now.pressure * h * h * h / (h0 * h0),
          .tows = (share / cam.stack_stiffness * now.pressure - now.tow_flattening) / creep_time};
}

GapState moved(const CamGap& cam, const GapState& start, const GapState& from, const Rates& rate,
               double time_step) {
  GapState to;
  to.film_thickness = from.film_thickness + time_step * rate.film;
  to.tow_flattening = from.tow_flattening + time_step * rate.tows;
  const double lost = 2.0 * (start.film_thickness - to.film_thickness) + to.tow_flattening;
  to.pressure = std::fmax(0.0, start.pressure - cam.stack_stiffness * lost);
  return to;
}

}  // namespace

GapState relax(const CamGap& cam, const GapState& start, const GapState& now, double time_step) {
  const Rates first = rates(cam, start, now);
  const Rates second = rates(cam, start, moved(cam, start, now, first, time_step));
  return moved(cam, start, now,
               {.film = 0.5 * (first.film + second.film), .tows = 0.5 * (first.tows + second.tows)},
               time_step);
}

}  // namespace heddle::friction
