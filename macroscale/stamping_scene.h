#pragma once

#include "friction/model.h"
#include "macroscale/checkpoint.h"
#include "macroscale/scene.h"
#include "macroscale/stamping.h"
#include "mesoscale/fabric_properties.h"

namespace heddle::macroscale {

/// The plies on one another where the closed binder leaves them: their middles a thickness apart less what
/// nesting and the binder's pressure take, that of the stack at z = 0.
Blank stamping_blank(const StampingSpec& spec, const mesoscale::FabricProperties& fabric);

/// Blank, tools and laws of a stamping. The punch is the first tool; die and binder may be several each.
/// Fabric and friction must outlive the scene.
Scene stamping_scene(const StampingSpec& spec, const mesoscale::FabricProperties& fabric,
                     const friction::Model& friction);

/// Tools of that scene, and how many of them have an unknown of their own.
StateSizes state_sizes(const StampingSpec& spec);

}  // namespace heddle::macroscale
