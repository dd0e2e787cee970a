#pragma once

#include "pipeline/export/part_model.h"
#include "pipeline/export_vtu.h"

namespace heddle::pipeline {

/// The part for ParaView: faces with `warp`, `weft` and `normal` (unit), `thickness_mm`, `shear_angle_deg`,
/// `tow_fibre_volume_fraction`, `beyond_table`; nodes with `director_mm`, the thickness along the normal.
QuadMesh part_picture(const PartModel& model);

}  // namespace heddle::pipeline
