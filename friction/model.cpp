#include "friction/model.h"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>
#include <string>

#include "friction/hersey.h"

namespace heddle::friction {

namespace {

Friction unshifted(const Coulomb& law, const Model&, const Context&) {
  Friction result;
  result.mu = law.coefficient;
  return result;
}

/// The chain rule in plain sight: mu(ln Hs(U, p, T)).
template <class HerseyLaw>
Friction unshifted(const HerseyLaw& law, const Model& model, const Context& context) {
  const HerseyNumber hersey = hersey_number(model.film, context);
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

std::string describe(const Context& c) {
  return fmt::format(
      "slip speed {} m/s, pressure {} Pa, fabric {} K, tool {} K, area fraction {}, area slope {} 1/Pa",
      c.slip_speed, c.pressure, c.fabric_temperature, c.tool_temperature, c.area_fraction, c.area_slope);
}

[[noreturn]] void report_fault(const Friction& f, const Context& context, std::size_t point) {
  if (f.mu < 0.0) {
    throw NumericalError(fmt::format(
        "friction point {}: mu = {} is negative ({}). The tool temperature shift outweighs the law here; use "
        "effects.tool_temperature_shift.form: factor, or a smaller slope.",
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
Friction evaluate_point(const AnyLaw& law, const Model& model, const Context& context,
                        const ContactState& state, std::size_t point) {
  Friction result = unshifted(law, model, context);
  apply(model.effects, context, result);
  result.state = state;
  if (!sound(result)) report_fault(result, context, point);
  return result;
}

}  // namespace

Friction evaluate(const Model& model, const Context& context, const ContactState& state) {
  return std::visit([&](const auto& law) { return evaluate_point(law, model, context, state, 0); },
                    model.law);
}

void evaluate(const Model& model, std::span<const Context> contexts, std::span<const ContactState> states,
              std::span<Friction> out) {
  if (states.size() != contexts.size() || out.size() != contexts.size()) {
    throw std::invalid_argument("friction::evaluate: contexts, states and out differ in size");
  }
  std::visit(
      [&](const auto& law) {
        for (std::size_t i = 0; i < contexts.size(); ++i) {
          out[i] = evaluate_point(law, model, contexts[i], states[i], i);
        }
      },
      model.law);
}

Traction traction(const Model& model, const Context& context, const ContactState& state) {
  const Friction friction = evaluate(model, context, state);
  return {.value = friction.mu * context.pressure,
          .dtau_dspeed = friction.dmu_dspeed * context.pressure,
          .dtau_dpressure = friction.mu + context.pressure * friction.dmu_dpressure,
          .friction = friction};
}

}  // namespace heddle::friction
