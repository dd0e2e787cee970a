#include "pipeline/case_settings.h"

#include <array>
#include <cmath>

#include "core/units.h"
#include "macroscale/outline_file.h"
#include "macroscale/punch_table.h"
#include "pipeline/forming_effect_keys.h"
#include "pipeline/friction_keys.h"
#include "pipeline/solid_keys.h"
#include "pipeline/thermal_keys.h"

namespace heddle::pipeline {
namespace {

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

mesoscale::OwnTow own_tow_of(const Settings& settings, const std::string& block) {
  const auto own = [&](const char* name) {
    return settings.has(block + name) ? std::optional(settings.number(block + name)) : std::nullopt;
  };
  return {own("tow_width"), own("gap"), own("tow_thickness"), own("linear_density")};
}

mesoscale::SectionShape section_of(const Settings& settings, const std::string& path) {
  using mesoscale::SectionShape;
  if (settings.is(path, "ellipse")) return SectionShape::ellipse;
  if (settings.is(path, "power_ellipse")) return SectionShape::power_ellipse;
  if (settings.is(path, "capped_lens")) return SectionShape::capped_lens;
  if (settings.is(path, "hybrid")) return SectionShape::hybrid;
  return SectionShape::lens;
}

mesoscale::HalfSpec half_of(const Settings& settings, const std::string& block) {
  mesoscale::HalfSpec half;
  half.section = section_of(settings, block + ".section");
  take(settings, block + ".section_power", half.section_power);
  take(settings, block + ".section_cap", half.section_cap);
  return half;
}

mesoscale::WeaveSpec weave_of(const Settings& settings, const std::string& block) {
  mesoscale::WeaveSpec weave;
  take(settings, block + ".pattern", weave.pattern);
  if (weave.pattern == "matrix" && settings.has(block + ".matrix"))
    weave.pattern += " " + settings.text(block + ".matrix");
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
  weave.section = section_of(settings, block + ".section");
  take(settings, block + ".section_power", weave.section_power);
  take(settings, block + ".section_cap", weave.section_cap);
  weave.upper = half_of(settings, block + ".upper");
  weave.lower = half_of(settings, block + ".lower");
  take(settings, block + ".upper_share", weave.upper_share);
  if (settings.has(block + ".warp_crimp")) weave.warp_crimp = settings.number(block + ".warp_crimp");
  weave.own = {own_tow_of(settings, block + ".warp."), own_tow_of(settings, block + ".weft.")};
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
  if (settings.is("forming.compaction", "van_wyk")) forming.compaction = mesoscale::CompactionChoice::van_wyk;
  if (settings.is("forming.compaction", "gutowski"))
    forming.compaction = mesoscale::CompactionChoice::gutowski;
  take(settings, "forming.compaction_modulus", forming.compaction_modulus);
  take(settings, "forming.compaction_exponent", forming.compaction_exponent);
  take(settings, "forming.gutowski_spring", forming.gutowski_spring);
  take(settings, "forming.gutowski_available", forming.gutowski_available);
  take(settings, "forming.tow_friction", forming.tow_friction);
  take(settings, "forming.reference_tension", forming.reference_tension);
  take(settings, "forming.in_tow_shear_share", forming.in_tow_shear_share);
  take(settings, "forming.bonding", forming.bonding);
  take(settings, "forming.compression_ratio", forming.compression_ratio);
  return forming;
}

mesoscale::StackSpec stack_of(const Settings& settings) {
  mesoscale::StackSpec stack;
  if (settings.has("cell.plies")) stack.plies = settings.integer("cell.plies");
  if (settings.has("cell.shift_warp")) stack.along_warp = settings.many("cell.shift_warp");
  if (settings.has("cell.shift_weft")) stack.along_weft = settings.many("cell.shift_weft");
  return stack;
}

FabricOverride fabric_override_of(const Settings& settings, const std::filesystem::path& folder) {
  FabricOverride given;
  const auto table = [&](const char* path) {
    return settings.has(path) ? folder / settings.text(path) : std::filesystem::path();
  };
  given.shear = table("fabric.shear.file");
  given.tension = table("fabric.tension.file");
  given.compaction = table("fabric.compaction.file");
  if (settings.has("fabric.bending.warp")) given.bending[0] = settings.number("fabric.bending.warp");
  if (settings.has("fabric.bending.weft")) given.bending[1] = settings.number("fabric.bending.weft");
  take(settings, "fabric.shear_scale", given.shear_scale);
  take(settings, "fabric.tension_scale", given.tension_scale);
  return given;
}

std::optional<mesoscale::FilmDirectionSpec> film_direction_of(const Settings& settings) {
  if (settings.blocks.count("film") == 0) return {};
  mesoscale::FilmDirectionSpec film;
  take(settings, "film.speed", film.speed);
  take(settings, "film.temperature", film.temperature);
  if (settings.has("film.fill")) film.fill = settings.number("film.fill");
  take(settings, "film.roughness", film.roughness);
  take(settings, "film.boundary_friction", film.boundary_friction);
  if (settings.has("film.samples")) film.samples = settings.integer("film.samples");
  return film;
}

mesoscale::CellSpec cell_of(const Settings& settings) {
  mesoscale::CellSpec cell;
  cell.weave = weave_of(settings, "weave");
  if (settings.is("cell.state", "consolidated")) cell.state = mesoscale::CellState::consolidated;
  if (settings.is("cell.state", "compacted")) {
    cell.state = mesoscale::CellState::compacted;
    if (settings.has("cell.thickness")) cell.compacted_thickness = settings.number("cell.thickness");
    if (settings.has("cell.pressure")) cell.compacted_pressure = settings.number("cell.pressure");
  }
  cell.resin = resin_of(settings);
  cell.forming = forming_of(settings);
  cell.stack = stack_of(settings);
  if (settings.is("cell.facing", "shift")) cell.facing = mesoscale::Facing::shift;
  if (settings.is("cell.facing", "mean")) cell.facing = mesoscale::Facing::mean;
  if (settings.has("cell.facing_shift")) cell.facing_shift = settings.pair("cell.facing_shift");
  cell.film = film_direction_of(settings);
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

macroscale::PressSpec press_of(const Settings& settings) {
  macroscale::PressSpec press;
  press.gravity = settings.is("process.gravity", "on");
  take(settings, "process.bottoming_force", press.force_limit);
  take(settings, "process.dwell", press.dwell);
  press.release = settings.is("process.release", "on");
  take(settings, "effects.press_compliance.compliance", press.compliance);
  const std::string misaligned = "effects.punch_misalignment";
  double offset = 0.0, direction = 0.0;
  take(settings, misaligned + ".offset", offset);
  take(settings, misaligned + ".direction", direction);
  press.punch_offset = {offset * std::cos(direction), offset * std::sin(direction)};
  take(settings, "effects.binder_tilt.angle", press.binder_tilt);
  take(settings, "effects.binder_tilt.axis", press.binder_tilt_axis);
  return press;
}

void take_bottom(const Settings& settings, macroscale::DieSpec& die) {
  using macroscale::DieBottom;
  if (settings.is("tools.die.bottom", "flat")) die.bottom = DieBottom::flat;
  if (settings.is("tools.die.bottom", "bowl")) die.bottom = DieBottom::bowl;
  take(settings, "tools.die.depth", die.depth);
}

void take_friction(const Settings& settings, macroscale::StampingSpec& stamping) {
  const auto coefficient = [&](const char* path) {
    return settings.has(path) ? std::optional(settings.number(path)) : std::nullopt;
  };
  stamping.punch.friction_coefficient = coefficient("tools.punch.friction_coefficient");
  stamping.die.friction_coefficient = coefficient("tools.die.friction_coefficient");
  stamping.binder.friction_coefficient = coefficient("tools.binder.friction_coefficient");
}

void take_control(const Settings& settings, macroscale::BinderSpec& binder) {
  if (settings.is("tools.binder.control", "gap")) binder.control = macroscale::BinderControl::gap;
  take(settings, "tools.binder.gap", binder.gap);
  take(settings, "tools.binder.stiffness", binder.stiffness);
  binder.free_tilt = settings.is("tools.binder.tilt", "free");
  take(settings, "tools.binder.sectors", binder.sectors);
}

macroscale::ProcessSpec process_of(const Settings& settings) {
  macroscale::ProcessSpec process;
  take(settings, "process.punch.stroke", process.stroke);
  take(settings, "process.punch.time", process.time);
  take(settings, "process.punch.slow_down", process.slow_down);
  take(settings, "process.punch.speed_scale", process.speed_scale);
  take(settings, "process.steps", process.steps);
  take(settings, "process.binder_force", process.binder_force);
  take(settings, "process.hold", process.hold);
  process.press = press_of(settings);
  take(settings, "process.tool_temperature", process.tool_temperature);
  take(settings, "process.blank_temperature", process.blank_temperature);
  return process;
}

macroscale::ShearFriction shear_friction_of(const Settings& settings) {
  macroscale::ShearFriction friction;
  take(settings, "fabric.shear_hysteresis.share", friction.share);
  take(settings, "fabric.shear_hysteresis.stiffness", friction.stiffness);
  return friction;
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

macroscale::Symmetry symmetry_of(const Settings& settings) {
  using macroscale::Symmetry;
  if (settings.is("blank.symmetry", "half_x")) return Symmetry::half_x;
  if (settings.is("blank.symmetry", "half_y")) return Symmetry::half_y;
  return settings.is("blank.symmetry", "quarter") ? Symmetry::quarter : Symmetry::none;
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
  if (settings.has("blank.layup")) stamping.blank.layup = settings.many("blank.layup");
  take(settings, "blank.nesting", stamping.blank.nesting);
  stamping.blank.symmetry = symmetry_of(settings);
  take(settings, "tools.punch.radius", stamping.punch.radius);
  take(settings, "tools.die.opening_radius", stamping.die.opening_radius);
  take(settings, "tools.die.fillet", stamping.die.fillet);
  take(settings, "tools.binder.inner_radius", stamping.binder.inner_radius);
  take(settings, "tools.binder.edge_fillet", stamping.binder.edge_fillet);
  take(settings, "tools.binder.mass", stamping.binder.mass);
  take_friction(settings, stamping);
  take_bottom(settings, stamping.die);
  take_control(settings, stamping.binder);
  stamping.punch.file = tool_file_of(settings, "punch", folder);
  stamping.die.file = tool_file_of(settings, "die", folder);
  stamping.binder.file = tool_file_of(settings, "binder", folder);
  stamping.process = process_of(settings);
  take(settings, "artefact.mass_scaling", stamping.artefact.mass_scaling);
  take(settings, "artefact.stabilisation", stamping.artefact.stabilisation);
  take(settings, "effects.shear_rate.factor", stamping.shear_rate);
  if (settings.is("fabric.shear_rate", "off")) stamping.shear_rate = 0.0;
  stamping.shear_friction = shear_friction_of(settings);
  stamping.contact_pressure = contact_pressure_of(settings);
  if (settings.is("contact.points", "gauss")) stamping.contact_sites = macroscale::ContactSites::gauss;
  stamping.compaction_follows_shear = settings.is("contact.compaction", "sheared");
  stamping.self_contact = settings.is("contact.self", "folds");
  stamping.thermal = thermal_of(settings);
  take_forming_effects(settings, stamping);
  return stamping;
}

}  // namespace

bool slope_is_fitted(const Settings& settings) {
  return settings.is(shift_path + ".slope", "fitted");
}

Case case_of(const ReadConfig& config, const std::filesystem::path& folder) {
  const Settings& settings = config.settings;
  const auto runs = [&](Stage stage) { return settings.stages.count(stage) > 0; };
  Case result;
  take(settings, "name", result.name);
  if (runs(Stage::cell)) result.cell = cell_of(settings);
  if (runs(Stage::cell)) result.fabric = fabric_override_of(settings, folder);
  if (runs(Stage::solid)) {
    result.solid = solid_of(settings);
    result.solid->stack = stack_of(settings);
  }
  if (runs(Stage::voxels)) result.voxels = voxels_of(settings, folder);
  if (runs(Stage::friction)) result.friction = friction_of(settings, folder);
  if (runs(Stage::friction_test)) result.friction_test = friction_test_of(settings, folder);
  if (result.friction_test && settings.blocks.count("friction_test.rig") > 0)
    result.friction_machine = friction_machine_of(settings);
  if (runs(Stage::stamping)) result.stamping = stamping_of(settings, folder);
  result.shear_friction = shear_friction_of(settings);
  result.grid_error = runs(Stage::grid_error) && settings.is("blank.grid_error", "on");
  if (runs(Stage::orientation_study)) {
    result.orientation_study.emplace();
    if (settings.has("orientation_study.blanks"))
      result.orientation_study->blanks = settings.many("orientation_study.blanks");
    if (settings.has("orientation_study.friction"))
      result.orientation_study->friction = settings.many("orientation_study.friction");
  }
  if (runs(Stage::study)) result.study = study_of(settings);
  if (runs(Stage::calibrate)) result.calibrate = calibrate_of(settings);
  if (runs(Stage::discover)) result.discover = discover_of(settings);
  result.notes = config.notes;
  result.settings = settings;
  return result;
}

Problems read_punch_motion(Case& a_case, const std::filesystem::path& folder) {
  const std::string key = "process.punch.file";
  if (!a_case.stamping || !a_case.settings.has(key)) return {};
  macroscale::ProcessSpec& process = a_case.stamping->process;
  process.slow_down = 0.0;
  try {
    process.profile = macroscale::read_punch_table(folder / a_case.settings.text(key));
    process.time = process.profile->x().back();
    process.stroke = process.profile->y().back();
  } catch (const InputError& error) {
    process.time = 1.0;  // rules of a motion that is not there would blame it
    process.stroke = 1e-3;
    return error.problems();
  }
  return {};
}

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

}  // namespace heddle::pipeline
