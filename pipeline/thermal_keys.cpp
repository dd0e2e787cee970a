#include "pipeline/thermal_keys.h"

#include <fmt/format.h>

#include "mesoscale/state.h"
#include "pipeline/case_rules.h"
#include "pipeline/key_table.h"

namespace heddle::pipeline {
namespace {

using macroscale::thermal::ThermalSpec;

void take(const Settings& settings, const std::string& path, double& value) {
  if (settings.has(path)) value = settings.number(path);
}

void take(const Settings& settings, const std::string& path, std::optional<double>& value) {
  if (settings.has(path)) value = settings.number(path);
}

}  // namespace

// A table reads better in rows than one field a line.
// clang-format off
std::vector<Key> thermal_keys() {
  std::vector<Key> keys{
      {.path = "thermal.ply.conductivity", .type = KeyType::quantity, .unit = "W/(m K)", .presence = defaulted,
       .default_text = "0.35 W/(m K)", .range = "(0 W/(m K), 1000 W/(m K)]",
       .help = "Through the thickness of the ply without voids; derived from recalled values."},
      {.path = "thermal.ply.density", .type = KeyType::quantity, .unit = "kg/m^3", .presence = defaulted,
       .default_text = "1484 kg/m^3", .range = "[100 kg/m^3, 30000 kg/m^3]", .help = "Of the ply without voids."},
      {.path = "thermal.ply.specific_heat", .type = KeyType::quantity, .unit = "J/(kg K)", .presence = defaulted,
       .default_text = "1600 J/(kg K)", .range = "[100 J/(kg K), 10000 J/(kg K)]",
       .help = "Of the molten ply; derived from recalled values."},
      {.path = "thermal.film.conductivity", .type = KeyType::quantity, .unit = "W/(m K)", .presence = defaulted,
       .default_text = "0.19 W/(m K)", .range = "(0 W/(m K), 1000 W/(m K)]",
       .help = "Of the melt on the faces; polypropylene 0.17 to 0.20 W/(m K) (recalled). Its thickness is resin.film_thickness."},
      {.path = "thermal.film.density", .type = KeyType::quantity, .unit = "kg/m^3", .presence = defaulted,
       .default_text = "760 kg/m^3", .range = "[100 kg/m^3, 30000 kg/m^3]",
       .help = "Of the melt; polypropylene at 200 degC 750 to 770 kg/m^3 (recalled)."},
      {.path = "thermal.film.specific_heat", .type = KeyType::quantity, .unit = "J/(kg K)", .presence = defaulted,
       .default_text = "2600 J/(kg K)", .range = "[100 J/(kg K), 10000 J/(kg K)]",
       .help = "Of the melt; polypropylene 2500 to 2700 J/(kg K) (recalled)."},
      {.path = "thermal.latent_heat", .type = KeyType::quantity, .unit = "kJ/kg", .presence = defaulted,
       .default_text = "99 kJ/kg", .range = "[0 kJ/kg, 1000 kJ/kg]",
       .help = "Of all crystals that form, per mass of resin; 207 kJ/kg x 0.48 (recalled)."},
      {.path = "thermal.crystallisation.rate", .type = KeyType::quantity, .unit = "1/s", .presence = defaulted,
       .default_text = "0.55 1/s", .range = "[0 1/s, 1000 1/s]",
       .help = "Largest rate of Nakamura's law; polypropylene (recalled). 0 1/s: the melt stays a melt."},
      {.path = "thermal.crystallisation.peak_temperature", .type = KeyType::quantity, .unit = "degC", .presence = defaulted,
       .default_text = "65 degC", .range = "[-100 degC, 500 degC]", .help = "Where it is largest (recalled)."},
      {.path = "thermal.crystallisation.width", .type = KeyType::quantity, .unit = "K", .presence = defaulted,
       .default_text = "49.3 K", .range = "[1 K, 500 K]",
       .help = "Of the bell at half its height; set so that 10 K/min give a peak at 118 degC."},
      {.path = "thermal.crystallisation.exponent", .type = KeyType::quantity, .presence = defaulted,
       .default_text = "3", .range = "[1, 6]", .help = "Avrami's n; 3: spheres from nuclei that are there."},
      {.path = "thermal.contact.light", .type = KeyType::quantity, .unit = "W/(m^2 K)", .presence = defaulted,
       .default_text = "500 W/(m^2 K)", .range = "(0 W/(m^2 K), 1000000 W/(m^2 K)]",
       .help = "Conductance of a tool that barely touches; prior."},
      {.path = "thermal.contact.full", .type = KeyType::quantity, .unit = "W/(m^2 K)", .presence = defaulted,
       .default_text = "3000 W/(m^2 K)", .range = "(0 W/(m^2 K), 1000000 W/(m^2 K)]",
       .help = "Of one pressed on hard; prior."},
      {.path = "thermal.contact.pressure", .type = KeyType::quantity, .unit = "kPa", .presence = defaulted,
       .default_text = "100 kPa", .range = "(0 kPa, 1000000 kPa]",
       .help = "At which it has come 63 % of the way; prior."},
      {.path = "thermal.air.temperature", .type = KeyType::quantity, .unit = "degC", .presence = defaulted,
       .default_text = "25 degC", .range = "[-100 degC, 500 degC]", .help = "Of air and walls."},
      {.path = "thermal.air.convection", .type = KeyType::quantity, .unit = "W/(m^2 K)", .presence = defaulted,
       .default_text = "10 W/(m^2 K)", .range = "[0 W/(m^2 K), 10000 W/(m^2 K)]", .help = "Of faces that no tool touches; prior: still air."},
      {.path = "thermal.air.emissivity", .type = KeyType::quantity, .presence = defaulted, .default_text = "0.9",
       .range = "[0, 1]", .help = "Of the faces; prior."},
      {.path = "thermal.punch_temperature", .type = KeyType::quantity, .unit = "degC", .presence = optional,
       .range = "[-100 degC, 500 degC]", .help = "Of the punch alone; else process.tool_temperature."},
      {.path = "thermal.die_temperature", .type = KeyType::quantity, .unit = "degC", .presence = optional,
       .range = "[-100 degC, 500 degC]", .help = "Of the die alone."},
      {.path = "thermal.binder_temperature", .type = KeyType::quantity, .unit = "degC", .presence = optional,
       .range = "[-100 degC, 500 degC]", .help = "Of the binder alone."},
      {.path = "thermal.freezing_temperature", .type = KeyType::quantity, .unit = "degC", .presence = defaulted,
       .default_text = "118 degC", .range = "[-100 degC, 500 degC]",
       .help = "Below it resin counts as solid in history, summary and report, and for the end of process.hold; polypropylene crystallises at 110 to 125 degC (recalled)."},
      {.path = "thermal.transfer_time", .type = KeyType::quantity, .unit = "s", .presence = defaulted,
       .default_text = "0 s", .range = "[0 s, 3600 s]",
       .help = "In air on both faces before the punch touches; process.blank_temperature is that before it."},
      {.path = "thermal.friction_heat", .type = KeyType::choice, .presence = defaulted, .default_text = "on",
       .choices = {"on", "off"}, .help = "on: friction warms the film that it shears."},
      {.path = "thermal.refinement", .type = KeyType::integer, .presence = defaulted, .default_text = "1",
       .range = "[1, 16]", .help = "Cells through the thickness, times this."},
  };
  for (Key& key : keys) {
    key.stage = Stage::stamping;
    key.used_when = "thermal";
  }
  return keys;
}
// clang-format on

std::optional<ThermalSpec> thermal_of(const Settings& settings) {
  if (settings.blocks.count("thermal") == 0) return {};
  ThermalSpec spec;
  for (const auto& [layer, material] : {std::pair{"ply", &spec.ply}, std::pair{"film", &spec.film}}) {
    const std::string block = fmt::format("thermal.{}.", layer);
    take(settings, block + "conductivity", material->conductivity);
    take(settings, block + "density", material->density);
    take(settings, block + "specific_heat", material->specific_heat);
  }
  take(settings, "resin.film_thickness", spec.film_thickness);
  if (settings.has("weave.fibre_mass_fraction"))
    spec.resin_mass_fraction = 1.0 - settings.number("weave.fibre_mass_fraction");
  take(settings, "thermal.latent_heat", spec.latent_heat);
  take(settings, "thermal.crystallisation.rate", spec.crystallisation.rate);
  take(settings, "thermal.crystallisation.peak_temperature", spec.crystallisation.peak_temperature);
  take(settings, "thermal.crystallisation.width", spec.crystallisation.width);
  take(settings, "thermal.crystallisation.exponent", spec.crystallisation.exponent);
  take(settings, "thermal.contact.light", spec.contact.light);
  take(settings, "thermal.contact.full", spec.contact.full);
  take(settings, "thermal.contact.pressure", spec.contact.pressure);
  take(settings, "thermal.air.temperature", spec.air.temperature);
  take(settings, "thermal.air.convection", spec.air.convection);
  take(settings, "thermal.air.emissivity", spec.air.emissivity);
  take(settings, "thermal.punch_temperature", spec.punch_temperature);
  take(settings, "thermal.die_temperature", spec.die_temperature);
  take(settings, "thermal.binder_temperature", spec.binder_temperature);
  take(settings, "thermal.freezing_temperature", spec.freezing_temperature);
  take(settings, "thermal.transfer_time", spec.transfer_time);
  spec.friction_heat = !settings.is("thermal.friction_heat", "off");
  if (settings.has("thermal.refinement")) spec.refinement = settings.integer("thermal.refinement");
  return spec;
}

namespace {

/// Terms by which friction sees a film that is not as warm as the fabric. With temperatures of its own the
/// blank has that film already.
Problems check_cooling_counted_twice(const friction::Effects& effects, const ThermalSpec& spec,
                                     const Settings& settings) {
  Problems problems;
  const auto refuse = [&](RuleId id, const std::string& key, const std::string& rule,
                          const std::string& way_out) {
    problems.push_back({std::move(id), key, "", rule, way_out});
  };
  const std::string cooled = "cools the film of friction once more: thermal does it at every node";
  if (friction::is_on(effects.tool_temperature_film))
    refuse("effects.tool_temperature_film.thermal"_rule, "effects.tool_temperature_film", cooled,
           "Leave it out where a part is stamped; fit the law with it in a file of the friction test.");
  if (friction::is_on(effects.shear_heating) && spec.friction_heat)
    refuse("effects.shear_heating.thermal"_rule, "effects.shear_heating",
           "warms the film by friction once more: thermal.friction_heat does",
           "Leave one of the two out: thermal.friction_heat: off, or no such effect.");
  if (friction::is_on(effects.tool_temperature_shift))
    refuse("effects.tool_temperature_shift.thermal"_rule, "effects.tool_temperature_shift",
           "is what a cold tool does to mu by cooling the film; thermal cools it at every node",
           "Leave the shift out; with the film's temperature by conduction nothing is left of it "
           "(docs/theory/film-temperature.md).");
  if (settings.is("friction.film_temperature", "conduction"))
    refuse("friction.film_temperature.thermal"_rule, "friction.film_temperature", cooled,
           "Leave it out where a part is stamped; fit the law with it in a file of the friction test.");
  return problems;
}

/// A law fitted with the melt at the fabric's temperature has the coldness of the rig's film in its
/// constants.
Problems check_fitted_cold(const FrictionSpec& friction) {
  if (!friction.calibrated()) return {};
  return {
      {"friction.calibration.thermal"_rule, "friction.calibration.data", "",
       "fits a law that takes the film to be as warm as the fabric, though the rig's tools cooled it; with "
       "thermal the film's cooling would count twice",
       "Give the constants instead (friction.scale and friction.exponent), fitted with "
       "friction.film_temperature: conduction and effects.tool_temperature_film: {weight: 1} by `heddle "
       "friction`; configs/thermal.yaml has them."}};
}

}  // namespace

Problems check_thermal(const Case& a_case, const ReadConfig& config) {
  if (!a_case.stamping || !a_case.stamping->thermal) return {};
  const ThermalSpec& spec = *a_case.stamping->thermal;
  const bool weave_known = a_case.cell && !any_below(config.failed, {"weave", "cell", "resin"}) &&
                           mesoscale::check(*a_case.cell).empty();
  Problems problems;
  if (weave_known)
    problems =
        macroscale::thermal::check_films(spec, mesoscale::fabric_geometry(*a_case.cell).mass.areal_density);
  if (!a_case.friction) return problems;
  append(problems, check_cooling_counted_twice(a_case.friction->model.effects, spec, config.settings));
  append(problems, check_fitted_cold(*a_case.friction));
  return problems;
}

}  // namespace heddle::pipeline
