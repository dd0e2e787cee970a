#include "pipeline/friction_keys.h"

#include <fmt/format.h>

#include <cmath>
#include <type_traits>

#include "core/units.h"
#include "pipeline/key_table.h"

namespace heddle::pipeline {
namespace {

using friction::About;

std::string interval(const friction::Bounds& range, const char* unit) {
  const bool low = std::isfinite(range.low), high = std::isfinite(range.high);
  if (!low && !high) return "";
  return fmt::format("{}{}, {}{}", range.low_open ? '(' : '[', low ? write_quantity(range.low, unit) : "",
                     high ? write_quantity(range.high, unit) : "", range.high_open ? ')' : ']');
}

/// A key for each number of a term. The amplitude of an effect has to be given, all else has a default.
template <class Term>
std::vector<Key> keys_of(const std::string& block, const std::string& used_when, Stage stage,
                         bool is_effect) {
  std::vector<Key> keys;
  for (const friction::Field<Term>& field : About<Term>::fields) {
    const bool amplitude = is_effect && keys.empty();
    keys.push_back({.path = fmt::format("{}.{}", block, field.name),
                    .type = KeyType::quantity,
                    .unit = field.unit,
                    .presence = amplitude ? Presence::required : Presence::defaulted,
                    .default_text = amplitude ? "" : write_quantity(Term{}.*(field.member), field.unit),
                    .range = interval(field.range, field.unit),
                    .choices = {},
                    .stage = stage,
                    .used_when = used_when,
                    .help = field.help});
  }
  return keys;
}

template <class Term>
void take_fields(const Settings& settings, const std::string& block, Term& term) {
  for (const friction::Field<Term>& field : About<Term>::fields) {
    const std::string path = fmt::format("{}.{}", block, field.name);
    if (settings.has(path)) term.*(field.member) = settings.number(path);
  }
}

/// Calls f with a default of each alternative of a variant.
template <class Variant, class Function>
void for_each_alternative(Function&& f) {
  [&]<std::size_t... I>(std::index_sequence<I...>) {
    (f(std::variant_alternative_t<I, Variant>{}), ...);
  }
  (std::make_index_sequence<std::variant_size_v<Variant>>{});
}

/// Laws with keys of their own names, from before the blocks.
template <class Law>
inline constexpr bool has_flat_keys =
    std::is_same_v<Law, friction::Coulomb> || std::is_same_v<Law, friction::HerseyPower> ||
    std::is_same_v<Law, friction::HerseyLinear>;

template <class Law>
std::string condition_of() {
  return fmt::format(friction::HerseyLaw<Law> ? "friction.law=stribeck friction.form={}" : "friction.law={}",
                     About<Law>::id);
}

template <class Law>
bool is_chosen(const Settings& settings) {
  if (!friction::HerseyLaw<Law>) return settings.is("friction.law", About<Law>::id);
  return settings.is("friction.law", "stribeck") && settings.is("friction.form", About<Law>::id);
}

std::vector<std::string> names(bool hersey) {
  std::vector<std::string> ids;
  for_each_alternative<friction::Law>([&]<class L>(const L&) {
    if (!has_flat_keys<L> && friction::HerseyLaw<L> == hersey) ids.push_back(About<L>::id);
  });
  return ids;
}

}  // namespace

std::vector<std::string> further_laws() {
  return names(false);
}

std::vector<std::string> further_forms() {
  return names(true);
}

std::vector<Key> friction_law_keys() {
  std::vector<Key> keys;
  for_each_alternative<friction::Law>([&]<class L>(const L&) {
    if (has_flat_keys<L>) return;
    append(keys,
           keys_of<L>(fmt::format("friction.{}", About<L>::id), condition_of<L>(), Stage::friction, false));
  });
  keys.push_back({.path = "friction.slip_resistance.evolution",
                  .type = KeyType::choice,
                  .presence = Presence::defaulted,
                  .default_text = "frozen",
                  .choices = {"frozen", "inside"},
                  .stage = Stage::friction,
                  .used_when = condition_of<friction::SlipResistance>(),
                  .help = "frozen: S of the step's start; inside: S after the slip of this step."});
  keys.push_back({.path = "friction.table",
                  .type = KeyType::file,
                  .presence = Presence::required,
                  .stage = Stage::friction,
                  .used_when = condition_of<friction::HerseyTable>(),
                  .help = "Table with the columns hersey_number and friction_coefficient."});
  return keys;
}

std::vector<Key> conduction_keys() {
  std::vector<Key> keys{
      {.path = "friction.film_temperature",
       .type = KeyType::choice,
       .presence = Presence::defaulted,
       .default_text = "closed_form",
       .choices = {"closed_form", "conduction"},
       .stage = Stage::friction,
       .help = "Where effects F1, F11 and F12 take the film's temperature from: formulas of their "
               "own, or one conduction through tool, film and ply."}};
  append(keys, keys_of<friction::FilmConductionSpec>(
                   "friction.conduction", "friction.film_temperature=conduction", Stage::friction, false));
  return keys;
}

std::vector<Key> rheology_keys() {
  std::vector<Key> keys;
  for_each_alternative<friction::Flow>([&]<class F>(const F&) {
    append(keys, keys_of<F>(fmt::format("resin.{}", About<F>::id),
                            fmt::format("resin.rheology={}", About<F>::id), Stage::always, false));
  });
  keys.push_back({.path = "resin.temperature_law",
                  .type = KeyType::choice,
                  .presence = Presence::defaulted,
                  .default_text = "arrhenius",
                  .choices = {"arrhenius", "wlf"},
                  .help = "How the film's viscosity shifts with temperature."});
  append(keys, keys_of<friction::Wlf>("resin.wlf", "resin.temperature_law=wlf", Stage::always, false));
  return keys;
}

std::vector<Key> friction_effect_keys() {
  std::vector<Key> keys;
  const friction::Effects effects;
  friction::for_each_effect(effects, [&]<class E>(const std::optional<E>&) {
    if (std::is_same_v<E, friction::ToolTemperatureShift>) return;
    const std::string block = fmt::format("effects.{}", About<E>::id);
    append(keys, keys_of<E>(block, block, Stage::friction, true));
  });
  keys.push_back(
      {.path = "effects.orientation.form",
       .type = KeyType::choice,
       .presence = Presence::defaulted,
       .default_text = "tows",
       .choices = {"tows", "trellis", "film"},
       .stage = Stage::friction,
       .used_when = "effects.orientation",
       .help = "tows: 1 + A sin^2(2 theta) whatever the shear; trellis: along the long diagonal of the "
               "sheared weave, growing with sin^2 of the shear angle; film: as the film of the unit cell drags "
               "(block film)."});
  return keys;
}

std::optional<friction::Law> further_law_of(const Settings& settings, const std::filesystem::path& folder) {
  std::optional<friction::Law> chosen;
  for_each_alternative<friction::Law>([&]<class L>(L law) {
    if (has_flat_keys<L> || !is_chosen<L>(settings)) return;
    take_fields(settings, fmt::format("friction.{}", About<L>::id), law);
    if constexpr (std::is_same_v<L, friction::SlipResistance>) {
      if (settings.is("friction.slip_resistance.evolution", "inside")) law.evolution = L::Evolution::inside;
    }
    if constexpr (std::is_same_v<L, friction::HerseyTable>) {
      if (settings.has("friction.table"))
        law = friction::read_hersey_table(
            (folder / settings.text("friction.table")).lexically_normal().string());
    }
    chosen = std::move(law);
  });
  return chosen;
}

std::vector<Key> rig_keys() {
  const std::string rig = "friction_test.rig";
  const auto stage = Stage::friction_test;
  std::vector<Key> keys{
      {.path = rig + ".pull_length",
       .type = KeyType::quantity,
       .unit = "mm",
       .presence = Presence::defaulted,
       .default_text = "50 mm",
       .range = "[5 mm, 10000 mm]",
       .stage = stage,
       .used_when = rig,
       .help = "Slip at which the steady force is read (assumed)."},
      {.path = rig + ".dwell",
       .type = KeyType::quantity,
       .unit = "s",
       .presence = Presence::defaulted,
       .default_text = "0 s",
       .range = "[0 s, 100000 s]",
       .stage = stage,
       .used_when = rig,
       .help = "Rest under load before the pull."},
      {.path = rig + ".sampling_rate",
       .type = KeyType::quantity,
       .unit = "1/s",
       .presence = Presence::defaulted,
       .default_text = "100 1/s",
       .range = "[1 1/s, 10000 1/s]",
       .stage = stage,
       .used_when = rig,
       .help = "Of the load cells (prior)."},
      {.path = rig + ".normal",
       .type = KeyType::choice,
       .presence = Presence::defaulted,
       .default_text = "held",
       .choices = {"held", "cam"},
       .stage = stage,
       .used_when = rig,
       .help = "held: the normal force stays; cam: the gap stays, and the force relaxes."},
      {.path = rig + ".finite_elements",
       .type = KeyType::choice,
       .presence = Presence::defaulted,
       .default_text = "off",
       .choices = {"off", "on"},
       .stage = stage,
       .used_when = rig,
       .help = "Every pull through the stamping solver's finite elements as well; needs a weave."},
      {.path = rig + ".bend.radius",
       .type = KeyType::quantity,
       .unit = "mm",
       .presence = Presence::defaulted,
       .default_text = "50 mm",
       .range = "[2 mm, 10000 mm]",
       .stage = stage,
       .used_when = rig,
       .help = "Of both arcs of the S-curve plates. Assumed: the paper does not give their shape."},
      {.path = rig + ".bend.angle",
       .type = KeyType::quantity,
       .unit = "deg",
       .presence = Presence::defaulted,
       .default_text = "20 deg",
       .range = "(0 deg, 80 deg]",
       .stage = stage,
       .used_when = rig,
       .help = "Steepest slope of the S-curve plates (assumed)."}};
  append(keys, keys_of<friction::Drive>(rig + ".drive", rig, stage, false));
  append(keys, keys_of<friction::Sample>(rig + ".sample", rig, stage, false));
  append(keys, keys_of<friction::CamGap>(rig + ".cam", rig + ".normal=cam", stage, false));
  return keys;
}

friction::Machine machine_of(const Settings& settings) {
  const std::string rig = "friction_test.rig";
  friction::Machine machine;
  take_fields(settings, rig + ".drive", machine.drive);
  take_fields(settings, rig + ".sample", machine.sample);
  if (settings.has(rig + ".sampling_rate")) machine.sampling_rate = settings.number(rig + ".sampling_rate");
  if (settings.is(rig + ".normal", "cam")) {
    machine.cam.emplace();
    take_fields(settings, rig + ".cam", *machine.cam);
  }
  return machine;
}

std::optional<friction::FilmConduction> conduction_of(const Settings& settings, double film_thickness) {
  if (!settings.is("friction.film_temperature", "conduction")) return {};
  friction::FilmConductionSpec spec;
  take_fields(settings, "friction.conduction", spec);
  return friction::film_conduction(spec, film_thickness);
}

friction::Rheology rheology_of(const Settings& settings) {
  friction::Rheology rheology;
  for_each_alternative<friction::Flow>([&]<class F>(F flow) {
    if (!settings.is("resin.rheology", About<F>::id)) return;
    take_fields(settings, fmt::format("resin.{}", About<F>::id), flow);
    rheology.flow = flow;
  });
  if (settings.is("resin.temperature_law", "wlf")) {
    friction::Wlf wlf;
    take_fields(settings, "resin.wlf", wlf);
    rheology.temperature = wlf;
  }
  return rheology;
}

void take_effects(const Settings& settings, friction::Effects& effects) {
  friction::for_each_effect(effects, [&]<class E>(std::optional<E>& effect) {
    const std::string block = fmt::format("effects.{}", About<E>::id);
    if (std::is_same_v<E, friction::ToolTemperatureShift> || settings.blocks.count(block) == 0) return;
    effect.emplace();
    take_fields(settings, block, *effect);
    if constexpr (std::is_same_v<E, friction::Orientation>) {
      if (settings.is(block + ".form", "trellis")) effect->form = E::Form::trellis;
      if (settings.is(block + ".form", "film")) effect->form = E::Form::film;
    }
  });
}

}  // namespace heddle::pipeline
