#pragma once

#include <string>

#include "pipeline/export/part_model.h"

namespace heddle::pipeline {

/// The part as an input file of Abaqus/Standard in mm, N, MPa, tonne and degC: shells S4 and S3 on the middle
/// surface, each with a *SHELL GENERAL SECTION of its own that takes the cell's A, B, D, its transverse shear
/// and its thermal forces as they are. Axes of a section: 1 along the warp, 3 normal to the cell.
///
/// Written after the published keywords, not run in Abaqus, which we do not have. The thermal forces are
/// taken as {N} = [D]{E} - F (T - ZERO); the head of the file says how to try that on one cell.
std::string abaqus_part(const PartModel& model);

}  // namespace heddle::pipeline
