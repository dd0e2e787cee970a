#include "mesoscale/cell_spec.h"

#include <cmath>
#include <cstdint>

#include <fmt/format.h>

#include "mesoscale/cell.h"
#include "mesoscale/closure.h"
#include "mesoscale/compaction.h"
#include "mesoscale/state.h"

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
      {"weave.warp_crimp", w.warp_crimp.value_or(0.5), "%", 100.0,
       within(0.0, w.warp_crimp.value_or(0.5), 1.0), "must lie between 0 and 100 %",
       "50 % is the balanced weave; leave it out for flush faces."},
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

void check_film(Problems& problems, const FilmDirectionSpec& f) {
  const double fill = f.fill.value_or(0.5);
  const Bound bounds[] = {
      {"film.speed", f.speed, "mm/s", 1e3, above_to(0.0, f.speed, 10.0),
       "must satisfy 0 < speed <= 10000 mm/s",
       "A blank is drawn in at some 50 mm/s where the punch takes 163."},
      {"film.temperature", f.temperature, "K", 1.0, within(200.0, f.temperature, 1000.0),
       "must lie between 200 and 1000 K", "The melt of the blank: 180 degC."},
      {"film.fill", fill, "%", 100.0, fill > 0.0 && fill < 1.0, "must satisfy 0 < fill < 100 %",
       "Leave it out for resin spread evenly over all room beside the glass."},
      {"film.roughness", f.roughness, "um", 1e6, above_to(0.0, f.roughness, 1e-3),
       "must satisfy 0 < roughness <= 1000 um", "A fibre's radius: 9.25 um."},
      {"film.boundary_friction", f.boundary_friction, "", 1.0, within(0.0, f.boundary_friction, 2.0),
       "must lie between 0 and 2", "The default is 0.2."},
  };
  for (const Bound& bound : bounds) add_if_broken(problems, bound);
  if (f.samples != 64 && f.samples != 128)
    problems.push_back({"film.samples.range"_rule, "film.samples", fmt::format("{}", f.samples),
                        "must be 64 or 128", "64 is within 3 % of 128 (docs/theory/film.md)."});
}

