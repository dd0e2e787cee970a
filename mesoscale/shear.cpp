#include "mesoscale/shear.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include "core/problem.h"
#include "mesoscale/root.h"

namespace heddle::mesoscale {

namespace {

constexpr double gas_constant = 8.314462618;  // [J/(mol K)]

// The tows of the unsheared fabric with the contact radius and edge of the sheared crossing.
std::array<TensionTow, 2> sheared_tows(const ShearModel& model, double shear_angle) {
  const CrossingGeometry crossing = sheared(model.fabric.crossing, shear_angle);
  std::array<TensionTow, 2> tows = model.tension.tow;
  for (std::size_t i = 0; i < 2; ++i)
    tows[i].length = length_law(crossing.tow[i], crossing.tow[1 - i], tows[i].length.form);
  return tows;
}

CrossoverContact contact_at(const ShearModel& model, double shear_angle) {
  return {model.fabric.crossing, shear_angle, model.law, model.fabric.quarters};
}

// Strain at which a tow of this crimp height carries the tension.
double strain_under(const TensionTow& tow, double tension, double height) {
  const auto excess = [&](double strain) {
    return tow.evaluate(strain, height).fabric_force / tow.spacing - tension;
  };
  const double low = -0.2, high = 0.2;
  const double at_low = excess(low), at_high = excess(high);
  if (!(at_low < 0.0 && at_high > 0.0))
    throw NumericalError(fmt::format("shear: no strain between -20 and 20 % carries {:.4g} N/m", tension));
  return bracketed_root(low, at_low, high, at_high, 1e-12 * tension, excess);
}

double potential_of(const ShearModel& model, const std::array<TensionTow, 2>& tows,
                    const CrossoverContact& contact, const std::array<double, 2>& strain,
                    const std::array<double, 2>& height) {
  const TensionTow::State warp = tows[0].evaluate(strain[0], height[0]),
                          weft = tows[1].evaluate(strain[1], height[1]);
  const double approach = (tows[0].rest_height - height[0]) + (tows[1].rest_height - height[1]);
  const double stored = (warp.energy + weft.energy) + (warp.bending_energy + weft.bending_energy) +
                        contact.evaluate(approach).energy;
  return stored / model.tension.area() - model.reference_tension * (strain[0] + strain[1]);
}

// Two tows that carry the tension and press on each other.
class LoadedPair {
 public:
  LoadedPair(const std::array<TensionTow, 2>& tows, double tension)
      : tows_(tows), tension_(tension), small_(tension * 0.5 * (tows[0].spacing + tows[1].spacing)) {}

  double force_scale() const { return small_; }

  // Heights of a mean of which each tow lifts equally: one root more, which is known where the tows are
  // alike.
  std::array<double, 2> heights(double mean) const {
    const double start = 0.5 * (tows_[0].rest_height - tows_[1].rest_height);
    const auto excess = [&](double off) { return lift(0, mean + off) - lift(1, mean - off); };
    const double at_start = excess(start);
    double off = start;
    if (at_start != 0.0) {
      const double way = at_start < 0.0 ? 1.0 : -1.0;
      double reach = 0.1 * (tows_[0].rest_height + tows_[1].rest_height);
      double far = start + way * reach, at_far = excess(far);
      for (int k = 0; k < 5 && !(way * at_far > 0.0); ++k) {
        reach *= 2.0;
        far = start + way * reach;
        at_far = excess(far);
      }
      if (!(way * at_far > 0.0))
        throw NumericalError(fmt::format("shear: no crimp heights of mean {:.4g} m balance", mean));
      off = at_start < 0.0 ? bracketed_root(start, at_start, far, at_far, 1e-12 * small_, excess)
                           : bracketed_root(far, at_far, start, at_start, 1e-12 * small_, excess);
    }
    return {mean + off, mean - off};
  }

  double lift(std::size_t i, double height) const {
    return tows_[i].evaluate(strain(i, height), height).lift;
  }
  double strain(std::size_t i, double height) const { return strain_under(tows_[i], tension_, height); }

