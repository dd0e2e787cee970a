#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "macroscale/folds.h"
#include "macroscale/indicators.h"
#include "pipeline/case.h"
#include "pipeline/friction_rig_stage.h"
#include "pipeline/report.h"
#include "pipeline/run_folder.h"
#include "pipeline/solid_stage.h"
#include "pipeline/stack_report.h"
#include "pipeline/stages.h"

namespace heddle::pipeline {

/// What the stages of one run have found so far.
struct Findings {
  std::optional<mesoscale::CellResult> cell;
  std::optional<WeavePictures> pictures;
  std::optional<StackView> stack;
  std::optional<mesoscale::solid::SolidResult> solid;
  std::optional<FrictionStage> friction;
  std::optional<FrictionRigStage> friction_rig;
  std::optional<macroscale::StampingResult> stamping;
  std::optional<macroscale::GridError> grid_error;
  std::vector<macroscale::LargestIndicator> indicators;  ///< of the last state
  std::optional<macroscale::Folds> folds;                ///< of the last state
};

/// Which stages a command runs.
enum class Part { all, weave, friction };

/// Hash of the inputs of each stage the case asks for.
std::vector<std::pair<std::string, std::string>> stage_hashes(const Case& a_case);

ReportInput report_input(const Case& a_case, const Findings& findings);

/// summary.json, report.html, and last the manifest: a folder that has one is whole.
void write_findings(const Case& a_case, RunFolder& folder, const Findings& findings);

/// The results of a command, on standard output.
void print_findings(const Case& a_case, const Findings& findings, Part part,
                    const std::filesystem::path& folder);

}  // namespace heddle::pipeline
