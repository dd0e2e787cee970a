#include "macroscale/fabric_effects.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

namespace heddle::macroscale {

namespace {

constexpr double ten_degrees = std::numbers::pi / 18.0;

// psi(n) of a tow's tension [N/m].
double pull_of(double tension, double reference) {
  return tension > 0.0 ? tension * tension / (tension + reference) : 0.0;
}

Curve scaled(const Curve& curve, double factor) {
  std::vector<double> y = curve.y();
  for (double& value : y) value *= factor;
  return {curve.x(), y};
}

// The spline through scaled values on a scaled grid is the scaled spline.
Surface stretched(const Surface& w, double k) {
  std::vector<double> values = w.values();
  for (double& value : values) value *= k * k;
  return {k * w.x0(), k * w.dx(), w.nx(), k * w.y0(), k * w.dy(), w.ny(), std::move(values)};
}

void demand(Problems& problems, bool holds, RuleId id, const char* key, double value, const char* rule,
            const char* way_out) {
  if (holds) return;
  problems.push_back({std::move(id), key, fmt::format("{:g}", value), rule, way_out, "", 0, {}});
}

}  // namespace

CornerScalar locking_law(const ShearLocking& law, double s) {
  const double gamma = std::asin(s);
  const double beyond = (std::abs(gamma) - law.angle) / ten_degrees;
  if (beyond <= 0.0) return {};
  const double m = law.exponent;
  const double power = law.amplitude * std::pow(beyond, m - 1.0);
  const double torque = std::copysign(power * beyond, s), tangent = m * power / ten_degrees;
  const double c = std::sqrt(1.0 - s * s);
  const double slope = 1.0 / c, bend = s / (c * c * c);  // d gamma / ds and its slope
  return {power * beyond * beyond * ten_degrees / (m + 1.0), torque * slope,
          tangent * slope * slope + torque * bend};
}

Surface coupling_of(const TensionCoupling& law, const Surface& tension_energy) {
  if (!law.on()) return {};
  constexpr int finer = 4;
  const int nx = finer * (tension_energy.nx() - 1) + 1, ny = finer * (tension_energy.ny() - 1) + 1;
  const double dx = tension_energy.dx() / finer, dy = tension_energy.dy() / finer;
  std::vector<double> values;
  for (int i = 0; i < nx; ++i)
    for (int j = 0; j < ny; ++j) {
      const Surface::Value w =
          tension_energy.evaluate(tension_energy.x0() + i * dx, tension_energy.y0() + j * dy);
      values.push_back(law.amplitude / law.reference *
                       (pull_of(w.fx, law.reference) + pull_of(w.fy, law.reference)));
    }
  return {tension_energy.x0(), dx, nx, tension_energy.y0(), dy, ny, std::move(values)};
}

double ShearSoftening::factor_at(double temperature) const {
  return std::exp(-rate * (temperature - reference));
}

mesoscale::FabricProperties with_effects(mesoscale::FabricProperties fabric, const FabricEffects& effects) {
  fabric.areal_density *= effects.inertia;
  if (effects.bending != 1.0)
    for (Curve& stiffness : fabric.bending) stiffness = scaled(stiffness, effects.bending);
  if (effects.crimp_stretch != 0.0)
    fabric.tension_energy = stretched(fabric.tension_energy, 1.0 + effects.crimp_stretch);
  return fabric;
}

Problems check(const FabricEffects& effects) {
  Problems p;
  const auto finite = [](double value) { return std::isfinite(value); };
  const ShearLocking& locking = effects.shear_locking;
  const TensionCoupling& coupling = effects.tension_coupling;
  demand(p, effects.bending > 0.0 && finite(effects.bending), "effects.bending.factor.range"_rule,
         "effects.bending.factor", effects.bending, "must be > 0", "1 is off.");
  demand(p, effects.inertia > 0.0 && finite(effects.inertia), "effects.inertia.factor.range"_rule,
         "effects.inertia.factor", effects.inertia, "must be > 0", "1 is the blank's own mass.");
  demand(p, effects.crimp_stretch > -1.0 && finite(effects.crimp_stretch),
         "effects.crimp_straightening.stretch.range"_rule, "effects.crimp_straightening.stretch",
         effects.crimp_stretch, "must be > -1", "0 is off; 0.1 pulls crimp out at strains a tenth larger.");
  demand(p, effects.tow_viscosity >= 0.0 && finite(effects.tow_viscosity),
         "effects.tow_rate_stiffening.viscosity.range"_rule, "effects.tow_rate_stiffening.viscosity",
         effects.tow_viscosity, "must be >= 0 N s/m", "0 N s/m is off.");
  demand(p, locking.amplitude >= 0.0 && finite(locking.amplitude),
         "effects.shear_locking.amplitude.range"_rule, "effects.shear_locking.amplitude", locking.amplitude,
         "must be >= 0 N/m", "0 N/m is off.");
  demand(p, locking.angle >= 0.0 && locking.angle < 0.5 * std::numbers::pi,
         "effects.shear_locking.angle.range"_rule, "effects.shear_locking.angle",
         locking.angle * 180.0 / std::numbers::pi, "must be at least 0 and below 90 deg",
         "`heddle weave` prints the angle at which the gaps close.");
  demand(p, locking.exponent >= 2.0 && finite(locking.exponent), "effects.shear_locking.exponent.range"_rule,
         "effects.shear_locking.exponent", locking.exponent, "must be at least 2",
         "Below, the tangent would jump where the tows lock.");
  demand(p, coupling.amplitude >= 0.0 && finite(coupling.amplitude),
         "effects.tension_shear_coupling.amplitude.range"_rule, "effects.tension_shear_coupling.amplitude",
         coupling.amplitude, "must be >= 0", "0 is off.");
  demand(p, coupling.reference > 0.0 && finite(coupling.reference),
         "effects.tension_shear_coupling.reference.range"_rule, "effects.tension_shear_coupling.reference",
         coupling.reference, "must be > 0 N/m", "The tension at which the amplitude holds.");
  demand(p, finite(effects.softening.rate) && std::abs(effects.softening.rate) <= 0.1,
         "effects.shear_thermal_softening.rate.range"_rule, "effects.shear_thermal_softening.rate",
         effects.softening.rate, "must lie within -0.1 and 0.1 1/K", "0 1/K is off.");
  return p;
}

}  // namespace heddle::macroscale
