#pragma once

#include <optional>
#include <string>
#include <vector>

#include "friction/film/film_conduction.h"
#include "macroscale/grid_error.h"
#include "macroscale/stamping.h"
#include "mesoscale/cell_spec.h"
#include "mesoscale/level_set.h"
#include "mesoscale/solid/solid_cell.h"
#include "mesoscale/touched_face.h"
#include "pipeline/coupon_report.h"
#include "pipeline/outputs.h"
#include "pipeline/picture.h"
#include "pipeline/stack_report.h"

namespace heddle::pipeline {

/// A line of the table of conditions, as the reader sees it.
struct Condition {
  std::string name;   ///< "Binder force"
  std::string value;  ///< "650 N"
};

/// Upper face of one cell over an even grid. Row-major with x (warp) fastest: height[j * nx + i].
struct HeightField {
  int nx = 0, ny = 0;
  double spacing_x = 0.0, spacing_y = 0.0;  ///< [m]
  std::vector<double> height;               ///< above the mid-plane of the fabric [m]
};

/// All that a report shows. Plain data in SI units; what is absent or empty leaves its section out.
struct ReportInput {
  std::string name;         ///< of the case
  std::string description;  ///< one sentence: what was stamped; may be empty
  std::vector<Condition> conditions;

  std::optional<mesoscale::CellSummary> cell = {};
  std::optional<mesoscale::FabricProperties> fabric = {};
  std::optional<ShearLoop> shear_loop = {};  ///< where tows rub
  std::optional<StackView> stack = {};       ///< of several plies
  std::optional<mesoscale::solid::SolidResult> solid = {};
  HeightField height = {};
  std::optional<mesoscale::TowBodies> tow_bodies = {};
  std::vector<SectionLine> section = {};             ///< of one cell, with its tows
  std::vector<mesoscale::TouchedFace> touched = {};  ///< upper faces under a flat tool, an angle each

  std::vector<FrictionTestRow> friction_test = {};
  std::vector<FrictionCurveRow> friction_curve =
      {};  ///< points of a curve in a row; a new pressure or temperature starts one

  std::vector<FrictionRigRow> friction_rig = {};
  std::vector<FrictionHistoryRow> friction_history = {};  ///< samples of a pull in a row
  std::vector<PlatePressure> plates = {};
  std::optional<friction::FilmConduction> film = {};  ///< where the film's temperature comes from conduction

  std::optional<macroscale::StampingSummary> stamping = {};
  std::vector<macroscale::HistoryRow> history = {};
  std::vector<macroscale::HeatRow> hold = {};  ///< after the stroke, tools closed
  std::optional<macroscale::BlankState> blank = {};
  std::optional<macroscale::GridError> grid_error = {};
  macroscale::ArtefactSpec artefact = {};

  std::vector<std::string> warnings = {};  ///< shown beside the verdicts
  std::vector<std::string> notes = {};     ///< assumptions and bands the reader should know
};

/// One page of HTML that needs no network: verdicts in words, charts, pictures, tables. Equal input, equal
/// bytes.
/// @throws std::invalid_argument  if the parts contradict each other (a mesh with too few nodes, a grid too
/// short)
std::string report_html(const ReportInput& input);

/// How a verdict is meant.
enum class Tone { holds, note, attention, fails };

/// One statement about the run, in words, with the number and the limit behind it.
struct Verdict {
  Tone tone;
  std::string text;
};

/// What the numbers say: what was stamped, the three results, whether energy and forces balance, whether the
/// answer is symmetric, what is not physics, what lies outside the calibrated box, and which constants are
/// priors.
std::vector<Verdict> verdicts(const ReportInput& input);

/// Limits by which verdicts are passed.
struct Limits {
  double energy_residual = 0.01;        ///< of the punch work, cumulative
  double force_balance = 1e-3;          ///< of the largest punch force
  double symmetry = 1e-3;               ///< of the largest shear angle or draw-in
  double numerical_dissipation = 0.02;  ///< of the punch work
  double grid_error = 0.02;             ///< of the peak punch force, as estimated
  double twist = 0.05;  ///< of the stored energy: more, and the control is no longer a help but a law
  double outside_calibration = 0.10;  ///< of the friction work: above it the verdict asks for attention
};
inline constexpr Limits limits{};

}  // namespace heddle::pipeline
