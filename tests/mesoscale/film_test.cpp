// Film and touched tows together: load balance, direction of sliding, pressure exponent of the touched area.
// Tests that print tables: ./heddle test -R 'NAME' -V (with -L slow where they are slow).
#include "mesoscale/film.h"
#include "mesoscale/film_direction.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "core/problem.h"
#include "mesoscale/quadrature.h"
#include "table1.h"

using namespace heddle;
using namespace heddle::mesoscale;
using Eigen::Vector2d;
using heddle::test::degrees;
using heddle::test::radians;
using heddle::test::table1;

namespace {

const CompactionLaw law{3.2e6, 5.0};
constexpr double speed = 16.67e-3;

FilmBearing bearing(double shear_deg, int samples, double fill = FilmSpec{}.fill) {
  FilmSpec spec;
  spec.samples = samples;
  spec.fill = fill;
  return FilmBearing(table1(), law, radians(shear_deg), spec);
}

std::vector<double> directions(double step_deg) {
  std::vector<double> angles;
  for (double angle = 0.0; angle <= 90.0; angle += step_deg) angles.push_back(radians(angle));
  return angles;
}

// Slope of ln f in ln x.
template <class Function>
double log_slope(const Function& f, double x) {
  return std::log(f(1.01 * x) / f(x / 1.01)) / (2.0 * std::log(1.01));
}

}  // namespace

TEST_CASE("resin of Table 1 spread evenly takes 23.3 percent of the room beside the glass", "[film]") {
  CHECK(even_fill(table1()) == Approx(0.207 / (1.0 - 0.110)).margin(0.002));
  CHECK(even_fill(table1()) == Approx(FilmSpec{}.fill).margin(5e-4));
  const double consolidated = even_fill(fabric_geometry(WeaveSpec{}, CellState::consolidated));
  CHECK(consolidated == Approx(1.0).epsilon(1e-9));  // no air is left
}

TEST_CASE("resin takes its share of the gap's volume, narrowest places first", "[film]") {
  const double fill = GENERATE(0.1, 0.233, 0.6), approach = GENERATE(-50e-6, 0.0, 100e-6);
  const FaceDepth face = face_depth(unit_cell(table1(), radians(10.0)), 64);
  const FilmMap map = film_map(unit_cell(table1(), radians(10.0)), face, approach, 9.25e-6, fill);
  double volume = 0.0, filled = 0.0, widest_wet = 0.0, narrowest_dry = 1.0;
  for (std::size_t e = 0; e < map.gap.size(); ++e)
    for (std::size_t g = 0; g < 4; ++g) {
      const double gap = map.gap[e][g];
      CHECK(gap >= 9.25e-6);
      if (!face.covered[e][g]) continue;
      volume += gap;
      if (map.resin[e][g]) {
        filled += gap;
        widest_wet = std::max(widest_wet, gap);
      } else {
        narrowest_dry = std::min(narrowest_dry, gap);
      }
    }
  CHECK(filled / volume == Approx(fill).margin(0.01));
  CHECK(widest_wet < narrowest_dry);
}

TEST_CASE("under a light load the film carries all, under a heavy one the tows carry the rest", "[film]") {
  const FilmBearing film = bearing(0.0, 32);
  const FilmState light = film.state(20e3, speed, 0.0);
  REQUIRE(light.converged);
  CHECK(light.film_carries());
  CHECK(light.film_load == Approx(20e3).epsilon(1e-3));
  CHECK(light.touched_fraction == 0.0);
  CHECK(light.least_gap > 9.25e-6);

  const FilmState heavy = film.state(1e6, speed, 0.0);
  REQUIRE(heavy.converged);
  CHECK_FALSE(heavy.film_carries());
  CHECK(heavy.pressure() == Approx(1e6).epsilon(1e-3));
  CHECK(heavy.solid_load > 0.3e6);
  CHECK(heavy.least_gap == 9.25e-6);
  CHECK(heavy.solid_load == Approx(film.plate().pressure(heavy.approach)).epsilon(1e-9));
  CHECK(heavy.along ==
        Approx(heavy.film_traction.x() + FilmSpec{}.boundary_friction * heavy.solid_load).epsilon(1e-12));
}

TEST_CASE("a slow tool finds no film and is carried by the tows", "[film]") {
  // Pressure goes with U^n: at 1e-9 of the speed 0.04 % of it is left.
  const FilmBearing film = bearing(0.0, 32);
  const FilmState still = film.state(5e3, 1e-9 * speed, 0.0);
  REQUIRE(still.converged);
  CHECK(still.solid_load > 0.95 * 5e3);
  CHECK(still.friction() < 0.25);
  CHECK(still.approach == Approx(film.plate().depth_at(5e3)).epsilon(0.02));
}

