#include "pipeline/config_schema.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <sstream>
#include <stdexcept>

#include "core/units.h"
#include "pipeline/calibrate_keys.h"
#include "pipeline/discover_keys.h"
#include "pipeline/forming_effect_keys.h"
#include "pipeline/friction_keys.h"
#include "pipeline/key_table.h"
#include "pipeline/solid_keys.h"
#include "pipeline/stamping_keys.h"
#include "pipeline/stamping_study_keys.h"
#include "pipeline/study_keys.h"
#include "pipeline/thermal_keys.h"

namespace heddle::pipeline {
namespace {

// A table reads better in rows than one field a line.
// clang-format off
std::vector<Key> head_keys() {
  return {
      {.path = "heddle", .type = KeyType::choice, .presence = required, .choices = {"1"},
       .help = "Version of this file format; write heddle: 1."},
      {.path = "name", .type = KeyType::word, .presence = required,
       .help = "Name of the case; results go to out/NAME."},
  };
}

std::vector<Key> weave_keys() {
  const auto cell = Stage::cell;
  return {
      {.path = "weave.pattern", .type = KeyType::text, .presence = required, .stage = cell,
       .help = "plain, twill m/n, twill m/n step s, satin N/k, crowfoot, or matrix for any other."},
      {.path = "weave.matrix", .type = KeyType::bits, .presence = required, .stage = cell,
       .used_when = "weave.pattern=matrix",
       .help = "One repeat, a row a warp and an entry a weft: 1 where the warp is over."},
      {.path = "weave.tow_width", .type = KeyType::quantity, .unit = "mm", .presence = required,
       .range = "(0 mm, 100 mm)", .stage = cell, .help = "Width of a tow (paper, Table 1: 4.64 mm)."},
      {.path = "weave.gap", .type = KeyType::quantity, .unit = "mm", .presence = required, .range = "[0 mm, 100 mm)",
       .stage = cell, .help = "Clear distance between neighbouring tows (Table 1: 0.75 mm)."},
      {.path = "weave.tow_thickness", .type = KeyType::quantity, .unit = "mm", .presence = required,
       .range = "(0 mm, 20 mm)", .stage = cell, .help = "Thickness of a tow (Table 1: 0.75 mm)."},
      {.path = "weave.fabric_thickness", .type = KeyType::quantity, .unit = "mm", .presence = required,
       .range = "(0 mm, 40 mm)", .stage = cell, .help = "Thickness of the fabric (Table 1: 1.5 mm)."},
      {.path = "weave.linear_density", .type = KeyType::quantity, .unit = "tex", .presence = required,
       .range = "(0 tex, 100000 tex)", .stage = cell,
       .help = "Mass per length of one tow, glass and resin (1872 tex)."},
      {.path = "weave.fibre_mass_fraction", .type = KeyType::quantity, .unit = "%", .presence = required,
       .range = "(0, 1]", .stage = cell, .help = "Glass over glass and resin, by mass (Table 1: 60 %)."},
      {.path = "weave.fibre_density", .type = KeyType::quantity, .unit = "kg/m^3", .presence = defaulted,
       .default_text = "2550 kg/m^3", .range = "[100 kg/m^3, 30000 kg/m^3]", .stage = cell, .help = "Glass."},
      {.path = "weave.resin_density", .type = KeyType::quantity, .unit = "kg/m^3", .presence = defaulted,
       .default_text = "905 kg/m^3", .range = "[100 kg/m^3, 30000 kg/m^3]", .stage = cell,
       .help = "Solid polypropylene."},
      {.path = "weave.fibre_modulus", .type = KeyType::quantity, .unit = "GPa", .presence = defaulted,
       .default_text = "72.4 GPa", .range = "(0 GPa, 2000 GPa)", .stage = cell, .help = "Young's modulus of glass."},
      {.path = "weave.fibre_diameter", .type = KeyType::quantity, .unit = "um", .presence = defaulted,
       .default_text = "18.5 um", .range = "(0 um, 1000 um)", .stage = cell,
       .help = "Of one filament; recalled, not measured."},
      {.path = "weave.warp_crimp", .type = KeyType::quantity, .unit = "%", .presence = optional, .range = "[0, 1]",
       .stage = cell, .help = "Share of the crimp height that the warps take; absent: faces are flush."},
      {.path = "weave.section", .type = KeyType::choice, .presence = defaulted, .default_text = "lens",
       .choices = {"lens", "ellipse", "power_ellipse", "capped_lens", "hybrid"}, .stage = cell,
       .help = "Outline of a tow cut across. Lens and capped lens do not reach into the tows they cross; ellipses do. hybrid: one shape above, another below."},
      {.path = "weave.section_power", .type = KeyType::quantity, .presence = defaulted, .default_text = "0.5",
       .range = "[0.2, 4]", .stage = cell, .used_when = "weave.section=power_ellipse",
       .help = "n of t/2 (1 - (2y/w)^2)^(n/2): 1 is the ellipse, smaller is fuller."},
      {.path = "weave.section_cap", .type = KeyType::quantity, .presence = defaulted, .default_text = "0.6",
       .range = "[0.1, 1]", .stage = cell, .used_when = "weave.section=capped_lens",
       .help = "Share of the width that is arc; the rest are straight flanks."},
  };
}

std::vector<Key> cell_keys() {
  const auto cell = Stage::cell;
  return {
      {.path = "cell.state", .type = KeyType::choice, .presence = defaulted, .default_text = "as_woven",
       .choices = {"as_woven", "compacted", "consolidated"}, .stage = cell,
       .help = "as_woven: molten, at fabric thickness, for forming; compacted: pressed to a thickness; consolidated: no voids left."},
      {.path = "cell.thickness", .type = KeyType::quantity, .unit = "mm", .presence = optional,
       .range = "(0 mm, 40 mm)", .stage = cell, .used_when = "cell.state=compacted",
       .help = "Of the compacted fabric; it, or cell.pressure."},
      {.path = "cell.pressure", .type = KeyType::quantity, .unit = "kPa", .presence = optional,
       .range = "(0 kPa, 1000000 kPa]", .stage = cell, .used_when = "cell.state=compacted",
       .help = "Of flat plates on the as-woven fabric: its compaction law says how thick that leaves it."},
      {.path = "cell.plies", .type = KeyType::integer, .presence = defaulted, .default_text = "1", .range = "[1, 8]",
       .stage = cell, .help = "Equal plies on one another, nested: thickness and shares of the stack; with solid, its A, B and D."},
      {.path = "cell.shift_warp", .type = KeyType::list, .unit = "mm", .presence = optional,
       .range = "(-10000 mm, 10000 mm)", .stage = cell,
       .help = "Where each ply lies along the warp, one number a ply, for instance [0 mm, 2.7 mm]; absent: on top of each other."},
      {.path = "cell.shift_weft", .type = KeyType::list, .unit = "mm", .presence = optional,
       .range = "(-10000 mm, 10000 mm)", .stage = cell, .help = "The same along the weft."},
      {.path = "cell.facing", .type = KeyType::choice, .presence = defaulted, .default_text = "flat",
       .choices = {"flat", "mean", "shift"}, .stage = cell,
       .help = "How plies of a blank press each other. flat: each as it presses a plate (with blank.nesting); shift: tows shifted by cell.facing_shift; mean: over all shifts, for tows that lie anyhow."},
      {.path = "cell.facing_shift", .type = KeyType::pair, .unit = "mm", .presence = required,
       .range = "(-10000 mm, 10000 mm)", .stage = cell, .used_when = "cell.facing=shift",
       .help = "Of the upper of two plies along warp and weft, for instance [2.7 mm, 0 mm]; [0 mm, 0 mm] is crown on crown."},
  };
}

// What one direction has of its own.
std::vector<Key> own_tow_keys() {
  std::vector<Key> keys;
  for (const std::string direction : {"warp", "weft"})
    for (Key key : weave_keys()) {
      const std::string name = key.path.substr(key.path.find('.') + 1);
      if (name != "tow_width" && name != "gap" && name != "tow_thickness" && name != "linear_density") continue;
      key.path = "weave." + direction + "." + name;
      key.presence = Presence::optional;
      key.help = fmt::format("Of the {}s alone; else weave.{}.", direction, name);
      keys.push_back(std::move(key));
    }
  return keys;
}

// The halves of a hybrid section: the shapes of the whole ones.
std::vector<Key> half_section_keys() {
  std::vector<Key> keys{
      {.path = "weave.upper_share", .type = KeyType::quantity, .unit = "%", .presence = defaulted,
       .default_text = "50 %", .range = "[10 %, 90 %]", .stage = Stage::cell, .used_when = "weave.section=hybrid",
       .help = "Thickness of the upper half of the section over that of the tow."}};
  for (const std::string half : {"upper", "lower"})
    for (Key key : weave_keys()) {
      const std::string name = key.path.substr(key.path.find('.') + 1);
      if (!name.starts_with("section")) continue;
      key.path = "weave." + half + "." + name;
      if (name == "section") {
        std::erase(key.choices, "hybrid");
        key.help = fmt::format("Shape of the {} half of the section.", half);
      }
      const std::string shape = key.used_when.substr(key.used_when.find('=') + 1);
      key.used_when = "weave.section=hybrid";
      if (!shape.empty()) key.used_when += fmt::format(" weave.{}.section={}", half, shape);
      keys.push_back(std::move(key));
    }
  return keys;
}

std::vector<Key> fabric_keys() {
  const auto cell = Stage::cell;
  return {
      {.path = "fabric.shear_rate", .type = KeyType::choice, .presence = defaulted, .default_text = "on",
       .choices = {"on", "off"}, .stage = cell,
       .help = "Master switch of the rate-dependent shear resistance."},
      {.path = "fabric.shear_hysteresis.share", .type = KeyType::quantity, .presence = defaulted,
       .default_text = "0", .range = "[0, 1)", .stage = Stage::stamping,
       .help = "Share of the shear resistance that is friction between tows: loading stays the fabric's curve, unloading leaves a loop. 0 is off; any other value is a prior."},
      {.path = "fabric.shear_hysteresis.stiffness", .type = KeyType::quantity, .presence = defaulted,
       .default_text = "2", .range = "[1, 1000]", .stage = Stage::stamping,
       .help = "Stiffness of that friction when shear turns back, over the steepest slope it has had on loading; a prior."},
      {.path = "fabric.shear.file", .type = KeyType::file, .presence = optional, .stage = cell,
       .help = "Measured shear in place of the weave's: columns shear_angle_deg and shear_force_N_per_mm, the normalised force of a picture frame, from 0 deg and 0 N/mm on."},
      {.path = "fabric.tension.file", .type = KeyType::file, .presence = optional, .stage = cell,
       .help = "Measured tension in place of the weave's, warp and weft each by itself: columns strain, warp_tension_N_per_mm and weft_tension_N_per_mm, from zeros on."},
      {.path = "fabric.compaction.file", .type = KeyType::file, .presence = optional, .stage = cell,
       .help = "Measured compaction in place of the weave's: columns thickness_mm and pressure_kPa, from weave.fabric_thickness and 0 kPa on."},
      {.path = "fabric.bending.warp", .type = KeyType::quantity, .unit = "N mm", .presence = optional,
       .range = "(0 N mm, 100000 N mm)", .stage = cell, .help = "Measured bending stiffness per width along the warp, in place of the weave's."},
      {.path = "fabric.bending.weft", .type = KeyType::quantity, .unit = "N mm", .presence = optional,
       .range = "(0 N mm, 100000 N mm)", .stage = cell, .help = "The same along the weft."},
      {.path = "fabric.shear_scale", .type = KeyType::quantity, .presence = defaulted, .default_text = "1",
       .range = "(0, 1000000)", .stage = cell,
       .help = "Factor on the rate-free resistance to shear, for studies; 1 is off."},
      {.path = "fabric.tension_scale", .type = KeyType::quantity, .presence = defaulted, .default_text = "1",
       .range = "(0, 1000000)", .stage = cell,
       .help = "Factor on the tension energy of the tows, for studies; 1 is off."},
  };
}

// Conditions on keys of `weave`, of the weave of the calibration pulls.
std::string of_the_pulled_weave(const std::string& conditions) {
  std::string result;
  std::istringstream terms(conditions);
  for (std::string term; terms >> term;) result += " friction.calibration." + term;
  return result;
}

// The weave of the calibration pulls: the keys of `weave`, each with Table 1 as its default. A weave under study may
// differ from the one that was pulled, and the law must not be fitted anew to it.
std::vector<Key> calibration_weave_keys() {
  const std::vector<std::pair<std::string, std::string>> table1 = {
      {"pattern", "plain"}, {"tow_width", "4.64 mm"}, {"gap", "0.75 mm"}, {"tow_thickness", "0.75 mm"},
      {"fabric_thickness", "1.5 mm"}, {"linear_density", "1872 tex"}, {"fibre_mass_fraction", "60 %"}};
  std::vector<Key> keys;
  std::vector<Key> all = weave_keys();
  append(all, own_tow_keys());
  append(all, half_section_keys());
  for (Key key : all) {
    for (const auto& [name, value] : table1)
      if (key.path == "weave." + name) key.default_text = value;
    key.path = "friction.calibration." + key.path;
    const std::string when = "friction.law=stribeck friction.contact_pressure=real";
    if (key.used_when.empty() && key.presence == required) key.presence = defaulted;
    key.stage = Stage::friction;
    // What another key of the weave asks for, the same key of this weave asks for here.
    key.used_when = when + of_the_pulled_weave(key.used_when);
    key.help = "Of the fabric that was pulled. " + key.help;
    keys.push_back(std::move(key));
  }
  return keys;
}

std::vector<Key> resin_keys() {
  return {
      {.path = "resin.rheology", .type = KeyType::choice, .presence = defaulted, .default_text = "power_law",
       .choices = {"power_law", "bingham", "herschel_bulkley", "carreau_yasuda", "cross"},
       .help = "Viscosity law of the film (paper, Eq. 4: power_law); the melt between the tows keeps the power law."},
      {.path = "resin.consistency", .type = KeyType::quantity, .unit = "Pa s^n", .presence = defaulted,
       .default_text = "6790 Pa s^n", .range = "(0 Pa s^n, )",
       .help = "m at the reference temperature; prior: polypropylene at 180 degC (Tadmor & Gogos)."},
      {.path = "resin.power_index", .type = KeyType::quantity, .presence = defaulted, .default_text = "0.38",
       .range = "(0, 1]", .help = "n; polypropylene melts lie at 0.37 to 0.41. Never fitted to friction."},
      {.path = "resin.film_thickness", .type = KeyType::quantity, .unit = "mm", .presence = defaulted,
       .default_text = "0.07 mm", .range = "(0 mm, 10 mm)", .help = "h of Eq. 5 (paper, section 2)."},
      {.path = "resin.activation_energy", .type = KeyType::quantity, .unit = "kJ/mol", .presence = defaulted,
       .default_text = "42 kJ/mol", .range = "[0 kJ/mol, 1000 kJ/mol]",
       .help = "Of the Arrhenius shift of m; prior: polypropylene 38 to 46 kJ/mol."},
      {.path = "resin.reference_temperature", .type = KeyType::quantity, .unit = "degC", .presence = defaulted,
       .default_text = "180 degC", .range = "[200 K, 1000 K]", .help = "Where the consistency holds."},
      {.path = "resin.rate_floor", .type = KeyType::quantity, .unit = "1/s", .presence = defaulted,
       .default_text = "1 1/s", .range = "(0 1/s, )",
       .help = "Shear rate below which the film is Newtonian, which keeps rest finite; ours."},
  };
}

// The film whose drag over the direction of sliding the unit cell hands over.
std::vector<Key> film_keys() {
  std::vector<Key> keys{
      {.path = "film.speed", .type = KeyType::quantity, .unit = "mm/s", .presence = defaulted,
       .default_text = "50 mm/s", .range = "(0 mm/s, 10000 mm/s]", .help = "Of the slip for which the film is worked out."},
      {.path = "film.temperature", .type = KeyType::quantity, .unit = "degC", .presence = defaulted,
       .default_text = "180 degC", .range = "[200 K, 1000 K]", .help = "Of the film."},
      {.path = "film.fill", .type = KeyType::quantity, .unit = "%", .presence = optional, .range = "(0, 1)",
       .help = "Share of the gap under the tool that resin fills, narrowest places first; else spread evenly over all room beside the glass."},
      {.path = "film.roughness", .type = KeyType::quantity, .unit = "um", .presence = defaulted,
       .default_text = "9.25 um", .range = "(0 um, 1000 um]", .help = "Film left where a tow is touched; prior: a fibre's radius."},
      {.path = "film.boundary_friction", .type = KeyType::quantity, .presence = defaulted, .default_text = "0.2",
       .range = "[0, 2]", .help = "Of touching fibres; prior."},
      {.path = "film.samples", .type = KeyType::integer, .presence = defaulted, .default_text = "64",
       .range = "[64, 128]", .help = "Along each edge of the repeat: 64 or 128."},
  };
  for (Key& key : keys) {
    key.stage = Stage::cell;
    key.used_when = "film";
  }
  return keys;
}

std::vector<Key> forming_keys() {
  const auto cell = Stage::cell;
  return {
      {.path = "forming.compaction", .type = KeyType::choice, .presence = defaulted, .default_text = "toll",
       .choices = {"toll", "van_wyk", "gutowski"}, .stage = cell,
       .help = "Law of tows pressed across: fibre networks k E V^n (van_wyk: n = 3), or nearly parallel fibres by Gutowski."},
      {.path = "forming.compaction_modulus", .type = KeyType::quantity, .unit = "MPa", .presence = defaulted,
       .default_text = "3.2 MPa", .range = "[0.001 MPa, 100000 MPa]", .stage = cell,
       .used_when = "!forming.compaction=gutowski",
       .help = "k E of sigma = k E (V^n - V0^n) in compaction; prior. With n = 3, 0.56 MPa is as stiff at V = 0.4."},
      {.path = "forming.compaction_exponent", .type = KeyType::quantity, .presence = defaulted, .default_text = "5",
       .range = "(1, 20]", .stage = cell, .used_when = "forming.compaction=toll",
       .help = "n of the compaction law: 3 random, 5 planar, more for bundles; prior."},
      {.path = "forming.gutowski_spring", .type = KeyType::quantity, .unit = "kPa", .presence = defaulted,
       .default_text = "3 kPa", .range = "[0.001 kPa, 1000000 kPa]", .stage = cell,
       .used_when = "forming.compaction=gutowski",
       .help = "A_s of A_s (sqrt(V/V0) - 1) / (sqrt(Va/V) - 1)^4; prior: as stiff as the default of toll at V = 0.4."},
      {.path = "forming.gutowski_available", .type = KeyType::quantity, .unit = "%", .presence = defaulted,
       .default_text = "0.85", .range = "(0.82, 0.907]", .stage = cell,
       .used_when = "forming.compaction=gutowski", .help = "Va, at which fibres have no room left; prior."},
      {.path = "forming.tow_friction", .type = KeyType::quantity, .presence = defaulted, .default_text = "0.2",
       .range = "[0, 2]", .stage = cell, .help = "Between crossing tows, lubricated; prior."},
      {.path = "forming.reference_tension", .type = KeyType::quantity, .unit = "N/m", .presence = defaulted,
       .default_text = "800 N/m", .range = "(0 N/m, 100000 N/m]", .stage = cell,
       .help = "Tow tension per width at which the shear energy is taken; prior, about that at the die rim of the shipped case."},
      {.path = "forming.in_tow_shear_share", .type = KeyType::quantity, .unit = "%", .presence = defaulted,
       .default_text = "0.5", .range = "[0, 1]", .stage = cell,
       .help = "0: tows turn rigidly, 1: they shear inside; prior."},
      {.path = "forming.bonding", .type = KeyType::quantity, .unit = "%", .presence = defaulted,
       .default_text = "0.3", .range = "[0, 1]", .stage = cell,
       .help = "0: fibres slide freely in bending, 1: bonded; prior."},
      {.path = "forming.compression_ratio", .type = KeyType::quantity, .unit = "%", .presence = defaulted,
       .default_text = "0.01", .range = "(0, 0.2]", .stage = cell,
       .help = "Tangent in compression over tangent in tension; prior."},
  };
}

std::vector<Key> friction_keys() {
  const auto friction = Stage::friction;
  const std::string stribeck = "friction.law=stribeck";
  const std::string direct_power = stribeck + " friction.form=power !friction.calibration.data";
  const std::string direct_linear = stribeck + " friction.form=linear !friction.calibration.data";
  std::vector<std::string> laws = further_laws(), forms = further_forms();
  laws.insert(laws.begin(), {"stribeck", "coulomb"});
  forms.insert(forms.begin(), {"power", "linear"});
  return {
      {.path = "friction.law", .type = KeyType::choice, .presence = required, .choices = laws, .stage = friction,
       .help = "stribeck: mu follows the Hersey number; coulomb: mu is constant; the others: docs/theory/friction.md."},
      {.path = "friction.coefficient", .type = KeyType::quantity, .presence = required, .range = "[0, 10)",
       .stage = friction, .used_when = "friction.law=coulomb", .help = "mu of the Coulomb law."},
      {.path = "friction.form", .type = KeyType::choice, .presence = defaulted, .default_text = "power",
       .choices = forms, .stage = friction,
       .used_when = stribeck,
       .help = "power: mu = C Hs^s; linear: mu = a + b Hs/Hs0, which grows without bound at low pressure."},
      {.path = "friction.contact_pressure", .type = KeyType::choice, .presence = defaulted, .default_text = "real",
       .choices = {"real", "nominal"}, .stage = friction,
       .help = "real: the law sees p / phi with the contact fraction phi of the weave; nominal: p."},
      {.path = "friction.calibration.data", .type = KeyType::file, .presence = optional, .stage = friction,
       .used_when = stribeck,
       .help = "Friction test table; when given, the constants of the law are fitted to it, else they must be given."},
      {.path = "friction.calibration.plate_area", .type = KeyType::quantity, .unit = "m^2", .presence = required,
       .range = "(0 m^2, 1 m^2)", .stage = friction, .used_when = stribeck,
       .help = "Of the friction rig, which turns its force into pressure. Assumed: the paper does not give it."},
      {.path = "friction.calibration.plate_area_band", .type = KeyType::pair, .unit = "m^2", .presence = optional,
       .range = "(0 m^2, 1 m^2)", .stage = friction, .used_when = stribeck,
       .help = "Smallest and largest plate area thought possible; reports carry it."},
      {.path = "friction.box.hersey", .type = KeyType::pair, .presence = optional, .range = "[0, )", .stage = friction,
       .used_when = "!friction.calibration.data",
       .help = "Hersey numbers between which the law was fitted; beyond them its log slope is held."},
      {.path = "friction.box.pressure", .type = KeyType::pair, .unit = "kPa", .presence = optional,
       .range = "[0 kPa, )", .stage = friction, .used_when = "!friction.calibration.data",
       .help = "Nominal pressures of the fit; reports say how much friction work lies outside."},
      {.path = "friction.box.speed", .type = KeyType::pair, .unit = "mm/s", .presence = optional,
       .range = "[0 mm/s, )", .stage = friction, .used_when = "!friction.calibration.data",
       .help = "Slip speeds of the fit."},
      {.path = "friction.scale", .type = KeyType::quantity, .presence = required, .range = "(0, )", .stage = friction,
       .used_when = direct_power, .help = "C of the power form."},
      {.path = "friction.exponent", .type = KeyType::quantity, .presence = required, .range = "[0, 1)",
       .stage = friction, .used_when = direct_power, .help = "s of the power form; about 0.14 in Table 4, 0 is constant friction."},
      {.path = "friction.offset", .type = KeyType::quantity, .presence = required, .range = "[0, 10]",
       .stage = friction, .used_when = direct_linear, .help = "a of the linear form."},
      {.path = "friction.slope", .type = KeyType::quantity, .presence = required, .range = "[0, 10]",
       .stage = friction, .used_when = direct_linear, .help = "b of the linear form."},
      {.path = "friction.reference_hersey", .type = KeyType::quantity, .presence = required, .range = "(0, )",
       .stage = friction, .used_when = direct_linear, .help = "Hs0 of the linear form."},
  };
}

std::vector<Key> friction_test_keys() {
  return {
      {.path = "friction_test.data", .type = KeyType::file, .presence = required, .stage = Stage::friction_test,
       .help = "Measured friction forces to compare with."},
      {.path = "friction_test.design", .type = KeyType::file, .presence = optional, .stage = Stage::friction_test,
       .help = "Range of the test parameters (paper, Table 2), over which mu and force are swept."},
  };
}

std::vector<Key> effect_keys() {
  const std::string on = "effects.tool_temperature_shift";
  std::vector<Key> keys{
      {.path = on + ".slope", .type = KeyType::quantity, .unit = "1/K", .presence = required,
       .range = "[-0.1 1/K, 0.1 1/K]", .choices = {"fitted"}, .stage = Stage::friction,
       .used_when = on,
       .help = "Change of mu (or of its factor) per kelvin of tool temperature, or fitted; 0 1/K is off."},
      {.path = on + ".reference", .type = KeyType::quantity, .unit = "degC", .presence = defaulted,
       .default_text = "85 degC", .range = "[-100 degC, 500 degC]", .stage = Stage::friction, .used_when = on,
       .help = "Tool temperature at which mu is unchanged (paper, Table 2 baseline)."},
      {.path = on + ".form", .type = KeyType::choice, .presence = defaulted, .default_text = "term",
       .choices = {"term", "factor"}, .stage = Stage::friction,
       .used_when = on,
       .help = "term: mu + slope (T - reference); factor: mu (1 + slope (T - reference))."},
  };
  keys.push_back({.path = "effects.shear_rate.factor", .type = KeyType::quantity, .presence = required,
                  .range = "[0, 1000]", .stage = Stage::stamping,
                  .used_when = "effects.shear_rate fabric.shear_rate=on",
                  .help = "On the rate-dependent shear resistance that the weave and its melt give; 1 changes nothing, 0 is off."});
  const std::vector<std::string> to_come{
      "normal_force_relaxation", "load_cell_offset",
      "gain_drift", "drive_backlash", "nonuniform_pressure", "mislabelled_condition", "discretisation"};
  append(keys, friction_effect_keys());
  append(keys, press_effect_keys());
  append(keys, forming_effect_keys());
  for (const std::string& id : to_come) keys.push_back(later("effects." + id, "Effect of a later version."));
  keys.push_back(later("effects.inter_tow_slip",
                       "Tows share the nodes of the sheet, which bind them at their crossovers: none can slide over another; "
                       "`gap_opening_warp_weft_mm` in the `.vtu` files shows where they would be pulled apart."));
  return keys;
}

std::vector<Key> study_keys() {
  const auto study = Stage::orientation_study;
  return {
      {.path = "orientation_study.blanks", .type = KeyType::list, .unit = "deg", .presence = required,
       .range = "[-180 deg, 180 deg]", .stage = study,
       .help = "Warp of each blank to be stamped against x; takes the place of blank.orientation."},
      {.path = "orientation_study.friction", .type = KeyType::list, .unit = "deg", .presence = required,
       .range = "[-180 deg, 180 deg]", .stage = study,
       .help = "Warp of each friction sample against its pull."},
  };
}

std::vector<Key> artefact_keys() {
  return {
      {.path = "artefact.mass_scaling", .type = KeyType::quantity, .presence = defaulted, .default_text = "1",
       .range = "[1e-6, 1e9]", .stage = Stage::stamping,
       .help = "Factor on areal density. Not physical; 1 is off. Without mass nothing holds a sheet that folds."},
      {.path = "artefact.stabilisation", .type = KeyType::quantity, .unit = "N s/m^3", .presence = defaulted,
       .default_text = "0 N s/m^3", .range = "[0 N s/m^3, )", .stage = Stage::stamping,
       .help = "Damping of every node per area. Not physical; 0 is off."},
  };
}
// clang-format on

std::vector<Key> all_keys() {
  std::vector<Key> keys = head_keys();
  append(keys, weave_keys());
  append(keys, own_tow_keys());
  append(keys, half_section_keys());
  append(keys, cell_keys());
  append(keys, voxel_keys());
  append(keys, fabric_keys());
  append(keys, solid_keys());
  append(keys, resin_keys());
  append(keys, rheology_keys());
  append(keys, film_keys());
  append(keys, forming_keys());
  append(keys, friction_keys());
  append(keys, calibration_weave_keys());
  append(keys, friction_law_keys());
  append(keys, conduction_keys());
  append(keys, friction_test_keys());
  append(keys, rig_keys());
  append(keys, process_keys());
  append(keys, thermal_keys());
  append(keys, blank_keys());
  append(keys, contact_keys());
  append(keys, tool_keys());
  append(keys, effect_keys());
  append(keys, artefact_keys());
  append(keys, study_keys());
  append(keys, cell_study_keys());
  append(keys, stamping_study_keys());
  append(keys, calibrate_keys());
  append(keys, discover_keys());
  return keys;
}

struct Bound {
  double value;
  std::string text;
};

Bound bound_of(std::string text, const std::string& unit, double unbounded) {
  text.erase(0, text.find_first_not_of(' '));
  if (text.empty()) return {unbounded, ""};
  const Reading reading = read_quantity(text, unit);
  if (!reading.ok()) throw std::logic_error(fmt::format("schema bound \"{}\" {}", text, reading.fault));
  return {reading.value, text};
}

}  // namespace

const std::vector<Key>& schema() {
  static const std::vector<Key> keys = all_keys();
  return keys;
}

const Key* find_key(const std::string& path) {
  const auto found =
      std::find_if(schema().begin(), schema().end(), [&](const Key& key) { return key.path == path; });
  return found == schema().end() ? nullptr : &*found;
}

bool is_block(const std::string& path) {
  const std::string start = path + ".";
  return std::any_of(schema().begin(), schema().end(),
                     [&](const Key& key) { return key.path.starts_with(start); });
}

std::vector<std::string> names_below(const std::string& block) {
  const std::string start = block.empty() ? "" : block + ".";
  std::vector<std::string> names;
  for (const Key& key : schema()) {
    if (!key.path.starts_with(start)) continue;
    const std::string rest = key.path.substr(start.size());
    const std::string name = rest.substr(0, rest.find('.'));
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  }
  return names;
}

bool Interval::contains(double value) const {
  return (low_open ? value > low : value >= low) && (high_open ? value < high : value <= high);
}

std::string Interval::rule(const std::string& name) const {
  if (low == high) return fmt::format("{} = {}", name, low_text);
  std::string text = name;
  if (!low_text.empty()) text = fmt::format("{} {} {}", low_text, low_open ? "<" : "<=", text);
  if (!high_text.empty()) text = fmt::format("{} {} {}", text, high_open ? "<" : "<=", high_text);
  return text;
}

Interval interval_of(const std::string& range, const std::string& unit) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  if (range.empty()) return {-infinity, infinity, true, true, "", ""};
  const std::size_t comma = range.find(',');
  const Bound low = bound_of(range.substr(1, comma - 1), unit, -infinity);
  const Bound high = bound_of(range.substr(comma + 1, range.size() - comma - 2), unit, infinity);
  return {low.value, high.value, range.front() == '(', range.back() == ')', low.text, high.text};
}

}  // namespace heddle::pipeline
