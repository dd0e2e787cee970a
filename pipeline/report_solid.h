#pragma once

#include <string>
#include <vector>

#include "mesoscale/solid/solid_cell.h"
#include "pipeline/chart.h"
#include "pipeline/report.h"

namespace heddle::pipeline {

/// Young's modulus of the sheet against the direction of the pull: stretched, bent, and of a stack of plies.
Canvas stiffness_chart(const mesoscale::solid::SolidResult& solid);

/// What a table of facts says of the solid part.
std::vector<Condition> solid_facts(const mesoscale::solid::SolidResult& solid);

/// C, A, B and D as tables of HTML.
std::string stiffness_tables(const mesoscale::solid::SolidResult& solid);

/// Whether the solutions converged, and whether the weave is balanced.
std::vector<Verdict> solid_verdicts(const mesoscale::solid::SolidResult& solid);

}  // namespace heddle::pipeline
