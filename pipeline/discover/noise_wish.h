#pragma once

#include <optional>

namespace heddle::discover {

/// What the user says of the scatter of ln F; what is empty comes from the data.
struct NoiseWish {
  std::optional<double> sample = {};  ///< standard deviation from piece to piece of fabric
  std::optional<double> day = {};     ///< from day to day, shared by all that was pulled on one
  double sample_assumed = 0.05;       ///< where no condition was repeated; prior
  double day_assumed = 0.02;          ///< where no condition was repeated on three days; prior
  double reading = 0.015;             ///< of one stretch beside the next, where replicates do not tell; prior
  /// How far the law's own curve over ln Hs may be off before its error counts as a missing effect, and over
  /// how long a stretch of ln Hs it wanders: a smooth Gaussian process.
  double form = 0.02;
  double form_length = 1.5;
  /// How far a pull may be from even along its slip, alike in all conditions, before that counts: rigs take
  /// up, fabrics settle. Over one e-fold of slip.
  double history = 0.01;
  /// The same of an effect: a share of what it does to ln F over each factor and over ln slip, wandering over
  /// this share of their ranges.
  double effect_form = 0.25;
  double effect_form_length = 0.5;
};

}  // namespace heddle::discover
