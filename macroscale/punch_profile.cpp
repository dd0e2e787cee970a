#include "macroscale/punch_profile.h"

#include <algorithm>
#include <cmath>

namespace heddle::macroscale {

namespace {

struct Profile {
  double duration, stop, plateau;  ///< whole time, length of the stop [s], speed before it [m/s]
};

Profile profile_of(const ProcessSpec& process) {
  const double duration = process.time / process.speed_scale;
  const double stop = process.slow_down / process.speed_scale;
  return {duration, stop, process.stroke / (duration - 0.5 * stop)};
}

// Where a rising curve reaches y, by halving down to neighbouring numbers.
double time_on(const Curve& profile, double y) {
  double low = profile.x().front(), high = profile.x().back();
  if (y <= profile.y().front()) return low;
  if (y >= profile.y().back()) return high;
  for (;;) {
    const double middle = 0.5 * (low + high);
    if (!(middle > low && middle < high)) return high;
    (profile(middle) < y ? low : high) = middle;
  }
}

// Ratio of the lengths of two dwell steps that follow each other: the first as long as a step of the stroke
// in the mean, all together the dwell.
double growth_of(double first, double whole) {
  const auto sum = [&](double ratio) {
    double total = 0.0, length = first;
    for (int k = 0; k < dwell_rows; ++k, length *= ratio) total += length;
    return total;
  };
  if (sum(1.0) >= whole) return 1.0;
  double low = 1.0, high = 2.0;
  while (sum(high) < whole) high *= 2.0;
  for (int k = 0; k < 100; ++k) {
    const double middle = 0.5 * (low + high);
    (sum(middle) < whole ? low : high) = middle;
  }
  return high;
}

double dwell_share(const ProcessSpec& process, double rows) {
  const double ratio = growth_of(stroke_time(process) / process.steps, process.press.dwell);
  if (ratio == 1.0) return rows / dwell_rows;
  return std::expm1(rows * std::log(ratio)) / std::expm1(dwell_rows * std::log(ratio));
}

}  // namespace

double stroke_time(const ProcessSpec& process) {
  return profile_of(process).duration;
}

double mean_speed(const ProcessSpec& process) {
  return process.stroke / profile_of(process).duration;
}

double stroke_at_time(const ProcessSpec& process, double time) {
  const Profile p = profile_of(process);
  if (process.profile) return (*process.profile)(std::clamp(time, 0.0, p.duration) * process.speed_scale);
  const double t = std::clamp(time, 0.0, p.duration), left = p.duration - t;
  if (left >= p.stop) return p.plateau * t;
  return process.stroke - 0.5 * p.plateau * left * left / p.stop;
}

double time_at_stroke(const ProcessSpec& process, double travel) {
  const Profile p = profile_of(process);
  if (process.profile) return time_on(*process.profile, travel) / process.speed_scale;
  const double left = process.stroke - travel;
  if (left <= 0.0) return p.duration;
  if (left >= 0.5 * p.plateau * p.stop) return travel / p.plateau;
  return p.duration - std::sqrt(2.0 * left * p.stop / p.plateau);
}

int all_steps(const ProcessSpec& process) {
  return process.steps + (process.press.dwell > 0.0 ? dwell_rows : 0);
}

double time_at_step(const ProcessSpec& process, int step, double share) {
  if (step <= process.steps)
    return time_at_stroke(process, process.stroke / process.steps * (step - 1 + share));
  return stroke_time(process) + process.press.dwell * dwell_share(process, step - process.steps - 1 + share);
}

}  // namespace heddle::macroscale
