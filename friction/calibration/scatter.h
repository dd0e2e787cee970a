#pragma once

#include <optional>
#include <string>

#include "friction/calibration/coupon_data.h"

namespace heddle::friction {

/// Standard deviation of ln F from one cause, and how far it is known.
struct Scatter {
  enum class Source {
    given,       ///< by the user
    replicates,  ///< samples pulled under one condition on one day
    residuals,   ///< what the fit leaves over
    anchors,     ///< one condition repeated on several days
    assumed,     ///< nothing in the data tells it
    unknown      ///< and nothing is assumed
  };
  double sd = 0.0;  ///< [-]
  Source source = Source::unknown;
  int degrees_of_freedom = 0;  ///< behind an estimate; 0 where it is not one

  bool estimated() const {
    return source == Source::replicates || source == Source::residuals || source == Source::anchors;
  }
};
const char* in_words(Scatter::Source source);

/// How measured forces scatter: ln F = ln F_model + g_sample + d_day + e_reading, each normal and
/// independent. The day's shift is shared by all its samples, so replicates of one day do not see it.
struct NoiseModel {
  Scatter sample;        ///< gain of one piece of fabric
  Scatter day;           ///< of rig, batch and operator of one day
  double reading = 0.0;  ///< of one stretch of a pull beside the next; only where a sample has several
};

/// Pooled within condition and day, over sample means of ln mu; the part that stretches of one pull scatter
/// by is taken off. Empty where no condition has two samples on one day.
std::optional<Scatter> scatter_of_samples(const CouponData& data, int faces, double reading);

/// Between the daily means of the condition that most days repeat, less what the samples of a day explain; 0
/// if that is all. Empty below three days: two differ by chance.
std::optional<Scatter> scatter_of_days(const CouponData& data, int faces, double sample_sd);

}  // namespace heddle::friction
