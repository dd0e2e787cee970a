#pragma once

#include <vector>

#include "friction/model.h"

namespace heddle::friction {

/// A number of the model that friction tests can find.
struct Parameter {
  const char* key;   ///< as in the configuration, for instance "friction.exponent"
  const char* unit;  ///< "" for a plain number
  double value;
  bool acts_through_hersey;  ///< without a spread of Hs among the tests nothing tells it
  bool acts_through_tool_temperature;
};

/// {mu} | {C, s} | {a, b} of the law, then the tool temperature slope where the effect is present. The film
/// is not among them: n, m and h come from rheology and microscopy.
std::vector<Parameter> parameters_of(const Model& model);

/// @param values  in the order of parameters_of(model)
void set_parameters(Model& model, const std::vector<double>& values);

/// mu of one contact point, and its slopes in ln Hs and in the parameters.
struct ParameterSlopes {
  double mu;
  double dmu_dlog_hersey;
  std::vector<double> dmu_dparameter;  ///< in the order of parameters_of(model)
};
/// Unlike evaluate, leaves a mu that is negative or not finite to the caller: a search may pass through it.
ParameterSlopes parameter_slopes(const Model& model, const Context& context);

}  // namespace heddle::friction
