#include "friction/combinations.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>
#include <vector>

namespace heddle::friction {

namespace {

constexpr std::string_view film_unseen =
    "the law sees no Hersey number, so nothing of the film reaches the friction";
constexpr std::string_view plateau_known = "the rheology has its own plateau at low rate";
constexpr std::string_view plateau_none = "a melt that yields has no plateau at low rate";
constexpr std::string_view weakening_known =
    "the law already falls with speed: the two could not be told apart";

constexpr std::array all_refusals{
    Refusal{"tool_temperature_film", no_hersey_number, film_unseen},
    Refusal{"film_squeeze_out", no_hersey_number, film_unseen},
    Refusal{"shear_heating", no_hersey_number, film_unseen},
    Refusal{"viscosity_plateau", no_hersey_number, film_unseen},
    Refusal{"pressure_dependent_area", no_hersey_number,
            "the law sees no Hersey number, so the contact area does not reach the friction"},
    Refusal{"boundary_lubrication", no_hersey_number,
            "the law sees no Hersey number, over which the boundary branch is written"},
    Refusal{"boundary_lubrication", "three_branch", "the law has its own boundary branch"},
    Refusal{"static_peak", "static_kinetic", "the law has its own static peak"},
    Refusal{"sliding_evolution", "slip_resistance", "the law evolves with slip itself"},
    Refusal{"stick_slip", "exponential_decay", weakening_known},
    Refusal{"stick_slip", "renard", weakening_known},
    Refusal{"viscosity_plateau", "carreau_yasuda", plateau_known},
    Refusal{"viscosity_plateau", "cross", plateau_known},
    Refusal{"viscosity_plateau", "bingham", plateau_none},
    Refusal{"viscosity_plateau", "herschel_bulkley", plateau_none}};

/// What the model is beside its effects.
std::vector<std::string_view> ids_of(const Model& model) {
  std::vector<std::string_view> ids{id_of(model.law)};
  if (!reads_hersey_number(model.law)) ids.push_back(no_hersey_number);
  ids.push_back(std::visit([]<class F>(const F&) { return About<F>::id; }, model.rheology.flow));
  return ids;
}

}  // namespace

std::span<const Refusal> refusals() {
  return all_refusals;
}

Problems check_combinations(const Model& model) {
  Problems problems;
  const auto ids = ids_of(model);
  for_each_effect(model.effects, [&]<class E>(const std::optional<E>& effect) {
    if (!is_on(effect)) return;
    for (const Refusal& refusal : all_refusals) {
      if (refusal.effect != About<E>::id || std::ranges::find(ids, refusal.with) == ids.end()) continue;
      const std::string_view with = refusal.with == no_hersey_number ? ids.front() : refusal.with;
      problems.push_back(
          {.id = "friction.combination.*"_family.of(fmt::format("{}.{}", refusal.effect, refusal.with)),
           .key = fmt::format("effects.{}", refusal.effect),
           .value = fmt::format("with {}", with),
           .rule = fmt::format("cannot be combined: {}", refusal.reason),
           .way_out = "Leave one of the two out."});
    }
  });
  return problems;
}

}  // namespace heddle::friction
