#include "pipeline/discover/validate.h"

#include <algorithm>
#include <cmath>

#include "pipeline/discover/prior.h"
#include "pipeline/discover/random.h"

namespace heddle::discover {

namespace {

struct Squares {
  double before = 0.0, after = 0.0;
};

double shrink_of(const Squares& sum) {
  return sum.before > 0.0 ? 1.0 - std::sqrt(sum.after / sum.before) : 0.0;
}

/// z with Phi(z) = p, by bisection: called twice.
double quantile(double p) {
  double low = -8.0, high = 8.0;
  for (int k = 0; k < 60; ++k) {
    const double middle = 0.5 * (low + high);
    (normal_probability(middle) < p ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace

Gap gap_of(const std::vector<HeldOut>& conditions, std::uint64_t seed) {
  const auto count = conditions.size();
  const auto n = static_cast<double>(count);
  Squares all;
  double noise = 0.0;
  for (const HeldOut& condition : conditions) {
    all.before += condition.before * condition.before;
    all.after += condition.after * condition.after;
    noise += condition.noise * condition.noise;
  }
  Gap gap{.before = std::sqrt(all.before / n),
          .after = std::sqrt(all.after / n),
          .floor = std::sqrt(noise / n),
          .shrink = shrink_of(all)};
  gap.conditions = static_cast<int>(count);
  if (gap.before > gap.floor) gap.closed = (gap.before - gap.after) / (gap.before - gap.floor);

  // Bias corrected and accelerated (Efron 1987): the share of draws below the estimate, and the skewness of
  // the values that leave one condition out.
  constexpr int draws = 2000;
  Random random(seed);
  std::vector<double> shrinks;
  for (int draw = 0; draw < draws; ++draw) {
    Squares sum;
    for (std::size_t k = 0; k < count; ++k) {
      const HeldOut& condition = conditions[random.below(count)];
      sum.before += condition.before * condition.before;
      sum.after += condition.after * condition.after;
    }
    shrinks.push_back(shrink_of(sum));
  }
  std::ranges::sort(shrinks);
  const auto below = static_cast<double>(std::ranges::lower_bound(shrinks, gap.shrink) - shrinks.begin());
  const double bias = quantile(std::clamp(below / draws, 1.0 / draws, 1.0 - 1.0 / draws));
  double mean = 0.0, cube = 0.0, square = 0.0;
  std::vector<double> without;
  for (const HeldOut& condition : conditions) {
    without.push_back(shrink_of(
        {all.before - condition.before * condition.before, all.after - condition.after * condition.after}));
    mean += without.back() / n;
  }
  for (const double value : without) {
    square += (mean - value) * (mean - value);
    cube += (mean - value) * (mean - value) * (mean - value);
  }
  const double acceleration = square > 0.0 ? cube / (6.0 * std::pow(square, 1.5)) : 0.0;
  const auto at = [&](double z) {
    const double shifted = bias + (bias + z) / (1.0 - acceleration * (bias + z));
    const double rank = normal_probability(shifted) * (draws - 1);
    return shrinks[static_cast<std::size_t>(std::clamp(rank, 0.0, draws - 1.0))];
  };
  gap.shrink_low = at(-1.959964);
  gap.shrink_high = at(1.959964);
  return gap;
}

}  // namespace heddle::discover
