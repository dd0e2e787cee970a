#pragma once

#include <vector>

#include "core/problem.h"
#include "macroscale/blank.h"
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

/// Shapes of punch, die and binder, each moved along z so that it touches the plane z = 0: punch and binder from
/// above, the die from below. Files become narrow bands.
struct TouchingTools {
  Shape punch, die, binder;
  std::vector<std::string> notes;  ///< what was read and repaired, for the report
};

/// @param largest_increment  of a node in one Newton iteration [m]: bands must be wider
/// @throws InputError  if a band cannot be built
TouchingTools touching_tools(const StampingSpec& spec, double thickness, double largest_increment);

/// The same shape moved up by z [m].
Shape raised(Shape shape, double z);

/// Area of the flat blank that lies under the flat face of a binder which touches z = 0 [m^2].
double flat_area(const Shape& binder, const Blank& blank);

}  // namespace heddle::macroscale
