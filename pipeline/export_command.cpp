#include <fmt/format.h>

#include "friction/export/fric_coef.h"
#include "friction/export/law_table.h"
#include "mesoscale/cell.h"
#include "mesoscale/solid/ccx_deck.h"
#include "pipeline/case.h"
#include "pipeline/commands.h"
#include "pipeline/export/part_command.h"
#include "pipeline/export/part_folder.h"
#include "pipeline/outputs.h"
#include "pipeline/stages.h"

namespace heddle::pipeline {

namespace {

namespace fs = std::filesystem;

/// The case of a folder: as it was calibrated, else as it was run.
fs::path case_file(const fs::path& given) {
  if (!fs::is_directory(given)) return given;
  for (const char* name : {"patched.yaml", "resolved.yaml"})
    if (fs::is_regular_file(given / name)) return given / name;
  throw InputError(
      {{"export.folder"_rule, "folder", given.string(), "holds neither patched.yaml nor resolved.yaml",
        "Name a configuration file, or the folder of a run or a calibration."}});
}

friction::ExportedLaw law_of(const Case& a_case) {
  const FrictionSpec& spec = *a_case.friction;
  friction::ExportedLaw law{.name = a_case.name, .model = {}};
  std::optional<mesoscale::FabricProperties> fabric;
  const bool real = spec.contact_pressure == macroscale::ContactPressure::real &&
                    friction::reads_hersey_number(spec.model.law);
  if (real) {
    fabric = analyse_cell(*a_case.cell, a_case.fabric).fabric;
    law.log_area = fabric->contact.log_fraction.curves().front();  // the one of no shear
  }
  Case of_law = a_case;
  if (!real) of_law.friction->contact_pressure = macroscale::ContactPressure::nominal;  // nothing reads it
  law.model = run_friction_stage(of_law, fabric ? &*fabric : nullptr).model;
  return law;
}

void say_limits(const friction::ExportedLaw& law) {
  if (law.log_area)
    fmt::print(
        "The contact area is that of the unsheared weave; in a stamping of heddle it follows the shear.\n");
  const friction::CalibrationBox& box = law.model.box;
  if (box.pressure_high < 1e299)
    fmt::print("The law was fitted between {:.4g} and {:.4g} kPa and {:.4g} and {:.4g} mm/s.\n",
               1e-3 * box.pressure_low, 1e-3 * box.pressure_high, 1e3 * box.speed_low, 1e3 * box.speed_high);
}

fs::path folder_of(const ExportOptions& options, const Case& a_case) {
  if (!options.run.output.empty()) return options.run.output;
  return fs::is_directory(options.run.file) ? options.run.file / "export"
                                            : fs::path("out/export") / a_case.name;
}

// The solid cell for CalculiX, one deck for the unsheared ply.
int export_cell(const ExportOptions& options, const Case& a_case, const fs::path& file) {
  if (!a_case.solid)
    throw InputError({{"export.solid"_rule, "solid", "", "is missing, and there is no cell to export",
                       "Add `solid: {per_pitch: 16, layers: 16}` beside `weave:`.", file.string()}});
  const fs::path deck = folder_of(options, a_case) / "cell.inp";
  write_file(deck, mesoscale::solid::ccx_deck(a_case.cell->weave, 0.0, *a_case.solid));
  if (options.run.print)
    fmt::print(
        "{}: `ccx -i cell` runs it: six mean stresses of 1 MPa, the strains from the displacements of set "
        "DRIVERS in cell.dat; mm, N, MPa.\n",
        deck.string());
  return exit_done;
}

}  // namespace

int export_case(const ExportOptions& options) {
  const fs::path file = case_file(options.run.file);
  const Case a_case = read_case(file, options.run.assignments);
  const bool of_stamping = fs::is_directory(options.run.file) && a_case.stamping.has_value();
  if (options.target == "ccx")
    return of_stamping ? export_part(options, a_case, folder_of(options, a_case))
                       : export_cell(options, a_case, file);
  if (of_stamping && options.target == "abaqus") {
    if (hands_over_a_part(a_case))
      export_part(options, a_case, folder_of(options, a_case));
    else if (options.run.print)
      fmt::print("No part: that takes `solid.shear_angles` and one ply; `--to ccx` says how.\n");
  }
  if (!a_case.friction)
    throw InputError({{"export.friction"_rule, "friction", "", "is missing, and there is no law to export",
                       "Add `friction:`; configs/friction_test.yaml shows one.", file.string()}});
  if (Problems problems = friction::check_export(a_case.friction->model); !problems.empty()) {
    for (Problem& problem : problems) problem.file = file.string();
    throw InputError(std::move(problems));
  }
  const friction::ExportedLaw law = law_of(a_case);
  const fs::path folder = folder_of(options, a_case);
  if (options.target == "abaqus") {
    write_file(folder / "heddle_friction.f", friction::fric_coef_fortran(law));
    if (!options.run.print) return exit_done;
    fmt::print("{}: user subroutine FRIC_COEF of Abaqus/Standard, law {}; its head says how to call it.\n",
               (folder / "heddle_friction.f").string(), friction::id_of(law.model.law));
  } else {
    const friction::LawTable table = friction::law_table(law);
    write_file(folder / "friction_law.csv", friction::law_table_csv(table));
    if (!options.run.print) return exit_done;
    fmt::print(
        "{}: mu over {} pressures, {} speeds, {} tool and {} fabric temperatures. Interpolated linearly in "
        "ln p, ln U and the temperatures it is off by {:.2g} % of mu at most, in the middle of the cells.\n",
        (folder / "friction_law.csv").string(), table.pressures.size(), table.speeds.size(),
        table.tool_temperatures.size(), table.fabric_temperatures.size(), 100.0 * table.middle_error);
  }
  say_limits(law);
  return exit_done;
}

}  // namespace heddle::pipeline