 private:
  const std::array<TensionTow, 2>& tows_;
  double tension_, small_;
};

// How much narrower than free a tow has become, and how fast it does so.
struct Narrowing {
  double by;     ///< w - w_o cos g [m]
  double slope;  ///< its slope in g [m/rad]
};

Narrowing narrowing(const TowGeometry& unsheared, double shear_angle) {
  const OpenWidth open = oblique_width(unsheared, shear_angle);
  const double c = std::cos(shear_angle), s = std::sin(shear_angle);
  return {width(unsheared.section) - open.width * c, open.width * s - open.slope * c};
}

// The tow seen from its side: squeezed across its width.
TowSqueeze side_squeeze(const ShearModel& model, const TowGeometry& tow) {
  return {model.law, width(tow.section), tow.fibre_fraction};
}

// Mean over the angle of (rho / sqrt(a b))^power, rho the radius of an ellipse of half axes a and b.
double mean_power_of_ellipse(double a, double b, double power) {
  if (a == b) return 1.0;
  constexpr int n = 64;  // the trapezium rule of a periodic function
  double sum = 0.0;
  for (int k = 0; k < n; ++k) {
    const double angle = 0.5 * std::numbers::pi * (k + 0.5) / n;
    sum += std::pow(std::sqrt(a * b) / std::hypot(b * std::cos(angle), a * std::sin(angle)), power);
  }
  return sum / n;
}

// Half the length of the contact along a tow.
double contact_reach(const CrossingGeometry& crossing, std::size_t tow, const QuarterKind& kind,
                     double film) {
  const double wrap = crossing.tow[tow].path.wrap();
  const Face met = kind.top == tow ? Face::upper : Face::lower;  // of the other tow
  return kind.floats[tow] ? std::min(wrap, reach(crossing.tow[1 - tow].section, met, film)) : wrap;
}

}  // namespace

double ShearModel::potential(double shear_angle, const std::array<double, 2>& strain,
                             const std::array<double, 2>& height) const {
  return potential_of(*this, sheared_tows(*this, shear_angle), contact_at(*this, shear_angle), strain,
                      height);
}

LoadedCrossing ShearModel::loaded(double shear_angle) const {
  const CrossoverContact contact = contact_at(*this, shear_angle);
  const std::array<TensionTow, 2> tows = sheared_tows(*this, shear_angle);
  const LoadedPair pair(tows, reference_tension);
  const double rest = 0.5 * (tows[0].rest_height + tows[1].rest_height);
  // Vertical balance N sin th = V/2 per tow, with the tow's bending: increases with h.
  const auto lift = [&](double mean) {
    const std::array<double, 2> height = pair.heights(mean);
    return 0.5 * (pair.lift(0, height[0]) + pair.lift(1, height[1])) - contact.force(2.0 * (rest - mean));
  };
  const double low = rest - 0.5 * contact.approach_at(1.2), high = 1.2 * rest;
  const double at_low = lift(low), at_high = lift(high);
  if (!(at_low < 0.0 && at_high > 0.0))
    throw NumericalError(
        fmt::format("shear: {:.4g} N/m cannot be balanced at {:.4g} rad", reference_tension, shear_angle));
  LoadedCrossing state;
  const double mean = bracketed_root(low, at_low, high, at_high, 1e-11 * pair.force_scale(), lift);
  state.height = pair.heights(mean);
  for (std::size_t i = 0; i < 2; ++i) state.strain[i] = pair.strain(i, state.height[i]);
  const double approach = 2.0 * (rest - mean);
  state.crossover_force = contact.force(approach);
  state.friction_arm = contact.arm(approach);
  state.potential = potential_of(*this, tows, contact, state.strain, state.height);
  return state;
}

double ShearModel::lateral_energy(double shear_angle) const {
  double sum = 0.0;
  for (const TowGeometry& tow : fabric.crossing.tow)
    sum += thickness(tow.section) / tow.spacing *
           side_squeeze(*this, tow).evaluate(narrowing(tow, shear_angle).by).energy;
  return sum;
}

ShearFlow ShearModel::flow(double shear_angle) const {
  const LoadedCrossing state = loaded(shear_angle);
  ShearFlow flow;
  const double ramp = shear_angle / std::hypot(shear_angle, ramp_angle);
  flow.dry = ramp * tow_friction * state.crossover_force * state.friction_arm / fabric.crossing.area();

  for (const TowGeometry& tow : fabric.crossing.tow) {
    const Narrowing side = narrowing(tow, shear_angle);
    flow.lateral +=
        thickness(tow.section) / tow.spacing * side_squeeze(*this, tow).stress(side.by) * side.slope;
  }

  // At the minimum only the geometry changes with g (envelope theorem), so strain and height are held.
  constexpr double step = 1e-5;  // [rad]: truncation 1e-10, rounding 1e-11 of the potential
  flow.tension = (potential(shear_angle + step, state.strain, state.height) -
                  potential(shear_angle - step, state.strain, state.height)) /
                 (2.0 * step);
  return flow;
}

SineGrid sine_grid(const FabricGeometry& fabric) {
  SineGrid grid;
  for (const TowGeometry& tow : fabric.crossing.tow) {
    const double packed = width(tow.section) / tow.spacing * tow.fibre_fraction / packed_fibre_fraction;
    if (packed < 1.0) grid.highest = std::min(grid.highest, std::sqrt(1.0 - packed * packed));
  }
  return grid;
}

Curve tabulate(const ShearModel& model, const SineGrid& grid) {
  const auto n = static_cast<std::size_t>(grid.points);
  std::vector<double> sine(n), stress(n);
  tbb::parallel_for(std::size_t{0}, n, [&](std::size_t k) {
    sine[k] = grid.highest * static_cast<double>(k) / static_cast<double>(n - 1);
    const double angle = std::asin(sine[k]);
    stress[k] = model.flow(angle).total() / std::cos(angle);
  });
  // Where tows of a loose weave stop widening, the crimp term falls: a snap of the even geometry that a
  // fabric with tows of many widths does not show. The largest stress so far is held, so that Psi stays
  // convex.
  for (std::size_t k = 1; k < n; ++k) stress[k] = std::max(stress[k], stress[k - 1]);
  return Curve(std::move(sine), std::move(stress));
}

double locking_angle(const Curve& shear_stress, double multiple) {
  // T = Psi'(sin g) cos g, so dT/dg = Psi'' cos^2 g - Psi' sin g.
  const auto tangent = [&](double angle) {
    const Curve::Value at = shear_stress.evaluate(std::sin(angle));
    return at.slope * std::cos(angle) * std::cos(angle) - at.y * std::sin(angle);
  };
  const double start = 20.0 * std::numbers::pi / 180.0, end = std::asin(shear_stress.x().back());
  const double wanted = multiple * tangent(start);
  constexpr double step = 1e-3;
  for (double angle = start; angle < end; angle += step) {
    const double before = tangent(angle) - wanted, after = tangent(angle + step) - wanted;
    if (before < 0.0 && after >= 0.0)
      return bracketed_root(angle, before, angle + step, after, 1e-12 * std::abs(wanted),
                            [&](double a) { return tangent(a) - wanted; });
  }
  throw NumericalError(fmt::format(
      "shear: the tangent never reaches {:.4g} times its value at 20 deg ({:.4g} N/m)", multiple, wanted));
}

ShearRateParts shear_rate_parts(const FabricGeometry& fabric, const ResinSpec& resin, double in_tow_share) {
  const CrossingGeometry& crossing = fabric.crossing;
  const double n = resin.power_index;
  const bool alike = faces_alike(crossing.tow[0].section) && faces_alike(crossing.tow[1].section);
  ShearRateParts parts;
  for (const QuarterKind& kind : quarter_kinds(fabric.quarters, alike)) {
    const double a = contact_reach(crossing, 0, kind, resin.film_thickness);
    const double b = contact_reach(crossing, 1, kind, resin.film_thickness);
    parts.film += kind.share * mean_power_of_ellipse(a, b, n + 3.0) * resin.consistency /
                  std::pow(resin.film_thickness, n) * 2.0 * std::numbers::pi *
                  std::pow(std::sqrt(a * b), n + 3.0) / ((n + 3.0) * crossing.area());
  }
  for (std::size_t i = 0; i < 2; ++i) {
    const TowGeometry& tow = crossing.tow[i];
    const double v = tow.fibre_fraction, saturation = std::min(fabric.tow_solid_fraction[i], 1.0);
    parts.in_tow += in_tow_share * area(tow.section) / tow.spacing * resin.consistency * saturation *
                    (1.0 + v) / (1.0 - v);
  }
  return parts;
}

ShearRate shear_rate(const FabricGeometry& fabric, const ResinSpec& resin, double in_tow_share) {
  const ShearRateParts parts = shear_rate_parts(fabric, resin, in_tow_share);
  return {parts.film + parts.in_tow, resin.power_index, resin.activation_energy / gas_constant,
          resin.reference_temperature};
}

}  // namespace heddle::mesoscale
