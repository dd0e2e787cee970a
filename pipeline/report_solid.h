#pragma once

#include <string>
#include <vector>

#include "mesoscale/solid/solid_cell.h"
#include "pipeline/chart.h"
#include "pipeline/report.h"

namespace heddle::pipeline {

/// Young's modulus of the sheet against the direction of the pull: stretched, bent, and of a stack of plies.
Canvas stiffness_chart(const mesoscale::solid::SolidResult& solid);

/// Stiffness A of the ply, and the resultants N that a kelvin asks of it when held flat, against the trellis
/// angle at which the fabric was consolidated. @param rows  two or more
Canvas sheared_stiffness_chart(const std::vector<mesoscale::solid::ShearedSolid>& rows);
Canvas sheared_thermal_chart(const std::vector<mesoscale::solid::ShearedSolid>& rows);

/// A laminate of several plies, beside what lone plies would make; empty without one.
std::string laminate_table(const mesoscale::solid::SolidResult& s);

/// The same numbers and more as tables of HTML, a row an angle.
std::string sheared_table(const std::vector<mesoscale::solid::ShearedSolid>& rows);

/// What a table of facts says of the solid part.
std::vector<Condition> solid_facts(const mesoscale::solid::SolidResult& solid);

/// C, A, B and D as tables of HTML.
std::string stiffness_tables(const mesoscale::solid::SolidResult& solid);

/// Whether the solutions converged, and whether the weave is balanced.
std::vector<Verdict> solid_verdicts(const mesoscale::solid::SolidResult& solid);

}  // namespace heddle::pipeline
