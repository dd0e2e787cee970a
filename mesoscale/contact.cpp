#include "mesoscale/contact.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include "core/problem.h"
#include "mesoscale/quadrature.h"
#include "mesoscale/root.h"

namespace heddle::mesoscale {

namespace {

// One kind of quarter crossing under a plate at depth d.
struct Quarter {
  const CrossingGeometry& crossing;
  bool upper_floats, lower_floats;
  double depth;

  double half_pitch() const { return 0.5 * crossing.pitch; }
  double half_width() const { return 0.5 * crossing.section.width; }
  double path_drop(bool floats, double u) const { return floats ? 0.0 : crossing.path.drop(u); }
  double upper(double u, double v) const { return path_drop(upper_floats, u) + crossing.section.drop(v); }
  double lower(double u, double v) const {
    return crossing.path.height - path_drop(lower_floats, v) + crossing.section.drop(u);
  }

  struct Touched {
    double upper_end;    ///< the upper tow is touched for v in [0, upper_end]
    double lower_start;  ///< the lower tow is touched for v in [lower_start, p/2]
  };
  Touched touched(double u) const;
  std::array<double, 6> kinks() const;
};

Quarter::Touched Quarter::touched(double u) const {
  const double left = depth - path_drop(upper_floats, u);
  double end = left > 0.0 ? std::min(crossing.section.reach(left), half_width()) : 0.0;
  double start = half_pitch();
  if (u < half_width() && !lower_floats) {
    const double must_fall = crossing.path.height + crossing.section.drop(u) - depth;
    if (must_fall < 0.5 * crossing.path.height) start = crossing.path.reach(must_fall);
  }
  if (end > start) {
    // Both faces are below the plate here: the higher one is touched. Their difference grows with v.
    const auto difference = [&](double v) { return upper(u, v) - lower(u, v); };
    const double at_start = difference(start), at_end = difference(end);
    const double change =
        at_start >= 0.0 ? start
        : at_end <= 0.0 ? end
                        : bracketed_root(start, at_start, end, at_end, 1e-13 * crossing.pitch, difference);
    start = change;
  }
  return {end, start};
}

// Where the touched intervals change their kind along u.
std::array<double, 6> Quarter::kinks() const {
  const double edge = half_pitch();
  const double fallen =
      upper_floats || depth >= 0.5 * crossing.path.height ? edge : crossing.path.reach(depth);
  const double above_lower = depth - 0.5 * crossing.path.height;
  const double lower_end = lower_floats ? 0.0 : crossing.section.reach(above_lower);
  std::array<double, 6> u{0.0, fallen, std::min(crossing.path.wrap(), edge), half_width(), lower_end, edge};
  std::sort(u.begin(), u.end());
  return u;
}

// Integral over the quarter of what `inside(u, touched)` returns, piece by piece between kinks.
template <class Inside>
double over_quarter(const Quarter& quarter, int panels, const Inside& inside) {
  const std::array<double, 6> kinks = quarter.kinks();
  double sum = 0.0;
  for (std::size_t k = 0; k + 1 < kinks.size(); ++k)
    sum += integrate_clustered(kinks[k], kinks[k + 1], panels,
                               [&](double u) { return inside(u, quarter.touched(u)); });
  return sum;
}

template <class Inside>
double cell_average(const PlateContact& plate, double depth, const Inside& inside) {
  double sum = 0.0;
  for (int upper = 0; upper < 2; ++upper)
    for (int lower = 0; lower < 2; ++lower) {
      const double share = plate.quarters[static_cast<std::size_t>(upper)][static_cast<std::size_t>(lower)];
      if (share == 0.0) continue;
      const Quarter quarter{plate.crossing, upper == 1, lower == 1, depth};
      sum += share * over_quarter(quarter, plate.panels,
                                  [&](double u, const Quarter::Touched& t) { return inside(quarter, u, t); });
    }
  const double quarter_area = 0.25 * plate.crossing.pitch * plate.crossing.pitch;
  return sum / quarter_area;
}

Curve compaction_curve(const PlateContact& plate, const ContactGrid& grid) {
  const double deepest = plate.depth_at(grid.highest_pressure);
  std::vector<double> depth(static_cast<std::size_t>(grid.depths)), pressure(depth.size());
  for (std::size_t k = 0; k < depth.size(); ++k) {
    depth[k] = deepest * static_cast<double>(k) / static_cast<double>(depth.size() - 1);
    pressure[k] = plate.pressure(depth[k]);
  }
  return Curve(std::move(depth), std::move(pressure));
}

// The compaction curve brackets each depth, so few evaluations are left for the root.
Curve area_curve(const PlateContact& plate, const Curve& compaction, const ContactGrid& grid) {
  const double low = std::log(grid.lowest_pressure), high = std::log(0.999 * grid.highest_pressure);
  std::vector<double> log_pressure(static_cast<std::size_t>(grid.pressures)),
      log_fraction(log_pressure.size());
  std::size_t above = 1;
  for (std::size_t k = 0; k < log_pressure.size(); ++k) {
    log_pressure[k] =
        low + (high - low) * static_cast<double>(k) / static_cast<double>(log_pressure.size() - 1);
    const double pressure = std::exp(log_pressure[k]);
    while (above + 1 < compaction.y().size() && compaction.y()[above] < pressure) ++above;
    const double shallow = above == 1 ? 1e-6 * compaction.x()[1] : compaction.x()[above - 1];
    log_fraction[k] =
        std::log(plate.touched_fraction(plate.depth_between(pressure, shallow, compaction.x()[above])));
  }
  return Curve(std::move(log_pressure), std::move(log_fraction));
}

// Angles at which the tows are not yet packed sideways; the last is held beyond.
std::vector<double> usable_angles(const CrossingGeometry& unsheared, const ContactGrid& grid) {
  std::vector<double> angles;
  for (const double degrees : grid.shear_angles_deg) {
    const double angle = degrees * std::numbers::pi / 180.0;
    if (angles.empty() || sheared(unsheared, angle).fibre_fraction <= packed_fibre_fraction)
      angles.push_back(angle);
  }
  return angles;
}

double error_against_half(PlateContact plate, const ContactGrid& grid) {
  PlateContact half = plate;
  half.panels = plate.panels / 2;
  double worst = 0.0;
  for (double pressure = 100.0; pressure < grid.highest_pressure; pressure *= 10.0) {
    const double depth = plate.depth_at(pressure);
    worst = std::max({worst, std::abs(half.pressure(depth) / plate.pressure(depth) - 1.0),
                      std::abs(half.touched_fraction(depth) / plate.touched_fraction(depth) - 1.0)});
  }
  return worst;
}

}  // namespace

double PlateContact::touched_fraction(double depth) const {
  return cell_average(*this, depth, [](const Quarter& quarter, double, const Quarter::Touched& t) {
    return t.upper_end + quarter.half_pitch() - t.lower_start;
  });
}

double PlateContact::pressure(double depth) const {
  constexpr int across = 2;
  return cell_average(*this, depth, [&](const Quarter& quarter, double u, const Quarter::Touched& t) {
    return integrate(0.0, t.upper_end, across,
                     [&](double v) { return squeeze.stress(depth - quarter.upper(u, v)); }) +
           integrate(t.lower_start, quarter.half_pitch(), across,
                     [&](double v) { return squeeze.stress(depth - quarter.lower(u, v)); });
  });
}

double PlateContact::depth_at(double wanted) const {
  const double deepest = squeeze.squeeze_at(1.2);
  return depth_between(wanted, 1e-9 * deepest, deepest);
}

double PlateContact::depth_between(double wanted, double shallow, double deep) const {
  const double target = std::log(wanted);
  const auto excess = [&](double log_depth) { return std::log(pressure(std::exp(log_depth))) - target; };
  const double low = std::log(shallow), high = std::log(deep), f_low = excess(low), f_high = excess(high);
  if (!(f_low <= 0.0 && f_high >= 0.0))
    throw NumericalError(
        fmt::format("contact: a pressure of {:.4g} Pa is not reached between depths {:.4g} and {:.4g} m "
                    "at shear angle {:.4g} rad",
                    wanted, shallow, deep, crossing.shear_angle));
  if (f_low == f_high) return deep;  // both zero: the bracket is a point
  // ln P is nearly straight in ln d, since P ~ d^2 at first.
  return std::exp(bracketed_root(low, f_low, high, f_high, 1e-10, excess));
}

PlateContact plate_contact(const FabricGeometry& fabric, const CompactionLaw& law, double shear_angle) {
  const CrossingGeometry crossing = sheared(fabric.crossing, shear_angle);
  return {crossing, fabric.quarters, TowSqueeze(law, crossing.section.thickness, crossing.fibre_fraction)};
}

double shallow_touched_fraction(const CrossingGeometry& crossing, double depth) {
  const double radii = std::sqrt(crossing.section.radius() * crossing.path.radius);
  return 2.0 * std::numbers::pi * depth * radii / (crossing.pitch * crossing.pitch);
}

ContactTables contact_tables(const FabricGeometry& fabric, const CompactionLaw& law,
                             const ContactGrid& grid) {
  const std::vector<double> angles = usable_angles(fabric.crossing, grid);
  const std::size_t n = angles.size();
  std::vector<double> errors(n);
  std::vector<Curve> compaction(n), area(n);
  tbb::parallel_for(std::size_t{0}, n, [&](std::size_t k) {
    const PlateContact plate = plate_contact(fabric, law, angles[k]);
    compaction[k] = compaction_curve(plate, grid);
    area[k] = area_curve(plate, compaction[k], grid);
    errors[k] = error_against_half(plate, grid);
  });
  return {CurveFamily(angles, std::move(compaction)), ContactArea{CurveFamily(angles, std::move(area))},
          *std::max_element(errors.begin(), errors.end())};
}

}  // namespace heddle::mesoscale
