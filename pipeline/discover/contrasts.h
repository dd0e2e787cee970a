#pragma once

#include <optional>
#include <span>
#include <vector>

#include "friction/friction_test.h"

namespace heddle::discover {

/// Slopes of ln mu, mu = F/(2 N), from pairs of pulls that differ in one condition alone; empty where there
/// is no such pair. Errors row by row may look like scatter where a slope has the wrong sign.
struct Sensitivities {
  std::optional<double> velocity;          ///< d ln mu / d ln U
  std::optional<double> normal_force;      ///< d ln mu / d ln N
  std::optional<double> tool_temperature;  ///< [1/K]

  /// n of a law of U^n/N alone: minus the ratio of the first two.
  std::optional<double> implied_index() const;
  /// Whether a law of one Hersey number with 0 < n <= 1 can have these slopes; true where nothing is known.
  bool can_be_hersey() const;
};

/// @param forces  one a row [N], measured or of some model; > 0
Sensitivities sensitivities_of(std::span<const friction::FrictionTestRow> rows,
                               const std::vector<double>& forces);

}  // namespace heddle::discover