void check_forming(Problems& problems, const FormingSpec& f) {
  const Bound bounds[] = {
      {"forming.compaction_modulus", f.compaction_modulus, "MPa", 1e-6,
       within(1e3, f.compaction_modulus, 1e11), "must lie between 0.001 and 100000 MPa",
       "The default is 3.2 MPa."},
      {"forming.compaction_exponent", f.compaction_exponent, "", 1.0,
       above_to(1.0, f.compaction_exponent, 20.0), "must satisfy 1 < n <= 20",
       "Toll: 3 for random, 5 for planar networks, more for bundles."},
      {"forming.gutowski_spring", f.gutowski_spring, "kPa", 1e-3, within(1.0, f.gutowski_spring, 1e9),
       "must lie between 0.001 and 1000000 kPa", "The default is 3 kPa."},
      {"forming.gutowski_available", f.gutowski_available, "", 1.0,
       above_to(packed_fibre_fraction, f.gutowski_available, 0.907),
       "must satisfy 0.82 < V_a <= 0.907, hexagonal packing", "The default is 0.85."},
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

// Key of a number of one direction: its own where it has one.
std::string key_of(std::size_t direction, bool own, const char* name) {
  const char* block = direction == 0 ? "weave.warp." : "weave.weft.";
  return own ? std::string(block) + name : std::string("weave.") + name;
}

void check_stack(Problems& problems, const StackSpec& stack) {
  if (stack.plies < 1 || stack.plies > most_plies) {
    problems.push_back({"*.range"_family.of("cell.plies"), "cell.plies", std::to_string(stack.plies),
                        fmt::format("must lie between 1 and {}", most_plies),
                        "Two plies show how they nest; a laminate of many tends to solid's stack of plies."});
    return;
  }
  for (const auto& [key, shifts] :
       {std::pair{"cell.shift_warp", &stack.along_warp}, {"cell.shift_weft", &stack.along_weft}}) {
    if (!shifts->empty() && shifts->size() != static_cast<std::size_t>(stack.plies))
      problems.push_back({"*.plies"_family.of(key),
                          key,
                          fmt::format("{} numbers", shifts->size()),
                          fmt::format("must hold one number a ply, and cell.plies is {}", stack.plies),
                          "Write 0 mm for a ply that is not shifted.",
                          "",
                          0,
                          {"cell.plies"}});
    for (const double shift : *shifts)
      if (!(std::abs(shift) < 10.0))
        problems.push_back({"*.range"_family.of(key), key, fmt::format("{:.6g} mm", 1e3 * shift),
                            "must lie between -10 and 10 m", "Shifts repeat with the weave."});
  }
}

struct TowKeys {
  std::string width, gap, thickness, linear_density;
};
TowKeys keys_of(const WeaveSpec& weave, std::size_t direction) {
  const OwnTow& own = weave.own[direction];
  return {key_of(direction, own.tow_width.has_value(), "tow_width"),
          key_of(direction, own.gap.has_value(), "gap"),
          key_of(direction, own.tow_thickness.has_value(), "tow_thickness"),
          key_of(direction, own.linear_density.has_value(), "linear_density")};
}

// Directions that have to be looked at: both, if one has something of its own.
std::vector<std::size_t> directions_of(const WeaveSpec& weave) {
  if (weave.own == std::array<OwnTow, 2>{}) return {0};
  return {0, 1};
}

// What a direction has of its own, by the bounds of the common keys.
void check_own_ranges(Problems& problems, const WeaveSpec& w) {
  for (std::size_t i = 0; i < 2; ++i) {
    const OwnTow& own = w.own[i];
    const TowKeys keys = keys_of(w, i);
    const TowSpec tow = w.tow(i);
    const Bound bounds[] = {
        {keys.width.c_str(), tow.width, "mm", 1e3, !own.tow_width || (tow.width > 0.0 && tow.width < 0.1),
         "must satisfy 0 < tow_width < 100 mm", "Table 1 gives 4.64 mm; write 4.64 mm."},
        {keys.gap.c_str(), tow.gap, "mm", 1e3, !own.gap || (tow.gap >= 0.0 && tow.gap < 0.1),
         "must satisfy 0 <= gap < 100 mm", "Table 1 gives 0.75 mm; write 0.75 mm."},
        {keys.thickness.c_str(), tow.thickness, "mm", 1e3,
         !own.tow_thickness || (tow.thickness > 0.0 && tow.thickness < 0.02),
         "must satisfy 0 < tow_thickness < 20 mm", "Table 1 gives 0.75 mm; write 0.75 mm."},
        {keys.linear_density.c_str(), tow.linear_density, "tex", 1e6,
         !own.linear_density || (tow.linear_density > 0.0 && tow.linear_density < 0.1),
         "must satisfy 0 < linear_density < 100000 tex", "Table 1's fabric has 1872 tex; write 1872 tex."},
    };
    for (const Bound& bound : bounds) add_if_broken(problems, bound);
  }
}

void check_section(Problems& problems, const WeaveSpec& w) {
  constexpr const char* of_the_power = "1 is the ellipse, smaller is fuller, 2 is nearly the lens.";
  constexpr const char* of_the_cap = "1 is the lens; 0.6 leaves two fifths of the width to the flanks.";
  const Bound bounds[] = {
      {"weave.section_power", w.section_power, "", 1.0, within(0.2, w.section_power, 4.0),
       "must lie between 0.2 and 4", of_the_power},
      {"weave.section_cap", w.section_cap, "", 1.0, within(0.1, w.section_cap, 1.0),
       "must lie between 0.1 and 1", of_the_cap},
      {"weave.upper_share", w.upper_share, "%", 100.0, within(0.1, w.upper_share, 0.9),
       "must lie between 10 % and 90 %", "50 % gives both halves of the section the same thickness."},
      {"weave.upper.section_power", w.upper.section_power, "", 1.0, within(0.2, w.upper.section_power, 4.0),
       "must lie between 0.2 and 4", of_the_power},
      {"weave.upper.section_cap", w.upper.section_cap, "", 1.0, within(0.1, w.upper.section_cap, 1.0),
       "must lie between 0.1 and 1", of_the_cap},
      {"weave.lower.section_power", w.lower.section_power, "", 1.0, within(0.2, w.lower.section_power, 4.0),
       "must lie between 0.2 and 4", of_the_power},
      {"weave.lower.section_cap", w.lower.section_cap, "", 1.0, within(0.1, w.lower.section_cap, 1.0),
       "must lie between 0.1 and 1", of_the_cap},
  };
  for (const Bound& bound : bounds) add_if_broken(problems, bound);
}

// Beyond these the crowns of neighbouring tows and the crossings no longer make a cloth, and the contact
// tables end.
void check_proportions(Problems& problems, const WeaveSpec& w) {
  for (const std::size_t i : directions_of(w)) {
    const TowSpec tow = w.tow(i);
    const TowKeys keys = keys_of(w, i);
    const double slenderness = tow.width / tow.thickness;
    if (slenderness < 2.0 || slenderness > 40.0)
      problems.push_back(
          {"*.proportion"_family.of(keys.width),
           keys.width,
           fmt::format("{:.6g} mm", 1e3 * tow.width),
           fmt::format("must be 2 to 40 times the tow thickness ({:.6g} mm); it is {:.3g} times",
                       1e3 * tow.thickness, slenderness),
           "Table 1 gives 4.64 mm and 0.75 mm.",
           "",
           0,
           {keys.thickness}});
    if (tow.gap > tow.width)
      problems.push_back(
          {"*.proportion"_family.of(keys.gap),
           keys.gap,
           fmt::format("{:.6g} mm", 1e3 * tow.gap),
           fmt::format("must not exceed the tow width ({:.6g} mm): wider apart the tows do not make a cloth",
                       1e3 * tow.width),
           "Table 1 gives 0.75 mm.",
           "",
           0,
           {keys.width}});
  }
}

void check_thickness(Problems& problems, const WeaveSpec& w) {
  // One percent: Table 1 rounds to 0.05 mm, and the height of the crowns follows the tows, not the table.
  const std::array<double, 2> tow{w.tow(0).thickness, w.tow(1).thickness};
  const double from_tows = tow[0] + tow[1] + std::abs(w.crimp_excess());
  if (std::abs(w.fabric_thickness - from_tows) <= 0.01 * from_tows) return;
  const bool alike = tow[0] == tow[1] && !w.warp_crimp;
  problems.push_back(
      {"weave.fabric_thickness.consistent"_rule,
       "weave.fabric_thickness",
       fmt::format("{:.6g} mm", 1e3 * w.fabric_thickness),
       fmt::format("must be the two tow thicknesses on top of each other{}, {:.6g} mm, within 1 %",
                   w.warp_crimp ? " and what the higher crowns stand out" : "", 1e3 * from_tows),
       alike ? fmt::format("Write fabric_thickness: {:.6g} mm, or tow_thickness: {:.6g} mm.", 1e3 * from_tows,
                           0.5e3 * w.fabric_thickness)
             : fmt::format("Write fabric_thickness: {:.6g} mm.", 1e3 * from_tows),
       "",
       0,
       {keys_of(w, 0).thickness, keys_of(w, 1).thickness}});
}

// A path that rises further than its tows leave it room for jams on a radius below that of the section under
// it, and would cut in.
void check_crimp_room(Problems& problems, const WeaveSpec& w) {
  if (!w.warp_crimp) return;
  const double asked = w.crimp_excess(), room = excess_with_room(w, asked);
  if (std::abs(asked - room) <= 1e-12 * w.fabric_thickness) return;
  const double both = w.tow(0).thickness + w.tow(1).thickness;
  problems.push_back(
      {"weave.warp_crimp.room"_rule,
       "weave.warp_crimp",
       fmt::format("{:.6g} %", 100.0 * *w.warp_crimp),
       fmt::format("must be at {} {:.6g} %: the {}s would cut into the {}s they go round",
                   asked > room ? "most" : "least", 100.0 * (room + w.tow(1).thickness) / both,
                   asked > room ? "warp" : "weft", asked > room ? "weft" : "warp"),
       "Give a share nearer to 50 %, or wider gaps.",
       "",
       0,
       {keys_of(w, 0).width, keys_of(w, 1).width, keys_of(w, 0).gap, keys_of(w, 1).gap,
        keys_of(w, 0).thickness, keys_of(w, 1).thickness, "weave.section", "weave.upper_share"}});
}

// Each direction rises by the thickness of the other, so the thinner one crimps the more: beyond this it
// would climb rather than weave.
void check_balance(Problems& problems, const WeaveSpec& w) {
  const std::array<double, 2> tow{w.tow(0).thickness, w.tow(1).thickness};
  const std::size_t thick = tow[0] >= tow[1] ? 0 : 1;
  if (tow[thick] <= 4.0 * tow[1 - thick]) return;
  const std::string key = keys_of(w, thick).thickness, other = keys_of(w, 1 - thick).thickness;
  problems.push_back({"*.balance"_family.of(key),
                      key,
                      fmt::format("{:.6g} mm", 1e3 * tow[thick]),
                      fmt::format("must be at most 4 times the thickness of the crossing tows ({:.6g} mm)",
                                  1e3 * tow[1 - thick]),
                      "Tows of such different size do not weave; give both directions a thickness.",
                      "",
                      0,
                      {other}});
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
                                                   "weave.section",
                                                   "weave.section_power",
                                                   "weave.section_cap",
                                                   "weave.upper_share",
                                                   "weave.upper.section",
                                                   "weave.upper.section_power",
                                                   "weave.upper.section_cap",
                                                   "weave.lower.section",
                                                   "weave.lower.section_power",
                                                   "weave.lower.section_cap",
                                                   "weave.warp.tow_width",
                                                   "weave.warp.gap",
                                                   "weave.warp.tow_thickness",
                                                   "weave.warp.linear_density",
                                                   "weave.weft.tow_width",
                                                   "weave.weft.gap",
                                                   "weave.weft.tow_thickness",
                                                   "weave.weft.linear_density",
                                                   "cell.state",
                                                   "cell.thickness",
                                                   "cell.pressure"};

void check_packing(Problems& problems, const CellSpec& spec) {
  const FabricGeometry woven = fabric_geometry(spec.weave, CellState::as_woven);
  // The fullest tow decides: as woven, or squeezed flat in the consolidated sheet.
  const FabricGeometry state = spec.state == CellState::as_woven ? woven : fabric_geometry(spec);
  for (const std::size_t i : directions_of(spec.weave)) {
    const std::string key = keys_of(spec.weave, i).thickness;
    if (woven.tow_solid_fraction[i] > 1.0) {
      problems.push_back({"*.holds_material"_family.of(key), key,
                          fmt::format("{:.6g} mm", 1e3 * spec.weave.tow(i).thickness),
                          fmt::format("the tow section must hold its glass and resin, but they fill {:.3g} "
                                      "of it",
                                      woven.tow_solid_fraction[i]),
                          "Give a thicker or wider tow, or a smaller linear_density.", "", 0,
                          keys_of_the_packing});
      continue;
    }
    const double fraction = state.crossing.tow[i].fibre_fraction;
    if (fraction <= 0.75) continue;
    return problems.push_back(
        {"weave.fibre_mass_fraction.packing"_rule, "weave.fibre_mass_fraction",
         fmt::format("{:.6g} %", 100.0 * spec.weave.fibre_mass_fraction),
         fmt::format("fibres must fill at most 0.75 of the tow, but fill {:.3g}", fraction),
         "Parallel fibres reach 0.785 in a square and 0.907 in a hexagonal array: give less glass, or a "
         "thicker or wider tow.",
         "", 0, keys_of_the_packing});
  }
}

}  // namespace

TowSpec WeaveSpec::tow(std::size_t direction) const {
  const OwnTow& tow = own[direction];
  return {tow.tow_width.value_or(tow_width), tow.gap.value_or(gap), tow.tow_thickness.value_or(tow_thickness),
          tow.linear_density.value_or(linear_density)};
}

double WeaveSpec::crimp_excess() const {
  if (!warp_crimp) return 0.0;
  const double warp = tow(0).thickness, weft = tow(1).thickness;
  return *warp_crimp * (warp + weft) - weft;
}

std::vector<std::array<double, 2>> StackSpec::shifts() const {
  std::vector<std::array<double, 2>> shifts(static_cast<std::size_t>(plies), {0.0, 0.0});
  for (std::size_t k = 0; k < shifts.size(); ++k)
    shifts[k] = {along_warp.empty() ? 0.0 : along_warp[k], along_weft.empty() ? 0.0 : along_weft[k]};
  return shifts;
}

Problems check(const CellSpec& spec) {
  Problems problems = check_pattern(spec.weave.pattern);
  const std::size_t before = problems.size();
  check_weave_ranges(problems, spec.weave);
  check_own_ranges(problems, spec.weave);
  check_section(problems, spec.weave);
  if (problems.size() == before) {
    check_proportions(problems, spec.weave);
    check_thickness(problems, spec.weave);
    check_balance(problems, spec.weave);
    check_crimp_room(problems, spec.weave);
  }
  check_stack(problems, spec.stack);
  check_resin(problems, spec.resin);
  check_forming(problems, spec.forming);
  if (spec.film) {
    check_film(problems, *spec.film);
    const WeaveSpec& weave = spec.weave;
    if (weave.pattern != "plain" || weave.own != std::array<OwnTow, 2>{} || weave.warp_crimp)
      problems.push_back(
          {"film.weave"_rule,
           "film",
           "",
           "is worked out for a plain weave of like warp and weft alone",
           "Leave the block out: other weaves drag otherwise on either face and when sheared the other "
           "way.",
           "",
           0,
           {"weave"}});
  }
  if (spec.facing != Facing::flat && spec.state != CellState::as_woven)
    problems.push_back(
        {"cell.facing.state"_rule,
         "cell.facing",
         "",
         "is of the fabric as woven, and cell.state is another",
         "Leave one of the two out: pressed plies are as thick as their mass says, however they lie.",
         "",
         0,
         {"cell.state"}});
  // States and packing need a geometry, and so sound numbers.
  if (problems.empty()) problems = check_state(spec);
  if (problems.empty()) check_packing(problems, spec);
  return problems;
}

}  // namespace heddle::mesoscale
