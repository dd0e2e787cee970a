#include <catch2/catch.hpp>
#include <cmath>

#include "friction/hersey.h"
#include "friction/power_law_film.h"
#include "tests/derivative_check.h"

using namespace heddle::friction;
using heddle::test::derivative_gap;

TEST_CASE("film viscosity slope in rate agrees with central differences", "[friction][derivative]") {
  const double n = GENERATE(0.3, 0.7, 1.0);
  const double g = GENERATE(-240.0, 0.0, 1e-3, 1.0, 240.0);  // both sides of the floor
  const PowerLawFilm film{.consistency = 4.0e3, .index = n, .rate_floor = 1.0};
  CAPTURE(n, g);

  const auto eta = [&](double x) { return film.evaluate(x, 450.0).viscosity; };
  const double scale = std::max(std::abs(g), film.rate_floor);
  const double slope = film.evaluate(g, 450.0).dviscosity_drate;

  CHECK(derivative_gap(eta, g, scale, slope) < 1e-7);
  const double wrong = 1.01 * slope + 1e-3 * eta(g) / scale;
  CHECK(derivative_gap(eta, g, scale, wrong) > 1e-4);  // the check can fail
}

TEST_CASE("film viscosity slope in temperature agrees with central differences", "[friction][derivative]") {
  const double temperature = GENERATE(294.15, 358.15, 453.15, 473.15);
  const PowerLawFilm film;
  CAPTURE(temperature);

  const auto eta = [&](double t) { return film.evaluate(238.0, t).viscosity; };
  const double slope = film.evaluate(238.0, temperature).dviscosity_dtemperature;

  CHECK(derivative_gap(eta, temperature, 100.0, slope) < 1e-7);
  CHECK(derivative_gap(eta, temperature, 100.0, 1.01 * slope) > 1e-4);
}

TEST_CASE("film viscosity is the bare power law at high rate", "[friction][analytic]") {
  const PowerLawFilm film;
  const double g = 1e6;
  const double bare = film.consistency * std::pow(g, film.index - 1.0);
  CHECK(film.evaluate(g, film.reference_temperature).viscosity == Approx(bare).epsilon(1e-11));
}

TEST_CASE("film viscosity is finite, greatest and flat at rest", "[friction][analytic]") {
  const PowerLawFilm film;
  const auto rest = film.evaluate(0.0, film.reference_temperature);
  CHECK(rest.viscosity == film.consistency);  // m g0^(n-1) with g0 = 1 1/s
  CHECK(rest.dviscosity_drate == 0.0);
  CHECK(film.evaluate(0.5, film.reference_temperature).viscosity < rest.viscosity);
}

TEST_CASE("film viscosity does not depend on the direction of shear", "[friction][invariant]") {
  const PowerLawFilm film;
  CHECK(film.evaluate(-37.0, 440.0).viscosity == film.evaluate(37.0, 440.0).viscosity);
  CHECK(film.evaluate(-37.0, 440.0).dviscosity_drate == -film.evaluate(37.0, 440.0).dviscosity_drate);
}

TEST_CASE("film viscosity with index one is Newtonian", "[friction][analytic]") {
  const PowerLawFilm film{.consistency = 300.0, .index = 1.0};
  CHECK(film.evaluate(0.0, film.reference_temperature).viscosity == 300.0);
  CHECK(film.evaluate(1e4, film.reference_temperature).viscosity == 300.0);
}

TEST_CASE("film consistency follows Arrhenius between two temperatures", "[friction][analytic]") {
  const PowerLawFilm film;
  const double cold = film.consistency_at(433.15), hot = film.consistency_at(473.15);
  const double energy = std::log(cold / hot) * 8.31446261815324 / (1.0 / 433.15 - 1.0 / 473.15);
  CHECK(energy == Approx(film.activation_energy).epsilon(1e-12));
  CHECK(film.consistency_at(film.reference_temperature) == film.consistency);
}

TEST_CASE("shear rate of the film is speed over thickness", "[friction][paper]") {
  // Eq. 5 with h = 0.07 mm: 16.67 mm/s gives 238 1/s.
  CHECK(PowerLawFilm{}.shear_rate(16.67e-3) == Approx(238.14).epsilon(1e-4));
}

