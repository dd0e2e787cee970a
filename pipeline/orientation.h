#pragma once

#include <string>
#include <vector>

#include "pipeline/case.h"
#include "pipeline/commands.h"
#include "pipeline/outputs.h"

namespace heddle::pipeline {

/// One blank of the study, stamped with its tows at an angle to its outline.
struct OrientedBlank {
  std::string id;      ///< "15_deg"; its files are in cases/ID/
  double angle = 0.0;  ///< warp against x [rad]
  macroscale::StampingResult result;
};

/// What is shown of the study.
struct OrientationFindings {
  std::string name;         ///< of the case
  std::string description;  ///< one sentence
  std::vector<OrientedBlank> blanks;
  std::vector<FrictionTestRow> samples;  ///< at the law, F = 2 mu N
  std::vector<std::string> notes;
};

/// Change of a result per degree of angle: slope of the least-squares line, and the range over all angles as
/// a share of the mean.
struct Sensitivity {
  std::string quantity, unit;
  double per_degree = 0.0;  ///< [unit/deg]
  double range = 0.0;       ///< (largest - smallest) / mean [-]
};

/// Of peak force, largest shear angle, largest draw-in; of the friction coefficient over the samples.
std::vector<Sensitivity> sensitivities(const OrientationFindings& findings);

/// One row a blank: table.csv.
std::string orientation_table_csv(const std::vector<OrientedBlank>& blanks);
/// The page: blanks side by side, edges, forces, tables.
std::string orientation_html(const OrientationFindings& findings);

/// Stamps the blank at each angle of `orientation_study.blanks` and pulls a sample at each angle of
/// `orientation_study.friction`. Writes table.csv, report.html, friction/ and cases/ID/. Returns an exit
/// code; a stamping that stopped leaves its files and the study goes on. Blanks that the cache holds are not
/// stamped again; a signal ends the study between two of them.
int run_orientation_study(const RunOptions& options, Case a_case);

}  // namespace heddle::pipeline
