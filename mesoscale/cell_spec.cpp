#include "mesoscale/cell_spec.h"

#include <cmath>
#include <cstdint>

#include <fmt/format.h>

#include "mesoscale/cell.h"
#include "mesoscale/closure.h"

namespace heddle::mesoscale {

namespace {

// One range rule; `unit` is shown, `per_unit` turns SI into it.
struct Bound {
  const char* key;
  double value;
  const char* unit;
  double per_unit;
  bool holds;
  const char* rule;
  const char* way_out;
};

void add_if_broken(Problems& problems, const Bound& bound) {
  if (bound.holds) return;
  const std::string space = *bound.unit ? " " : "";
  problems.push_back({"*.range"_family.of(bound.key), bound.key,
                      fmt::format("{:.6g}{}{}", bound.value * bound.per_unit, space, bound.unit), bound.rule,
                      bound.way_out});
}

// Comparisons are written so that a NaN breaks them.
bool within(double low, double value, double high) {
  return value >= low && value <= high;
}
bool above_to(double low, double value, double high) {
  return value > low && value <= high;
}
bool positive(double value) {
  return value > 0.0 && std::isfinite(value);
}

void check_weave_ranges(Problems& problems, const WeaveSpec& w) {
  const Bound bounds[] = {
      {"weave.tow_width", w.tow_width, "mm", 1e3, w.tow_width > 0.0 && w.tow_width < 0.1,
       "must satisfy 0 < tow_width < 100 mm", "Table 1 gives 4.64 mm; write 4.64 mm."},
      {"weave.gap", w.gap, "mm", 1e3, w.gap >= 0.0 && w.gap < 0.1, "must satisfy 0 <= gap < 100 mm",
       "Table 1 gives 0.75 mm; write 0.75 mm."},
      {"weave.tow_thickness", w.tow_thickness, "mm", 1e3, w.tow_thickness > 0.0 && w.tow_thickness < 0.02,
       "must satisfy 0 < tow_thickness < 20 mm", "Table 1 gives 0.75 mm; write 0.75 mm."},
      {"weave.fabric_thickness", w.fabric_thickness, "mm", 1e3,
       w.fabric_thickness > 0.0 && w.fabric_thickness < 0.04, "must satisfy 0 < fabric_thickness < 40 mm",
       "Table 1 gives 1.5 mm; write 1.5 mm."},
      {"weave.linear_density", w.linear_density, "tex", 1e6, w.linear_density > 0.0 && w.linear_density < 0.1,
       "must satisfy 0 < linear_density < 100000 tex", "The fabric of Table 1 has 1872 tex; write 1872 tex."},
      {"weave.fibre_mass_fraction", w.fibre_mass_fraction, "%", 100.0,
       above_to(0.0, w.fibre_mass_fraction, 1.0), "must satisfy 0 < fibre_mass_fraction <= 100 %",
       "Table 1 gives 60 %; write 60 %."},
      {"weave.fibre_density", w.fibre_density, "kg/m^3", 1.0, within(100.0, w.fibre_density, 30000.0),
       "must lie between 100 and 30000 kg/m^3", "E-glass has 2550 kg/m^3."},
      {"weave.resin_density", w.resin_density, "kg/m^3", 1.0, within(100.0, w.resin_density, 30000.0),
       "must lie between 100 and 30000 kg/m^3", "Polypropylene has 905 kg/m^3."},
      {"weave.fibre_modulus", w.fibre_modulus, "GPa", 1e-9, above_to(0.0, w.fibre_modulus, 2e12),
       "must satisfy 0 < fibre_modulus <= 2000 GPa", "E-glass has 72.4 GPa."},
      {"weave.fibre_diameter", w.fibre_diameter, "um", 1e6, above_to(0.0, w.fibre_diameter, 1e-3),
       "must satisfy 0 < fibre_diameter <= 1000 um", "Glass rovings have 10 to 25 um."},
  };
  for (const Bound& bound : bounds) add_if_broken(problems, bound);
}

void check_resin(Problems& problems, const ResinSpec& r) {
  const Bound bounds[] = {
      {"resin.consistency", r.consistency, "Pa s^n", 1.0, positive(r.consistency), "must be finite and > 0",
       "Polypropylene at 180 degC has about 6790 Pa s^n."},
      {"resin.power_index", r.power_index, "", 1.0, above_to(0.0, r.power_index, 1.0),
       "must satisfy 0 < n <= 1", "The melt thins with rate (paper, Eq. 4); polypropylene has 0.37 to 0.41."},
      {"resin.film_thickness", r.film_thickness, "mm", 1e3, above_to(0.0, r.film_thickness, 0.01),
       "must satisfy 0 < film_thickness <= 10 mm", "The paper gives 0.07 mm; write 0.07 mm."},
      {"resin.activation_energy", r.activation_energy, "kJ/mol", 1e-3, within(0.0, r.activation_energy, 1e6),
       "must lie between 0 and 1000 kJ/mol", "Polypropylene has about 42 kJ/mol."},
      {"resin.reference_temperature", r.reference_temperature, "K", 1.0,
       within(200.0, r.reference_temperature, 1000.0), "must lie between 200 and 1000 K",
       "The consistency of polypropylene is given at 180 degC."},
  };
  for (const Bound& bound : bounds) add_if_broken(problems, bound);
}

void check_forming(Problems& problems, const FormingSpec& f) {
  const Bound bounds[] = {
      {"forming.compaction_modulus", f.compaction_modulus, "MPa", 1e-6,
       within(1e3, f.compaction_modulus, 1e11), "must lie between 0.001 and 100000 MPa",
       "The default is 3.2 MPa."},
      {"forming.compaction_exponent", f.compaction_exponent, "", 1.0,
       above_to(1.0, f.compaction_exponent, 20.0), "must satisfy 1 < n <= 20",
       "Toll: 3 for random, 5 for planar networks, more for bundles."},
      {"forming.tow_friction", f.tow_friction, "", 1.0, within(0.0, f.tow_friction, 2.0),
       "must lie between 0 and 2", "The default is 0.2."},
      {"forming.reference_tension", f.reference_tension, "N/m", 1.0, above_to(0.0, f.reference_tension, 1e5),
       "must satisfy 0 < reference_tension <= 100000 N/m", "The default is 800 N/m."},
      {"forming.in_tow_shear_share", f.in_tow_shear_share, "", 1.0, within(0.0, f.in_tow_shear_share, 1.0),
       "must lie between 0 and 1", "0: tows turn rigidly; 1: all shear is inside the tows."},
      {"forming.bonding", f.bonding, "", 1.0, within(0.0, f.bonding, 1.0), "must lie between 0 and 1",
       "0: fibres slide freely when the fabric bends; 1: they are bonded."},
      {"forming.compression_ratio", f.compression_ratio, "", 1.0, above_to(0.0, f.compression_ratio, 0.2),
       "must satisfy 0 < compression_ratio <= 0.2",
       "The default is 0.01; 0 would leave slack tows without stiffness."},
  };
  for (const Bound& bound : bounds) add_if_broken(problems, bound);
}

// Beyond these the crowns of neighbouring tows and the crossings no longer make a cloth, and the contact
// tables end.
void check_proportions(Problems& problems, const WeaveSpec& w) {
  const double slenderness = w.tow_width / w.tow_thickness;
  if (slenderness < 2.0 || slenderness > 40.0)
    problems.push_back({"weave.tow_width.proportion"_rule,
                        "weave.tow_width",
                        fmt::format("{:.6g} mm", 1e3 * w.tow_width),
                        fmt::format("must be 2 to 40 times the tow thickness ({:.6g} mm); it is {:.3g} times",
                                    1e3 * w.tow_thickness, slenderness),
                        "Table 1 gives 4.64 mm and 0.75 mm.",
                        "",
                        0,
                        {"weave.tow_thickness"}});
  if (w.gap > w.tow_width)
    problems.push_back(
        {"weave.gap.proportion"_rule,
         "weave.gap",
         fmt::format("{:.6g} mm", 1e3 * w.gap),
         fmt::format("must not exceed the tow width ({:.6g} mm): wider apart the tows do not make a cloth",
                     1e3 * w.tow_width),
         "Table 1 gives 0.75 mm.",
         "",
         0,
         {"weave.tow_width"}});
}

void check_thickness(Problems& problems, const WeaveSpec& w) {
  // One percent: Table 1 rounds to 0.05 mm, and the height of the crowns follows the tows, not the table.
  const double from_tows = 2.0 * w.tow_thickness;
  if (std::abs(w.fabric_thickness - from_tows) <= 0.01 * from_tows) return;
  problems.push_back(
      {"weave.fabric_thickness.consistent"_rule,
       "weave.fabric_thickness",
       fmt::format("{:.6g} mm", 1e3 * w.fabric_thickness),
       fmt::format("must be the two tow thicknesses on top of each other, {:.6g} mm, within 1 %",
                   1e3 * from_tows),
       fmt::format("Write fabric_thickness: {:.6g} mm, or tow_thickness: {:.6g} mm.", 1e3 * from_tows,
                   0.5e3 * w.fabric_thickness),
       "",
       0,
       {"weave.tow_thickness"}});
}

// The mass of a tow's materials against the room its weave leaves them.
const std::vector<std::string> keys_of_the_packing{"weave.pattern",
                                                   "weave.tow_width",
                                                   "weave.gap",
                                                   "weave.tow_thickness",
                                                   "weave.fabric_thickness",
                                                   "weave.linear_density",
                                                   "weave.fibre_mass_fraction",
                                                   "weave.fibre_density",
                                                   "weave.resin_density",
                                                   "cell.state"};

void check_packing(Problems& problems, const CellSpec& spec) {
  const FabricGeometry fabric = fabric_geometry(spec.weave, CellState::as_woven);
  if (fabric.tow_solid_fraction > 1.0) {
    problems.push_back(
        {"weave.tow_thickness.holds_material"_rule, "weave.tow_thickness",
         fmt::format("{:.6g} mm", 1e3 * spec.weave.tow_thickness),
         fmt::format("the tow section must hold its glass and resin, but they fill {:.3g} of it",
                     fabric.tow_solid_fraction),
         "Give a thicker or wider tow, or a smaller linear_density.", "", 0, keys_of_the_packing});
    return;
  }
  // The fullest tow decides: as woven, or squeezed flat in the consolidated sheet.
  const double fraction = spec.state == CellState::as_woven
                              ? fabric.crossing.fibre_fraction
                              : fabric_geometry(spec.weave, spec.state).crossing.fibre_fraction;
  if (fraction <= 0.75) return;
  problems.push_back(
      {"weave.fibre_mass_fraction.packing"_rule, "weave.fibre_mass_fraction",
       fmt::format("{:.6g} %", 100.0 * spec.weave.fibre_mass_fraction),
       fmt::format("fibres must fill at most 0.75 of the tow, but fill {:.3g}", fraction),
       "Parallel fibres reach 0.785 in a square and 0.907 in a hexagonal array: give less glass, or a "
       "thicker or wider tow.",
       "", 0, keys_of_the_packing});
}

}  // namespace

Problems check(const CellSpec& spec) {
  Problems problems = check_pattern(spec.weave.pattern);
  const std::size_t before = problems.size();
  check_weave_ranges(problems, spec.weave);
  if (problems.size() == before) {
    check_proportions(problems, spec.weave);
    check_thickness(problems, spec.weave);
  }
  // Packing needs a geometry, and so sound numbers.
  if (problems.empty()) check_packing(problems, spec);
  check_resin(problems, spec.resin);
  check_forming(problems, spec.forming);
  return problems;
}

}  // namespace heddle::mesoscale
