// Studies of the unit cell: which weaves, which numbers, and slopes against closed forms.
#include "mesoscale/study/cell_study.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "../table1.h"

using namespace heddle;
using namespace heddle::mesoscale;
using namespace heddle::mesoscale::study;

namespace {

const std::vector<double> at_rest{0.0};

std::vector<Sensitivity> sensitivities_of(const CellSpec& base, const StudySpec& spec, Dimension dimension) {
  const std::array<CellSpec, 4> cells = stencil(base, spec, dimension);
  std::array<CellProperties, 4> around;
  for (std::size_t k = 0; k < 4; ++k) around[k] = cell_properties(cells[k], {}, spec.shear_angles);
  return sensitivities(cell_properties(base, {}, spec.shear_angles), around, step_of(base, spec, dimension),
                       dimension, spec.shear_angles);
}

Sensitivity of(const std::vector<Sensitivity>& all, const std::string& key) {
  for (const Sensitivity& s : all)
    if (s.property == index_of(key)) return s;
  FAIL("no sensitivity of " << key);
  return {};
}

// Within what the differences say of themselves, which must be so little that a slope one percent off is
// seen.
void check_slope(const Sensitivity& found, double exact) {
  CAPTURE(properties()[found.property].key, found.slope, found.error, exact);
  const double rounding = 1e-9 * std::abs(exact);
  CHECK(std::abs(found.slope - exact) <= 1.5 * found.error + rounding);
  CHECK(std::abs(found.slope - 1.01 * exact) > 1.5 * found.error + rounding);
}

std::vector<std::string> rules(const Problems& problems) {
  std::vector<std::string> ids;
  for (const Problem& problem : problems) ids.push_back(problem.id.text());
  return ids;
}

}  // namespace

// Closed forms in the gap g alone: p = w + g, tows and their contact as they are.
//   cos g* = w / p;   B = A_f E_f d_f^2 / (16 p);   l(p): dl/dp = cos th (the arc turns, its ends do not
//   slide)
TEST_CASE("sensitivities to the gap are the slopes of the closed forms", "[study][derivative]") {
  CellSpec base;
  base.forming.bonding = 0.0;  // fibres slide: the bending stiffness is that of single fibres
  const auto found = sensitivities_of(base, StudySpec{}, Dimension::gap);
  const double w = base.weave.tow_width, p = w + base.weave.gap;
  const CellProperties here = cell_properties(base, {}, at_rest);
  const double closure = std::acos(w / p);
  check_slope(of(found, "gap_closure_angle_deg"), w / (p * p * std::sin(closure)));
  check_slope(of(found, "bending_warp_N_mm"), -here.at[0][index_of("bending_warp_N_mm")] / p);
  const ArcPath path = heddle::test::table1().crossing.tow[0].path;
  const double crimp_slope = std::cos(path.angle) / p - path.length() / (p * p);
  check_slope(of(found, "crimp_warp"), crimp_slope);
  // Two directions of tows of one linear density and length l a pitch: m = 2 q l / p^2.
  const double q = base.weave.linear_density;
  check_slope(of(found, "areal_density_kg_m2"),
              2.0 * q * (std::cos(path.angle) / (p * p) - 2.0 * path.length() / (p * p * p)));
}

TEST_CASE("sensitivities to width and thickness are the slopes of the closed forms", "[study][derivative][slow]") {
  const CellSpec base;
  const double w = base.weave.tow_width, g = base.weave.gap, p = w + g, t = base.weave.tow_thickness;
  const double closure = std::acos(w / p);
  const auto width = sensitivities_of(base, StudySpec{}, Dimension::tow_width);
  check_slope(of(width, "gap_closure_angle_deg"), -g / (p * p * std::sin(closure)));
  const auto thickness = sensitivities_of(base, StudySpec{}, Dimension::tow_thickness);
  CHECK(of(thickness, "gap_closure_angle_deg").slope == 0.0);
  // A tow in a lens of small angles: the glass fraction is A_f over 2/3 w t, to first order in t / w.
  const CellProperties here = cell_properties(base, {}, at_rest);
  const double fraction = here.at[0][index_of("tow_fibre_fraction")];
  CHECK(of(thickness, "tow_fibre_fraction").slope == Approx(-fraction / t).epsilon(0.05));
  CHECK(of(width, "tow_fibre_fraction").slope == Approx(-fraction / w).epsilon(0.05));
}

TEST_CASE("the error that central differences state is that of second order", "[study][convergence][slow]") {
  const CellSpec base;
  StudySpec coarse, fine;
  coarse.step = 0.04;
  fine.step = 0.02;
  for (const std::string key : {"crimp_warp", "gap_closure_angle_deg", "areal_density_kg_m2"}) {
    const Sensitivity a = of(sensitivities_of(base, coarse, Dimension::gap), key);
    const Sensitivity b = of(sensitivities_of(base, fine, Dimension::gap), key);
    CAPTURE(key, a.error, b.error);
    CHECK(std::log2(a.error / b.error) == Approx(2.0).margin(0.35));
  }
}

