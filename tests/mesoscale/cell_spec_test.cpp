#include "mesoscale/cell_spec.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <limits>
#include <string>

#include "mesoscale/forming.h"
#include "table1.h"

using namespace heddle;
using namespace heddle::mesoscale;
using heddle::test::degrees;

namespace {

struct Wrong {
  std::string id;
  std::function<void(CellSpec&)> spoil;
};

const std::vector<Wrong>& wrong_specs() {
  static const std::vector<Wrong> list{
      {"weave.pattern.unknown", [](CellSpec& s) { s.weave.pattern = "knit"; }},
      {"weave.tow_width.range", [](CellSpec& s) { s.weave.tow_width = 0.0; }},
      {"weave.gap.range", [](CellSpec& s) { s.weave.gap = 0.75; }},
      {"weave.tow_thickness.range", [](CellSpec& s) { s.weave.tow_thickness = -1e-3; }},
      {"weave.linear_density.range", [](CellSpec& s) { s.weave.linear_density = 0.0; }},
      {"weave.fibre_mass_fraction.range", [](CellSpec& s) { s.weave.fibre_mass_fraction = 60.0; }},
      {"weave.fibre_density.range", [](CellSpec& s) { s.weave.fibre_density = 2.55; }},
      {"weave.resin_density.range", [](CellSpec& s) { s.weave.resin_density = 0.0; }},
      {"weave.fibre_modulus.range", [](CellSpec& s) { s.weave.fibre_modulus = -1.0; }},
      {"weave.fibre_diameter.range", [](CellSpec& s) { s.weave.fibre_diameter = 18.5; }},
      {"weave.warp.tow_width.range", [](CellSpec& s) { s.weave.own[0].tow_width = 0.0; }},
      {"weave.weft.gap.range", [](CellSpec& s) { s.weave.own[1].gap = -1e-3; }},
      {"weave.weft.tow_thickness.range", [](CellSpec& s) { s.weave.own[1].tow_thickness = 0.75; }},
      {"weave.warp.linear_density.range", [](CellSpec& s) { s.weave.own[0].linear_density = 1872.0; }},
      {"weave.warp.tow_width.proportion", [](CellSpec& s) { s.weave.own[0].tow_width = 1.2e-3; }},
      {"weave.weft.gap.proportion", [](CellSpec& s) { s.weave.own[1].gap = 5e-3; }},
      {"weave.warp.tow_thickness.holds_material",
       [](CellSpec& s) {
         s.weave.own[0].tow_thickness = 0.35e-3;
         s.weave.fabric_thickness = 1.1e-3;
       }},
      {"weave.warp.tow_thickness.balance",
       [](CellSpec& s) {
         s.weave.own = {OwnTow{{}, {}, 1.2e-3, {}}, OwnTow{{}, {}, 0.2e-3, 200e-6}};
         s.weave.fabric_thickness = 1.4e-3;
       }},
      {"weave.section_power.range", [](CellSpec& s) { s.weave.section_power = 0.0; }},
      {"weave.section_cap.range", [](CellSpec& s) { s.weave.section_cap = 0.0; }},
      {"weave.upper_share.range", [](CellSpec& s) { s.weave.upper_share = 0.05; }},
      {"weave.upper.section_power.range", [](CellSpec& s) { s.weave.upper.section_power = 5.0; }},
      {"weave.upper.section_cap.range", [](CellSpec& s) { s.weave.upper.section_cap = 1.1; }},
      {"weave.lower.section_power.range", [](CellSpec& s) { s.weave.lower.section_power = 0.1; }},
      {"weave.lower.section_cap.range", [](CellSpec& s) { s.weave.lower.section_cap = 0.0; }},
      {"weave.pattern.falls_apart", [](CellSpec& s) { s.weave.pattern = "matrix 10/10"; }},
      {"weave.fabric_thickness.consistent", [](CellSpec& s) { s.weave.fabric_thickness = 1.2e-3; }},
      {"weave.tow_thickness.holds_material", [](CellSpec& s) { s.weave.linear_density = 4000e-6; }},
      {"weave.fibre_mass_fraction.packing",
       [](CellSpec& s) {
         s.weave.fibre_mass_fraction = 0.9;
         s.weave.linear_density = 5200e-6;
         s.weave.resin_density = 5000.0;
       }},
      {"resin.consistency.range", [](CellSpec& s) { s.resin.consistency = 0.0; }},
      {"resin.power_index.range", [](CellSpec& s) { s.resin.power_index = 1.7; }},
      {"resin.film_thickness.range", [](CellSpec& s) { s.resin.film_thickness = 0.0; }},
      {"resin.activation_energy.range", [](CellSpec& s) { s.resin.activation_energy = -1.0; }},
      {"resin.reference_temperature.range", [](CellSpec& s) { s.resin.reference_temperature = 0.0; }},
      {"forming.compaction_modulus.range", [](CellSpec& s) { s.forming.compaction_modulus = 0.0; }},
      {"forming.compaction_exponent.range", [](CellSpec& s) { s.forming.compaction_exponent = 1.0; }},
      {"forming.gutowski_spring.range",
       [](CellSpec& s) {
         s.forming.compaction = CompactionChoice::gutowski;
         s.forming.gutowski_spring = 0.0;
       }},
      {"forming.gutowski_available.range",
       [](CellSpec& s) {
         s.forming.compaction = CompactionChoice::gutowski;
         s.forming.gutowski_available = 0.8;
       }},
      {"forming.tow_friction.range", [](CellSpec& s) { s.forming.tow_friction = -0.1; }},
      {"weave.tow_width.proportion", [](CellSpec& s) { s.weave.tow_width = 90e-3; }},
      {"weave.gap.proportion", [](CellSpec& s) { s.weave.gap = 20e-3; }},
      {"forming.reference_tension.range", [](CellSpec& s) { s.forming.reference_tension = 0.0; }},
      {"forming.in_tow_shear_share.range", [](CellSpec& s) { s.forming.in_tow_shear_share = 1.2; }},
      {"forming.bonding.range", [](CellSpec& s) { s.forming.bonding = -0.5; }},
      {"forming.compression_ratio.range", [](CellSpec& s) { s.forming.compression_ratio = 0.0; }},
  };
  return list;
}

bool has(const Problems& problems, const std::string& id) {
  return std::any_of(problems.begin(), problems.end(), [&](const Problem& p) { return p.id == id; });
}

}  // namespace

