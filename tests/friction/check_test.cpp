#include <algorithm>
#include <catch2/catch.hpp>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "friction/friction_test.h"
#include "friction/model.h"

using namespace heddle;
using namespace heddle::friction;

namespace {

const double not_a_number = std::numeric_limits<double>::quiet_NaN();

Model sound_model() {
  return {.law = HerseyPower{.scale = 0.325, .exponent = 0.136},
          .film = {},
          .effects = {.tool_temperature_shift = ToolTemperatureShift{.slope = -9.7e-4}},
          .box = {.hersey_low = 0.18, .hersey_high = 0.51}};
}

FrictionTestRow sound_row() {
  return {.name = "baseline",
          .velocity = 16.67e-3,
          .normal_force = 1500.0,
          .measured_force = 843.0,
          .paper_model_force = {}};
}

/// One rule broken: which rule says so, at which key.
template <class T>
struct Fault {
  std::string id;
  std::string key;
  std::function<void(T&)> break_it;
};

void check_one_problem(const Problems& problems, const std::string& id, const std::string& key) {
  CAPTURE(id);
  REQUIRE(problems.size() == 1);
  CHECK(problems[0].id == id);
  CHECK(problems[0].key == key);
  CHECK_FALSE(problems[0].rule.empty());
  CHECK_FALSE(problems[0].way_out.empty());
}

}  // namespace

TEST_CASE("a sound model, rig and row have no problems", "[friction][wrong input]") {
  CHECK(check(sound_model()).empty());
  CHECK(check(FrictionRig{}).empty());
  const std::vector rows{sound_row()};
  CHECK(check(rows, true).empty());
}

TEST_CASE("each rule of the model is met by one bad value", "[friction][wrong input]") {
  const std::vector<Fault<Model>> faults{
      {"resin.consistency.range", "resin.consistency", [](Model& m) { m.film.consistency = 0.0; }},
      {"resin.consistency.range", "resin.consistency", [](Model& m) { m.film.consistency = not_a_number; }},
      {"resin.power_index.range", "resin.power_index", [](Model& m) { m.film.index = 1.7; }},
      {"resin.power_index.range", "resin.power_index", [](Model& m) { m.film.index = 0.0; }},
      {"resin.film_thickness.range", "resin.film_thickness", [](Model& m) { m.film.thickness = 0.07; }},
      {"resin.film_thickness.range", "resin.film_thickness", [](Model& m) { m.film.thickness = -7e-5; }},
      {"resin.activation_energy.range", "resin.activation_energy",
       [](Model& m) { m.film.activation_energy = -1.0; }},
      {"resin.activation_energy.range", "resin.activation_energy",
       [](Model& m) { m.film.activation_energy = 42e6; }},
      {"resin.reference_temperature.range", "resin.reference_temperature",
       [](Model& m) { m.film.reference_temperature = 0.0; }},
      {"resin.rate_floor.range", "resin.rate_floor", [](Model& m) { m.film.rate_floor = 0.0; }},
      {"friction.coefficient.range", "friction.coefficient", [](Model& m) { m.law = Coulomb{-0.1}; }},
      {"friction.coefficient.range", "friction.coefficient", [](Model& m) { m.law = Coulomb{30.0}; }},
      {"friction.scale.range", "friction.scale",
       [](Model& m) {
         m.law = HerseyPower{0.0, 0.1};
       }},
      {"friction.exponent.range", "friction.exponent",
       [](Model& m) {
         m.law = HerseyPower{0.3, 1.0};
       }},
      {"friction.exponent.range", "friction.exponent",
       [](Model& m) {
         m.law = HerseyPower{0.3, not_a_number};
       }},
      {"friction.reference_hersey.range", "friction.reference_hersey",
       [](Model& m) {
         m.law = HerseyLinear{0.24, 0.04, -1.0};
       }},
      {"friction.offset.positive", "friction.offset",
       [](Model& m) {
         m.law = HerseyLinear{-0.1, 0.04, 0.36};
       }},
      {"friction.offset.positive", "friction.offset",
       [](Model& m) {
         m.law = HerseyLinear{0.24, -0.2, 0.36};
       }},
      {"friction.calibration.box_order", "friction.box", [](Model& m) { m.box.pressure_low = 1e301; }},
      {"friction.calibration.box_order", "friction.box", [](Model& m) { m.box.speed_low = -1.0; }},
      {"effects.tool_temperature_shift.slope.range", "effects.tool_temperature_shift.slope",
       [](Model& m) { m.effects.tool_temperature_shift->slope = -0.927; }},
      {"effects.tool_temperature_shift.slope.range", "effects.tool_temperature_shift.slope",
       [](Model& m) { m.effects.tool_temperature_shift->slope = not_a_number; }},
      {"effects.tool_temperature_shift.reference.range", "effects.tool_temperature_shift.reference",
       [](Model& m) { m.effects.tool_temperature_shift->reference = 0.0; }},
  };
  for (const auto& [id, key, break_it] : faults) {
    Model model = sound_model();
    break_it(model);
    check_one_problem(check(model), id, key);
  }
}

