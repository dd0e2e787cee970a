#include "friction/rig/curved_plates.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <tuple>

#include <fmt/format.h>

namespace heddle::friction {

namespace {

struct Faces {
  double lower = 0.0, upper = 0.0;  ///< pressures [Pa]
};

/// Pressures of the two faces of a layer closed by `closing`, the lower one `difference` above the upper.
Faces faces_of(const Curve& compaction, double closing, double difference) {
  const auto pressure = [&](double approach) { return approach > 0.0 ? compaction(approach) : 0.0; };
  // p_l(a) - p_u(closing - a) rises with a. Where tension alone lifts the fabric off one plate, the other
  // carries it all, whatever that presses it by.
  double low = std::min(0.0, closing), high = std::max(0.0, closing);
  if (difference >= pressure(closing)) return {.lower = std::max(difference, 0.0), .upper = 0.0};
  if (difference <= -pressure(closing)) return {.lower = 0.0, .upper = std::max(-difference, 0.0)};
  for (int k = 0; k < 60; ++k) {
    const double middle = 0.5 * (low + high);
    (pressure(middle) - pressure(closing - middle) < difference ? low : high) = middle;
  }
  const double approach = 0.5 * (low + high);
  return {.lower = pressure(approach), .upper = pressure(closing - approach)};
}

/// The march along the path at one closing of the plates.
class March {
 public:
  March(const SCurve& path, const Model& model, const FrictionTestRow& row, const FrictionRig& rig,
        const Curve& compaction, double width, const AreaFunction& area)
      : path_(path),
        model_(model),
        row_(row),
        rig_(rig),
        compaction_(compaction),
        width_(width),
        area_(area),
        length_(rig.plate_area / width),
        lead_(0.5 * (length_ - path.arcs())) {}

  /// Heun's rule; the arcs start and end on steps.
  CurvedPull at_closing(double closing) const {
    CurvedPull pull;
    pull.closing = closing;
    double tension = 0.0, s = 0.0, touching = 0.0;
    for (const double end : {lead_, lead_ + 0.5 * path_.arcs(), lead_ + path_.arcs(), length_}) {
      constexpr int steps = 100;
      const double step = (end - s) / steps, from = s;
      for (int k = 0; k < steps; ++k) {
        const double middle = from + (k + 0.5) * step;  // curvature of this stretch; slope varies with s
        const double curvature = friction::at(path_, middle - lead_).curvature;
        const Slice here = slice(from + k * step, curvature, tension, closing);
        const Slice there = slice(from + (k + 1) * step, curvature, tension + step * here.friction, closing);
        pull.s.push_back(middle);
        pull.tension.push_back(tension);
        pull.lower_pressure.push_back(here.faces.lower);
        pull.upper_pressure.push_back(here.faces.upper);
        if (here.faces.lower > 0.0 && here.faces.upper > 0.0) touching += step;
        tension += 0.5 * step * (here.friction + there.friction);
        pull.upper_load += 0.5 * step * (here.load + there.load);
      }
      s = end;
    }
    pull.pull_force = tension;
    pull.released = 1.0 - touching / length_;
    return pull;
  }

 private:
  struct Slice {
    Faces faces;
    double friction, load;  ///< per length of path [N/m]
  };

  Slice slice(double s, double curvature, double tension, double closing) const {
    const double slope = friction::at(path_, s - lead_).slope;
    const Faces faces = faces_of(compaction_, closing * std::cos(slope), tension * curvature / width_);
    const double lower = traction_at(faces.lower), upper = traction_at(faces.upper);
    return {.faces = faces,
            .friction = width_ * (lower + upper),
            .load = width_ * (faces.upper * std::cos(slope) - upper * std::sin(slope))};
  }

  double traction_at(double pressure) const {
    if (pressure == 0.0) return 0.0;
    Context context = contact_of(row_, rig_);
    context.pressure = pressure;
    if (area_) std::tie(context.area_fraction, context.area_slope) = area_(pressure);
    return traction(model_, context, state_after_pull(model_, context, rig_)).value;
  }

  const SCurve& path_;
  const Model& model_;
  const FrictionTestRow& row_;
  const FrictionRig& rig_;
  const Curve& compaction_;
  double width_;
  const AreaFunction& area_;
  double length_, lead_;  ///< of the path, and level before the arcs [m]
};

}  // namespace

PathPoint at(const SCurve& path, double s) {
  const double half = path.radius * path.angle;
  if (s <= 0.0 || s >= 2.0 * half) return {};
  if (s < half) return {.slope = s / path.radius, .curvature = 1.0 / path.radius};
  return {.slope = path.angle - (s - half) / path.radius, .curvature = -1.0 / path.radius};
}

CurvedPull pull_over(const SCurve& path, const Model& model, const FrictionTestRow& row,
                     const FrictionRig& rig, const Curve& compaction, double width,
                     const AreaFunction& area) {
  if (path.arcs() > rig.plate_area / width)
    throw std::invalid_argument(
        fmt::format("curved plates: arcs of {} m on a path of {} m", path.arcs(), rig.plate_area / width));
  const March march(path, model, row, rig, compaction, width, area);
  double low = 0.0, high = 2.0 * compaction.x().back();
  const double most = march.at_closing(high).upper_load;
  if (most < row.normal_force)
    throw NumericalError(
        fmt::format("curved plates, row {}: {} N is more than the compaction curve carries ({} N)", row.name,
                    row.normal_force, most));
  for (int k = 0; k < 50; ++k) {
    const double middle = 0.5 * (low + high);
    (march.at_closing(middle).upper_load < row.normal_force ? low : high) = middle;
  }
  return march.at_closing(0.5 * (low + high));
}

}  // namespace heddle::friction
