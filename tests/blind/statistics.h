#pragma once

#include <optional>
#include <span>
#include <vector>

namespace heddle::blind {

/// So many of so many.
struct Rate {
  int hits = 0, of = 0;
  void count(bool hit) {
    ++of;
    hits += hit ? 1 : 0;
  }
  double value() const { return of > 0 ? static_cast<double>(hits) / of : 0.0; }
};

struct Interval {
  double low = 0, high = 1;
};

/// Wilson's score interval at 95 %; [0, 1] of nothing.
/// @source E. B. Wilson, J. Am. Stat. Assoc. 22 (1927) 209
Interval wilson(const Rate& rate);

/// @return nothing of an empty list
std::optional<double> median(std::vector<double> values);

/// A stated probability and whether it came true.
struct Forecast {
  double probability = 0;  ///< 0..1
  bool right = false;
};

/// One bar of a reliability diagram.
struct Bin {
  Rate right;
  double stated = 0;  ///< mean probability of the forecasts in it
};

/// Five bins of equal width over [0, 1].
std::vector<Bin> reliability(std::span<const Forecast> forecasts);

/// Expected calibration error: mean over forecasts of |mean stated probability - share right| of their bin.
double calibration_error(std::span<const Forecast> forecasts);

}  // namespace heddle::blind
