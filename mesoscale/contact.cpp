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

// One kind of quarter crossing under a plate at depth d: u along the upper tow, v across it.
struct Quarter {
  const CrossingGeometry& crossing;
  std::size_t top;  ///< 0: the warp is the upper tow
  bool upper_floats, lower_floats;
  double depth;
  /// Of the crowns of {warp, weft} below the plane of the highest, where faces are not flush [m].
  std::array<double, 2> sunk;

  const TowGeometry& upper_tow() const { return crossing.tow[top]; }
  const TowGeometry& lower_tow() const { return crossing.tow[1 - top]; }
  double length() const { return 0.5 * lower_tow().spacing; }  ///< of the quarter along u
  double breadth() const { return 0.5 * upper_tow().spacing; }
  static double path_drop(const TowGeometry& tow, bool floats, double u) {
    return floats ? 0.0 : tow.path.drop(u);
  }
  double upper(double u, double v) const {
    return path_drop(upper_tow(), upper_floats, u) + drop(upper_tow().section, Face::upper, v) + sunk[top];
  }
  double lower(double u, double v) const {
    return lower_tow().path.height - path_drop(lower_tow(), lower_floats, v) +
           drop(lower_tow().section, Face::upper, u) + sunk[1 - top];
  }

  struct Touched {
    double upper_end;    ///< the upper tow is touched for v in [0, upper_end]
    double lower_start;  ///< the lower tow is touched for v in [lower_start, p/2]
  };
  Touched touched(double u) const;
  std::array<double, 6> kinks() const;
};

Quarter::Touched Quarter::touched(double u) const {
  const double left = depth - sunk[top] - path_drop(upper_tow(), upper_floats, u);
  double end = left > 0.0
                   ? std::min(reach(upper_tow().section, Face::upper, left), 0.5 * width(upper_tow().section))
                   : 0.0;
  double start = breadth();
  const TowGeometry& below = lower_tow();
  if (u < 0.5 * width(below.section) && !lower_floats) {
    const double must_fall = below.path.height + drop(below.section, Face::upper, u) + sunk[1 - top] - depth;
    if (must_fall < 0.5 * below.path.height) start = below.path.reach(must_fall);
  }
  if (end > start) {
    // Both faces are below the plate here: the higher one is touched. Their difference grows with v.
    const auto difference = [&](double v) { return upper(u, v) - lower(u, v); };
    const double at_start = difference(start), at_end = difference(end);
    const double change = at_start >= 0.0 ? start
                          : at_end <= 0.0 ? end
                                          : bracketed_root(start, at_start, end, at_end,
                                                           1e-13 * upper_tow().spacing, difference);
    // Lens tows never get here with a root: the upper face is the higher one as far as it goes.
    start = end = change;
  }
  return {end, start};
}

// Where the touched intervals change their kind along u.
std::array<double, 6> Quarter::kinks() const {
  const double edge = length();
  const ArcPath &over = upper_tow().path, &under = lower_tow().path;
  const double below_crown = depth - sunk[top];
  const double fallen = upper_floats || below_crown >= 0.5 * over.height ? edge : over.reach(below_crown);
  const double above_lower = depth - sunk[1 - top] - 0.5 * under.height;
  const double lower_end = lower_floats ? 0.0 : reach(lower_tow().section, Face::upper, above_lower);
  std::array<double, 6> u{0.0,       fallen, std::min(over.wrap(), edge), 0.5 * width(lower_tow().section),
                          lower_end, edge};
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

// Crowns of {warp, weft} below the highest.
std::array<double, 2> sunk_crowns(const CrossingGeometry& crossing) {
  const auto crown = [&](std::size_t i) {
    return 0.5 * (crossing.tow[i].path.height + thickness(crossing.tow[i].section));
  };
  // Flush faces, but for rounding.
  const double apart = crown(0) - crown(1);
  if (std::abs(apart) <= 1e-14 * crown(0)) return {0.0, 0.0};
  return {std::max(-apart, 0.0), std::max(apart, 0.0)};
}

template <class Inside>
double cell_average(const PlateContact& plate, double depth, const Inside& inside) {
  // Of a balanced crossing it does not matter which tow is on top.
  const bool alike = plate.crossing.balanced();
  const std::array<double, 2> sunk = sunk_crowns(plate.crossing);
  double sum = 0.0;
  for (std::size_t top = 0; top < (alike ? 1 : 2); ++top)
    for (std::size_t upper = 0; upper < 2; ++upper)
      for (std::size_t lower = 0; lower < 2; ++lower) {
        const double share =
            plate.quarters[top][upper][lower] + (alike ? plate.quarters[1][upper][lower] : 0.0);
        if (share == 0.0) continue;
        const Quarter quarter{plate.crossing, top, upper == 1, lower == 1, depth, sunk};
        sum += share * over_quarter(quarter, plate.panels, [&](double u, const Quarter::Touched& t) {
                 return inside(quarter, u, t);
               });
      }
  const double quarter_area = 0.25 * plate.crossing.area();
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
    const std::array<TowGeometry, 2> tow = sheared(unsheared, angle).tow;
    if (angles.empty() || std::max(tow[0].fibre_fraction, tow[1].fibre_fraction) <= packed_fibre_fraction)
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
    return t.upper_end + quarter.breadth() - t.lower_start;
  });
}

double PlateContact::pressure(double depth) const {
  constexpr int across = 2;
  return cell_average(*this, depth, [&](const Quarter& quarter, double u, const Quarter::Touched& t) {
    const TowSqueeze &above = squeeze[quarter.top], &below = squeeze[1 - quarter.top];
    return integrate(0.0, t.upper_end, across,
                     [&](double v) { return above.stress(depth - quarter.upper(u, v)); }) +
           integrate(t.lower_start, quarter.breadth(), across,
                     [&](double v) { return below.stress(depth - quarter.lower(u, v)); });
  });
}

double PlateContact::depth_at(double wanted) const {
  // The tow that packs first sets the depth.
  const double deepest = std::min(squeeze[0].squeeze_at(1.2), squeeze[1].squeeze_at(1.2));
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
  const auto squeeze = [&](const TowGeometry& tow) {
    return TowSqueeze(law, thickness(tow.section), tow.fibre_fraction);
  };
  return {crossing, fabric.quarters, {squeeze(crossing.tow[0]), squeeze(crossing.tow[1])}};
}

double shallow_touched_fraction(const CrossingGeometry& crossing, double depth) {
  double radii = 0.0;
  for (const TowGeometry& tow : crossing.tow)
    radii += 0.5 * std::sqrt(crown_radius(tow.section, Face::upper) * tow.path.radius);
  return 2.0 * std::numbers::pi * depth * radii / crossing.area();
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
