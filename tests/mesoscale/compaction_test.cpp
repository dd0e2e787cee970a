#include <catch2/catch.hpp>
#include <cmath>

#include "mesoscale/compaction.h"
#include "mesoscale/crossover.h"
#include "mesoscale/forming.h"
#include "table1.h"
#include "tests/derivative_check.h"

using namespace heddle;
using namespace heddle::mesoscale;
using heddle::test::derivative_gap;
using heddle::test::lens_of;
using heddle::test::table1;

namespace {
const CompactionLaw law{3.2e6, 5.0};

CompactionLaw of(CompactionChoice choice) {
  FormingSpec forming;
  forming.compaction = choice;
  return compaction_law(forming);
}
CompactionLaw any_law() {
  return of(GENERATE(CompactionChoice::toll, CompactionChoice::van_wyk, CompactionChoice::gutowski));
}
constexpr double v0 = 0.19;  // of Table 1's tows
}  // namespace

TEST_CASE("fibre bed pressure has an exact slope on both sides of packing", "[compaction][derivative]") {
  const CompactionLaw law = any_law();
  const double v = GENERATE(0.2, 0.5, 0.74, 0.78, 0.83, 0.9);
  CAPTURE(static_cast<int>(law.form), law.exponent, v);
  const auto stress = [&](double x) { return law.evaluate(x, v0).stress; };
  const double slope = law.evaluate(v, v0).slope;
  CHECK(derivative_gap(stress, v, 0.1, slope) < 1e-7);
  CHECK(derivative_gap(stress, v, 0.1, 1.01 * slope) > 1e-4);
}

TEST_CASE("below packing the law is Toll's, above it is steep and finite", "[compaction]") {
  CHECK(law.evaluate(0.5, v0).stress == Approx(3.2e6 * std::pow(0.5, 5)));
  CHECK(law.evaluate(0.80, v0).stress > 10.0 * law.evaluate(0.75, v0).stress);
  CHECK(std::isfinite(law.evaluate(1.2, v0).stress));
}

TEST_CASE("van Wyk's tow presses with k E (V^3 - V0^3) and takes the work of it", "[compaction]") {
  const CompactionLaw van_wyk = of(CompactionChoice::van_wyk);
  const double thickness = 0.75e-3, v = 0.5, squeezed = thickness * (1.0 - v0 / v);
  const TowSqueeze::Value at = TowSqueeze(van_wyk, thickness, v0).evaluate(squeezed);
  CHECK(at.stress == Approx(3.2e6 * (std::pow(v, 3) - std::pow(v0, 3))).epsilon(1e-13));
  // V0 t int k E (V^3 - V0^3) dV / V^2
  const double work =
      3.2e6 * (0.5 * (v * v - v0 * v0) - std::pow(v0, 3) * (1.0 / v0 - 1.0 / v)) * v0 * thickness;
  CHECK(at.energy == Approx(work).epsilon(1e-12));
}

TEST_CASE(
    "Gutowski's tow has the pressure of the published form, nothing at its start and no end short of Va",
    "[compaction]") {
  CompactionLaw law = of(CompactionChoice::gutowski);
  law.available = 0.9025;  // square roots 0.95, 0.5 and 0.4
  law.spring = 2e3;
  CHECK(law.evaluate(0.25, 0.16).stress == Approx(2e3 * 0.25 / std::pow(0.9, 4)).epsilon(1e-13));
  CHECK(law.evaluate(0.16, 0.16).stress == 0.0);
  CHECK(law.evaluate(0.1, 0.16).stress == 0.0);
  // Work against a sum over the published form.
  double sum = 0.0;
  constexpr int n = 20000;
  for (int k = 0; k < n; ++k) {
    const double v = 0.16 + (0.8 - 0.16) * (k + 0.5) / n;
    const double stress = 2e3 * (std::sqrt(v / 0.16) - 1.0) / std::pow(std::sqrt(0.9025 / v) - 1.0, 4);
    sum += stress / (v * v) * (0.8 - 0.16) / n;
  }
  CHECK(law.work(0.16, 0.8) == Approx(sum).epsilon(1e-6));
  // Straight on beyond V = 0.82, without a jump of value or slope.
  const CompactionLaw::Value below = law.evaluate(0.82 - 1e-12, 0.16),
                             above = law.evaluate(0.82 + 1e-12, 0.16);
  CHECK(below.stress == Approx(above.stress).epsilon(1e-8));
  CHECK(below.slope == Approx(above.slope).epsilon(1e-8));
  CHECK(law.evaluate(0.95, 0.16).slope == above.slope);
}

TEST_CASE("the default of Gutowski's law is as stiff as the default network at a fibre fraction of 0.4",
          "[compaction]") {
  const double network = law.evaluate(0.4, v0).stress - law.evaluate(v0, v0).stress;
  CHECK(of(CompactionChoice::gutowski).evaluate(0.4, v0).stress == Approx(network).epsilon(0.05));
}

TEST_CASE("work of squeezing a tow has the stress as its slope", "[compaction][derivative]") {
  const CompactionLaw law = any_law();
  CAPTURE(static_cast<int>(law.form), law.exponent);
  const TowSqueeze squeeze(law, 0.75e-3, v0);
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
  const CompactionLaw law = any_law();
  const CrossoverContact contact(table1().crossing, 0.0, law);
  const double c = GENERATE(0.05e-3, 0.3e-3, 0.8e-3);
  CAPTURE(static_cast<int>(law.form), law.exponent, c);
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

TEST_CASE("lateral shear flow is the slope of its energy and starts at gap closure, by van Wyk and Gutowski",
          "[compaction][shear][derivative]") {
  CellSpec spec;
  spec.forming.compaction = GENERATE(CompactionChoice::van_wyk, CompactionChoice::gutowski);
  const FormingModels models = forming_models(spec);
  CHECK(models.shear.flow(0.35).lateral == 0.0);
  for (const double angle : {0.6, 0.7, 0.9}) {
    const double flow = models.shear.flow(angle).lateral;
    const auto energy = [&](double g) { return models.shear.lateral_energy(g); };
    CHECK(flow > 0.0);
    CHECK(derivative_gap(energy, angle, 0.1, flow) < 1e-6);
    CHECK(derivative_gap(energy, angle, 0.1, 1.01 * flow) > 1e-4);
  }
}

TEST_CASE("fabrics of van Wyk's and of Gutowski's tows keep the rules of the hand-over",
          "[compaction][cell]") {
  CellSpec spec;
  spec.forming.compaction = GENERATE(CompactionChoice::van_wyk, CompactionChoice::gutowski);
  const CellResult result = analyse(spec);  // throws where a table breaks its rule
  CHECK(result.fabric.provenance.specification != specification_hash(CellSpec{}));
  const double degree = std::acos(-1.0) / 180.0;
  CHECK(result.summary.locking_angle > 35.0 * degree);
  CHECK(result.summary.locking_angle < 60.0 * degree);
}
