#include <fmt/format.h>

#include "friction/export/fric_coef.h"

namespace heddle::friction {

namespace {

constexpr const char* memory_words =
    "depends on what the contact went through, and the routine is given its present state alone";

Problem memory_problem(std::string key, std::string value, std::string way_out) {
  return {.id = "export.memory"_rule,
          .key = std::move(key),
          .value = std::move(value),
          .rule = memory_words,
          .way_out = std::move(way_out)};
}

}  // namespace

Problems check_export(const Model& model) {
  Problems problems;
  const bool remembers =
      std::holds_alternative<StaticKinetic>(model.law) || std::holds_alternative<SlipResistance>(model.law);
  if (remembers)
    problems.push_back(memory_problem("friction.law", id_of(model.law),
                                      "Export a law without memory, or the steady part of this one."));
  const Effects& effects = model.effects;
  const auto refuse = [&]<class E>(const std::optional<E>& effect) {
    if (is_on(effect))
      problems.push_back(
          memory_problem(fmt::format("effects.{}", About<E>::id), "", "Leave it out: --set effects.ID=off."));
  };
  if (is_on(effects.shear_heating) && effects.shear_heating->settling > 0.0)
    problems.push_back(memory_problem("effects.shear_heating.settling",
                                      fmt::format("{} s", effects.shear_heating->settling),
                                      "Write 0 s: walls that are warm at once."));
  if (is_on(effects.tool_temperature_film) && effects.tool_temperature_film->settling > 0.0)
    problems.push_back(memory_problem("effects.tool_temperature_film.settling",
                                      fmt::format("{} s", effects.tool_temperature_film->settling),
                                      "Let the film settle at once: 0 s."));
  refuse(effects.static_peak);
  refuse(effects.sliding_evolution);
  refuse(effects.film_squeeze_out);
  refuse(effects.dwell_ageing);
  refuse(effects.solidification);
  refuse(effects.wear);
  if (problems.empty() && has_memory(model))  // the film's heat, on which an effect draws
    problems.push_back(memory_problem("friction.film_temperature", "conduction", "Write closed_form."));
  if (is_on(effects.orientation))
    problems.push_back(
        {.id = "export.direction"_rule,
         .key = "effects.orientation",
         .value = "",
         .rule = "depends on the direction of slip against the tows, which the routine is not given",
         .way_out = "Leave it out: --set effects.orientation=off."});
  return problems;
}

}  // namespace heddle::friction