TEST_CASE("a nearly empty gap carries less than a fuller one, at every gap", "[film]") {
  const double approach = GENERATE(-50e-6, 0.0, 20e-6);
  const double lean = bearing(0.0, 32, 0.02).film(approach, {speed, 0.0}).load;
  const double even = bearing(0.0, 32).film(approach, {speed, 0.0}).load;
  const double rich = bearing(0.0, 32, 0.6).film(approach, {speed, 0.0}).load;
  CHECK(lean < 0.9 * even);
  CHECK(even < rich);
}

TEST_CASE("film of the cell: load, drag and complementarity on grids of 32, 64, 128 samples", "[film]") {
  const double shear = GENERATE(0.0, 30.0);
  double load[3], drag[3];
  for (int k = 0; k < 3; ++k) {
    const FilmPressure film = bearing(shear, 32 << k).film(0.0, {speed, 0.0});
    REQUIRE(film.converged);
    CHECK(film.residual <= 1e-8);
    CHECK(film.intake + film.voids == Approx(film.outflow).epsilon(1e-9));
    load[k] = film.load;
    drag[k] = film.traction.x();
  }
  fmt::print("film at touch, sheared {} deg: load {:.0f} {:.0f} {:.0f} Pa, drag {:.0f} {:.0f} {:.0f} Pa\n",
             shear, load[0], load[1], load[2], drag[0], drag[1], drag[2]);
  CHECK(load[1] == Approx(load[2]).epsilon(0.02));
  CHECK(drag[1] == Approx(drag[2]).epsilon(0.01));
}

TEST_CASE("sliding by 90 degrees more feels the same in a balanced weave that is not sheared", "[film]") {
  const double angle = radians(GENERATE(0.0, 20.0, 40.0));
  const auto film = [&](double shear, double direction) {
    return bearing(shear, 32).film(5e-6, speed * Vector2d(std::cos(direction), std::sin(direction)));
  };
  const FilmPressure one = film(0.0, angle), other = film(0.0, angle + radians(90.0));
  CHECK(other.load == Approx(one.load).epsilon(1e-6));
  CHECK(other.traction.x() == Approx(-one.traction.y()).margin(1e-6 * one.traction.norm()));
  CHECK(other.traction.y() == Approx(one.traction.x()).margin(1e-6 * one.traction.norm()));
  // Sheared, the symmetry is lost, and only the mirror about the trellis diagonals is left.
  const double shear = 20.0, mirrored = radians(90.0 - shear) - angle;
  CHECK(film(shear, mirrored).load == Approx(film(shear, angle).load).epsilon(1e-5));
  if (angle == 0.0) CHECK(std::abs(film(shear, radians(90.0)).load / film(shear, 0.0).load - 1.0) > 0.01);
}

TEST_CASE("direction of sliding changes friction by less than 2 percent, unless the fabric is sheared",
          "[film][paper][long]") {
  // The paper saw no effect of orientation. At 0 shear it follows from the weave; at 30 degrees it would not.
  // A quarter turn is symmetric (above), and so is the mirror: 0 to 45 degrees stand for all.
  const auto range = [](double shear, const std::vector<double>& angles) {
    const auto states = friction_by_direction(bearing(shear, 64), 50e3, speed, angles);
    for (const FilmState& state : states) REQUIRE(state.converged);
    return anisotropy(states);
  };
  const double unsheared = range(0.0, {0.0, radians(22.5), radians(45.0)});
  const double sheared = range(30.0, {radians(30.0), radians(90.0)});
  fmt::print("friction at 50 kPa: {:.3f} % from smallest to largest, {:.2f} % sheared by 30 degrees\n",
             100.0 * unsheared, 100.0 * sheared);
  CHECK(unsheared < 0.02);
  CHECK(sheared > 10.0 * unsheared);
}

