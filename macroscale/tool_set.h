#pragma once

#include <string>
#include <vector>

#include "core/problem.h"
#include "macroscale/stamping.h"
#include "macroscale/tools.h"

namespace heddle::macroscale {

/// The specification with every tool file read and checked (ToolFileSpec::loaded).
/// @throws InputError  with the problems of all files
StampingSpec with_tools_loaded(StampingSpec spec);

/// What the tool files have to fit: each other on the whole stroke, the fabric between them, the blank.
/// Distances are taken from the vertices of one tool to the other at nine positions of the stroke.
/// @param spec       with its tools loaded; nothing is looked at where all tools are shapes
/// @param thickness  of the stress-free fabric [m]
Problems check_tools(const StampingSpec& spec, double thickness);

/// Shapes of punch, die and binder, each moved along z so that it touches the plane z = 0: punch and binder
/// from above, the die from below. Files become narrow bands.
struct TouchingTools {
  Shape punch, die, binder;
  std::vector<std::string> notes;  ///< what was read and repaired, for the report
};

/// @param largest_increment  of a node in one Newton iteration [m]: bands must be wider
/// @throws InputError  if a band cannot be built
TouchingTools touching_tools(const StampingSpec& spec, double thickness, double largest_increment);

/// The same shape moved up by z [m].
Shape raised(Shape shape, double z);

/// Area of the flat blank that lies under the flat face of the binder: where it presses [m^2].
double binder_area(const StampingSpec& spec);

}  // namespace heddle::macroscale
