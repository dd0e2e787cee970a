#pragma once

#include "macroscale/stamping.h"

/// The only way from a tool file to a stamping; in a library of its own, because it brings gmsh.
namespace heddle::macroscale {

/// The specification with every tool file read, checked and turned into a distance field
/// (ToolFileSpec::loaded).
/// @param thickness  of the stress-free fabric, which the field must reach past [m]
/// @throws InputError  with the problems of all files
StampingSpec with_tools_loaded(StampingSpec spec, double thickness);

}  // namespace heddle::macroscale
