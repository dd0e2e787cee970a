#include "mesoscale/tension.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "core/problem.h"
#include "table1.h"
#include "tests/derivative_check.h"

using namespace heddle;
using namespace heddle::mesoscale;
using heddle::test::derivative_gap;
using heddle::test::lens_of;
using heddle::test::table1;
using heddle::test::table1_models;

namespace {

double smaller_eigenvalue(const Surface::Value& at) {
  return 0.5 * (at.fxx + at.fyy) - std::hypot(0.5 * (at.fxx - at.fyy), at.fxy);
}

const Surface& table1_surface() {
  static const Surface surface = tabulate(table1_models().tension);
  return surface;
}

// Warp strain less the tow's own elongation when the weft strain is chosen to carry (almost) nothing.
double free_weft_straightening(PathForm form) {
  TensionOptions options;
  options.form = form;
  options.bending_stiffness = {1e-9, 1e-9};
  const TensionModel model = tension_model(table1(), CompactionLaw{3.2e6, 5.0}, options);
  const double strain = 0.02;
  const TensionModel::State state = model.relax({strain, -0.015});
  CHECK(state.height[0] < 0.01e-3);
  const double elongation = state.tension[0] * model.tow[0].spacing / model.tow[0].stretch.stiffness +
                            0.5 * model.tow[0].stretch.straightening;
  return (1.0 + strain) / (1.0 + elongation) - 1.0;
}

}  // namespace

TEST_CASE("tow force and stiffness are slopes of the tow energy", "[tension][derivative]") {
  const TowStretch tow{31.9e3, 1e-3};
  const double strain = GENERATE(2e-4, 9e-4, 1.1e-3, 0.02);
  const TowStretch::Value at = tow.evaluate(strain);
  const auto energy = [&](double e) { return tow.evaluate(e).energy; };
  const auto force = [&](double e) { return tow.evaluate(e).force; };
  CHECK(derivative_gap(energy, strain, 1e-4, at.force) < 1e-6);
  CHECK(derivative_gap(energy, strain, 1e-4, 1.01 * at.force) > 1e-4);
  CHECK(derivative_gap(force, strain, 1e-4, at.stiffness) < 1e-6);
  CHECK(derivative_gap(force, strain, 1e-4, 1.01 * at.stiffness) > 1e-4);
  CHECK(tow.evaluate(-0.01).force == 0.0);
}

TEST_CASE("the woven fabric is free of stress", "[tension]") {
  const TensionModel::State state = table1_models().tension.relax({0.0, 0.0});
  CHECK(state.energy == 0.0);
  CHECK(state.tension[0] == 0.0);
  CHECK(state.height[0] == 0.75e-3);
  CHECK(state.crossover_force == 0.0);
}

TEST_CASE("fabric tension is the slope of the relaxed energy", "[tension][derivative]") {
  const TensionModel& model = table1_models().tension;
  const double e1 = GENERATE(-0.004, 0.003, 0.009, 0.016);
  const double e2 = GENERATE(-0.006, 0.002, 0.011);
  CAPTURE(e1, e2);
  const TensionModel::State at = model.relax({e1, e2});
  const auto along_warp = [&](double e) { return model.relax({e, e2}).energy; };
  const auto along_weft = [&](double e) { return model.relax({e1, e}).energy; };
  CHECK(derivative_gap(along_warp, e1, 1e-3, at.tension[0]) < 1e-5);
  CHECK(derivative_gap(along_weft, e2, 1e-3, at.tension[1]) < 1e-5);
  CHECK(derivative_gap(along_warp, e1, 1e-3, 1.01 * at.tension[0]) > 1e-4);
}

TEST_CASE("crossing tows balance: twice N sin th of each is the crossover force", "[tension]") {
  const TensionModel& model = table1_models().tension;
  const double e = GENERATE(0.004, 0.009, 0.014);
  const TensionModel::State state = model.relax({e, 0.5 * e});
  for (std::size_t i = 0; i < 2; ++i) {
    const PathLength path =
        model.tow[0].length.evaluate(model.tow[0].spacing * (1.0 + (i == 0 ? e : 0.5 * e)), state.height[i]);
    const double along = state.tension[i] * model.tow[0].spacing;  // N cos th
    const double bending = model.tow[0].crimp_stiffness * (state.height[i] - model.tow[0].rest_height);
    CHECK(along * path.dl_dh / path.dl_dp + bending == Approx(state.crossover_force).epsilon(1e-6));
  }
}

TEST_CASE("equal stretch both ways exchanges no crimp", "[tension]") {
  const double e = GENERATE(0.002, 0.008, 0.02);
  const TensionModel::State state = table1_models().tension.relax({e, e});
  CHECK(state.height[0] == Approx(state.height[1]).epsilon(1e-9));
  CHECK(state.tension[0] == Approx(state.tension[1]).epsilon(1e-9));
  CHECK(state.height[0] < 0.75e-3);  // both flatten: the crossover is compacted
}

TEST_CASE("warp and weft exchange: pulling the warp straightens it and crimps the weft", "[tension]") {
  const TensionModel::State state = table1_models().tension.relax({0.009, -0.004});
  CHECK(state.height[0] < 0.5e-3);
  CHECK(state.height[1] > 0.75e-3);
}

