// What the cache keeps of a friction model: every number of every law, rheology and effect.
#include <catch2/catch.hpp>

#include "pipeline/friction_store.h"
#include "pipeline/stage_store.h"
#include "tests/friction/every_model.h"

using namespace heddle;
using namespace heddle::test;

namespace {

std::string bytes_of(const friction::Model& model) {
  Hdf5Writer file;
  pipeline::write_model(file, model);
  return file.finish();
}

friction::Model again(const friction::Model& model) {
  return pipeline::read_model(Hdf5Reader(bytes_of(model)));
}

/// mu as the model gives it at a contact that has slipped.
double coefficient(const friction::Model& model) {
  return friction::evaluate_unchecked(model, contact_at(0.013, 1.4e5, 451.0, 371.0), used_contact()).mu;
}

/// Every number moved off its default, so that one left out shows.
template <class Term>
void move_numbers(Term& term) {
  for (const auto& field : friction::About<Term>::fields) term.*(field.member) *= 1.0 + 1.0 / 1024.0;
}

friction::Model sample() {
  friction::Model model;
  model.film.thickness = 0.069e-3;
  model.box = {0.03, 1.5, 1e4, 3e5, 1e-3, 0.1};
  return model;
}

}  // namespace

TEST_CASE("every law, rheology and effect comes out of the cache with its bits",
          "[pipeline][cache][friction]") {
  const auto check_kept = [](const friction::Model& model) {
    const friction::Model kept = again(model);
    CHECK(bytes_of(kept) == bytes_of(model));
    CHECK(coefficient(kept) == coefficient(model));
  };
  for (friction::Law law : every_law())
    for (const friction::Rheology& rheology : every_rheology()) {
      friction::Model model = sample();
      std::visit([](auto& l) { move_numbers(l); }, law);
      model.law = law;
      model.rheology = rheology;
      CAPTURE(friction::id_of(law), rheology.flow.index(), rheology.temperature.index());
      check_kept(model);
    }
  friction::Model heated = sample();
  friction::FilmConductionSpec spec{.contact_resistance = 3e-4};
  move_numbers(spec);
  heated.law = friction::HerseyPower{.scale = 0.325, .exponent = 0.136};
  heated.conduction = friction::film_conduction(spec, 0.069e-3);
  heated.effects.tool_temperature_film = friction::ToolTemperatureFilm{.weight = 0.9, .settling = 0.05};
  heated.effects.shear_heating = friction::ShearHeating{.amplitude = 1.0};
  check_kept(heated);
  for (const NamedEffect& effect : every_effect()) {
    friction::Model model = sample();
    model.law = friction::HerseyPower{.scale = 0.325, .exponent = 0.136};
    const friction::Model baseline = model;
    const std::string plain = bytes_of(baseline);
    effect.set(model.effects, effect.usual);
    friction::for_each_effect(model.effects, [](auto& e) {
      if (e) move_numbers(*e);
    });
    CAPTURE(effect.id);
    check_kept(model);
    CHECK(bytes_of(model) != plain);
    CHECK(coefficient(again(model)) != coefficient(baseline));
    // Off but there is kept as such: the report names it.
    effect.set(model.effects, 0.0);
    check_kept(model);
    CHECK(bytes_of(model) != plain);
  }
}

TEST_CASE("the choices of a term that are no numbers are kept", "[pipeline][cache][friction]") {
  friction::Model model = sample();
  model.law = friction::SlipResistance{.evolution = friction::SlipResistance::Evolution::inside};
  model.effects.tool_temperature_shift =
      friction::ToolTemperatureShift{.slope = -1e-3, .form = friction::ToolTemperatureShift::Form::factor};
  model.effects.orientation =
      friction::Orientation{.amplitude = 0.2, .form = friction::Orientation::Form::trellis};
  const friction::Model kept = again(model);
  CHECK(kept.effects.orientation->form == friction::Orientation::Form::trellis);
  CHECK(std::get<friction::SlipResistance>(kept.law).evolution ==
        friction::SlipResistance::Evolution::inside);
  CHECK(kept.effects.tool_temperature_shift->form == friction::ToolTemperatureShift::Form::factor);
}

TEST_CASE("the rig's pulls, histories and plates come out of the cache with their bits",
          "[pipeline][cache][friction]") {
  pipeline::FrictionRigStage stage;
  stage.rows.resize(2);
  stage.rows[0] = {.name = "first, of two",
                   .velocity = 0.017,
                   .normal_force = 1500.0,
                   .law_force = 850.0,
                   .peak_force = 1001.0,
                   .peak_displacement = 1e-4,
                   .steady_force = 849.0,
                   .steady_coefficient = 0.283,
                   .normal_force_loss = 0.1,
                   .film_temperature = 361.0,
                   .element_force = 848.0,
                   .measured_force = 843.0,
                   .paper_force = 804.0};
  stage.rows[1] = {.name = "S",
                   .tool_temperature = 360.0,
                   .fabric_temperature = 450.0,
                   .orientation = 0.5,
                   .curved = true};
  stage.history = {{"first, of two", 0.1, 0.01, 5.0, 1499.0, 0.2, 400.0},
                   {"first, of two", 0.2, 0.02, 6.0, 1498.0, 0.21, 399.0},
                   {"S", 0.3, 0.03, 7.0, 1497.0, 0.22, 398.0}};
  stage.plates = {{"flat", 2, 3, 0.05, 0.04, {1, 2, 3, 4, 5, 6}, {6, 5, 4, 3, 2, 1}}};
  stage.notes = {"a note"};
  const std::string bytes = pipeline::bytes_of(stage, "key");
  const auto back = pipeline::read_friction_rig_stage(Hdf5Reader(bytes));
  CHECK((pipeline::bytes_of(back, "key") == bytes));
  REQUIRE(back.rows.size() == 2);
  CHECK(back.rows[0].name == "first, of two");
  CHECK(back.rows[0].film_temperature == 361.0);
  CHECK(back.rows[1].curved);
  CHECK_FALSE(back.rows[1].steady_force);
  REQUIRE(back.history.size() == 3);
  CHECK(back.history[1].pull_force == 6.0);
  CHECK(back.history[2].name == "S");
  CHECK(back.plates[0].upper[1] == 5.0);
  CHECK(back.notes == stage.notes);
  CHECK(friction_rig_csv(back.rows) == friction_rig_csv(stage.rows));
}

TEST_CASE("a law of another program is refused", "[pipeline][cache][friction][wrong input]") {
  Hdf5Writer file;
  file.write("/law/name", "ohm");
  const std::string bytes = file.finish();
  CHECK_THROWS_AS(pipeline::read_model(Hdf5Reader(bytes)), Hdf5Error);
}
