#include "pipeline/export/part_picture.h"

#include <numbers>
#include <utility>

namespace heddle::pipeline {

QuadMesh part_picture(const PartModel& model) {
  QuadMesh mesh{model.mesh.position, {}, {}, {}};
  DataArray warp{"warp", 3, {}}, weft{"weft", 3, {}}, normal{"normal", 3, {}},
      thickness{"thickness_mm", 1, {}}, angle{"shear_angle_deg", 1, {}},
      fibres{"tow_fibre_volume_fraction", 1, {}}, beyond{"beyond_table", 1, {}},
      director{"director_mm", 3, {}};
  for (std::size_t f = 0; f < model.mesh.faces.size(); ++f) {
    mesh.quads.push_back(model.mesh.faces[f].corners);
    const CellStiffness& cell = model.cell_of(f);
    for (const auto& [array, axis] :
         {std::pair{&warp, &cell.warp}, std::pair{&weft, &cell.weft}, std::pair{&normal, &cell.normal}})
      array->values.insert(array->values.end(), axis->begin(), axis->end());
    thickness.values.push_back(1e3 * model.thickness[f]);
    angle.values.push_back(180.0 / std::numbers::pi * cell.shear_angle);
    fibres.values.push_back(cell.tow_fibre_fraction);
    beyond.values.push_back(cell.beyond_table ? 1.0 : 0.0);
  }
  for (const auto& d : model.director)
    for (const double x : d) director.values.push_back(1e3 * x);
  mesh.cell_data = {warp, weft, normal, thickness, angle, fibres, beyond};
  mesh.point_data = {director};
  return mesh;
}

}  // namespace heddle::pipeline