TEST_CASE("Hersey number is viscosity times speed over pressure and film thickness", "[friction][paper]") {
  const PowerLawFilm film;
  const Context context{.slip_speed = 16.67e-3, .pressure = 150e3};
  const HerseyNumber hersey = hersey_number(film, context);
  // Eq. 6 with p h in place of N. The floors move it by (g0/g)^2 n/2, here 3.4e-6.
  const double bare =
      film.consistency * std::pow(16.67e-3 / 0.07e-3, 0.38 - 1.0) * 16.67e-3 / (150e3 * 0.07e-3);
  CHECK(hersey.value == Approx(bare).epsilon(5e-6));
  CHECK(hersey.value != Approx(bare).epsilon(1e-6));  // the comparison is fine enough to see the floor
}

TEST_CASE("Hersey number on the real contact area is the area fraction times the nominal one",
          "[friction][analytic]") {
  const PowerLawFilm film;
  Context context{.slip_speed = 0.03, .pressure = 2e4};
  const double nominal = hersey_number(film, context).value;
  context.area_fraction = 0.25;  // a power of two: exact
  CHECK(hersey_number(film, context).value == 0.25 * nominal);
}

TEST_CASE("Hersey number stays positive with finite slopes at rest and without load", "[friction][bound]") {
  const PowerLawFilm film;
  const double speed = GENERATE(0.0, 1e-9, 0.1);
  const double pressure = GENERATE(0.0, 1e-9, 1e5);
  const HerseyNumber hersey = hersey_number(film, {.slip_speed = speed, .pressure = pressure});
  CAPTURE(speed, pressure);
  CHECK(hersey.value > 0.0);
  CHECK(std::isfinite(hersey.value));
  CHECK(std::isfinite(hersey.dlog_dspeed));
  CHECK(std::isfinite(hersey.dlog_dpressure));
}

TEST_CASE("logarithmic slopes of the Hersey number agree with central differences",
          "[friction][derivative]") {
  const PowerLawFilm film;
  const double speed = GENERATE(0.0, 5e-5, 1e-3, 0.2);
  const double pressure = GENERATE(0.0, 0.5, 5e3, 3e5);
  const double a = 0.7;  // phi = 0.1 (p_f / 1e5)^a, looked up at the floored pressure
  const auto at = [&](double u, double p, double t) {
    const FlooredPressure pf = floored(p);
    const double phi = 0.1 * std::pow(pf.value / 1e5, a);
    return hersey_number(film, {.slip_speed = u,
                                .pressure = p,
                                .fabric_temperature = t,
                                .area_fraction = phi,
                                .area_slope = a * phi / pf.value * pf.slope});
  };
  const HerseyNumber here = at(speed, pressure, 450.0);
  CAPTURE(speed, pressure);

  const auto in_speed = [&](double u) { return std::log(at(u, pressure, 450.0).value); };
  const auto in_pressure = [&](double p) { return std::log(at(speed, p, 450.0).value); };
  const auto in_temperature = [&](double t) { return std::log(at(speed, pressure, t).value); };
  const double speed_scale = std::max(speed, 7e-5), pressure_scale = std::max(pressure, 1.0);

  CHECK(derivative_gap(in_speed, speed, speed_scale, here.dlog_dspeed) < 1e-6);
  CHECK(derivative_gap(in_pressure, pressure, pressure_scale, here.dlog_dpressure) < 1e-6);
  CHECK(derivative_gap(in_temperature, 450.0, 100.0, here.dlog_dfabric_temperature) < 1e-6);

  CHECK(derivative_gap(in_speed, speed, speed_scale, 1.01 * here.dlog_dspeed + 1e-3 / speed_scale) > 1e-4);
  CHECK(derivative_gap(in_pressure, pressure, pressure_scale,
                       1.01 * here.dlog_dpressure + 1e-3 / pressure_scale) > 1e-4);
  CHECK(derivative_gap(in_temperature, 450.0, 100.0, 1.01 * here.dlog_dfabric_temperature) > 1e-4);
}
