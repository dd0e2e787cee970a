#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "pipeline/discover/prior.h"

/// What discovery knows of the world: numbers with priors, effects that may be missing, and a function from a
/// choice of them to what would be measured. It assumes nothing of the cost of that function.
namespace heddle::discover {

/// One number that a fit may move.
struct Unknown {
  std::string key;   ///< of the configuration or of a rig effect: "effects.static_peak.amplitude"
  std::string unit;  ///< as core/units takes it
  Prior prior;
};

/// Whether a name is physics to be added to the model, or a fault of the measurement or of the numerics.
enum class Kind { physics, rig, numerics };

/// A named effect that the model may lack. Its first number is the amplitude, whose off value leaves the
/// baseline.
struct Candidate {
  std::string id;
  Kind kind = Kind::physics;
  std::vector<Unknown> numbers;
  std::vector<std::string> look_alikes;
  std::string form;    ///< its equation
  std::string source;  ///< where form and priors come from
  /// ln of its share of its id's prior probability, where one id stands for many choices; else 0.
  double log_weight = 0.0;
  std::string detail = {};  ///< which choice, in words
};

/// Values of the numbers behind one prediction.
struct Trial {
  Eigen::VectorXd baseline;  ///< one a number of ForwardModel::baseline
  /// Candidates that are on, with a value for each of their numbers; in library order.
  std::vector<std::pair<std::size_t, Eigen::VectorXd>> effects;
};

struct ForwardModel {
  std::vector<Unknown> baseline;
  std::vector<Candidate> candidates;
  /// Logarithm of what would be measured, one entry an observation; NaN where the trial has no answer. Called
  /// from several threads at once.
  std::function<Eigen::VectorXd(const Trial&)> predict;
};

/// One coordinate over which the form of an effect may be off.
struct FormCoordinate {
  std::vector<int> level;  ///< of each observation: those that share the coordinate share the level
  Eigen::MatrixXd
      likeness;  ///< covariance of the error at two observations, of unit variance, mean taken out
};

/// What was measured, in the order of ForwardModel::predict.
struct Observations {
  Eigen::VectorXd value;       ///< ln of the observable
  Eigen::MatrixXd covariance;  ///< of value: noise, and what the model's form may be off
  /// Nature's form of an effect is not the library's: what it does to ln F may be off by a share `form` of
  /// itself over each coordinate that it depends on, smoothly. Empty: forms are taken as exact.
  std::vector<FormCoordinate> coordinates = {};
  double form = 0.25;
};

/// Candidates that are on, by number, rising. Empty: the baseline.
using Hypothesis = std::vector<std::size_t>;

}  // namespace heddle::discover
