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

double mean_interlacing(const TensionModel& model) {
  return 0.5 * (model.interlacing[0] + model.interlacing[1]);
}

// The unsheared length law with the contact radius and edge of the sheared crossing.
LengthLaw length_law(const ShearModel& model, double shear_angle) {
  const CrossingGeometry crossing = sheared(model.fabric.crossing, shear_angle);
  LengthLaw law = model.tension.length;
  law.contact_radius = crossing.section.radius() + 0.5 * crossing.section.thickness;
  law.edge = std::min(0.5 * crossing.section.width, 0.475 * crossing.pitch);
  return law;
}

struct TowState {
  double energy;         ///< per pitch of tow [J]
  double force;          ///< N [N]
  double along, upward;  ///< d length / d p and d length / d h, floats included [-]
};

TowState tow_state(const TensionModel& model, const LengthLaw& law, double strain, double height) {
  const double share = mean_interlacing(model), pitch = model.pitch * (1.0 + strain);
  const PathLength path = law.evaluate(pitch, height);
  const double rest = 0.5 * (model.rest_length(0) + model.rest_length(1));
  const TowStretch::Value tow =
      model.stretch.evaluate((share * path.length + (1.0 - share) * pitch) / rest - 1.0);
  return {rest * tow.energy, tow.force, share * path.dl_dp + 1.0 - share, share * path.dl_dh};
}

// Strain at which a tow of this crimp height carries the tension.
double strain_under(const TensionModel& model, const LengthLaw& law, double tension, double height) {
  const auto excess = [&](double strain) {
    const TowState tow = tow_state(model, law, strain, height);
    return tow.force * tow.along / model.pitch - tension;
  };
  const double low = -0.2, high = 0.2;
  const double at_low = excess(low), at_high = excess(high);
  if (!(at_low < 0.0 && at_high > 0.0))
    throw NumericalError(fmt::format("shear: no strain between -20 and 20 % carries {:.4g} N/m", tension));
  return bracketed_root(low, at_low, high, at_high, 1e-12 * tension, excess);
}

double potential_of(const ShearModel& model, const LengthLaw& length, const CrossoverContact& contact,
                    double strain, double height) {
  const TowState tow = tow_state(model.tension, length, strain, height);
  const double off = height - model.tension.rest_height;
  const double stored =
      2.0 * tow.energy + model.tension.crimp_stiffness * off * off + contact.evaluate(-2.0 * off).energy;
  return stored / (model.tension.pitch * model.tension.pitch) - 2.0 * model.reference_tension * strain;
}

// How much narrower than free a tow has become, and how fast it does so.
struct Narrowing {
  double by;     ///< w - w_o cos g [m]
  double slope;  ///< its slope in g [m/rad]
};

Narrowing narrowing(const ShearModel& model, double shear_angle) {
  const OpenWidth open = oblique_width(model.fabric.crossing, shear_angle);
  const double c = std::cos(shear_angle), s = std::sin(shear_angle);
  return {model.fabric.crossing.section.width - open.width * c, open.width * s - open.slope * c};
}

// The tow seen from its side: squeezed across its width.
TowSqueeze side_squeeze(const ShearModel& model) {
  return {model.law, model.fabric.crossing.section.width, model.fabric.crossing.fibre_fraction};
}

}  // namespace

double ShearModel::potential(double shear_angle, double strain, double height) const {
  return potential_of(*this, length_law(*this, shear_angle),
                      CrossoverContact(fabric.crossing, shear_angle, law), strain, height);
}

LoadedCrossing ShearModel::loaded(double shear_angle) const {
  const CrossoverContact contact(fabric.crossing, shear_angle, law);
  const LengthLaw length = length_law(*this, shear_angle);
  const double rest = tension.rest_height;
  // Vertical balance N sin th = V/2 per tow, with the tow's bending: increases with h.
  const auto lift = [&](double height) {
    const double strain = strain_under(tension, length, reference_tension, height);
    const TowState tow = tow_state(tension, length, strain, height);
    return tow.force * tow.upward + tension.crimp_stiffness * (height - rest) -
           contact.force(2.0 * (rest - height));
  };
  const double low = rest - 0.5 * contact.approach_at(1.2), high = 1.2 * rest;
  const double at_low = lift(low), at_high = lift(high);
  if (!(at_low < 0.0 && at_high > 0.0))
    throw NumericalError(
        fmt::format("shear: {:.4g} N/m cannot be balanced at {:.4g} rad", reference_tension, shear_angle));
  LoadedCrossing state;
  state.height = bracketed_root(low, at_low, high, at_high, 1e-11 * reference_tension * tension.pitch, lift);
  state.strain = strain_under(tension, length, reference_tension, state.height);
  const double approach = 2.0 * (rest - state.height);
  state.crossover_force = contact.force(approach);
  state.friction_arm = contact.arm(approach);
  state.potential = potential_of(*this, length, contact, state.strain, state.height);
  return state;
}

double ShearModel::lateral_energy(double shear_angle) const {
  return 2.0 * fabric.crossing.section.thickness / fabric.crossing.pitch *
         side_squeeze(*this).evaluate(narrowing(*this, shear_angle).by).energy;
}

ShearFlow ShearModel::flow(double shear_angle) const {
  const double pitch = fabric.crossing.pitch;
  const LoadedCrossing state = loaded(shear_angle);
  ShearFlow flow;
  const double ramp = shear_angle / std::hypot(shear_angle, ramp_angle);
  flow.dry = ramp * tow_friction * state.crossover_force * state.friction_arm / (pitch * pitch);

  const Narrowing side = narrowing(*this, shear_angle);
  flow.lateral =
      2.0 * fabric.crossing.section.thickness / pitch * side_squeeze(*this).stress(side.by) * side.slope;

  // At the minimum only the geometry changes with g (envelope theorem), so strain and height are held.
  constexpr double step = 1e-5;  // [rad]: truncation 1e-10, rounding 1e-11 of the potential
  flow.tension = (potential(shear_angle + step, state.strain, state.height) -
                  potential(shear_angle - step, state.strain, state.height)) /
                 (2.0 * step);
  return flow;
}

SineGrid sine_grid(const FabricGeometry& fabric) {
  SineGrid grid;
  const CrossingGeometry& crossing = fabric.crossing;
  const double packed =
      crossing.section.width / crossing.pitch * crossing.fibre_fraction / packed_fibre_fraction;
  if (packed < 1.0) grid.highest = std::min(grid.highest, std::sqrt(1.0 - packed * packed));
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
  const double n = resin.power_index, disc = crossing.path.wrap();
  ShearRateParts parts;
  parts.film = resin.consistency / std::pow(resin.film_thickness, n) * 2.0 * std::numbers::pi *
               std::pow(disc, n + 3.0) / ((n + 3.0) * crossing.pitch * crossing.pitch);
  const double v = crossing.fibre_fraction, saturation = std::min(fabric.tow_solid_fraction, 1.0);
  parts.in_tow = in_tow_share * 2.0 * crossing.section.area() / crossing.pitch * resin.consistency *
                 saturation * (1.0 + v) / (1.0 - v);
  return parts;
}

ShearRate shear_rate(const FabricGeometry& fabric, const ResinSpec& resin, double in_tow_share) {
  const ShearRateParts parts = shear_rate_parts(fabric, resin, in_tow_share);
  return {parts.film + parts.in_tow, resin.power_index, resin.activation_energy / gas_constant,
          resin.reference_temperature};
}

}  // namespace heddle::mesoscale
