#include "pipeline/case.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>

#include "core/text_file.h"
#include "core/units.h"
#include "friction/calibrate.h"
#include "friction/combinations.h"
#include "friction/test_design.h"
#include "macroscale/outline_file.h"
#include "macroscale/tool_loading.h"
#include "macroscale/tool_set.h"
#include "pipeline/friction_keys.h"
#include "pipeline/outputs.h"
#include "pipeline/solid_keys.h"

namespace heddle::pipeline {
namespace {

// ---- from settings to the rooms' specifications. A key that could not be read leaves the default of its
// struct:
// ---- the case is not used then, only looked through for more problems.

void take(const Settings& settings, const std::string& path, double& value) {
  if (settings.has(path)) value = settings.number(path);
}
void take(const Settings& settings, const std::string& path, int& value) {
  if (settings.has(path)) value = settings.integer(path);
}
void take(const Settings& settings, const std::string& path, std::array<double, 2>& value) {
  if (settings.has(path)) value = settings.pair(path);
}
void take(const Settings& settings, const std::string& path, std::string& value) {
  if (settings.has(path)) value = settings.text(path);
}

template <std::size_t columns>
std::vector<std::array<double, columns>> rows(const Settings& settings, const std::string& path) {
  std::vector<std::array<double, columns>> result;
  if (!settings.has(path)) return result;
  const std::vector<double>& values = settings.many(path);
  for (std::size_t k = 0; k + columns <= values.size(); k += columns) {
    result.emplace_back();
    std::copy_n(values.begin() + static_cast<std::ptrdiff_t>(k), columns, result.back().begin());
  }
  return result;
}

mesoscale::WeaveSpec weave_of(const Settings& settings, const std::string& block) {
  mesoscale::WeaveSpec weave;
  take(settings, block + ".pattern", weave.pattern);
  take(settings, block + ".tow_width", weave.tow_width);
  take(settings, block + ".gap", weave.gap);
  take(settings, block + ".tow_thickness", weave.tow_thickness);
  take(settings, block + ".fabric_thickness", weave.fabric_thickness);
  take(settings, block + ".linear_density", weave.linear_density);
  take(settings, block + ".fibre_mass_fraction", weave.fibre_mass_fraction);
  take(settings, block + ".fibre_density", weave.fibre_density);
  take(settings, block + ".resin_density", weave.resin_density);
  take(settings, block + ".fibre_modulus", weave.fibre_modulus);
  take(settings, block + ".fibre_diameter", weave.fibre_diameter);
  return weave;
}

mesoscale::ResinSpec resin_of(const Settings& settings) {
  mesoscale::ResinSpec resin;
  take(settings, "resin.consistency", resin.consistency);
  take(settings, "resin.power_index", resin.power_index);
  take(settings, "resin.film_thickness", resin.film_thickness);
  take(settings, "resin.activation_energy", resin.activation_energy);
  take(settings, "resin.reference_temperature", resin.reference_temperature);
  return resin;
}

mesoscale::FormingSpec forming_of(const Settings& settings) {
  mesoscale::FormingSpec forming;
  take(settings, "forming.compaction_modulus", forming.compaction_modulus);
  take(settings, "forming.compaction_exponent", forming.compaction_exponent);
  take(settings, "forming.tow_friction", forming.tow_friction);
  take(settings, "forming.reference_tension", forming.reference_tension);
  take(settings, "forming.in_tow_shear_share", forming.in_tow_shear_share);
  take(settings, "forming.bonding", forming.bonding);
  take(settings, "forming.compression_ratio", forming.compression_ratio);
  return forming;
}

mesoscale::CellSpec cell_of(const Settings& settings) {
  mesoscale::CellSpec cell;
  cell.weave = weave_of(settings, "weave");
  cell.state = settings.is("cell.state", "consolidated") ? mesoscale::CellState::consolidated
                                                         : mesoscale::CellState::as_woven;
  cell.resin = resin_of(settings);
  cell.forming = forming_of(settings);
  return cell;
}

/// The melt between fabric and tool is the melt between the tows.
friction::PowerLawFilm film_of(const Settings& settings) {
  const mesoscale::ResinSpec resin = resin_of(settings);
  friction::PowerLawFilm film;
  film.consistency = resin.consistency;
  film.index = resin.power_index;
  film.thickness = resin.film_thickness;
  film.activation_energy = resin.activation_energy;
  film.reference_temperature = resin.reference_temperature;
  take(settings, "resin.rate_floor", film.rate_floor);
  return film;
}

friction::Law law_of(const Settings& settings, const std::filesystem::path& folder) {
  if (auto law = further_law_of(settings, folder)) return *std::move(law);
  if (settings.is("friction.law", "coulomb")) {
    friction::Coulomb law;
    take(settings, "friction.coefficient", law.coefficient);
    return law;
  }
  if (settings.is("friction.form", "linear")) {
    friction::HerseyLinear law;
    take(settings, "friction.offset", law.offset);
    take(settings, "friction.slope", law.slope);
    take(settings, "friction.reference_hersey", law.reference);
    return law;
  }
  friction::HerseyPower law;
  take(settings, "friction.scale", law.scale);
  take(settings, "friction.exponent", law.exponent);
  return law;
}

const std::string shift_path = "effects.tool_temperature_shift";

bool slope_is_fitted(const Settings& settings) {
  return settings.is(shift_path + ".slope", "fitted");
}

friction::Effects effects_of(const Settings& settings) {
  friction::Effects effects;
  take_effects(settings, effects);
  if (settings.blocks.count(shift_path) == 0) return effects;
  friction::ToolTemperatureShift shift;
  if (!slope_is_fitted(settings)) take(settings, shift_path + ".slope", shift.slope);
  take(settings, shift_path + ".reference", shift.reference);
  shift.form = settings.is(shift_path + ".form", "factor") ? friction::ToolTemperatureShift::Form::factor
                                                           : friction::ToolTemperatureShift::Form::term;
  effects.tool_temperature_shift = shift;
  return effects;
}

macroscale::ContactPressure contact_pressure_of(const Settings& settings) {
  return settings.is("friction.contact_pressure", "nominal") ? macroscale::ContactPressure::nominal
                                                             : macroscale::ContactPressure::real;
}

void take_box(const Settings& settings, friction::CalibrationBox& box) {
  const auto take_range = [&](const char* path, double& low, double& high) {
    if (!settings.has(path)) return;
    low = settings.pair(path)[0];
    high = settings.pair(path)[1];
  };
  take_range("friction.box.hersey", box.hersey_low, box.hersey_high);
  take_range("friction.box.pressure", box.pressure_low, box.pressure_high);
  take_range("friction.box.speed", box.speed_low, box.speed_high);
}

FrictionSpec friction_of(const Settings& settings, const std::filesystem::path& folder) {
  FrictionSpec friction;
  try {
    friction.model.law = law_of(settings, folder);
  } catch (const InputError& error) {
    friction.table_problems = error.problems();
  }
  friction.model.film = film_of(settings);
  friction.model.rheology = rheology_of(settings);
  friction.model.effects = effects_of(settings);
  friction.model.conduction = conduction_of(settings, friction.model.film.thickness);
  friction.contact_pressure = contact_pressure_of(settings);
  const std::string area = "friction.calibration.plate_area";
  friction.has_plate_area = settings.has(area);
  take(settings, area, friction.rig.plate_area);
  friction.rig.plate_area_band = {friction.rig.plate_area, friction.rig.plate_area};
  take(settings, area + "_band", friction.rig.plate_area_band);
  take_box(settings, friction.model.box);
  const bool stribeck = settings.is("friction.law", "stribeck");
  if (stribeck && settings.has("friction.calibration.data")) {
    friction.calibration_data = folder / settings.text("friction.calibration.data");
    friction.calibration_weave = weave_of(settings, "friction.calibration.weave");
    friction.fit_temperature_slope = slope_is_fitted(settings);
  }
  take(settings, "friction_test.rig.pull_length", friction.rig.pull_length);
  take(settings, "friction_test.rig.dwell", friction.rig.dwell_before);
  return friction;
}

FrictionMachineSpec friction_machine_of(const Settings& settings) {
  FrictionMachineSpec spec;
  spec.machine = machine_of(settings);
  take(settings, "friction_test.rig.bend.radius", spec.bend.radius);
  take(settings, "friction_test.rig.bend.angle", spec.bend.angle);
  spec.finite_elements = settings.is("friction_test.rig.finite_elements", "on");
  return spec;
}

FrictionTestSpec friction_test_of(const Settings& settings, const std::filesystem::path& folder) {
  FrictionTestSpec test;
  if (settings.has("friction_test.data")) test.data = folder / settings.text("friction_test.data");
  if (settings.has("friction_test.design")) test.design = folder / settings.text("friction_test.design");
  return test;
}

macroscale::ProcessSpec process_of(const Settings& settings) {
  macroscale::ProcessSpec process;
  take(settings, "process.punch.stroke", process.stroke);
  take(settings, "process.punch.time", process.time);
  take(settings, "process.punch.slow_down", process.slow_down);
  take(settings, "process.punch.speed_scale", process.speed_scale);
  take(settings, "process.steps", process.steps);
  take(settings, "process.binder_force", process.binder_force);
  take(settings, "process.tool_temperature", process.tool_temperature);
  take(settings, "process.blank_temperature", process.blank_temperature);
  return process;
}

std::optional<macroscale::ToolFileSpec> tool_file_of(const Settings& settings, const std::string& tool,
                                                     const std::filesystem::path& folder) {
  const std::string block = "tools." + tool;
  if (!settings.has(block + ".file")) return {};
  macroscale::ToolFileSpec spec;
  spec.source.file = folder / settings.text(block + ".file");
  if (settings.has(block + ".length_unit"))
    spec.source.length_unit = read_quantity("1 " + settings.text(block + ".length_unit"), "mm").value;
  take(settings, block + ".mesh_size", spec.source.mesh_size);
  take(settings, block + ".chord_error", spec.source.chord_error);
  take(settings, block + ".voxel", spec.voxel);
  if (settings.is(block + ".sheet", "on")) spec.source.topology = macroscale::TopologyRule::open_allowed;
  spec.source.repair = settings.is(block + ".repair", "on");
  return spec;
}

macroscale::StampingSpec stamping_of(const Settings& settings, const std::filesystem::path& folder) {
  macroscale::StampingSpec stamping;
  const bool drawn = settings.is("blank.shape", "polygon") || settings.is("blank.shape", "drawing");
  stamping.blank.shape = settings.is("blank.shape", "circle") ? macroscale::BlankShape::circle
                         : drawn                              ? macroscale::BlankShape::polygon
                                                              : macroscale::BlankShape::rectangle;
  take(settings, "blank.size", stamping.blank.size);
  take(settings, "blank.radius", stamping.blank.radius);
  for (const auto& point : rows<2>(settings, "blank.points")) stamping.blank.polygon.outer.push_back(point);
  for (const auto& hole : rows<3>(settings, "blank.holes"))
    stamping.blank.holes.push_back({{hole[0], hole[1]}, hole[2]});
  take(settings, "blank.orientation", stamping.blank.orientation);
  take(settings, "blank.spacing", stamping.blank.spacing);
  take(settings, "blank.plies", stamping.blank.plies);
  take(settings, "tools.punch.radius", stamping.punch.radius);
  take(settings, "tools.die.opening_radius", stamping.die.opening_radius);
  take(settings, "tools.die.fillet", stamping.die.fillet);
  take(settings, "tools.binder.inner_radius", stamping.binder.inner_radius);
  take(settings, "tools.binder.edge_fillet", stamping.binder.edge_fillet);
  take(settings, "tools.binder.mass", stamping.binder.mass);
  stamping.punch.file = tool_file_of(settings, "punch", folder);
  stamping.die.file = tool_file_of(settings, "die", folder);
  stamping.binder.file = tool_file_of(settings, "binder", folder);
  stamping.process = process_of(settings);
  take(settings, "artefact.mass_scaling", stamping.artefact.mass_scaling);
  take(settings, "artefact.stabilisation", stamping.artefact.stabilisation);
  stamping.shear_rate = !settings.is("fabric.shear_rate", "off");
  stamping.contact_pressure = contact_pressure_of(settings);
  return stamping;
}

Case case_of(const ReadConfig& config, const std::filesystem::path& folder) {
  const Settings& settings = config.settings;
  const auto runs = [&](Stage stage) { return settings.stages.count(stage) > 0; };
  Case result;
  take(settings, "name", result.name);
  if (runs(Stage::cell)) result.cell = cell_of(settings);
  if (runs(Stage::solid)) result.solid = solid_of(settings);
  if (runs(Stage::voxels)) result.voxels = voxels_of(settings, folder);
  if (runs(Stage::friction)) result.friction = friction_of(settings, folder);
  if (runs(Stage::friction_test)) result.friction_test = friction_test_of(settings, folder);
  if (result.friction_test && settings.blocks.count("friction_test.rig") > 0)
    result.friction_machine = friction_machine_of(settings);
  if (runs(Stage::stamping)) result.stamping = stamping_of(settings, folder);
  result.grid_error = runs(Stage::grid_error) && settings.is("blank.grid_error", "on");
  if (runs(Stage::orientation_study)) {
    result.orientation_study.emplace();
    if (settings.has("orientation_study.blanks"))
      result.orientation_study->blanks = settings.many("orientation_study.blanks");
    if (settings.has("orientation_study.friction"))
      result.orientation_study->friction = settings.many("orientation_study.friction");
  }
  if (runs(Stage::calibrate)) result.calibrate = calibrate_of(settings);
  result.notes = config.notes;
  result.settings = settings;
  return result;
}

// ---- rules between keys

/// Whether one of these blocks, or a key below it, has no value.
bool any_below(const std::set<std::string>& failed, const std::vector<std::string>& blocks) {
  return std::any_of(failed.begin(), failed.end(), [&](const std::string& key) {
    return std::any_of(blocks.begin(), blocks.end(), [&](const std::string& block) {
      return key == block || key.starts_with(block + ".") || block.starts_with(key + ".");
    });
  });
}

void append(Problems& problems, Problems more) {
  problems.insert(problems.end(), std::make_move_iterator(more.begin()), std::make_move_iterator(more.end()));
}

/// Without those about a key already named: two rooms check the melt that they share.
void append_new(Problems& problems, const Problems& more) {
  const Problems known = problems;
  std::copy_if(more.begin(), more.end(), std::back_inserter(problems), [&](const Problem& problem) {
    return std::none_of(known.begin(), known.end(),
                        [&](const Problem& other) { return other.key == problem.key; });
  });
}

/// A model whose constants are still to be fitted, or whose table could not be read, has only its film and
/// effects to check.
Problems check_friction_model(const FrictionSpec& spec) {
  friction::Model model = spec.model;
  const bool has_law = spec.table_problems.empty();
  if (spec.calibrated() || !has_law) model.law = friction::HerseyPower{.scale = 1.0, .exponent = 0.1};
  Problems problems = spec.table_problems;
  append_new(problems, friction::check(model));
  if (has_law) append_new(problems, friction::check_combinations(spec.model));
  return problems;
}

/// Constants given beside a table that would fit them: which of the two counts would be a guess.
Problems check_constants_beside_data(const Settings& settings) {
  Problems problems;
  if (!settings.has("friction.calibration.data") || !settings.is("friction.law", "stribeck")) return problems;
  const bool power = settings.is("friction.form", "power");
  const std::vector<std::string> constants =
      power ? std::vector<std::string>{"friction.scale", "friction.exponent"}
            : std::vector<std::string>{"friction.offset", "friction.slope", "friction.reference_hersey"};
  for (const std::string& path : constants) {
    if (!settings.has(path)) continue;
    problems.push_back({"*.beside_data"_family.of(path), path, "",
                        "is given beside friction.calibration.data, which fits it",
                        "Leave one of the two out."});
  }
  return problems;
}

Problems check_fitted_slope(const Settings& settings) {
  if (!slope_is_fitted(settings)) return {};
  if (settings.has("friction.calibration.data") && settings.is("friction.law", "stribeck")) return {};
  return {{"effects.tool_temperature_shift.slope.fitted"_rule,
           shift_path + ".slope",
           "",
           "is to be fitted, and no friction.calibration.data of a Stribeck law is there to fit it to",
           "Give the table, or a number: Table 4 of the paper gives -9.27e-4 1/K.",
           "",
           0,
           {"friction.calibration.data", "friction.law"}}};
}

Problems check_rig(const FrictionSpec& spec, const Settings& settings) {
  if (!spec.has_plate_area) return {};
  Problems problems = friction::check(spec.rig);
  // A band that was not given is the area itself; a fault of the area alone would be said twice.
  if (!settings.has("friction.calibration.plate_area_band")) {
    std::erase_if(problems, [](const Problem& problem) { return problem.key.ends_with("_band"); });
  }
  return problems;
}

/// Problems inside a friction table, with the table's own name and lines.
Problems check_table(const std::filesystem::path& file, bool measured_force_needed) {
  if (file.empty()) return {};
  try {
    const auto rows = friction::read_friction_table(file.lexically_normal().string());
    Problems problems = friction::check(rows, measured_force_needed);
    for (Problem& problem : problems) problem.file = file.lexically_normal().string();
    return problems;
  } catch (const InputError& error) {
    return error.problems();
  }
}

/// Whether the table can fix the law's constants at all; the contact area that a real pressure would bring
/// moves their values, not how many the rows can tell apart.
Problems check_calibration(const FrictionSpec& spec) {
  if (!spec.calibrated()) return {};
  const std::string file = spec.calibration_data.lexically_normal().string();
  Problems problems;
  try {
    friction::calibrate(spec.model, friction::read_friction_table(file), spec.rig, {},
                        {.hold_tool_temperature_slope = !spec.fit_temperature_slope, .search = {}});
  } catch (const InputError& error) {
    problems = error.problems();
    for (Problem& problem : problems) problem.file = file;
  }
  return problems;
}

Problems check_friction(const FrictionSpec& spec, const ReadConfig& config) {
  Problems problems = check_constants_beside_data(config.settings);
  append(problems, check_fitted_slope(config.settings));
  append(problems, check_rig(spec, config.settings));
  append(problems, check_friction_model(spec));
  append(problems, check_table(spec.calibration_data, true));
  drop_unknowable(problems, config.failed);
  const bool sound = problems.empty() && !any_below(config.failed, {"friction", "effects", "resin"});
  if (sound) append(problems, check_calibration(spec));
  return problems;
}

/// The fabric that was pulled is a cell as well, at its own keys.
Problems check_pulled_weave(const Case& a_case) {
  if (!a_case.cell || !a_case.friction->calibrated()) return {};
  mesoscale::CellSpec pulled = *a_case.cell;
  pulled.weave = a_case.friction->calibration_weave;
  Problems problems;
  for (const Problem& problem : mesoscale::check(pulled)) {
    if (!problem.key.starts_with("weave.")) continue;
    Problem moved = problem;
    moved.id = "friction.calibration.*"_family.of(problem.id.text());
    moved.key = "friction.calibration." + problem.key;
    for (std::string& other : moved.others)
      if (other.starts_with("weave.")) other = "friction.calibration." + other;
    problems.push_back(std::move(moved));
  }
  return problems;
}

/// The fabric passes between punch and die.
Problems check_clearance(const mesoscale::CellSpec& cell, const macroscale::StampingSpec& stamping) {
  constexpr double rounding = 1e-9;  // [m]: lets 71.5 mm - 70 mm hold a fabric of 1.5 mm
  if (stamping.die.file || stamping.punch.file) return {};  // measured on their surfaces
  const double clearance = stamping.die.opening_radius - stamping.punch.radius;
  const double thickness = cell.weave.fabric_thickness;
  if (clearance <= 0.0 || clearance >= thickness - rounding) return {};  // <= 0: said by the room itself
  return {{"tools.die.opening_radius.fabric"_rule,
           "tools.die.opening_radius",
           "",
           fmt::format("leaves {:.4g} mm beside the punch, less than the fabric's {:.4g} mm", 1e3 * clearance,
                       1e3 * thickness),
           fmt::format("Open the die to at least {:.6g} mm.", 1e3 * (stamping.punch.radius + thickness)),
           "",
           0,
           {"tools.punch.radius", "weave.fabric_thickness"}}};
}

Problems check_design(const std::filesystem::path& file) {
  if (file.empty()) return {};
  try {
    friction::read_test_design(file.lexically_normal().string());
  } catch (const InputError& error) {
    return error.problems();
  }
  return {};
}

/// The machine's plates and its finite elements.
Problems check_machine(const Case& a_case) {
  Problems problems;
  const double length = std::sqrt(a_case.friction->rig.plate_area);
  if (a_case.friction_machine->bend.arcs() > 0.95 * length)
    problems.push_back(
        {"friction_test.rig.bend.length"_rule,
         "friction_test.rig.bend.radius",
         "",
         fmt::format("gives arcs of {:.4g} mm on plates {:.4g} mm long; they must fit with some "
                     "level beside them",
                     1e3 * a_case.friction_machine->bend.arcs(), 1e3 * length),
         "Take a smaller radius or angle.",
         "",
         0,
         {"friction_test.rig.bend.angle", "friction.calibration.plate_area"}});
  if (a_case.friction_machine->finite_elements && !a_case.cell)
    problems.push_back({"friction_test.rig.finite_elements.weave"_rule, "friction_test.rig.finite_elements",
                        "", "needs a weave: the solver's fabric comes from it",
                        "Add `weave:`, or write `off`."});
  return problems;
}

/// Each angle names a folder of results.
Problems check_distinct(const std::vector<double>& angles, const std::string& key) {
  std::vector<double> sorted = angles;
  std::sort(sorted.begin(), sorted.end());
  if (std::adjacent_find(sorted.begin(), sorted.end()) == sorted.end()) return {};
  return {
      {"*.distinct"_family.of(key), key, "", "must not hold an angle twice", "Leave the second one out."}};
}

/// The polygon of a blank that is given as a drawing.
Problems read_drawing(Case& a_case, const std::filesystem::path& folder) {
  const Settings& settings = a_case.settings;
  const std::string block = "blank.drawing";
  if (!a_case.stamping || !settings.has(block + ".file") || !settings.has(block + ".length_unit")) return {};
  macroscale::OutlineFile drawing;
  drawing.file = folder / settings.text(block + ".file");
  drawing.length_unit = read_quantity("1 " + settings.text(block + ".length_unit"), "mm").value;
  take(settings, block + ".chord_error", drawing.chord_error);
  try {
    a_case.stamping->blank.polygon = macroscale::read_outline(drawing, block);
  } catch (const InputError& error) {
    a_case.stamping->blank = macroscale::BlankSpec{};  // rules of a blank that is not there would blame it
    return error.problems();
  }
  return {};
}

/// A voxel file is a cell without forming laws: nothing can follow it.
Problems check_voxels(const Case& a_case, const ReadConfig& config) {
  Problems problems;
  if (a_case.cell || a_case.friction)
    problems.push_back(
        {"cell.voxels.alone"_rule, "cell.voxels.file", "",
         "is a cell of its own, which has stiffness but no forming laws; it stands alone",
         "Leave weave, solid, friction, process, tools and blank out, or leave out cell.voxels."});
  if (any_below(config.failed, {"cell"})) return problems;  // a file that cannot be read has no labels
  append(problems, mesoscale::solid::check(*a_case.voxels));
  return problems;
}

/// Every rule that the rooms and this file know, on a case whose keys without a value hold their defaults.
Problems check_between_keys(const Case& a_case, const ReadConfig& config) {
  Problems problems;
  if (a_case.cell) append(problems, mesoscale::check(*a_case.cell));
  if (a_case.solid) append(problems, mesoscale::solid::check(*a_case.solid));
  if (a_case.voxels) append(problems, check_voxels(a_case, config));
  if (a_case.friction) {
    append_new(problems, check_friction(*a_case.friction, config));
    append(problems, check_pulled_weave(a_case));
  }
  if (a_case.friction_test) {
    if (a_case.friction_test->data != a_case.friction->calibration_data)
      append(problems, check_table(a_case.friction_test->data, false));
    append(problems, check_design(a_case.friction_test->design));
    if (a_case.friction_machine) append(problems, check_machine(a_case));
  }
  if (a_case.calibrate) append(problems, check_calibrate(*a_case.calibrate, config.settings));
  if (a_case.stamping) {
    Problems of_stamping = macroscale::check(*a_case.stamping);
    if (a_case.settings.is("blank.shape", "drawing"))  // its corners are those of the drawing
      for (Problem& problem : of_stamping)
        if (problem.key == "blank.points") problem.key = "blank.drawing.file";
    append(problems, std::move(of_stamping));
  }
  if (a_case.orientation_study) {
    append(problems, check_distinct(a_case.orientation_study->blanks, "orientation_study.blanks"));
    append(problems, check_distinct(a_case.orientation_study->friction, "orientation_study.friction"));
  }
  if (a_case.cell && a_case.stamping) append(problems, check_clearance(*a_case.cell, *a_case.stamping));
  drop_unknowable(problems, config.failed);
  return problems;
}

constexpr double melting_range_of_polypropylene = 433.15;  // its lower end [K]; recalled

/// Values no source of ours measures, said wherever the case is shown.
void note_assumptions(Case& a_case) {
  const Setting* area = a_case.settings.find("friction.calibration.plate_area");
  if (a_case.friction && a_case.friction->calibrated() && area != nullptr) {
    a_case.notes.push_back(fmt::format(
        "friction.calibration.plate_area = {} is assumed: the paper does not give it", area->written));
  }
  if (a_case.stamping && a_case.cell->state == mesoscale::CellState::consolidated)
    a_case.notes.push_back(
        "cell.state = consolidated: the solid part's fabric is stamped, not the molten one");
  if (a_case.stamping && a_case.stamping->process.blank_temperature < melting_range_of_polypropylene)
    a_case.notes.push_back(fmt::format(
        "process.blank_temperature = {} lies below the melting range of polypropylene (about 160 degC, "
        "recalled): the melt's viscosity is carried on to where the resin is solid",
        a_case.settings.find("process.blank_temperature")->written));
  if (a_case.friction && a_case.friction->model.conduction) {
    const friction::Effects& effects = a_case.friction->model.effects;
    if (!friction::is_on(effects.tool_temperature_film) && !friction::is_on(effects.solidification) &&
        !friction::is_on(effects.shear_heating))
      a_case.notes.push_back(
          "friction.film_temperature = conduction changes nothing by itself: effects tool_temperature_film, "
          "solidification and shear_heating draw on it, and none of them is on");
  }
  const bool artefact = a_case.stamping && (a_case.stamping->artefact.mass_scaling != 1.0 ||
                                            a_case.stamping->artefact.stabilisation != 0.0);
  if (artefact) a_case.notes.push_back("artefact: a non-physical help is switched on");
}

std::string friction_line(const FrictionSpec& friction) {
  const std::string pressure = friction.contact_pressure == macroscale::ContactPressure::real
                                   ? "real contact pressure"
                                   : "nominal pressure";
  if (std::holds_alternative<friction::Coulomb>(friction.model.law)) {
    return fmt::format("friction: Coulomb, mu = {}",
                       std::get<friction::Coulomb>(friction.model.law).coefficient);
  }
  if (!friction::reads_hersey_number(friction.model.law))
    return fmt::format("friction: {} law, constants as given", friction::id_of(friction.model.law));
  return fmt::format("friction: Stribeck law, {} form, {}, {}", friction::id_of(friction.model.law), pressure,
                     friction.calibrated() ? "fitted to friction.calibration.data" : "constants as given");
}

/// A case as far as it could be read, with all that is wrong with it.
struct Draft {
  ReadConfig config;
  Case a_case;
};

Draft draft_of(const std::string& text, const std::string& file, const std::filesystem::path& folder,
               const std::vector<std::string>& assignments) {
  Draft draft;
  draft.config = read_config(text, file, folder, assignments);
  draft.a_case = case_of(draft.config, folder);
  Problems between = read_drawing(draft.a_case, folder);
  append(between, check_between_keys(draft.a_case, draft.config));
  locate(between, draft.config);
  append(draft.config.problems, std::move(between));
  return draft;
}

Case finished(Draft draft, const std::string& file) {
  sort_by_place(draft.config.problems, file);
  if (!draft.config.problems.empty()) throw InputError(draft.config.problems);
  note_assumptions(draft.a_case);
  return std::move(draft.a_case);
}

/// Reads the tools' files; a case whose tools have problems stays without them.
Problems tool_problems(Case& a_case) {
  if (!a_case.stamping) return {};
  const double thickness = a_case.cell->weave.fabric_thickness;
  Problems problems;
  try {
    a_case.stamping = macroscale::with_tools_loaded(*a_case.stamping, thickness);
    problems = macroscale::check_tools(*a_case.stamping, thickness);
  } catch (const InputError& error) {
    problems = error.problems();
  }
  for (Problem& problem : problems) {
    if (!problem.file.empty()) continue;
    // The key itself, or the tool's file where the problem is about the tool as a whole.
    const Setting* place = a_case.settings.find(problem.key);
    if (place == nullptr) place = a_case.settings.find(problem.key + ".file");
    if (place == nullptr) place = a_case.settings.find(problem.key + ".shape");
    if (place == nullptr) continue;
    problem.file = place->file;
    problem.line = place->line;
    if (problem.value.empty()) problem.value = place->written;
  }
  return problems;
}

/// Whether the tools' files can be read and measured: the blank gives their scale, the stroke their way.
bool tools_can_be_looked_at(const Draft& draft) {
  const std::vector<std::string> looked_at{"tools", "blank", "process.punch.stroke", "process.steps",
                                           "weave.fabric_thickness"};
  std::set<std::string> wrong = draft.config.failed;
  for (const Problem& problem : draft.config.problems) wrong.insert(problem.key);
  return !any_below(wrong, looked_at);
}

}  // namespace

Case read_case_text(const std::string& text, const std::string& file, const std::filesystem::path& folder,
                    const std::vector<std::string>& assignments) {
  return finished(draft_of(text, file, folder, assignments), file);
}

Case read_case(const std::filesystem::path& file, const std::vector<std::string>& assignments) {
  return read_case_text(read_text_file(file), file.string(), file.parent_path(), assignments);
}

void load_tools(Case& a_case) {
  if (Problems problems = tool_problems(a_case); !problems.empty()) throw InputError(std::move(problems));
}

Case read_case_and_tools(const std::filesystem::path& file, const std::vector<std::string>& assignments) {
  Draft draft = draft_of(read_text_file(file), file.string(), file.parent_path(), assignments);
  if (tools_can_be_looked_at(draft)) append(draft.config.problems, tool_problems(draft.a_case));
  return finished(std::move(draft), file.string());
}

std::vector<std::string> stage_lines(const Case& a_case) {
  std::vector<std::string> lines;
  if (a_case.cell) {
    lines.push_back(fmt::format("mesoscale: {} weave, {}", a_case.cell->weave.pattern,
                                a_case.settings.text("cell.state")));
  }
  if (a_case.solid)
    lines.push_back(fmt::format("solid: stiffness of the consolidated weave, {} voxels a pitch, {} layers",
                                a_case.solid->grid.per_pitch, a_case.solid->grid.layers));
  if (a_case.voxels) {
    const auto [nx, ny, nz] = a_case.voxels->shape;
    lines.push_back(fmt::format("solid: stiffness of {} x {} x {} voxels, {}", nx, ny, nz,
                                a_case.settings.text("cell.boundary")));
  }
  if (a_case.friction) lines.push_back(friction_line(*a_case.friction));
  if (a_case.friction_test) lines.push_back("friction test: comparison with friction_test.data");
  if (a_case.friction_machine)
    lines.push_back(
        fmt::format("friction rig: each pull as a history{}",
                    a_case.friction_machine->finite_elements ? ", and through the finite elements" : ""));
  if (a_case.stamping) {
    const macroscale::ProcessSpec& process = a_case.stamping->process;
    lines.push_back(fmt::format("macroscale: stroke {} in {}, {} steps", write_quantity(process.stroke, "mm"),
                                write_quantity(process.time / process.speed_scale, "s"), process.steps));
  }
  if (a_case.grid_error) lines.push_back("grid error: the same stamping on twice the node spacing");
  if (a_case.orientation_study)
    lines.push_back(fmt::format("orientation study: {} blanks, {} friction samples",
                                a_case.orientation_study->blanks.size(),
                                a_case.orientation_study->friction.size()));
  if (a_case.calibrate) lines.push_back("calibrate: by `heddle calibrate` alone, to its --data");
  return lines;
}

void write_resolved(const Case& a_case, const std::filesystem::path& folder) {
  write_file(folder / "resolved.yaml", resolved_yaml(a_case.settings));
  for (const Key& key : schema()) {
    const Setting* setting = a_case.settings.find(key.path);
    if (key.type != KeyType::file || setting == nullptr) continue;
    write_file(folder / resolved_file_name(*setting), read_file(setting->folder / setting->text));
  }
}

}  // namespace heddle::pipeline
