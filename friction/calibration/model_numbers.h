#pragma once

#include <string>
#include <vector>

#include "friction/friction_test.h"
#include "friction/model.h"

namespace heddle::friction {

/// One number of a model that a fit may move.
struct ModelNumber {
  std::string key;   ///< as in the configuration: "friction.scale", "resin.power_index"
  std::string unit;  ///< as core/units takes it; "" for a plain number
  Bounds range;      ///< in which it must lie, in SI
  double value = 0.0;
};

/// Every number of the model that acts: of the law, of the film and its rheology where the law reads a Hersey
/// number, of the effects that are there. Choices (a form, a table) are no numbers.
std::vector<ModelNumber> numbers_of(const Model& model);

/// The same of every law, rheology and effect there is, whatever acts in one model: names for a choice.
std::vector<ModelNumber> all_numbers();

/// The number itself. The reference holds while the model is not given another law, rheology or effect.
/// @param key  one of numbers_of(model)
/// @throws std::out_of_range  if the model has no such number
double& number_in(Model& model, const std::string& key);

/// What one reading of a friction test saw.
struct PullReading {
  Context context;
  double slip = 0.0;   ///< at which the force is read [m]
  double dwell = 0.0;  ///< rest under load before the pull [s]
};

/// mu of a reading, with the memory that the model itself gives the contact.
/// @return whatever comes out: a search may pass through what is negative or not finite
double coefficient_of(const Model& model, const PullReading& reading);

/// d mu / d number at one reading.
struct NumberSlope {
  double value = 0.0;
  bool exact = false;  ///< from the law's own slopes; else by differences
  /// Of differences: how far two step sizes disagree, as a change of ln mu per relative change of the number
  /// (of one that is 0, per change that moves mu by about its own size).
  double error = 0.0;
};

/// Exact for the constants of Coulomb, power and linear law, for m, n, h, E, T_ref and g0 of the film beneath
/// the latter two, and for the slope of the tool temperature shift, while no other effect is on and the film
/// has its own power law. Else central differences of fourth order whose step is taken from the number's own
/// effect on mu, one-sided at the end of its range.
/// @param keys  of numbers_of(model)
std::vector<NumberSlope> number_slopes(const Model& model, const PullReading& reading,
                                       const std::vector<std::string>& keys);

}  // namespace heddle::friction
