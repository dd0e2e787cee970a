#pragma once

#include "mesoscale/solid/solid_cell.h"
#include "pipeline/case.h"

namespace heddle::pipeline {

/// The stiffness that a case asks for: of its weave's solid part, or of its voxel file.
mesoscale::solid::SolidResult run_solid_stage(const Case& a_case);

/// On standard output.
void print_solid(const mesoscale::solid::SolidResult& result);

}  // namespace heddle::pipeline