TEST_CASE("all problems of a model come at once", "[friction][wrong input]") {
  Model model = sound_model();
  model.film.index = 1.7;
  model.film.thickness = 0.0;
  model.law = HerseyPower{-1.0, 2.0};
  CHECK(check(model).size() == 4);
}

TEST_CASE("a film that the law does not use is not looked at", "[friction][wrong input]") {
  Model model{.law = Coulomb{0.3}, .film = {}, .effects = {}, .box = {}};
  model.film.index = 1.7;
  CHECK(check(model).empty());
}

TEST_CASE("each rule of the rig is met by one bad value", "[friction][wrong input]") {
  const std::string area = "friction.calibration.plate_area.range",
                    band = "friction.calibration.plate_area_band.order";
  const std::string area_key = "friction.calibration.plate_area",
                    band_key = "friction.calibration.plate_area_band";
  check_one_problem(check(FrictionRig{.plate_area = 0.01, .plate_area_band = {0.02, 0.005}}), band, band_key);
  check_one_problem(check(FrictionRig{.plate_area = 0.01, .plate_area_band = {0.012, 0.02}}), band, band_key);
  check_one_problem(check(FrictionRig{.plate_area = 0.01, .plate_area_band = {0.0, 0.02}}), band, band_key);
  const Problems zero_area = check(FrictionRig{.plate_area = 0.0});  // the band cannot hold it either
  REQUIRE(zero_area.size() == 2);
  CHECK(zero_area[0].id == area);
  CHECK(zero_area[0].key == area_key);
  CHECK(check(FrictionRig{.plate_area = 100.0})[0].id == area);  // cm^2 taken for m^2
  CHECK(check(FrictionRig{.plate_area = not_a_number})[0].id == area);
}

TEST_CASE("each rule of a friction test row is met by one bad value", "[friction][wrong input]") {
  const std::vector<Fault<FrictionTestRow>> faults{
      {"friction.test.velocity.range", "row baseline, velocity", [](auto& r) { r.velocity = 0.0; }},
      {"friction.test.normal_force.range", "row baseline, normal_force",
       [](auto& r) { r.normal_force = -1.0; }},
      {"friction.test.tool_temperature.range", "row baseline, tool_temperature",
       [](auto& r) { r.tool_temperature = -10.0; }},
      {"friction.test.fabric_temperature.range", "row baseline, fabric_temperature",
       [](auto& r) { r.fabric_temperature = not_a_number; }},
      {"friction.test.measured_force.range", "row baseline, measured_force",
       [](auto& r) { r.measured_force = 0.0; }},
      {"friction.test.measured_force.missing", "row baseline, force_measured_N",
       [](auto& r) { r.measured_force.reset(); }},
  };
  for (const auto& [id, key, break_it] : faults) {
    std::vector rows{sound_row()};
    break_it(rows[0]);
    check_one_problem(check(rows, true), id, key);
  }
  check_one_problem(check(std::vector<FrictionTestRow>{}, false), "friction.test.empty", "data");
}

TEST_CASE("a row without measurement is sound where none is needed", "[friction][wrong input]") {
  std::vector rows{sound_row()};
  rows[0].measured_force.reset();
  CHECK(check(rows, false).empty());
}

TEST_CASE("a friction test table is refused with every problem and its line", "[friction][wrong input]") {
  const std::string header = "case,velocity_mm_s,normal_force_N,tool_temperature_C,fabric_temperature_C\n";
  const auto problems_of = [](const std::string& text) {
    try {
      parse_friction_table(text, "bad.csv");
    } catch (const InputError& error) {
      return error.problems();
    }
    return Problems{};
  };
  const auto ids = [](const Problems& problems) {
    std::vector<std::string> list;
    for (const Problem& problem : problems) list.push_back(problem.id);
    return list;
  };
  using Ids = std::vector<std::string>;

  CHECK(ids(problems_of(header + "a,1,2,3,4\n")).empty());
  CHECK(ids(problems_of("")) == Ids{"csv.empty"});
  CHECK(ids(problems_of("# only a comment\n\n")) == Ids{"csv.empty"});
  CHECK(ids(problems_of("case,velocity_mm_s,normal_force_N,tool_temperature_C\n")) ==
        Ids{"friction.table.column.missing"});
  CHECK(ids(problems_of("case," + header)) == Ids{"friction.table.column.twice"});
  CHECK(ids(problems_of("speed," + header)) == Ids{"friction.table.column.unknown"});

  const Problems two = problems_of(header + "a,1,2,3\nb,fast,2,3,\n");
  REQUIRE(ids(two) == Ids{"csv.cells", "friction.table.number", "friction.table.number"});
  CHECK(two[0].line == 2);
  CHECK(two[1].line == 3);
  CHECK(two[1].key == "velocity_mm_s");
  CHECK(two[1].value == "fast");
  CHECK(two[1].file == "bad.csv");
  CHECK(two[2].key == "fabric_temperature_C");

  CHECK_THROWS_AS(read_friction_table("no/such/table.csv"), InputError);
}
