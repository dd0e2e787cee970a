#include <catch2/catch.hpp>
#include <cmath>

#include "mesoscale/compaction.h"
#include "mesoscale/crossover.h"
#include "table1.h"
#include "tests/derivative_check.h"

using namespace heddle;
using namespace heddle::mesoscale;
using heddle::test::derivative_gap;
using heddle::test::lens_of;
using heddle::test::table1;

namespace {
const CompactionLaw law{3.2e6, 5.0};
}

TEST_CASE("fibre bed pressure has an exact slope on both sides of packing", "[compaction][derivative]") {
  const double v = GENERATE(0.19, 0.5, 0.74, 0.78, 0.9);
  CAPTURE(v);
  const auto stress = [](double x) { return law.evaluate(x).stress; };
  const double slope = law.evaluate(v).slope;
  CHECK(derivative_gap(stress, v, 0.1, slope) < 1e-7);
  CHECK(derivative_gap(stress, v, 0.1, 1.01 * slope) > 1e-4);
}

TEST_CASE("below packing the law is Toll's, above it is steep and finite", "[compaction]") {
  CHECK(law.evaluate(0.5).stress == Approx(3.2e6 * std::pow(0.5, 5)));
  CHECK(law.evaluate(0.80).stress > 10.0 * law.evaluate(0.75).stress);
  CHECK(std::isfinite(law.evaluate(1.2).stress));
}

TEST_CASE("work of squeezing a tow has the stress as its slope", "[compaction][derivative]") {
  const TowSqueeze squeeze(law, 0.75e-3, 0.19);
  const double delta = GENERATE(0.01e-3, 0.2e-3, 0.5e-3, 0.58e-3);  // the last is past packing
  CAPTURE(delta);
  const TowSqueeze::Value at = squeeze.evaluate(delta);
  const auto energy = [&](double x) { return squeeze.evaluate(x).energy; };
  const auto stress = [&](double x) { return squeeze.stress(x); };
  CHECK(at.stress == squeeze.stress(delta));
  CHECK(derivative_gap(energy, delta, 0.3 * delta, at.stress) < 1e-6);
  CHECK(derivative_gap(energy, delta, 0.3 * delta, 1.01 * at.stress) > 1e-4);
  CHECK(derivative_gap(stress, delta, 0.1e-3, at.slope) < 1e-6);
  CHECK(derivative_gap(stress, delta, 0.1e-3, 1.01 * at.slope) > 1e-4);
}

TEST_CASE("a tow that is not squeezed pushes back with nothing", "[compaction]") {
  const TowSqueeze squeeze(law, 0.75e-3, 0.19);
  CHECK(squeeze.evaluate(-1e-4).stress == 0.0);
  CHECK(squeeze.evaluate(0.0).energy == 0.0);
  CHECK(squeeze.stress(1e-12) < 1e-3);
}

TEST_CASE("crossover force and stiffness are slopes of its energy", "[compaction][derivative]") {
  const CrossoverContact contact(table1().crossing, 0.0, law);
  const double c = GENERATE(0.05e-3, 0.3e-3, 0.8e-3);
  CAPTURE(c);
  const CrossoverContact::Value at = contact.evaluate(c);
  CHECK(contact.force(c) == Approx(at.force).epsilon(1e-13));
  CHECK(derivative_gap([&](double x) { return contact.evaluate(x).energy; }, c, 0.1 * c, at.force) < 1e-6);
  CHECK(derivative_gap([&](double x) { return contact.evaluate(x).energy; }, c, 0.1 * c, 1.01 * at.force) >
        1e-4);
  CHECK(derivative_gap([&](double x) { return contact.force(x); }, c, 0.1 * c, at.stiffness) < 1e-5);
  CHECK(derivative_gap([&](double x) { return contact.force(x); }, c, 0.1 * c, 1.01 * at.stiffness) > 1e-4);
}

TEST_CASE("crossover force converges: a brute-force sum over the overlap gives the same", "[compaction]") {
  const CrossingGeometry crossing = table1().crossing;
  const CrossoverContact contact(crossing, 0.0, law);
  const TowSqueeze squeeze(law, lens_of(crossing).thickness, crossing.tow[0].fibre_fraction);
  const double c = GENERATE(0.1e-3, 0.4e-3, 0.9e-3);
  constexpr int n = 600;
  const double edge = 0.5 * lens_of(crossing).width, step = edge / n;
  std::vector<double> gap(n);
  for (int i = 0; i < n; ++i) {
    const double u = step * (i + 0.5);
    gap[static_cast<std::size_t>(i)] = lens_of(crossing).drop(u) - crossing.tow[0].path.drop(u);
  }
  double force = 0.0;
  for (double a : gap)
    for (double b : gap) force += 4.0 * step * step * squeeze.stress(0.5 * (c - a - b));
  CHECK(contact.force(c) == Approx(force).epsilon(2e-3));
}

TEST_CASE("the arm of a square overlap under even pressure is 0.3826 of its side", "[compaction]") {
  // Mean distance from the centre of a square of side w: w (sqrt 2 + asinh 1) / 6.
  const CrossingGeometry crossing = table1().crossing;
  const double side = lens_of(crossing).width;
  const double mean = side * (std::sqrt(2.0) + std::asinh(1.0)) / 6.0;
  CHECK(CrossoverContact(crossing, 0.0, law).arm(0.0) == Approx(mean).epsilon(1e-3));
}
