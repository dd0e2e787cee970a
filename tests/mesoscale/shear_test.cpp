#include "mesoscale/shear.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "core/problem.h"
#include "mesoscale/quadrature.h"
#include "table1.h"
#include "tests/derivative_check.h"

using namespace heddle;
using namespace heddle::mesoscale;
using heddle::test::degrees;
using heddle::test::derivative_gap;
using heddle::test::radians;
using heddle::test::table1_models;

namespace {
const Curve& table1_curve() {
  static const Curve curve = tabulate(table1_models().shear, sine_grid(table1_models().fabric));
  return curve;
}
}  // namespace

TEST_CASE("a crossing under the reference tension carries it both ways", "[shear]") {
  const ShearModel& model = table1_models().shear;
  const LoadedCrossing loaded = model.loaded(0.0);
  const TensionModel::State state = model.tension.relax(loaded.strain);
  // The tension model reads the crossover force from a table of 600 points.
  CHECK(state.tension[0] == Approx(model.reference_tension).epsilon(1e-4));
  CHECK(state.height[0] == Approx(loaded.height[0]).epsilon(1e-4));
  CHECK(state.crossover_force == Approx(loaded.crossover_force).epsilon(1e-4));
}

TEST_CASE("lateral shear flow is the slope of the lateral energy and starts at gap closure",
          "[shear][derivative]") {
  const ShearModel& model = table1_models().shear;
  CHECK(model.flow(radians(20.0)).lateral == Approx(0.0).margin(1e-12));
  CHECK(model.lateral_energy(radians(20.0)) == Approx(0.0).margin(1e-15));
  const double angle = radians(GENERATE(28.0, 33.0, 40.0, 60.0, 77.8));  // closing, closed, packed
  CAPTURE(angle);
  const auto energy = [&](double g) { return model.lateral_energy(g); };
  const double flow = model.flow(angle).lateral;
  CHECK(derivative_gap(energy, angle, 0.02, flow) < 1e-5);
  CHECK(derivative_gap(energy, angle, 0.02, 1.01 * flow) > 1e-4);
}

TEST_CASE("closed tows resist as 2 t sin g times their lateral pressure", "[shear]") {
  const FormingModels& m = table1_models();
  const double angle = radians(50.0), v0 = m.fabric.crossing.tow[0].fibre_fraction;
  const double v = v0 * (4.64 / 5.39) / std::cos(angle);
  const double pressure = m.compaction.evaluate(v, v0).stress - m.compaction.evaluate(v0, v0).stress;
  CHECK(m.shear.flow(angle).lateral == Approx(2.0 * 0.75e-3 * std::sin(angle) * pressure).epsilon(1e-9));
}

TEST_CASE("tension shear flow is the slope of the relaxed potential", "[shear][derivative]") {
  const ShearModel& model = table1_models().shear;
  const double angle = radians(GENERATE(10.0, 29.0, 45.0, 65.0));
  CAPTURE(angle);
  const auto relaxed = [&](double g) { return model.loaded(g).potential; };
  const double flow = model.flow(angle).tension;
  CHECK(derivative_gap(relaxed, angle, 0.3, flow) < 1e-5);
  CHECK(derivative_gap(relaxed, angle, 0.3, 1.01 * flow) > 1e-4);
}

TEST_CASE("crossover friction is the force times its arm, without a jump at rest", "[shear]") {
  const ShearModel& model = table1_models().shear;
  CHECK(model.flow(0.0).dry == 0.0);
  const LoadedCrossing loaded = model.loaded(radians(15.0));
  const double full = 0.2 * loaded.crossover_force * loaded.friction_arm / (5.39e-3 * 5.39e-3);
  CHECK(model.flow(radians(15.0)).dry == Approx(full).epsilon(0.003));
  CHECK(model.flow(radians(1.0)).dry == Approx(model.flow(radians(3.0)).dry / std::sqrt(2.0)).epsilon(0.06));
}

TEST_CASE("the work of the shear table is the work of its terms", "[shear]") {
  const ShearModel& model = table1_models().shear;
  const double end = radians(60.0);
  const LoadedCrossing at_end = model.loaded(end), at_start = model.loaded(0.0);
  const double dry = integrate(0.0, radians(5.0), 12, [&](double g) { return model.flow(g).dry; }) +
                     integrate(radians(5.0), end, 12, [&](double g) { return model.flow(g).dry; });
  const double work = dry + model.lateral_energy(end) + at_end.potential - at_start.potential;
  CHECK(table1_curve().integral(std::sin(end)) == Approx(work).epsilon(2e-3));
}

TEST_CASE("shear resistance never falls and locks steeply but finitely", "[shear]") {
  const Curve& stress = table1_curve();
  CHECK(fault_of_monotone_table(stress.x(), stress.y(), "shear").empty());
  CHECK(stress.y().front() == 0.0);
  // Squeezed sideways, tows stiffen steeply; friction and tension between them grow with the process, not
  // with angle.
  const ShearModel& model = table1_models().shear;
  CHECK(model.flow(radians(60.0)).lateral > 5.0 * model.flow(radians(45.0)).lateral);
  CHECK(stress(std::sin(radians(70.0))) > 5.0 * stress(std::sin(radians(45.0))));
  CHECK(std::isfinite(stress(1.0)));
}

TEST_CASE("no stress of the Table 1 table had to be held", "[shear]") {
  const ShearModel& model = table1_models().shear;
  const Curve& stress = table1_curve();
  for (std::size_t k = 0; k < stress.x().size(); k += 7) {
    const double angle = std::asin(stress.x()[k]);
    CHECK(stress.y()[k] == Approx(model.flow(angle).total() / std::cos(angle)).margin(1e-9));
  }
}

TEST_CASE("the plain weave of Table 1 locks between 45 and 50 degrees", "[shear]") {
  CHECK(degrees(locking_angle(table1_curve())) > 45.0);
  CHECK(degrees(locking_angle(table1_curve())) < 50.0);
  CHECK_THROWS_AS(locking_angle(Curve({0.0, 0.5, 0.98}, {0.0, 1.0, 1.96})), NumericalError);
}

TEST_CASE("the crossover film resists as the integral of its power law over the disc", "[shear]") {
  const FormingModels& m = table1_models();
  const ResinSpec resin;
  const double a = m.fabric.crossing.tow[0].path.wrap(), n = resin.power_index, rate = 2.0;
  // Torque times rate over the cell, at one rate, against m_s rate^(n + 1).
  const double power = integrate(0.0, a, 40, [&](double r) {
    const double film_rate = rate * r / resin.film_thickness;
    const double stress = resin.consistency * std::pow(film_rate, n);
    return stress * rate * r * 2.0 * std::numbers::pi * r;
  });
  const double per_area = power / (m.fabric.crossing.tow[0].spacing * m.fabric.crossing.tow[0].spacing);
  CHECK(shear_rate_parts(m.fabric, resin, 0.0).film * std::pow(rate, n + 1.0) ==
        Approx(per_area).epsilon(1e-6));
}

TEST_CASE("rate resistance is of the expected size and thins with heat", "[shear]") {
  const FormingModels& m = table1_models();
  const ShearRate rate = shear_rate(m.fabric, ResinSpec{}, 0.5);
  CHECK(rate.consistency > 4.0);
  CHECK(rate.consistency < 10.0);
  CHECK(rate.index == 0.38);
  CHECK(rate.activation_temperature == Approx(42.0e3 / 8.314462618));
  CHECK(shear_rate_parts(m.fabric, ResinSpec{}, 0.0).in_tow == 0.0);
  CHECK(rate.consistency_at(473.15) < rate.consistency_at(453.15));
}