TEST_CASE("a balanced weave answers alike along warp and weft, and every number of it is finite", "[study]") {
  const std::vector<double> angles{0.0, heddle::test::radians(25.0), heddle::test::radians(45.0)};
  solid::SolidSpec solid;
  solid.grid = {.per_pitch = 8, .layers = 6};
  const CellProperties found = cell_properties(CellSpec{}, solid, angles);
  REQUIRE(found.at.size() == angles.size());
  for (const auto& row : found.at) {
    for (const double value : row) CHECK(std::isfinite(value));
    CHECK(row[index_of("crimp_warp")] == row[index_of("crimp_weft")]);
    CHECK(row[index_of("tension_warp_N_per_mm")] ==
          Approx(row[index_of("tension_weft_N_per_mm")]).epsilon(1e-9));
  }
  CHECK(found.at[0][index_of("solid_A11_GPa")] ==
        Approx(found.at[0][index_of("solid_A22_GPa")]).epsilon(1e-4));
  CHECK(found.at[0][index_of("shear_flow_N_per_mm")] == Approx(0.0).margin(1e-9));
  // Sheared cloth covers less ground with the same mass.
  CHECK(found.at[2][0] == Approx(found.at[0][0] / std::cos(angles[2])).epsilon(1e-12));
}

TEST_CASE("one at a time makes each change by itself, crossed every combination, none of them twice",
          "[study]") {
  const CellSpec base;
  StudySpec spec;
  spec.patterns = {"twill 2/2", "plain"};  // the second is the weave given
  spec.values[1] = {0.5e-3, 1e-3};
  spec.values[2] = {0.7e-3};
  const std::vector<StudyPoint> single = points(base, spec);
  REQUIRE(single.size() == 1 + 1 + 2 + 1);
  CHECK(single[0].cell.weave == base.weave);
  CHECK(single[2].cell.weave.gap == 0.5e-3);
  CHECK(single[2].cell.weave.pattern == "plain");
  CHECK(single[4].cell.weave.fabric_thickness == Approx(1.4e-3).epsilon(1e-12));  // it follows the tows
  spec.design = Design::crossed;
  const std::vector<StudyPoint> all = points(base, spec);
  CHECK(all.size() == 2 * 3 * 2);
  for (std::size_t i = 0; i < all.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) CHECK_FALSE(all[i] == all[j]);
}

TEST_CASE("a length changes in both directions where tows have their own", "[study]") {
  CellSpec base;
  base.weave.own[0] = {3.2e-3, 0.5e-3, 0.6e-3, 1100e-6};
  base.weave.own[1] = {5.1e-3, 1.1e-3, 0.9e-3, 2400e-6};
  const CellSpec thicker = changed(base, Dimension::tow_thickness, 0.01e-3);
  CHECK(thicker.weave.tow(0).thickness == Approx(0.61e-3));
  CHECK(thicker.weave.tow(1).thickness == Approx(0.91e-3));
  CHECK(check(thicker).empty());
  CHECK(thicker.weave.tow(0).width == base.weave.tow(0).width);
}

TEST_CASE("a study that cannot be is refused under its own keys with the numbers that clash", "[study]") {
  const CellSpec base;
  StudySpec spec;
  spec.values[1] = {5e-3};  // wider apart than the tows are wide
  Problems problems = check(spec, base);
  REQUIRE(rules(problems) == std::vector<std::string>{"study.gap.weave"});
  CHECK(problems[0].rule.find("weave.gap = 5 mm") != std::string::npos);
  CHECK(problems[0].rule.find("4.64 mm") != std::string::npos);

  spec = {};
  spec.patterns = {"twill 0/2"};
  CHECK(rules(check(spec, base)) == std::vector<std::string>{"study.pattern.weave"});

  spec = {};
  CellSpec tight = base;
  tight.weave.gap = 0.01e-3;  // a step of 0.046 mm leads to tows that overlap
  CHECK(rules(check(spec, tight)) == std::vector<std::string>{"study.step.weave"});
  spec.sensitivities = false;
  CHECK(check(spec, tight).empty());

  spec.values[0] = {4e-3};
  CellSpec own = base;
  own.weave.own[1].tow_width = 4.5e-3;
  CHECK(rules(check(spec, own)) == std::vector<std::string>{"study.tow_width.hidden"});

  spec = {};
  spec.design = Design::crossed;
  for (auto& values : spec.values)
    for (int k = 0; k < 20; ++k) values.push_back(1e-3 * k);
  CHECK(rules(check(spec, base)).front() == "study.design.cells");
}