TEST_CASE("table of friction against the direction of sliding, sheared by 0 to 30 degrees", "[film][slow]") {
  const double pressure = GENERATE(50e3, 150e3);
  std::vector<double> ranges;
  fmt::print("pressure {:.0f} kPa, {:.2f} mm/s: mu (sideways pull / normal) by direction in degrees\nshear ",
             1e-3 * pressure, 1e3 * speed);
  for (const double angle : directions(15.0)) fmt::print("{:>15.0f}", degrees(angle));
  fmt::print("   largest/smallest\n");
  for (const double shear : {0.0, 10.0, 20.0, 30.0}) {
    const auto states = friction_by_direction(bearing(shear, 64), pressure, speed, directions(15.0));
    fmt::print("{:>5.0f} ", shear);
    for (const FilmState& state : states) {
      REQUIRE(state.converged);
      fmt::print("{:>7.4f} ({:+.4f})", state.friction(), state.across / state.pressure());
    }
    ranges.push_back(anisotropy(states));
    fmt::print("{:>9.2f} %\n", 100.0 * ranges.back());
  }
  CHECK(ranges[0] < 0.02);
  if (pressure > 100e3) CHECK(ranges[3] > 0.05);
  for (std::size_t k = 1; k < ranges.size(); ++k) CHECK(ranges[k] > ranges[k - 1]);
}

TEST_CASE("drag of a sheared weave turns with its long diagonal and grows with the square of its shear",
          "[film][slow]") {
  // mu / mean = 1 + A sin^2(gamma) cos 2(theta - theta_d), theta_d = (90 deg - gamma) / 2 the long diagonal.
  // Over evenly spaced directions of half a turn the harmonics are plain sums.
  const double pressure = GENERATE(8.6e3, 50e3, 100e3, 150e3);
  constexpr int count = 12;
  std::vector<double> angles;
  for (int k = 0; k < count; ++k) angles.push_back(radians(180.0 * k / count));
  for (const double shear : {10.0, 20.0, 30.0}) {
    const auto states = friction_by_direction(bearing(shear, 64), pressure, speed, angles);
    const double diagonal = radians(0.5 * (90.0 - shear)), sine = std::sin(radians(shear));
    double mean = 0.0, even = 0.0, odd = 0.0, fourth = 0.0;
    for (int k = 0; k < count; ++k) {
      REQUIRE(states[k].converged);
      const double mu = states[k].friction() / count, turn = 2.0 * (angles[k] - diagonal);
      mean += mu;
      even += 2.0 * mu * std::cos(turn);
      odd += 2.0 * mu * std::sin(turn);
      fourth += 2.0 * mu * std::cos(2.0 * turn);
    }
    fmt::print(
        "{:>4.1f} kPa, sheared by {} deg: mean mu {:.4f}, A {:+.3f}; across {:+.4f} %, fourth harmonic "
        "{:+.3f} %\n",
        1e-3 * pressure, shear, mean, even / mean / (sine * sine), 100.0 * odd / mean, 100.0 * fourth / mean);
    CHECK(std::abs(odd) < 1e-3 * mean);  // the mirror about the diagonal
    // Where the film floats high above the crowns (a binder's pressure) it does not feel them at all.
    if (pressure < 10e3)
      CHECK(std::abs(even) < 5e-3 * mean);
    else
      CHECK(even > 0.0);
  }
}

TEST_CASE("pressure exponent of the touched area: what geometry gives, and what Table 4 asks for",
          "[film][paper]") {
  const PlateContact plate = plate_contact(table1(), law, 0.0);
  const auto touched = [&](double depth) { return plate.touched_fraction(depth); };
  // A bed of springs, s = k delta: dP/dd = k phi, so phi(d) alone gives its exponent.
  const auto springs = [&](double depth) {
    return integrate_clustered(0.0, depth, 4, [&](double d) { return touched(d); });
  };
  fmt::print("depth_mm   phi    exponent: bed of springs, drained tow (P/kE)\n");
  for (const double depth : {0.01e-3, 0.05e-3, 0.1e-3, 0.2e-3, 0.3e-3, 0.4e-3, 0.5e-3}) {
    const double slope = log_slope(touched, depth), spring = slope / log_slope(springs, depth),
                 tow = slope / log_slope([&](double d) { return plate.pressure(d); }, depth);
    fmt::print("{:>7.2f} {:>8.4f} {:>12.3f} {:>18.3f} ({:.1e})\n", 1e3 * depth, touched(depth), spring, tow,
               plate.pressure(depth) / law.modulus);
    // A crown carries as phi ~ d, P ~ d^2: one half. Springs never stiffen, a tow does, so it stays below.
    CHECK(spring < 0.55);
    CHECK(tow < spring);
    if (depth <= 0.05e-3) CHECK(spring == Approx(0.5).margin(0.01));
    if (depth <= 0.01e-3) CHECK(tow == Approx(0.5).margin(0.02));
  }
  const auto exponent = [&](double pressure) {
    return log_slope([&](double p) { return touched(plate.depth_at(p)); }, pressure);
  };
  fmt::print("pressure_kPa  exponent of the drained tow\n");
  for (const double pressure : {0.01e3, 0.1e3, 0.5e3, 1e3, 2e3, 8.6e3, 75e3, 150e3, 300e3})
    fmt::print("{:>10.2f} {:>10.3f}\n", 1e-3 * pressure, exponent(pressure));
  // Table 4 with n = 0.37..0.41 asks for 0.26..0.33: met near 1 kPa, where phi is 0.45; not at the rig's.
  CHECK(exponent(0.5e3) > 0.33);
  CHECK(exponent(8.6e3) < 0.26);
  CHECK(exponent(150e3) < 0.02);
}

