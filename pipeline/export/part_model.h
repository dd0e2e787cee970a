#pragma once

#include <array>
#include <string>
#include <vector>

#include "pipeline/export/part_layers.h"
#include "pipeline/export/part_mesh.h"
#include "pipeline/part_stiffness.h"

namespace heddle::pipeline {

/// A temperature that the part's residual state rests on, and where it is from.
struct PartTemperature {
  double value = 0.0;  ///< [K]
  std::string source;  ///< "thermal.freezing_temperature"
};

/// A support that holds one node along one axis of the model.
struct PartSupport {
  int node = 0;
  int axis = 0;  ///< 0, 1, 2 for x, y, z
};

/// The formed blank once it is solid, for a structural solver: a middle surface, at each node of it the
/// thickness along the normal, and the stiffness of each face.
struct PartModel {
  std::string name;
  PartMesh mesh;
  std::vector<CellStiffness> cells;             ///< of the blank's quads
  std::vector<std::array<double, 3>> director;  ///< of each node: normal times thickness [m]
  std::vector<double> area;                     ///< of each face's middle surface [m^2]
  std::vector<double> thickness;                ///< of each face: volume between its directors over area [m]
  std::vector<double> mass;                     ///< of each face, by its area before forming [kg]
  PartTemperature stress_free, room;
  std::array<PartSupport, 6> supports;  ///< 3-2-1: they hold the part and press on nothing

  const CellStiffness& cell_of(std::size_t face) const {
    return cells[static_cast<std::size_t>(mesh.faces[face].quad)];
  }
};

/// @param blank          of one ply
/// @param table          stiffness over the trellis angle, at least two angles
/// @param areal_density  before forming [kg/m^2]
/// @throws std::invalid_argument  as part_mesh and part_stiffness
PartModel part_model(std::string name, const macroscale::BlankState& blank,
                     const std::vector<mesoscale::solid::ShearedSolid>& table, double areal_density,
                     PartTemperature stress_free, PartTemperature room);

/// Three layers for each face, with the same share of the thickness in the middle everywhere: a third, or
/// less where a third leaves some layer too soft.
/// @throws NumericalError  naming a cell where no share gives layers with a positive definite stiffness
std::vector<PartLayers> part_layers(const PartModel& model);

}  // namespace heddle::pipeline
