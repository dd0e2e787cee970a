#include "friction/calibration/model_numbers.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <stdexcept>
#include <type_traits>
#include <utility>
#include <variant>

#include "friction/parameters.h"

namespace heddle::friction {

namespace {

/// The laws whose keys have no name of the law in them, from before the others.
template <class AnyLaw>
constexpr bool has_flat_keys = std::is_same_v<AnyLaw, Coulomb> || std::is_same_v<AnyLaw, HerseyPower> ||
                               std::is_same_v<AnyLaw, HerseyLinear>;

/// Calls f(key, unit, range, number) with each number of a term.
template <class Term, class Function>
void visit_fields(Term& term, const std::string& block, const Function& f) {
  for (const Field<std::remove_const_t<Term>>& field : About<std::remove_const_t<Term>>::fields)
    f(fmt::format("{}.{}", block, field.name), field.unit, field.range, term.*(field.member));
}

template <class AnyModel, class Function>
void visit_film(AnyModel& model, const Function& f) {
  auto& film = model.film;
  std::visit(
      [&]<class F>(F& flow) {
        using Flow = std::remove_const_t<F>;
        if constexpr (std::is_same_v<Flow, PowerLaw>) {
          f("resin.consistency", "Pa s^n", positive_range, film.consistency);
          f("resin.power_index", "", Bounds{.low = 0.0, .high = 1.0, .high_open = false}, film.index);
        }
        visit_fields(flow, fmt::format("resin.{}", About<Flow>::id), f);
      },
      model.rheology.flow);
  f("resin.film_thickness", "mm", Bounds{.low = 0.0, .high = 0.01}, film.thickness);
  std::visit(
      [&]<class T>(T& law) {
        using Temperature = std::remove_const_t<T>;
        if constexpr (std::is_same_v<Temperature, Arrhenius>)
          f("resin.activation_energy", "kJ/mol", Bounds{.low = 0.0, .high = 1e6, .low_open = false},
            film.activation_energy);
        visit_fields(law, fmt::format("resin.{}", About<Temperature>::id), f);
      },
      model.rheology.temperature);
  f("resin.reference_temperature", "degC", Bounds{.low = 200.0, .high = 1000.0}, film.reference_temperature);
  f("resin.rate_floor", "1/s", positive_range, film.rate_floor);
}

template <class AnyModel, class Function>
void visit_numbers(AnyModel& model, const Function& f) {
  std::visit(
      [&]<class L>(L& law) {
        using AnyLaw = std::remove_const_t<L>;
        visit_fields(law, has_flat_keys<AnyLaw> ? "friction" : fmt::format("friction.{}", About<AnyLaw>::id),
                     f);
      },
      model.law);
  if (reads_hersey_number(model.law)) visit_film(model, f);
  for_each_effect(model.effects, [&](auto& effect) {
    using Effect = typename std::remove_cvref_t<decltype(effect)>::value_type;
    if (effect) visit_fields(*effect, fmt::format("effects.{}", About<Effect>::id), f);
  });
}

/// Calls f with a default of each alternative of a variant.
template <class Variant, class Function>
void for_each_alternative(const Function& f) {
  [&]<std::size_t... I>(std::index_sequence<I...>) {
    (f(std::variant_alternative_t<I, Variant>{}), ...);
  }
  (std::make_index_sequence<std::variant_size_v<Variant>>{});
}

/// d ln Hs / d number of Hs = m a(T) g_f^n phi/p_f, g_f^2 = (U/h)^2 + g0^2; empty for what Hs does not see.
std::optional<double> log_hersey_slope(const PowerLawFilm& film, const Context& context,
                                       const std::string& key) {
  constexpr double gas_constant = 8.31446261815324;  // [J/(mol K)]
  const double rate = film.shear_rate(context.slip_speed);
  const double square = rate * rate + film.rate_floor * film.rate_floor;
  if (key == "resin.consistency") return 1.0 / film.consistency;
  if (key == "resin.power_index") return 0.5 * std::log(square);
  if (key == "resin.film_thickness") return -film.index * rate * rate / (square * film.thickness);
  if (key == "resin.rate_floor") return film.index * film.rate_floor / square;
  if (key == "resin.activation_energy")
    return (1.0 / context.fabric_temperature - 1.0 / film.reference_temperature) / gas_constant;
  if (key == "resin.reference_temperature")
    return film.activation_energy / (gas_constant * film.reference_temperature * film.reference_temperature);
  return {};
}

/// Slopes that need no differences, by key; empty where the model's chain has none.
std::map<std::string, double> exact_slopes(const Model& model, const PullReading& reading,
                                           const std::vector<std::string>& keys) {
  std::map<std::string, double> known;
  if (!has_exact_slopes(model)) return known;
  const ParameterSlopes at = parameter_slopes(model, reading.context);
  const std::vector<Parameter> parameters = parameters_of(model);
  for (std::size_t k = 0; k < parameters.size(); ++k) known[parameters[k].key] = at.dmu_dparameter[k];
  if (const auto* linear = std::get_if<HerseyLinear>(&model.law))  // only b/Hs0 counts
    known["friction.reference_hersey"] = -known["friction.slope"] * linear->slope / linear->reference;
  if (!reads_hersey_number(model.law)) return known;
  for (const std::string& key : keys)
    if (const auto slope = log_hersey_slope(model.film, reading.context, key))
      known[key] = at.dmu_dlog_hersey * *slope;
  return known;
}

/// Change of the number that moves mu by about 1e-4 of itself, found from below by tens within its range.
double telling_step(const auto& mu_at, const auto& inside, double value) {
  const double still = mu_at(0.0);
  double step = value != 0.0 ? 1e-6 * std::abs(value) : 1e-10;
  const double largest = value != 0.0 ? 1e-2 * std::abs(value) : 1e10;
  while (10.0 * step < largest && inside(10.0 * step) &&
         !(std::abs(mu_at(step) - still) > 1e-4 * std::abs(still)))
    step *= 10.0;
  return step;
}

/// (-f(2h) + 8 f(h) - 8 f(-h) + f(-2h)) / 12 h
double central(const auto& f, double h) {
  return (8.0 * (f(h) - f(-h)) - (f(2.0 * h) - f(-2.0 * h))) / (12.0 * h);
}
/// (-3 f(0) + 4 f(h) - f(2h)) / 2 h, for h of either sign.
double one_sided(const auto& f, double h) {
  return (4.0 * f(h) - 3.0 * f(0.0) - f(2.0 * h)) / (2.0 * h);
}

NumberSlope difference(const Model& model, const PullReading& reading, const ModelNumber& number) {
  Model other = model;
  double& moved = number_in(other, number.key);
  const auto mu_at = [&](double change) {
    moved = number.value + change;
    return coefficient_of(other, reading);
  };
  const auto inside = [&](double change) { return number.range.contains(number.value + change); };
  const double sign = inside(1e-9 * std::max(std::abs(number.value), 1e-3)) ? 1.0 : -1.0;
  const double step = telling_step([&](double h) { return mu_at(sign * h); },
                                   [&](double h) { return inside(sign * h); }, number.value);
  const auto slope_by = [&](double h) {
    if (inside(2.0 * h) && inside(-2.0 * h)) return central(mu_at, h);
    return one_sided(mu_at, sign * h);
  };
  const double fine = slope_by(0.25 * step), coarse = slope_by(0.5 * step);
  const double scale = number.value != 0.0 ? std::abs(number.value) : 1e4 * step;
  return {.value = fine, .exact = false, .error = std::abs(fine - coarse) * scale / std::abs(mu_at(0.0))};
}

}  // namespace

std::vector<ModelNumber> numbers_of(const Model& model) {
  std::vector<ModelNumber> numbers;
  visit_numbers(model, [&](std::string key, const char* unit, const Bounds& range, double value) {
    numbers.push_back({std::move(key), unit, range, value});
  });
  return numbers;
}

std::vector<ModelNumber> all_numbers() {
  std::vector<ModelNumber> all;
  const auto add = [&](const Model& model) {
    for (ModelNumber& number : numbers_of(model))
      if (std::ranges::find(all, number.key, &ModelNumber::key) == all.end())
        all.push_back(std::move(number));
  };
  for_each_alternative<Law>(
      [&](auto law) { add({.law = std::move(law), .film = {}, .effects = {}, .box = {}}); });
  const Model film{.law = HerseyPower{}, .film = {}, .effects = {}, .box = {}};
  for_each_alternative<Flow>([&](auto flow) {
    Model model = film;
    model.rheology.flow = flow;
    add(model);
  });
  for_each_alternative<TemperatureLaw>([&](auto law) {
    Model model = film;
    model.rheology.temperature = law;
    add(model);
  });
  Model effects = film;
  for_each_effect(effects.effects, [](auto& effect) { effect.emplace(); });
  add(effects);
  return all;
}

double& number_in(Model& model, const std::string& key) {
  double* found = nullptr;
  visit_numbers(model, [&](const std::string& name, const char*, const Bounds&, double& number) {
    if (name == key) found = &number;
  });
  if (found == nullptr) throw std::out_of_range("friction::number_in: the model has no " + key);
  return *found;
}

double coefficient_of(const Model& model, const PullReading& reading) {
  FrictionRig rig;
  rig.pull_length = reading.slip;
  rig.dwell_before = reading.dwell;
  return evaluate_unchecked(model, reading.context, state_after_pull(model, reading.context, rig)).mu;
}

std::vector<NumberSlope> number_slopes(const Model& model, const PullReading& reading,
                                       const std::vector<std::string>& keys) {
  const std::map<std::string, double> exact = exact_slopes(model, reading, keys);
  std::vector<ModelNumber> numbers;  // asked for only where a key needs differences
  std::vector<NumberSlope> slopes;
  for (const std::string& key : keys) {
    if (const auto known = exact.find(key); known != exact.end()) {
      slopes.push_back({.value = known->second, .exact = true});
      continue;
    }
    if (numbers.empty()) numbers = numbers_of(model);
    const auto number = std::ranges::find(numbers, key, &ModelNumber::key);
    if (number == numbers.end()) throw std::out_of_range("friction::number_slopes: no number " + key);
    slopes.push_back(difference(model, reading, *number));
  }
  return slopes;
}

}  // namespace heddle::friction
