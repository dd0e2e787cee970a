#include "pipeline/case_rules.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <numbers>

#include "friction/calibrate.h"
#include "friction/combinations.h"
#include "friction/test_design.h"
#include "macroscale/symmetric_piece.h"
#include "pipeline/case_settings.h"
#include "pipeline/stamping_study_keys.h"
#include "pipeline/thermal_keys.h"

namespace heddle::pipeline {

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

namespace {

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
           "effects.tool_temperature_shift.slope",
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

/// The film of the unit cell is what the effect's form takes.
Problems check_film_direction(const Case& a_case) {
  const auto& orientation = a_case.friction->model.effects.orientation;
  const bool asked = orientation && orientation->form == friction::Orientation::Form::film;
  const bool there = a_case.cell && a_case.cell->film;
  if (there && !a_case.settings.is("resin.rheology", "power_law"))
    return {{"film.rheology"_rule,
             "film",
             "",
             "flows by the power law, and resin.rheology is another",
             "Leave one of the two out.",
             "",
             0,
             {"resin.rheology"}}};
  if (!asked || there) return {};
  return {{"effects.orientation.form.film"_rule,
           "effects.orientation.form",
           "film",
           "takes the drag of the unit cell's film, which this file does not ask for",
           "Add the block `film: {}` (and with it a weave), or choose form: trellis.",
           "",
           0,
           {"film"}}};
}

/// The fabric that was pulled is a cell as well, at its own keys.
Problems check_pulled_weave(const Case& a_case) {
  if (!a_case.cell || !a_case.friction->calibrated()) return {};
  mesoscale::CellSpec pulled = *a_case.cell;
  pulled.weave = a_case.friction->calibration_weave;
  if (pulled.state == mesoscale::CellState::compacted) pulled.state = mesoscale::CellState::as_woven;
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
  const double thickness = macroscale::stack_thickness(stamping.blank, cell.weave.fabric_thickness);
  if (clearance <= 0.0 || clearance >= thickness - rounding) return {};  // <= 0: said by the room itself
  return {{"tools.die.opening_radius.fabric"_rule,
           "tools.die.opening_radius",
           "",
           fmt::format("leaves {:.4g} mm beside the punch, less than the {} {:.4g} mm", 1e3 * clearance,
                       stamping.blank.plies > 1 ? "plies'" : "fabric's", 1e3 * thickness),
           fmt::format("Open the die to at least {:.6g} mm.", 1e3 * (stamping.punch.radius + thickness)),
           "",
           0,
           {"tools.punch.radius", "weave.fabric_thickness"}}};
}

/// Blanks turned against the planes on which a piece of them would end.
Problems check_turned_pieces(const Case& a_case) {
  if (!a_case.stamping || a_case.stamping->blank.symmetry == macroscale::Symmetry::none) return {};
  const auto& blanks = a_case.orientation_study->blanks;
  const auto turned = std::find_if_not(blanks.begin(), blanks.end(), macroscale::runs_along_axes);
  if (turned == blanks.end()) return {};
  return {{"orientation_study.blanks.symmetry"_rule,
           "orientation_study.blanks",
           fmt::format("{:g} deg", *turned * 180.0 / std::numbers::pi),
           "must be 0 or 90 deg where blank.symmetry has a piece of the blank computed",
           "Leave blank.symmetry out: then the whole of each blank is computed.",
           "",
           0,
           {"blank.symmetry"}}};
}

/// Plies that nest by half a thickness would have their middles inside each other's faces.
Problems check_nesting(const mesoscale::CellSpec& cell, const macroscale::BlankSpec& blank) {
  if (cell.facing != mesoscale::Facing::flat && blank.nesting > 0.0)
    return {{"blank.nesting.facing"_rule,
             "blank.nesting",
             fmt::format("{:g} mm", 1e3 * blank.nesting),
             "counts nesting twice: cell.facing has how near the plies come",
             "Leave one of the two out.",
             "",
             0,
             {"cell.facing"}}};
  const auto& angles = blank.layup;
  if (cell.facing == mesoscale::Facing::shift &&
      std::any_of(angles.begin(), angles.end(), [&](double a) { return a != angles.front(); }))
    return {{"cell.facing.layup"_rule,
             "cell.facing",
             "shift",
             "is one shift for all tows, and the plies of blank.layup are turned against each other",
             "Take cell.facing: mean: the tows of turned plies meet at every shift.",
             "",
             0,
             {"blank.layup"}}};
  const double most = 0.5 * cell.weave.fabric_thickness;
  if (blank.nesting < most) return {};
  return {{"blank.nesting.thickness"_rule,
           "blank.nesting",
           fmt::format("{:g} mm", 1e3 * blank.nesting),
           fmt::format("must be less than half of the fabric's thickness ({:g} mm)", 1e3 * most),
           "`heddle weave` with `cell.plies: 2` says how much a shift lets two plies nest.",
           "",
           0,
           {"weave.fabric_thickness"}}};
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

/// What is measured of the fabric begins at the thickness of the weave as it comes, which other states have
/// not.
Problems check_given_fabric(const Case& a_case) {
  const mesoscale::CellSpec& cell = *a_case.cell;
  if (!a_case.fabric.compaction.empty() && cell.facing != mesoscale::Facing::flat)
    return {{"cell.facing.compaction"_rule,
             "cell.facing",
             "",
             "takes the compaction of the weave's tows, and fabric.compaction.file replaces it at the tools "
             "alone",
             "Leave one of the two out.",
             "",
             0,
             {"fabric.compaction.file"}}};
  if (!a_case.fabric.compaction.empty() && cell.state != mesoscale::CellState::as_woven)
    return {{"fabric.compaction.file.state"_rule,
             "fabric.compaction.file",
             "",
             "is measured on the fabric as woven, and cell.state is another",
             "Leave one of the two out.",
             "",
             0,
             {"cell.state"}}};
  return check(a_case.fabric, cell.weave.fabric_thickness);
}

}  // namespace

Problems check_between_keys(const Case& a_case, const ReadConfig& config) {
  Problems problems;
  if (a_case.cell) append(problems, mesoscale::check(*a_case.cell));
  if (a_case.cell && !any_below(config.failed, {"fabric", "weave", "cell"}))
    append(problems, check_given_fabric(a_case));
  if (a_case.solid) append(problems, mesoscale::solid::check(*a_case.solid));
  if (a_case.voxels) append(problems, check_voxels(a_case, config));
  if (a_case.friction) {
    append_new(problems, check_friction(*a_case.friction, config));
    append(problems, check_pulled_weave(a_case));
    append(problems, check_film_direction(a_case));
  }
  if (a_case.friction_test) {
    if (a_case.friction_test->data != a_case.friction->calibration_data)
      append(problems, check_table(a_case.friction_test->data, false));
    append(problems, check_design(a_case.friction_test->design));
    if (a_case.friction_machine) append(problems, check_machine(a_case));
  }
  if (a_case.discover) append(problems, check_discover(*a_case.discover, config.settings));
  if (a_case.calibrate) append(problems, check_calibrate(*a_case.calibrate, config.settings));
  if (a_case.stamping) {
    Problems of_stamping = macroscale::check(*a_case.stamping);
    if (a_case.settings.is("blank.shape", "drawing"))  // its corners are those of the drawing
      for (Problem& problem : of_stamping)
        if (problem.key == "blank.points") problem.key = "blank.drawing.file";
    if (a_case.stamping->process.profile)  // its end is the stroke
      for (Problem& problem : of_stamping)
        if (problem.key == "process.punch.stroke" || problem.key == "process.punch.time")
          problem.key = "process.punch.file";
    append(problems, std::move(of_stamping));
  }
  if (a_case.orientation_study) {
    append(problems, check_distinct(a_case.orientation_study->blanks, "orientation_study.blanks"));
    append(problems, check_distinct(a_case.orientation_study->friction, "orientation_study.friction"));
    append(problems, check_turned_pieces(a_case));
  }
  if (const auto study = stamping_study_of(a_case.settings))
    append(problems, check_stamping_study(*study, config.root));
  if (a_case.study && !any_below(config.failed, {"weave", "cell", "study"}))
    append(problems, check_study(*a_case.study, *a_case.cell));
  if (a_case.cell && a_case.stamping) {
    append(problems, check_clearance(*a_case.cell, *a_case.stamping));
    append(problems, check_nesting(*a_case.cell, a_case.stamping->blank));
  }
  append(problems, check_thermal(a_case, config));
  drop_unknowable(problems, config.failed);
  return problems;
}

}  // namespace heddle::pipeline