TEST_CASE("Table 1 has no problem", "[cell]") {
  CHECK(check(CellSpec{}).empty());
}

TEST_CASE("every rule of the cell is met by one wrong value, and tells the way out", "[cell]") {
  for (const Wrong& wrong : wrong_specs()) {
    CAPTURE(wrong.id);
    CellSpec spec;
    wrong.spoil(spec);
    const Problems problems = check(spec);
    REQUIRE(has(problems, wrong.id));
    for (const Problem& problem : problems) {
      CHECK_FALSE(problem.rule.empty());
      CHECK_FALSE(problem.way_out.empty());
      CHECK(problem.id.text().starts_with(problem.key));
    }
    CHECK_THROWS_AS(analyse(spec), InputError);
  }
}

TEST_CASE("a NaN breaks the rule of its key", "[cell]") {
  CellSpec spec;
  spec.weave.gap = std::numeric_limits<double>::quiet_NaN();
  spec.resin.power_index = std::numeric_limits<double>::quiet_NaN();
  spec.weave.fabric_thickness = std::numeric_limits<double>::quiet_NaN();
  CHECK(has(check(spec), "weave.gap.range"));
  CHECK(has(check(spec), "resin.power_index.range"));
  CHECK(has(check(spec), "weave.fabric_thickness.range"));
}

TEST_CASE("all problems come at once", "[cell]") {
  CellSpec spec;
  spec.weave.pattern = "knit";
  spec.weave.gap = -1.0;
  spec.resin.power_index = 0.0;
  spec.forming.bonding = 2.0;
  CHECK(check(spec).size() == 4);
}

TEST_CASE("the stage answers for Table 1 with the figures of the paper's fabric", "[cell][paper]") {
  const CellResult result = analyse(CellSpec{});
  const CellSummary& s = result.summary;
  CHECK(s.areal_density == Approx(0.703).epsilon(0.005));
  CHECK(100.0 * s.crimp[0] == Approx(1.156).margin(0.005));
  CHECK(s.crimp[1] == s.crimp[0]);
  CHECK(degrees(s.gap_closure_angle) == Approx(30.59).margin(0.05));
  CHECK(100.0 * s.contact_area_fraction == Approx(8.16).margin(0.05));
  CHECK(s.consolidated_thickness == Approx(0.476e-3).margin(1e-6));
  CHECK(s.tow_fibre_volume_fraction == Approx(0.19).margin(0.005));
  CHECK(degrees(s.locking_angle) == Approx(47.5).margin(2.5));
  CHECK(result.fabric.thickness == 1.5e-3);
  CHECK(result.fabric.pitch[0] == Approx(5.39e-3));
  CHECK(check(result.fabric).empty());
  CHECK(result.fabric.provenance.grid_error < 2e-3);
  CHECK_FALSE(result.fabric.provenance.unverified.empty());
}

TEST_CASE("the same specification gives the same bits", "[cell]") {
  const FabricProperties a = analyse(CellSpec{}).fabric, b = analyse(CellSpec{}).fabric;
  CHECK(a.tension_energy.values() == b.tension_energy.values());
  CHECK(a.shear_stress.y() == b.shear_stress.y());
  for (std::size_t k = 0; k < a.compaction.curves().size(); ++k) {
    CHECK(a.compaction.curves()[k].y() == b.compaction.curves()[k].y());
    CHECK(a.contact.log_fraction.curves()[k].y() == b.contact.log_fraction.curves()[k].y());
  }
}

TEST_CASE("every value of the specification enters its hash", "[cell]") {
  const std::string base = specification_hash(CellSpec{});
  CHECK(base.size() == 16);
  CHECK(base == specification_hash(CellSpec{}));
  CellSpec state;
  state.state = CellState::consolidated;
  CHECK(specification_hash(state) != base);
  for (const Wrong& wrong : wrong_specs()) {
    CellSpec spec;
    wrong.spoil(spec);
    CAPTURE(wrong.id);
    CellSpec usual;  // with the same law: numbers of a law that is not chosen change nothing
    usual.forming.compaction = spec.forming.compaction;
    CHECK(specification_hash(spec) != specification_hash(usual));
  }
}

TEST_CASE("every weave and state passes the rules of the hand-over", "[cell][slow]") {
  const std::string pattern = GENERATE("plain", "twill 2/2", "satin 8/3");
  const CellState state = GENERATE(CellState::as_woven, CellState::consolidated);
  CellSpec spec;
  spec.weave.pattern = pattern;
  spec.state = state;
  CAPTURE(pattern);
  CHECK(check(analyse(spec).fabric).empty());
}