TEST_CASE("the same exponents belong to a tow 150 times as stiff at the pressure of the rig",
          "[film][paper]") {
  // Below packing only P / kE counts. A tow full of resin that cannot leave it in time is such a tow.
  const PlateContact stiff = plate_contact(table1(), {150.0 * law.modulus, law.exponent}, 0.0);
  const PlateContact soft = plate_contact(table1(), law, 0.0);
  CHECK(stiff.depth_at(150e3) == Approx(soft.depth_at(1e3)).epsilon(1e-6));
  const double exponent =
      log_slope([&](double p) { return stiff.touched_fraction(stiff.depth_at(p)); }, 150e3);
  fmt::print("tow 150 times as stiff, 150 kPa: phi {:.3f}, exponent {:.3f}\n",
             stiff.touched_fraction(stiff.depth_at(150e3)), exponent);
  CHECK(exponent > 0.26);
  CHECK(exponent < 0.33);
}

TEST_CASE("friction of Table 4 from geometry and rheology alone", "[film][paper][slow]") {
  // No number of the table goes in. Plate area (1500 N over it) is assumed 0.01 m^2 with a band.
  const FilmBearing film = bearing(0.0, 128);
  fmt::print("plate_m2     mu   (U x 2.5)  (N x 2)   film's share  measured 0.281, x 1.063, x 0.920\n");
  for (const double area : {0.005, 0.01, 0.02}) {
    const FilmState baseline = film.state(1500.0 / area, speed, 0.0);
    const FilmState fast = film.state(1500.0 / area, 41.67e-3, 0.0);
    const FilmState loaded = film.state(3000.0 / area, speed, 0.0);
    REQUIRE((baseline.converged && fast.converged && loaded.converged));
    const double by_speed = fast.friction() / baseline.friction();
    const double by_load = loaded.friction() / baseline.friction();
    fmt::print("{:>8.3f} {:>7.3f} {:>8.3f} {:>9.3f} {:>10.3f}\n", area, baseline.friction(), by_speed,
               by_load, baseline.film_load / baseline.pressure());
    CHECK(baseline.friction() > 0.1);
    CHECK(baseline.friction() < 0.5);
  }
  const FilmState binder = film.state(8.6e3, speed, 0.0);
  fmt::print("under a binder, 8.6 kPa: mu {:.2f}, least gap {:.4f} mm\n", binder.friction(),
             1e3 * binder.least_gap);
  CHECK(binder.film_carries());
}

TEST_CASE("what the assumed numbers of the film do to the friction of Table 4", "[film][paper][slow]") {
  struct Change {
    const char* name;
    FilmSpec spec;
  };
  FilmSpec base;
  base.samples = 64;
  std::vector<Change> changes(7, {"as assumed", base});
  changes[1] = {"fill 0.1", base}, changes[1].spec.fill = 0.1;
  changes[2] = {"fill 0.5", base}, changes[2].spec.fill = 0.5;
  changes[3] = {"roughness / 2", base}, changes[3].spec.roughness /= 2.0;
  changes[4] = {"roughness x 2", base}, changes[4].spec.roughness *= 2.0;
  changes[5] = {"consistency / 2", base}, changes[5].spec.fluid.consistency /= 2.0;
  changes[6] = {"index 0.41", base}, changes[6].spec.fluid.index = 0.41;
  fmt::print("{:<16}     mu  (U x 2.5)  (N x 2)  film's share at N x 2\n", "150 kPa");
  double least = 1e300, most = 0.0;
  for (const Change& change : changes) {
    const FilmBearing film(table1(), law, 0.0, change.spec);
    const FilmState baseline = film.state(150e3, speed, 0.0);
    const FilmState fast = film.state(150e3, 41.67e-3, 0.0), loaded = film.state(300e3, speed, 0.0);
    REQUIRE((baseline.converged && fast.converged && loaded.converged));
    const double by_load = loaded.friction() / baseline.friction();
    fmt::print("{:<16} {:>6.3f} {:>8.3f} {:>9.3f} {:>9.3f}\n", change.name, baseline.friction(),
               fast.friction() / baseline.friction(), by_load, loaded.film_load / loaded.pressure());
    least = std::min(least, by_load);
    most = std::max(most, by_load);
  }
  // Neither sign of the load's effect is excluded: the film alone cannot decide what Table 4 measured
  // (0.920).
  CHECK(least < 1.0);
  CHECK(most > 1.0);
}

