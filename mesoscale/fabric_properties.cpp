#include "mesoscale/fabric_properties.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace heddle::mesoscale {

namespace {

constexpr const char* rebuild =
    "Run the unit-cell stage again, or mend the table in the file it was read from.";

void require(Problems& problems, bool holds, const RuleId& id, const std::string& key, double value,
             const std::string& rule) {
  if (!holds) problems.push_back({id, key, fmt::format("{:.6g}", value), rule, rebuild});
}

void check_monotone(Problems& problems, const Curve& curve, const std::string& key, const std::string& what) {
  if (curve.empty()) {
    problems.push_back({"fabric.*.empty"_family.of(key), "fabric." + key, "",
                        "must be a table of two or more points", rebuild});
    return;
  }
  if (const std::string fault = fault_of_monotone_table(curve.x(), curve.y(), what); !fault.empty())
    problems.push_back({"fabric.*.monotone"_family.of(key), "fabric." + key, "", fault, rebuild});
}

void check_family(Problems& problems, const CurveFamily& family, const std::string& key,
                  const std::string& what) {
  if (family.empty()) {
    problems.push_back(
        {"fabric.*.empty"_family.of(key), "fabric." + key, "", "must hold one or more tables", rebuild});
    return;
  }
  for (std::size_t k = 0; k < family.curves().size(); ++k)
    check_monotone(problems, family.curves()[k], key,
                   fmt::format("{} at shear angle {:.4g} rad", what, family.parameter()[k]));
}

double smaller_eigenvalue(const Surface::Value& at) {
  const double mean = 0.5 * (at.fxx + at.fyy), half = 0.5 * (at.fxx - at.fyy);
  return mean - std::hypot(half, at.fxy);
}

// Convex at every grid point and in the middle of every cell, up to rounding of the second differences.
void check_convex(Problems& problems, const Surface& energy) {
  const std::string key = "fabric.tension_energy";
  if (energy.empty()) {
    problems.push_back(
        {"fabric.*.empty"_family.of("tension_energy"), key, "", "must be a table of strain energy", rebuild});
    return;
  }
  double stiffest = 0.0, worst = 0.0, worst_x = 0.0, worst_y = 0.0;
  for (int i = 0; i <= 2 * (energy.nx() - 1); ++i)
    for (int j = 0; j <= 2 * (energy.ny() - 1); ++j) {
      const double x = energy.x0() + 0.5 * i * energy.dx(), y = energy.y0() + 0.5 * j * energy.dy();
      const Surface::Value at = energy.evaluate(x, y);
      stiffest = std::max({stiffest, at.fxx, at.fyy});
      if (const double low = smaller_eigenvalue(at); low < worst) {
        worst = low;
        worst_x = x;
        worst_y = y;
      }
    }
  if (worst < -1e-9 * stiffest)
    problems.push_back(
        {"fabric.tension_energy.convex"_rule, key, fmt::format("curvature {:.4g} N/m", worst),
         fmt::format("w(e1, e2) must be convex, but is not at strains ({:.6g}, {:.6g})", worst_x, worst_y),
         "Use a finer strain grid, or a wider straightening range of the tows."});
}

}  // namespace

ContactArea::Value ContactArea::evaluate(double pressure, double shear_angle) const {
  const Curve::Value log = log_fraction.evaluate(std::log(pressure), std::abs(shear_angle));
  const double fraction = std::exp(log.y);
  // Beyond the table the log slope is held; an area cannot exceed the plate.
  if (fraction >= 1.0) return {1.0, 0.0};
  return {fraction, fraction * log.slope / pressure};
}

DragDirection::Value DragDirection::evaluate(double pressure, double shear_angle) const {
  if (empty()) return {};
  const std::vector<double>& table = cosine.curves().front().x();
  const double log_pressure =
      pressure > 0.0 ? std::clamp(std::log(pressure), table.front(), table.back()) : table.front();
  const double angle = std::abs(shear_angle), side = shear_angle < 0.0 ? -1.0 : 1.0;
  return {cosine.evaluate(log_pressure, angle).y, side * sine.evaluate(log_pressure, angle).y};
}

Problems check(const FabricProperties& fabric) {
  Problems problems;
  const auto positive = [&](double value, const std::string& name) {
    require(problems, value > 0.0 && std::isfinite(value), "fabric.*.range"_family.of(name), "fabric." + name,
            value, "must be finite and > 0");
  };
  positive(fabric.areal_density, "areal_density");
  positive(fabric.pitch[0], "pitch.warp");
  positive(fabric.pitch[1], "pitch.weft");
  positive(fabric.thickness, "thickness");
  positive(fabric.shear_rate.reference_temperature, "shear_rate.reference_temperature");
  const ShearRate& rate = fabric.shear_rate;
  require(problems, rate.consistency >= 0.0 && std::isfinite(rate.consistency),
          "fabric.*.range"_family.of("shear_rate.consistency"), "fabric.shear_rate.consistency",
          rate.consistency, "must be finite and >= 0");
  require(problems, rate.index > 0.0 && rate.index <= 1.0, "fabric.*.range"_family.of("shear_rate.index"),
          "fabric.shear_rate.index", rate.index, "must satisfy 0 < n <= 1 (convex dissipation)");
  require(problems, rate.activation_temperature >= 0.0 && std::isfinite(rate.activation_temperature),
          "fabric.*.range"_family.of("shear_rate.activation_temperature"),
          "fabric.shear_rate.activation_temperature", rate.activation_temperature, "must be finite and >= 0");

  check_convex(problems, fabric.tension_energy);
  check_monotone(problems, fabric.shear_stress, "shear_stress", "shear stress");
  for (std::size_t i = 0; i < 2; ++i) {
    const std::string key = i == 0 ? "bending.warp" : "bending.weft";
    if (fabric.bending[i].empty())
      problems.push_back({"fabric.*.empty"_family.of(key), "fabric." + key, "",
                          "must be a table of two or more points", rebuild});
    for (double b : fabric.bending[i].y())
      require(problems, b > 0.0, "fabric.*.range"_family.of(key), "fabric." + key, b, "must be > 0");
  }
  check_family(problems, fabric.compaction, "compaction", "compaction pressure");
  for (const Curve& curve : fabric.compaction.curves())
    require(problems, curve.empty() || (curve.x().front() == 0.0 && curve.y().front() == 0.0),
            "fabric.compaction.start"_rule, "fabric.compaction", curve.empty() ? 0.0 : curve.y().front(),
            "must start at zero pressure for zero approach");
  check_family(problems, fabric.contact.log_fraction, "contact", "log area fraction");
  for (const Curve& curve : fabric.contact.log_fraction.curves())
    require(problems, curve.empty() || curve.y().back() <= 0.0, "fabric.*.range"_family.of("contact"),
            "fabric.contact", curve.empty() ? 0.0 : curve.y().back(),
            "the area fraction must not exceed 1 (its log must be <= 0)");
  if (!fabric.facing.empty()) {
    positive(fabric.facing.rest, "ply_facing.rest");
    check_monotone(problems, fabric.facing.compaction, "ply_facing", "pressure between plies");
  }
  for (const CurveFamily* family : {&fabric.contact.drag.cosine, &fabric.contact.drag.sine})
    for (const Curve& curve : family->curves())
      for (const double share : curve.y())
        require(problems, std::abs(share) < 0.7, "fabric.*.range"_family.of("drag_direction"),
                "fabric.drag_direction", share,
                "drag must not turn negative in any direction (|K_c|, |K_s| < 0.7)");
  return problems;
}

}  // namespace heddle::mesoscale
