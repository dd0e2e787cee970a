#include "macroscale/grid_error.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "macroscale/blank.h"

namespace heddle::macroscale {

StampingSpec coarse_companion(const StampingSpec& spec) {
  StampingSpec coarse = spec;
  // One spacing serves both directions; the larger of the two halves neither less than asked for.
  const auto halved = [](double spacing, int cells) { return spacing * cells / ((cells + 1) / 2); };
  const std::vector<double> layup = spec.blank.layup.empty() ? std::vector{0.0} : spec.blank.layup;
  coarse.blank.spacing = 0.0;
  for (const double turned : layup) {
    const Blank ply = make_blank(outline_of(spec.blank), spec.blank.spacing, spec.blank.orientation + turned,
                                 0.0, spec.blank.symmetry);
    coarse.blank.spacing =
        std::max({coarse.blank.spacing, halved(ply.spacing[0], ply.nu), halved(ply.spacing[1], ply.nv)});
  }
  return coarse;
}

GridError compare_grids(const StampingResult& run, const StampingResult& companion) {
  GridError error;
  const StampingSummary &fine = run.summary, &coarse = companion.summary;
  error.spacing = coarse.spacing;
  error.nodes = coarse.nodes;
  error.companion_force = coarse.peak_punch_force;
  const double ratio = std::sqrt(coarse.spacing[0] * coarse.spacing[1] / (fine.spacing[0] * fine.spacing[1]));
  if (!fine.completed) {
    error.reason = "the run itself did not end: " + fine.failure;
    return error;
  }
  if (!coarse.completed) {
    error.reason = "its companion on the coarser grid did not end: " + coarse.failure;
    return error;
  }
  if (run.history.size() != companion.history.size() || run.history.empty()) {
    error.reason = "the runs do not have the same steps";
    return error;
  }
  if (!(ratio > 1.2)) {
    error.reason = fmt::format("the companion's spacing is only {:.2f} times that of the run", ratio);
    return error;
  }
  const double left = 1.0 / (ratio - 1.0);  // first order: e(h) = e(r h) / r
  double largest = 0.0;
  for (std::size_t k = 0; k < run.history.size(); ++k)
    largest = std::max(largest, std::abs(run.history[k].punch_force - companion.history[k].punch_force));
  error.known = true;
  error.force = left * std::max(largest, std::abs(fine.peak_punch_force - coarse.peak_punch_force));
  error.force_share = fine.peak_punch_force > 0.0 ? error.force / fine.peak_punch_force : 0.0;
  error.extrapolated_force = fine.peak_punch_force + left * (fine.peak_punch_force - coarse.peak_punch_force);
  error.shear_angle = left * std::abs(fine.shear_angle_max - coarse.shear_angle_max);
  error.draw_in = left * std::abs(fine.draw_in_max - coarse.draw_in_max);
  return error;
}

GridError grid_error(const StampingSpec& spec, const mesoscale::FabricProperties& fabric,
                     const friction::Model& friction, const StampingResult& run,
                     const StampingControl& control) {
  const StampingSpec coarse = coarse_companion(spec);
  if (const Problems problems = check(coarse); !problems.empty()) {
    GridError error;
    error.reason = fmt::format("the grid cannot be coarsened: {} {} {}", problems.front().key,
                               problems.front().value, problems.front().rule);
    return error;
  }
  return compare_grids(run, run_stamping(coarse, fabric, friction, control));
}

}  // namespace heddle::macroscale
