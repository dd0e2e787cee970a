#pragma once

#include "macroscale/stamping.h"

namespace heddle::macroscale {

/// Punch motion: constant speed, then, if asked for, a linear stop over the last part (paper, section 3.2.2:
/// "relatively constant" and slowing "only in the final 0.01 s"); or a table (macroscale/punch_table.h).
/// speed_scale squeezes the whole profile in time.

/// Duration of the stroke [s].
double stroke_time(const ProcessSpec& process);
/// Stroke over its time [m/s].
double mean_speed(const ProcessSpec& process);
/// Downward travel at a time [m].
double stroke_at_time(const ProcessSpec& process, double time);
/// Its inverse [s], for 0 <= travel <= stroke.
double time_at_stroke(const ProcessSpec& process, double travel);

/// Steps of the stroke and, where there is a dwell, those after it.
int all_steps(const ProcessSpec& process);
/// Time at a share of a step [s], 1 <= step <= all_steps: equal in stroke, then, while the tools stand still,
/// growing from the mean step of the stroke.
double time_at_step(const ProcessSpec& process, int step, double share);

}  // namespace heddle::macroscale
