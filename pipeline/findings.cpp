#include "pipeline/findings.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "core/units.h"
#include "macroscale/advice.h"
#include "pipeline/indicator_outputs.h"
#include "pipeline/shear_loop.h"
#include "pipeline/stage_keys.h"

namespace heddle::pipeline {

namespace {

// What of a symmetric part was computed, as a sentence behind another; nothing for all of it.
std::string piece_in_words(macroscale::Symmetry symmetry) {
  if (symmetry == macroscale::Symmetry::none) return "";
  return fmt::format(
      " One {} of it is computed, on its planes of symmetry; all that is shown is of the whole.",
      symmetry == macroscale::Symmetry::quarter ? "quarter" : "half");
}

std::string description_of(const Case& a_case) {
  if (a_case.voxels) return "The stiffness of one cell of voxels.";
  if (!a_case.stamping)
    return a_case.cell && !a_case.friction_machine ? "One unit cell of the weave." : "The friction test.";
  const auto& s = *a_case.stamping;
  const std::string punch = s.punch.file
                                ? "by the punch of " + s.punch.file->source.file.filename().string()
                                : fmt::format("into a hemisphere of {:.0f} mm radius", 1e3 * s.punch.radius);
  const std::string plies = s.blank.plies > 1 ? fmt::format("{} plies of ", s.blank.plies) : "";
  return fmt::format("A {} blank of {}{} weave stamped {:.0f} mm deep {} in {:.2f} s.{}",
                     blank_in_words(s.blank), plies, a_case.cell->weave.pattern, 1e3 * s.process.stroke,
                     punch, s.process.time / s.process.speed_scale, piece_in_words(s.blank.symmetry));
}

std::vector<Condition> conditions_of(const Case& a_case) {
  if (!a_case.stamping) return {};
  const auto& s = *a_case.stamping;
  return {
      s.binder.control == macroscale::BinderControl::gap
          ? Condition{"Binder", fmt::format("held at a gap of {:g} mm", 1e3 * s.binder.gap)}
          : Condition{"Binder force", fmt::format("{:g} N", s.process.binder_force)},
      {"Tool temperature", fmt::format("{:g} degC", s.process.tool_temperature - zero_celsius)},
      {"Blank temperature", fmt::format("{:g} degC", s.process.blank_temperature - zero_celsius)},
      {"Stroke",
       fmt::format("{:g} mm in {:g} s", 1e3 * s.process.stroke, s.process.time / s.process.speed_scale)},
      {"Blank", fmt::format("{}, warp at {:g} deg", blank_in_words(s.blank), degrees * s.blank.orientation)},
      {"Steps", fmt::format("{} of equal stroke", s.process.steps)}};
}

HeightField report_height(const mesoscale::HeightField& h) {
  HeightField field;
  field.nx = field.ny = h.n;
  field.spacing_x = std::hypot(h.along_warp[0], h.along_warp[1]) / h.n;
  field.spacing_y = std::hypot(h.along_weft[0], h.along_weft[1]) / h.n;
  field.height = h.top;
  return field;
}

std::vector<SectionLine> report_section(const std::vector<mesoscale::Outline>& outlines) {
  std::vector<SectionLine> lines;
  for (const auto& outline : outlines)
    lines.push_back({outline.tow == mesoscale::TowDirection::warp ? SectionKind::warp : SectionKind::weft,
                     outline.points});
  return lines;
}

/// The fabric as woven, and sheared to 30 degrees as at the side of a dome.
std::vector<mesoscale::TouchedFace> touched_faces(const mesoscale::CellSpec& spec,
                                                  const mesoscale::FabricProperties& fabric) {
  const mesoscale::FabricGeometry geometry = mesoscale::fabric_geometry(spec);
  const int tows = std::max(geometry.weave.warps, geometry.weave.wefts);
  std::vector<mesoscale::TouchedFace> faces;
  for (const double angle : {0.0, std::numbers::pi / 6.0})
    faces.push_back(mesoscale::touched_face(geometry, fabric.compaction, angle, std::min(24 * tows, 96)));
  return faces;
}

}  // namespace

ReportInput report_input(const Case& a_case, const Findings& findings) {
  ReportInput input;
  input.name = a_case.name;
  input.description = description_of(a_case);
  input.conditions = conditions_of(a_case);
  if (findings.cell) {
    input.cell = findings.cell->summary;
    input.fabric = findings.cell->fabric;
    if (a_case.shear_friction.on())
      input.shear_loop = shear_loop(findings.cell->fabric, a_case.shear_friction);
    input.height = report_height(findings.pictures->height);
    input.section = report_section(findings.pictures->section);
    input.tow_bodies = findings.pictures->bodies;
    // A stamping has enough to show.
    if (!findings.stamping) input.touched = touched_faces(*a_case.cell, findings.cell->fabric);
  }
  input.stack = findings.stack;
  input.solid = findings.solid;
  if (findings.friction) {
    input.friction_test = findings.friction->test;
    input.friction_curve = findings.friction->curve;
    input.notes = findings.friction->notes;
    input.film = findings.friction->model.conduction;
  }
  if (findings.friction_rig) {
    input.friction_rig = findings.friction_rig->rows;
    input.friction_history = findings.friction_rig->history;
    input.plates = findings.friction_rig->plates;
    input.notes.insert(input.notes.end(), findings.friction_rig->notes.begin(),
                       findings.friction_rig->notes.end());
  }
  if (findings.stamping) {
    input.stamping = findings.stamping->summary;
    input.history = findings.stamping->history;
    input.hold = findings.stamping->hold;
    input.blank = findings.stamping->final_state;
    input.grid_error = findings.grid_error;
    input.artefact = a_case.stamping->artefact;
    input.warnings = indicator_warnings(
        findings.indicators,
        indicator_limits(*a_case.stamping, findings.cell->fabric, findings.stamping->summary.spacing));
    if (findings.folds) {
      const auto folds = fold_warnings(*findings.folds, findings.stamping->summary);
      input.warnings.insert(input.warnings.end(), folds.begin(), folds.end());
    }
  }
  input.notes.insert(input.notes.end(), a_case.notes.begin(), a_case.notes.end());
  return input;
}

std::vector<std::pair<std::string, std::string>> stage_hashes(const Case& a_case) {
  std::vector<std::pair<std::string, std::string>> hashes;
  const auto add = [&](ChainStage stage) {
    hashes.emplace_back(name_of(stage), inputs_of(stage, a_case).key());
  };
  if (a_case.cell) add(ChainStage::mesoscale);
  if (a_case.solid || a_case.voxels) add(ChainStage::solid);
  if (a_case.friction) add(ChainStage::friction);
  if (a_case.friction_machine) add(ChainStage::friction_rig);
  if (a_case.stamping) add(ChainStage::macroscale);
  if (a_case.grid_error) add(ChainStage::grid_error);
  return hashes;
}

void write_findings(const Case& a_case, RunFolder& folder, const Findings& findings) {
  SummaryRecord record;
  if (findings.cell) record.cell = findings.cell->summary;
  if (findings.pictures) record.tow_bodies = findings.pictures->bodies;
  if (findings.stack) record.stack = findings.stack->summary;
  if (findings.cell && a_case.stamping)
    record.contact_area_fraction_binder =
        findings.cell->fabric.contact.evaluate(mean_binder_pressure(*a_case.stamping), 0.0).fraction;
  if (findings.stamping) {
    record.stamping = findings.stamping->summary;
    record.grid_error = findings.grid_error;
    record.indicators = findings.indicators;
    record.folds = findings.folds;
    record.failure = findings.stamping->failure;
    if (record.failure)
      record.advice = macroscale::advice_for(*record.failure, *a_case.stamping, *record.stamping);
  }
  folder.write("summary.json", summary_json(record));
  folder.write("report.html", report_html(report_input(a_case, findings)));
  folder.close(a_case, stage_hashes(a_case));
}

}  // namespace heddle::pipeline
