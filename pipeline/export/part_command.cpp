#include "pipeline/export/part_command.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

#include "core/units.h"
#include "pipeline/export/abaqus_part.h"
#include "pipeline/export/ccx_part.h"
#include "pipeline/export/keyword_text.h"
#include "pipeline/export/part_folder.h"
#include "pipeline/export/part_picture.h"
#include "pipeline/outputs.h"

namespace heddle::pipeline {

namespace {

// As given, else of the case, else the default of the case's key, which is then assumed.
PartTemperature temperature(const std::string& given, const std::string& option, const std::string& key,
                            double of_case, bool assumed) {
  if (given.empty()) return {of_case, assumed ? "assumed: the default of " + key : key};
  const Reading reading = read_quantity(given, "degC");
  if (!reading.ok())
    throw InputError({{"export.temperature"_rule, option, given, reading.fault, reading.way_out}});
  return {reading.value, option};
}

// What a reader of the file should know of it.
void say_of(const PartModel& model, const macroscale::BlankState& blank) {
  const auto& faces = model.mesh.faces;
  const double mass = std::accumulate(model.mass.begin(), model.mass.end(), 0.0);
  fmt::print(
      "{} nodes on the middle surface, {} quads and {} triangles; {:.2f} g", model.mesh.position.size(),
      std::count_if(faces.begin(), faces.end(), [](const PartFace& f) { return f.count == 4; }),
      std::count_if(faces.begin(), faces.end(), [](const PartFace& f) { return f.count == 3; }), 1e3 * mass);
  const double off = model.mesh.flat_area / model.mesh.blank_area - 1.0;
  if (std::abs(off) > 1e-9) fmt::print(" ({:+.2g} % of the blank's, along its trimmed edge)", 100.0 * off);
  fmt::print(".\nFree of stress at {:.1f} degC ({}), cooled to {:.1f} degC ({}).\n",
             celsius(model.stress_free), model.stress_free.source, celsius(model.room), model.room.source);
  const auto beyond = std::count_if(model.cells.begin(), model.cells.end(),
                                    [](const CellStiffness& c) { return c.beyond_table; });
  if (beyond > 0)
    fmt::print(
        "{} of {} cells are sheared beyond the table and have its end: add an angle to solid.shear_angles.\n",
        beyond, model.cells.size());
  const auto melt = std::count_if(blank.heat.mean.begin(), blank.heat.mean.end(),
                                  [&](double t) { return t > model.stress_free.value; });
  if (melt > 0)
    fmt::print(
        "{} of {} nodes were warmer than that when the run ended: they freeze in the shape they then had.\n",
        melt, blank.heat.mean.size());
}

}  // namespace

int export_part(const ExportOptions& options, const Case& a_case, const std::filesystem::path& to) {
  const auto& given = a_case.stamping->thermal;
  const macroscale::thermal::ThermalSpec thermal = given.value_or(macroscale::thermal::ThermalSpec{});
  PartTemperature stress_free =
      temperature(options.stress_free, "--stress-free", "thermal.freezing_temperature",
                  thermal.freezing_temperature, !given);
  PartTemperature room =
      temperature(options.room, "--room", "thermal.air.temperature", thermal.air.temperature, !given);
  const FormedPart part = read_formed_part(options.run.file, a_case);
  const PartModel model = part_model(a_case.name, part.blank, part.table, part.areal_density,
                                     std::move(stress_free), std::move(room));
  const bool ccx = options.target == "ccx";
  const std::filesystem::path deck = to / (ccx ? "part_ccx.inp" : "part_abaqus.inp");
  write_file(deck, ccx ? ccx_part(model) : abaqus_part(model));
  write_file(to / "part_stiffness.csv", part_stiffness_csv(model.cells));
  write_file(to / "part.vtu", vtu(part_picture(model)));
  if (!options.run.print) return exit_done;
  fmt::print(
      "{}: {}; mm, N, MPa, tonne, degC. Directions and stiffness of each cell: {} and part.vtu.\n",
      deck.string(),
      ccx ? "`ccx -i part_ccx` runs it: the part springs in as it cools"
          : "shells with A, B, D and thermal forces; written after the published keywords, not run in Abaqus",
      (to / "part_stiffness.csv").string());
  say_of(model, part.blank);
  return exit_done;
}

}  // namespace heddle::pipeline
