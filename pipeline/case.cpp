#include "pipeline/case.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <set>

#include "core/text_file.h"
#include "core/units.h"
#include "macroscale/tool_loading.h"
#include "macroscale/tool_set.h"
#include "pipeline/case_rules.h"
#include "pipeline/case_settings.h"
#include "pipeline/outputs.h"
#include "pipeline/stamping_study_keys.h"

namespace heddle::pipeline {
namespace {

constexpr double melting_range_of_polypropylene = 433.15;  // its lower end [K]; recalled

/// Tools that leave the law of the case.
void note_tool_friction(Case& a_case) {
  if (!a_case.stamping) return;
  const auto say = [&](const char* tool, const std::optional<double>& coefficient) {
    if (!coefficient) return;
    a_case.notes.push_back(
        *coefficient == 0.0
            ? fmt::format("tools.{}.friction_coefficient = 0: this tool is frictionless", tool)
            : fmt::format("tools.{0}.friction_coefficient = {1}: mu = {1} on this tool, whatever the law of "
                          "`friction` and its effects say of the others",
                          tool, *coefficient));
  };
  say("punch", a_case.stamping->punch.friction_coefficient);
  say("die", a_case.stamping->die.friction_coefficient);
  say("binder", a_case.stamping->binder.friction_coefficient);
}

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
  if (a_case.cell && a_case.cell->state == mesoscale::CellState::compacted)
    a_case.notes.push_back(
        "cell.state = compacted: the forming laws take the fabric as free of stress at its thickness");
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
  note_tool_friction(a_case);
  if (const auto given = in_words(a_case.fabric); !given.empty())
    a_case.notes.push_back(
        fmt::format("fabric, given in place of what the weave says: {}", fmt::join(given, "; ")));
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
  append(between, read_punch_motion(draft.a_case, folder));
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
  const double thickness =
      macroscale::stack_thickness(a_case.stamping->blank, a_case.cell->weave.fabric_thickness);
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
  const std::vector<std::string> looked_at{"tools",
                                           "blank",
                                           "process.punch.stroke",
                                           "process.punch.file",
                                           "process.steps",
                                           "weave.fabric_thickness"};
  std::set<std::string> wrong = draft.config.failed;
  for (const Problem& problem : draft.config.problems) {
    wrong.insert(problem.key);
    wrong.insert(problem.id);  // a table's problems have its columns for keys
  }
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
    const int plies = a_case.cell->stack.plies;
    lines.push_back(fmt::format("mesoscale: {} weave, {}{}", a_case.cell->weave.pattern,
                                a_case.settings.text("cell.state"),
                                plies > 1 ? fmt::format(", a stack of {} plies", plies) : ""));
  }
  if (a_case.solid)
    lines.push_back(fmt::format("solid: stiffness of the consolidated weave, {} voxels a pitch, {} layers",
                                a_case.solid->grid.per_pitch, a_case.solid->grid.layers));
  if (a_case.voxels && a_case.voxels->format == mesoscale::solid::VoxelFormat::texgen) {
    lines.push_back(fmt::format("solid: stiffness of TexGen's voxels in {}, {}",
                                a_case.voxels->file.filename().string(),
                                a_case.settings.text("cell.boundary")));
  } else if (a_case.voxels) {
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
  if (a_case.study)
    lines.push_back(fmt::format("study: by `heddle study` alone, {} weaves at {} shear angles",
                                mesoscale::study::points(*a_case.cell, *a_case.study).size(),
                                a_case.study->shear_angles.size()));
  if (const auto study = stamping_study_of(a_case.settings)) {
    std::string what;
    for (const auto& [count, name] : {std::pair{study->models.size(), "models"},
                                      {study->speed_scales.size(), "speeds"},
                                      {study->binder_forces.size(), "binder forces"},
                                      {study->variations.size(), "variations"}})
      if (count > 0) what += fmt::format("{}{} {}", what.empty() ? "" : ", ", count, name);
    lines.push_back(fmt::format("stamping study: by `heddle study` alone, {}", what));
  }
  if (a_case.discover) lines.push_back("discover: by `heddle discover` alone, in its --data");
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
