#include "friction/parameters.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "friction/hersey.h"

namespace heddle::friction {

namespace {

std::vector<Parameter> law_parameters(const Coulomb& law) {
  return {{"friction.coefficient", "", law.coefficient, false, false}};
}
std::vector<Parameter> law_parameters(const HerseyPower& law) {
  return {{"friction.scale", "", law.scale, false, false},
          {"friction.exponent", "", law.exponent, true, false}};
}
std::vector<Parameter> law_parameters(const HerseyLinear& law) {
  return {{"friction.offset", "", law.offset, false, false}, {"friction.slope", "", law.slope, true, false}};
}

template <class AnyLaw>
std::vector<Parameter> law_parameters(const AnyLaw& law) {
  std::vector<Parameter> list;
  for (const Field<AnyLaw>& field : About<AnyLaw>::fields)
    list.push_back({fmt::format("friction.{}.{}", About<AnyLaw>::id, field.name), field.unit,
                    law.*(field.member), HerseyLaw<AnyLaw> && !list.empty(), false});
  return list;
}

std::size_t set_law(Coulomb& law, const std::vector<double>& values) {
  law.coefficient = values[0];
  return 1;
}
std::size_t set_law(HerseyPower& law, const std::vector<double>& values) {
  law.scale = values[0];
  law.exponent = values[1];
  return 2;
}
std::size_t set_law(HerseyLinear& law, const std::vector<double>& values) {
  law.offset = values[0];
  law.slope = values[1];
  return 2;
}

template <class AnyLaw>
std::size_t set_law(AnyLaw& law, const std::vector<double>& values) {
  std::size_t next = 0;
  for (const Field<AnyLaw>& field : About<AnyLaw>::fields) law.*(field.member) = values[next++];
  return next;
}

ParameterSlopes law_slopes(const Coulomb& law, const Model&, const Context&) {
  return {.mu = law.coefficient, .dmu_dlog_hersey = 0.0, .dmu_dparameter = {1.0}};
}

ParameterSlopes law_slopes(const HerseyPower& law, const Model& model, const Context& context) {
  const double hersey = hersey_number(model.film, context).value;
  const auto [mu, dmu_dlog_hersey] = law_value(law, hersey, model.box);
  return {.mu = mu,
          .dmu_dlog_hersey = dmu_dlog_hersey,
          .dmu_dparameter = {std::pow(hersey, law.exponent), mu * std::log(hersey)}};
}

/// Beyond the box mu = (a + r) x^k with x = Hs / edge, r = b edge / Hs0 and k = r / (a + r):
///     dmu/da = x^k (1 - k ln x),   dmu/dr = x^k (1 + (1 - k) ln x)
/// Inside x = 1, and both are those of the straight line.
ParameterSlopes law_slopes(const HerseyLinear& law, const Model& model, const Context& context) {
  const double hersey = hersey_number(model.film, context).value;
  const double edge = std::clamp(hersey, model.box.hersey_low, model.box.hersey_high);
  const LawValue at_edge = law_value(law, edge, model.box);
  const double k = at_edge.dmu_dlog_hersey / at_edge.mu;
  const double log_x = std::log(hersey / edge);
  const double power = std::exp(k * log_x);
  const auto [mu, dmu_dlog_hersey] = law_value(law, hersey, model.box);
  return {.mu = mu,
          .dmu_dlog_hersey = dmu_dlog_hersey,
          .dmu_dparameter = {power * (1.0 - k * log_x),
                             power * (1.0 + (1.0 - k) * log_x) * edge / law.reference}};
}

template <class AnyLaw>
ParameterSlopes law_slopes(const AnyLaw&, const Model&, const Context&) {
  throw std::logic_error(
      "friction::parameter_slopes: a law without slopes of its own");  // see has_exact_slopes
}

/// (f(+step) - f(-step)) / (2 step)
template <class Function>
double central(const Function& f, double step) {
  return (f(step) - f(-step)) / (2.0 * step);
}

ParameterSlopes differences(const Model& model, const Context& context, const ContactState& state) {
  ParameterSlopes slopes{
      .mu = evaluate_unchecked(model, context, state).mu, .dmu_dlog_hersey = 0.0, .dmu_dparameter = {}};
  // Hs is proportional to the area fraction.
  const auto with_area = [&](double log_area) {
    Context changed = context;
    changed.area_fraction *= std::exp(log_area);
    changed.area_slope *= std::exp(log_area);
    return evaluate_unchecked(model, changed, state).mu;
  };
  if (reads_hersey_number(model.law)) slopes.dmu_dlog_hersey = central(with_area, 1e-5);
  const std::vector<Parameter> parameters = parameters_of(model);
  std::vector<double> values;
  for (const Parameter& parameter : parameters) values.push_back(parameter.value);
  for (std::size_t j = 0; j < values.size(); ++j) {
    const auto with_value = [&](double change) {
      std::vector<double> changed = values;
      changed[j] += change;
      Model other = model;
      set_parameters(other, changed);
      return evaluate_unchecked(other, context, state).mu;
    };
    slopes.dmu_dparameter.push_back(central(with_value, 1e-5 * std::max(std::abs(values[j]), 1e-4)));
  }
  return slopes;
}

/// As effects.cpp does it to mu, here to the slopes as well.
void shift(const ToolTemperatureShift& effect, const Context& context, ParameterSlopes& slopes) {
  const double difference = context.tool_temperature - effect.reference;
  if (effect.form == ToolTemperatureShift::Form::term) {
    slopes.mu += effect.slope * difference;
    slopes.dmu_dparameter.push_back(difference);
    return;
  }
  const double factor = 1.0 + effect.slope * difference;
  const double dmu_deffect_slope = slopes.mu * difference;
  slopes.mu *= factor;
  slopes.dmu_dlog_hersey *= factor;
  for (double& slope : slopes.dmu_dparameter) slope *= factor;
  slopes.dmu_dparameter.push_back(dmu_deffect_slope);
}

}  // namespace

std::vector<Parameter> parameters_of(const Model& model) {
  std::vector<Parameter> list = std::visit([](const auto& law) { return law_parameters(law); }, model.law);
  if (const auto& effect = model.effects.tool_temperature_shift) {
    list.push_back({"effects.tool_temperature_shift.slope", "1/K", effect->slope, false, true});
  }
  return list;
}

void set_parameters(Model& model, const std::vector<double>& values) {
  const std::size_t next = std::visit([&](auto& law) { return set_law(law, values); }, model.law);
  if (auto& effect = model.effects.tool_temperature_shift) effect->slope = values[next];
}

// Where law_slopes and shift say it all.
bool has_exact_slopes(const Model& model) {
  const EffectStages stages = stages_of(model.effects);
  const bool known = std::holds_alternative<Coulomb>(model.law) ||
                     std::holds_alternative<HerseyPower>(model.law) ||
                     std::holds_alternative<HerseyLinear>(model.law);
  return known && model.rheology.of_the_film() && !stages.film && !stages.coefficient;
}

ParameterSlopes parameter_slopes(const Model& model, const Context& context, const ContactState& state) {
  if (!has_exact_slopes(model)) return differences(model, context, state);
  ParameterSlopes slopes =
      std::visit([&](const auto& law) { return law_slopes(law, model, context); }, model.law);
  if (const auto& effect = model.effects.tool_temperature_shift) shift(*effect, context, slopes);
  return slopes;
}

}  // namespace heddle::friction
