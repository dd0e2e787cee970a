#pragma once

#include <string>
#include <vector>

#include "friction/model.h"

namespace heddle::friction {

/// A number of the model that friction tests can find.
struct Parameter {
  std::string key;   ///< as in the configuration, for instance "friction.exponent"
  const char* unit;  ///< "" for a plain number
  double value;
  bool acts_through_hersey;  ///< without a spread of Hs among the tests nothing tells it
  bool acts_through_tool_temperature;
};

/// {mu} | {C, s} | {a, b} | all numbers of another law, in the order of About<Law>::fields; then the tool
/// temperature slope where the effect is present. The film is not among them: n, m and h come from rheology
/// and microscopy. A table has none.
std::vector<Parameter> parameters_of(const Model& model);

/// @param values  in the order of parameters_of(model)
void set_parameters(Model& model, const std::vector<double>& values);

/// mu of one contact point, and its slopes in ln Hs and in the parameters.
struct ParameterSlopes {
  double mu;
  double dmu_dlog_hersey;
  std::vector<double> dmu_dparameter;  ///< in the order of parameters_of(model)
};
/// Whether the slopes below are exact, not differences: Coulomb, power and linear law on the film's power law
/// with no effect on but the shift.
bool has_exact_slopes(const Model& model);
/// Unlike evaluate, leaves a mu that is negative or not finite to the caller: a search may pass through it.
/// Exact where has_exact_slopes; central differences elsewhere (relative error about 1e-9).
/// @param state  of the contact at the moment of the test
ParameterSlopes parameter_slopes(const Model& model, const Context& context, const ContactState& state = {});

}  // namespace heddle::friction
