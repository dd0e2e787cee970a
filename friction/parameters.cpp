#include "friction/parameters.h"

#include <algorithm>
#include <cmath>

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

ParameterSlopes parameter_slopes(const Model& model, const Context& context) {
  ParameterSlopes slopes =
      std::visit([&](const auto& law) { return law_slopes(law, model, context); }, model.law);
  if (const auto& effect = model.effects.tool_temperature_shift) shift(*effect, context, slopes);
  return slopes;
}

}  // namespace heddle::friction
