#pragma once

#include <string>

#include "pipeline/export/part_model.h"

namespace heddle::pipeline {

/// The part as an input file of CalculiX in mm, N, MPa, tonne and degC. CalculiX has no shell section that
/// takes A, B and D, and expands its shells to bricks with rigid knots where normals differ; so each face is
/// three bricks (C3D20R; C3D15 where it is a triangle) on one another, whose stiffnesses together have the
/// cell's A, B, D and thermal resultants exactly (part_layers.h). Every brick has a material of its own, and
/// every face an orientation: 1 along the warp, 3 normal to the cell.
///
/// Sets of elements: PART, LAYER1 (bottom), LAYER2, LAYER3, BEYOND_TABLE where there are such; of nodes:
/// PART, MIDDLE (of the middle surface), EDGE (of its free sides), SUPPORTS.
/// @throws NumericalError  as part_layers
std::string ccx_part(const PartModel& model);

/// Its parts: everything before the first step, and supports with the step that cools it down.
std::string ccx_part_body(const PartModel& model);
std::string ccx_part_cooling(const PartModel& model);

/// Number in the file of the node on the middle surface.
int ccx_middle_node(int node);

}  // namespace heddle::pipeline
