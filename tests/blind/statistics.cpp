#include "statistics.h"

#include <algorithm>
#include <cmath>

namespace heddle::blind {

Interval wilson(const Rate& rate) {
  if (rate.of == 0) return {};
  constexpr double z = 1.959963984540054;  // normal quantile of 0.975
  const double n = rate.of, p = rate.value();
  const double centre = p + z * z / (2.0 * n);
  const double spread = z * std::sqrt(p * (1.0 - p) / n + z * z / (4.0 * n * n));
  const double scale = 1.0 + z * z / n;
  return {std::max(0.0, (centre - spread) / scale), std::min(1.0, (centre + spread) / scale)};
}

std::optional<double> median(std::vector<double> values) {
  if (values.empty()) return std::nullopt;
  std::ranges::sort(values);
  const std::size_t middle = values.size() / 2;
  return values.size() % 2 == 1 ? values[middle] : 0.5 * (values[middle - 1] + values[middle]);
}

std::vector<Bin> reliability(std::span<const Forecast> forecasts) {
  std::vector<Bin> bins(5);
  for (const Forecast& forecast : forecasts) {
    Bin& bin = bins[static_cast<std::size_t>(std::clamp(static_cast<int>(forecast.probability * 5.0), 0, 4))];
    bin.right.count(forecast.right);
    bin.stated += forecast.probability;
  }
  for (Bin& bin : bins) bin.stated /= std::max(1, bin.right.of);
  return bins;
}

double calibration_error(std::span<const Forecast> forecasts) {
  double sum = 0.0;
  for (const Bin& bin : reliability(forecasts))
    sum += bin.right.of * std::abs(bin.stated - bin.right.value());
  return forecasts.empty() ? 0.0 : sum / static_cast<double>(forecasts.size());
}

}  // namespace heddle::blind
