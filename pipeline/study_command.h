#pragma once

#include <string>
#include <vector>

#include "mesoscale/study/cell_study.h"
#include "pipeline/commands.h"

namespace heddle::pipeline {

/// One weave of a study and what it came to.
struct StudiedCell {
  mesoscale::study::StudyPoint point;
  mesoscale::study::CellProperties properties;  ///< empty where `failure` says why
  std::string failure = {};
};

/// All that files and page show of a study.
struct CellStudyFindings {
  std::string name;  ///< of the case
  mesoscale::CellSpec base;
  mesoscale::study::StudySpec spec;
  bool solid = false;              ///< the solid part was homogenised as well
  std::vector<StudiedCell> cells;  ///< the weave given first
  std::vector<mesoscale::study::Sensitivity> sensitivities;
  std::vector<std::string> notes = {};
};

/// table.csv: one row a weave and angle, keys then results; a value that a weave has not is left empty.
std::string study_table_csv(const CellStudyFindings& findings);
/// The same numbers as data sets: /keys/..., /results/... (NaN for what a weave has not), one entry a row.
std::string study_table_h5(const CellStudyFindings& findings);
/// sensitivities.csv: slope per millimetre and its error, and both as shares.
std::string sensitivities_csv(const CellStudyFindings& findings);
/// The page.
std::string cell_study_html(const CellStudyFindings& findings);

/// Looks at every weave of the study. Writes table.csv, table.h5, sensitivities.csv and report.html. Cells
/// that the cache holds are not computed again; a signal ends the study between two of them; one that fails
/// is said and the others go on. Returns an exit code, and throws InputError for bad input.
int study_case(const RunOptions& options);

}  // namespace heddle::pipeline