TEST_CASE("samples, fill and roughness outside their range are refused together", "[film]") {
  FilmSpec spec;
  spec.samples = 100;
  spec.fill = 1.0;
  spec.roughness = 0.0;
  try {
    FilmBearing(table1(), law, 0.0, spec);
    FAIL("accepted");
  } catch (const InputError& error) {
    REQUIRE(error.problems().size() == 3);
    CHECK(error.problems()[0].id == "film.samples.range");
    CHECK(error.problems()[1].id == "film.fill.range");
    CHECK(error.problems()[2].id == "film.roughness.range");
  }
}

TEST_CASE("drag over the direction is held beyond its table, and the mirror image turns its second share",
          "[film][invariant]") {
  DragDirection drag;
  CHECK(drag.empty());
  CHECK(drag.evaluate(1e5, 0.3).cosine == 0.0);
  CHECK(drag.evaluate(1e5, 0.3).sine == 0.0);
  const auto table = [](double last) {
    return CurveFamily({0.0, 0.5}, {Curve({std::log(1e4), std::log(1e5)}, {0.0, 0.0}),
                                    Curve({std::log(1e4), std::log(1e5)}, {0.1, last})});
  };
  drag = {table(0.2), table(0.3)};
  CHECK(drag.evaluate(1e5, 0.5).cosine == Approx(0.2));
  CHECK(drag.evaluate(1e5, 0.25).sine == Approx(0.15));
  CHECK(drag.evaluate(9e5, 0.9).sine == Approx(0.3));
  CHECK(drag.evaluate(0.0, 0.5).sine == Approx(0.1));
  CHECK(drag.evaluate(1e5, -0.5).cosine == drag.evaluate(1e5, 0.5).cosine);
  CHECK(drag.evaluate(1e5, -0.5).sine == -drag.evaluate(1e5, 0.5).sine);
}

TEST_CASE("the table of drag over the direction gives the film's friction in directions it was not made from",
          "[film][slow]") {
  FilmDirectionSpec spec;
  spec.speed = speed;
  spec.fill = FilmSpec{}.fill;
  const DragDirection drag = drag_direction(table1(), law, ResinSpec{}, spec);
  const double shear = radians(30.0);
  const std::vector<double> angle{-15.0, 0.0, 15.0, 30.0, 45.0, 60.0, 75.0, 90.0, 105.0, 120.0, 135.0, 150.0};
  std::vector<double> direction;
  for (const double a : angle) direction.push_back(radians(a));
  const double pressure = 150e3;
  const auto states = friction_by_direction(bearing(30.0, 64), pressure, speed, direction);
  double mean = 0.0;
  for (const FilmState& state : states) mean += state.friction() / static_cast<double>(states.size());
  const auto share = drag.evaluate(pressure, shear);
  const double amplitude = std::hypot(share.cosine, share.sine);
  CHECK(amplitude > 0.05);
  double projected = 0.0;
  for (std::size_t k = 0; k < states.size(); ++k) {
    const double turn = 2.0 * direction[k];
    const double of_table = share.cosine * std::cos(turn) + share.sine * std::sin(turn),
                 of_film = states[k].friction() / mean - 1.0;
    projected += 2.0 / static_cast<double>(states.size()) * of_film * of_table / amplitude;
    fmt::print("{:>5g} kPa, {:>4.0f} deg: film {:+.4f}, table {:+.4f}\n", 1e-3 * pressure, angle[k], of_film,
               of_table);
    CHECK(std::abs(of_table - of_film) < 0.35 * amplitude);  // the fourth harmonic
  }
  // The second harmonic itself from twelve directions; three of them take the sixth for a part of it.
  fmt::print("second harmonic of twelve directions {:.4f}, of three {:.4f}\n", projected, amplitude);
  CHECK(projected == Approx(amplitude).epsilon(0.1));
}
