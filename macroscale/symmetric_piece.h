#pragma once

#include <vector>

#include "core/problem.h"
#include "macroscale/scene.h"
#include "macroscale/stamping.h"

namespace heddle::macroscale {

/// Whether tows at an angle to x run along x and y, as a plane of symmetry asks for [rad].
bool runs_along_axes(double orientation);

/// Unknowns that planes of symmetry hold: of each node on one, its way across. Empty without symmetry.
std::vector<char> held_by_planes(const Blank& blank);

/// Leaves the tools of a scene the loads, masses and springs that go with its piece of the blank.
void take_share(std::vector<Tool>& tools, Symmetry symmetry);

/// What in blank and press is not its own mirror image, as the specification says it. Tools from files are
/// looked at by check_mirrored_tools.
Problems check_symmetry(const StampingSpec& spec);

/// Surfaces of tool files that are not their own mirror image where the blank can get to.
/// @param spec  with its tools loaded
Problems check_mirrored_tools(const StampingSpec& spec);

}  // namespace heddle::macroscale