TEST_CASE("a warp with a free weft straightens at its own crimp", "[tension]") {
  const CrossingGeometry c = table1().crossing;
  const SawToothPath saw{c.tow[0].spacing, c.tow[0].path.height};
  CHECK(100.0 * free_weft_straightening(PathForm::saw_tooth) == Approx(100.0 * saw.crimp()).margin(0.002));
  CHECK(100.0 * saw.crimp() == Approx(0.963).margin(0.001));
  CHECK(100.0 * free_weft_straightening(PathForm::arc) ==
        Approx(100.0 * c.tow[0].path.crimp()).margin(0.002));
}

// Inextensible tows l0 on saw-teeth, rigid where they cross, without friction or bending: heights follow from
// lengths, h_i = sqrt(l0^2 - p^2 (1 + e_i)^2), they add up to what they did, and N1 sin th1 = N2 sin th2
// makes n1 / n2 = tan th2 / tan th1. Source: Kawabata's model in this limit.
TEST_CASE("inextensible saw-tooth tows exchange crimp and share tension by the closed form",
          "[tension][analytic]") {
  TensionOptions options;
  options.form = PathForm::saw_tooth;
  options.fibre_modulus = 72.4e12;
  options.compression_ratio = 0.0;
  TensionModel model = tension_model(table1(), CompactionLaw{3.2e13, 5.0}, options);
  for (TensionTow& tow : model.tow) {
    tow.stretch.straightening = 1e-6;
    tow.crimp_stiffness = 1e-3;  // next to nothing, but a slack tow's height must be something
  }
  const double p = model.tow[0].spacing, t = 0.75e-3, l = std::hypot(p, t);
  const auto height = [&](double e) { return std::sqrt(l * l - p * p * (1.0 + e) * (1.0 + e)); };
  for (const double e1 : {0.002, 0.005, 0.008}) {
    const double h1 = height(e1), h2 = 2.0 * t - h1;
    const double e2 = std::sqrt(l * l - h2 * h2) / p - 1.0;
    CAPTURE(e1, e2);
    CHECK(e2 < 0.0);  // the weft draws in
    // A hair more than the tows have to give, so that they carry.
    const TensionModel::State state = model.relax({e1, e2 + 3e-6});
    CHECK(state.height[0] == Approx(h1).epsilon(1e-3));
    CHECK(state.height[1] == Approx(h2).epsilon(1e-3));
    const double ratio = (h2 / (1.0 + e2)) / (h1 / (1.0 + e1));
    CHECK(state.tension[1] > 0.0);
    CHECK(state.tension[0] / state.tension[1] == Approx(ratio).epsilon(2e-3));
    CHECK(state.tension[0] / state.tension[1] != Approx(1.01 * ratio).epsilon(2e-3));
  }
}

TEST_CASE("a straightened fabric is as stiff as its glass", "[tension]") {
  const TensionModel& model = table1_models().tension;
  const double slope =
      (model.relax({0.0205, -0.01}).tension[0] - model.relax({0.0195, -0.01}).tension[0]) / 1e-3;
  CHECK(slope ==
        Approx(72.4e9 * 0.4405e-6 / 5.39e-3).epsilon(0.02));  // EA / p = 5.9 MN/m; l0 > p takes 1.1 %
}

TEST_CASE("compression meets the small tangent asked for", "[tension]") {
  const TensionModel& model = table1_models().tension;
  const double slope = (model.relax({-0.010, 0.0}).tension[0] - model.relax({-0.012, 0.0}).tension[0]) / 2e-3;
  CHECK(slope == Approx(0.01 * model.tow[0].stretch.stiffness / model.tow[0].spacing).epsilon(0.01));
}

TEST_CASE("the tabulated energy is symmetric and convex at points and between", "[tension]") {
  const Surface& w = table1_surface();
  double worst = 1e300;
  for (int i = 0; i <= 700; ++i)
    for (int j = 0; j <= 700; ++j) {
      const double x = -0.02 + 0.05 * i / 700.0, y = -0.02 + 0.05 * j / 700.0;
      worst = std::min(worst, smaller_eigenvalue(w.evaluate(x, y)));
    }
  CHECK(worst > -1e-9 * 5.9e6);
  const Surface::Value a = w.evaluate(0.011, 0.003), b = w.evaluate(0.003, 0.011);
  CHECK(a.f == Approx(b.f).epsilon(1e-9));
  CHECK(a.fx == Approx(b.fy).epsilon(1e-9));
}

TEST_CASE("tabulated tension follows the direct solution within a thousandth of full scale", "[tension]") {
  const TensionModel& model = table1_models().tension;
  const Surface& w = table1_surface();
  double full_scale = 0.0, worst = 0.0;
  for (int i = 0; i < 60; ++i)
    for (int j = 0; j < 60; ++j) {
      const double x = -0.019 + 0.048 * (i + 0.37) / 60.0, y = -0.019 + 0.048 * (j + 0.71) / 60.0;
      const TensionModel::State state = model.relax({x, y});
      const Surface::Value at = w.evaluate(x, y);
      worst = std::max({worst, std::abs(at.fx - state.tension[0]), std::abs(at.fy - state.tension[1])});
      full_scale = std::max(full_scale, state.tension[0]);
    }
  CHECK(worst < 1e-3 * full_scale);
}

TEST_CASE("tension that cannot be found names the strains", "[tension]") {
  TensionModel model = table1_models().tension;
  model.tow[0].stretch.stiffness = std::nan("");
  CHECK_THROWS_WITH(model.relax({0.01, 0.002}), Catch::Contains("(0.01, 0.002)"));
}
