#pragma once

#include <memory>

#include "core/level_set.h"
#include "core/problem.h"
#include "macroscale/stamping.h"
#include "macroscale/tool_band.h"
#include "macroscale/tools.h"

namespace heddle::macroscale {

/// A tool file as the solver uses it.
struct LoadedToolFile {
  LoadedTool tool;
  std::shared_ptr<const ToolBand> band;  ///< in the file's own frame
};

/// Where the fabric can get to against a tool, in the frame of the tool's file: sideways as far as the blank
/// plus the stroke; a quarter of the stroke beyond what lies between punch and binder. Tools are often thick,
/// and nothing meets their far sides. A node that leaves this room stops the run (macroscale/tool_band.h).
/// @param mesh  of the tool, as in its file
Box reach_of_fabric(const StampingSpec& spec, Role role, const TriangleMesh& mesh);

/// What the tool files have to fit: each other on the whole stroke, the fabric between them, the blank.
/// Distances are taken from the vertices of one tool to the other at nine positions of the stroke.
/// @param spec       with its tools loaded; nothing is looked at where all tools are shapes
/// @param thickness  of the stress-free fabric [m]
Problems check_tools(const StampingSpec& spec, double thickness);

/// Shapes of punch, die and binder, each moved along z so that it touches the plane z = 0: punch and binder
/// from above, the die from below.
struct TouchingTools {
  Shape punch, die, binder;
};

/// @param spec  with its tools loaded
TouchingTools touching_tools(const StampingSpec& spec);

/// The same shape moved up by z [m].
Shape raised(Shape shape, double z);

/// What lies of the flat blank under the flat face of the binder: where it presses.
struct BinderFace {
  double area = 0.0;  ///< [m^2]
  double arm = 0.0;   ///< radius of gyration, the mean of all level axes through the punch's [m]
};
BinderFace binder_face(const StampingSpec& spec);

}  // namespace heddle::macroscale
