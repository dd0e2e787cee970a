#include "friction/model.h"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>
#include <string>
#include <type_traits>

#include "friction/hersey.h"

namespace heddle::friction {

namespace {

/// What is the same for every point of a batch.
struct Plan {
  explicit Plan(const Model& model)
      : stages(stages_of(model.effects)), own_film(stages.film || !model.rheology.of_the_film()) {}
  EffectStages stages;
  bool own_film;  ///< the Hersey number is not the one of friction/hersey.h
};

/// The chain rule in plain sight: mu(ln Hs(U, p, T)).
template <HerseyLaw AnyLaw>
Friction on_hersey_number(const AnyLaw& law, const Model& model, const HerseyNumber& hersey) {
  const auto [mu, dmu_dlog_hersey] = law_value(law, hersey.value, model.box);
  Friction result;
  result.mu = mu;
  result.dmu_dspeed = dmu_dlog_hersey * hersey.dlog_dspeed;
  result.dmu_dpressure = dmu_dlog_hersey * hersey.dlog_dpressure;
  result.dmu_dfabric_temperature = dmu_dlog_hersey * hersey.dlog_dfabric_temperature;
  result.hersey = hersey.value;
  result.film_viscosity = hersey.viscosity;
  // Hs never falls with U (n > 0), so mu falls with U exactly where the law falls with Hs. The sign is read
  // off the law, not off dmu_dspeed, which vanishes at rest.
  result.convex = dmu_dlog_hersey >= 0.0;
  return result;
}

/// The same on a film that effects or another rheology changed.
template <HerseyLaw AnyLaw>
Friction on_film(const AnyLaw& law, const Model& model, const FilmState& film) {
  const auto [mu, dmu_dlog_hersey] = law_value(law, film.hersey.value, model.box);
  Friction result;
  set_coefficient(result, film.hersey.mapped(mu, dmu_dlog_hersey / film.hersey.value));
  result.hersey = film.hersey.value;
  result.film_viscosity = film.viscosity.value;
  result.convex = dmu_dlog_hersey >= 0.0;
  return result;
}

Friction on_point(const Coulomb& law, const Inputs&) {
  Friction result;
  result.mu = law.coefficient;
  return result;
}

template <class AnyLaw>
Friction on_point(const AnyLaw& law, const Inputs& inputs) {
  Friction result;
  set_coefficient(result, coefficient(law, inputs));
  result.convex = result.dmu_dspeed >= 0.0;
  return result;
}

Sensitive sensitive(const HerseyNumber& hersey) {
  Sensitive result(1.0);
  result.slope[static_cast<std::size_t>(Variable::slip_speed)] = hersey.dlog_dspeed;
  result.slope[static_cast<std::size_t>(Variable::pressure)] = hersey.dlog_dpressure;
  result.slope[static_cast<std::size_t>(Variable::fabric_temperature)] = hersey.dlog_dfabric_temperature;
  return hersey.value * result;
}

void shift(const Model& model, const Context& context, Friction& friction) {
  const auto& effect = model.effects.tool_temperature_shift;
  if (is_on(effect)) apply(*effect, context, friction);
}

/// A total slope of either sign decides; where it vanishes (at rest), the law's own.
void flag_falling(Friction& friction) {
  if (friction.dmu_dspeed != 0.0) friction.convex = friction.dmu_dspeed > 0.0;
}

const FilmConduction* conduction_of(const Model& model) {
  return model.conduction ? &*model.conduction : nullptr;
}

/// Everything but the state: the plain chain without memory of a batch's common case first.
template <class AnyLaw>
Friction coefficient_at(const AnyLaw& law, const Model& model, const Plan& plan, const Context& context,
                        const ContactState& state) {
  if constexpr (std::is_same_v<AnyLaw, Coulomb>) {
    if (!plan.stages.coefficient) {
      Friction result;
      result.mu = law.coefficient;
      shift(model, context, result);
      return result;
    }
  }
  if constexpr (HerseyLaw<AnyLaw>) {
    if (!plan.own_film) {
      const HerseyNumber hersey = hersey_number(model.film, context);
      Friction result = on_hersey_number(law, model, hersey);
      shift(model, context, result);
      if (!plan.stages.coefficient) return result;
      const Inputs inputs(context, state, conduction_of(model));
      apply_to_coefficient(model.effects, inputs, inputs.area_fraction, sensitive(hersey), result);
      flag_falling(result);
      return result;
    }
  }
  const Inputs inputs(context, state, conduction_of(model));
  const Sensitive area = contact_area(model.effects, inputs);
  Sensitive hersey;
  Friction result;
  if constexpr (HerseyLaw<AnyLaw>) {
    const FilmState film = film_state(model.effects, model.rheology, model.film, inputs, area);
    result = on_film(law, model, film);
    result.state.film_temperature = film.temperature.value + film.heating;
    hersey = film.hersey;
  } else {
    result = on_point(law, inputs);
  }
  shift(model, context, result);
  if (plan.stages.coefficient) apply_to_coefficient(model.effects, inputs, area, hersey, result);
  flag_falling(result);
  return result;
}

std::string describe(const Context& c) {
  return fmt::format(
      "slip speed {} m/s, pressure {} Pa, fabric {} K, tool {} K, area fraction {}, area slope {} 1/Pa",
      c.slip_speed, c.pressure, c.fabric_temperature, c.tool_temperature, c.area_fraction, c.area_slope);
}

[[noreturn]] void report_fault(const Friction& f, const Context& context, std::size_t point) {
  if (f.mu < 0.0) {
    throw NumericalError(fmt::format(
        "friction point {}: mu = {} is negative ({}). The tool temperature shift, or another term that takes "
        "from mu, outweighs the law here; use effects.tool_temperature_shift.form: factor, or a smaller "
        "slope.",
        point, f.mu, describe(context)));
  }
  throw NumericalError(
      fmt::format("friction point {}: mu = {}, dmu/dU = {} s/m, dmu/dp = {} 1/Pa, dmu/dT = {} and {} 1/K; "
                  "all must be finite ({})",
                  point, f.mu, f.dmu_dspeed, f.dmu_dpressure, f.dmu_dfabric_temperature,
                  f.dmu_dtool_temperature, describe(context)));
}

bool sound(const Friction& f) {
  const double sum =
      f.mu + f.dmu_dspeed + f.dmu_dpressure + f.dmu_dfabric_temperature + f.dmu_dtool_temperature;
  return f.mu >= 0.0 && std::isfinite(sum);
}

template <class AnyLaw>
Friction evaluate_point(const AnyLaw& law, const Model& model, const Plan& plan, const Context& context,
                        const ContactState& state) {
  Friction result = coefficient_at(law, model, plan, context, state);
  const double film_temperature = result.state.film_temperature;
  result.state = state;
  if (plan.own_film && HerseyLaw<AnyLaw>) result.state.film_temperature = film_temperature;
  if (plan.stages.coefficient) advance(model.effects, context, result.state);
  if constexpr (std::is_same_v<AnyLaw, SlipResistance>)
    result.state.slip_resistance = slip_resistance_after(law, context, state);
  return result;
}

}  // namespace

Friction evaluate_unchecked(const Model& model, const Context& context, const ContactState& state) {
  const Plan plan(model);
  return std::visit([&](const auto& law) { return evaluate_point(law, model, plan, context, state); },
                    model.law);
}

Friction evaluate(const Model& model, const Context& context, const ContactState& state) {
  const Friction result = evaluate_unchecked(model, context, state);
  if (!sound(result)) report_fault(result, context, 0);
  return result;
}

void evaluate(const Model& model, std::span<const Context> contexts, std::span<const ContactState> states,
              std::span<Friction> out) {
  if (states.size() != contexts.size() || out.size() != contexts.size()) {
    throw std::invalid_argument("friction::evaluate: contexts, states and out differ in size");
  }
  const Plan plan(model);
  std::visit(
      [&](const auto& law) {
        for (std::size_t i = 0; i < contexts.size(); ++i) {
          out[i] = evaluate_point(law, model, plan, contexts[i], states[i]);
          if (!sound(out[i])) report_fault(out[i], contexts[i], i);
        }
      },
      model.law);
}

bool has_memory(const Model& model) {
  return std::holds_alternative<StaticKinetic>(model.law) ||
         std::holds_alternative<SlipResistance>(model.law) ||
         has_memory(model.effects, model.conduction.has_value());
}

Traction traction(const Model& model, const Context& context, const ContactState& state) {
  const Friction friction = evaluate(model, context, state);
  return {.value = friction.mu * context.pressure,
          .dtau_dspeed = friction.dmu_dspeed * context.pressure,
          .dtau_dpressure = friction.mu + context.pressure * friction.dmu_dpressure,
          .friction = friction};
}

}  // namespace heddle::friction
