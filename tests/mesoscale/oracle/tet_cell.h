#pragma once

#include <array>
#include <vector>

#include "mesoscale/solid/solid_cell.h"

namespace heddle::test {

/// One repeat of a consolidated weave as tetrahedra that follow the faces of the tows, periodic in its plane:
/// where gmsh takes the faces of bodies from (gmsh_plate.h).
///
/// Nodes stand on vertical lines over an even grid of the parameter plane whose columns end at the edges of
/// the tows. Faces of the tows cut each line; a triangle of lines is filled from below, layer by layer, by
/// lifting its lowest node to the next one on its line. Which line is lifted next depends on the
/// nodes of the two lines of a side alone, so tetrahedra of neighbours share their faces, whatever touches or
/// ends there: no film between touching tows is needed, and no sliver comes of it.
struct TetCell {
  struct Node {
    int line;  ///< nodes of a line and its periodic image are one
    double height;
    int rank = 0;  ///< edges of tows below it on its line
  };
  struct Tetrahedron {
    std::array<int, 4> node;
    std::array<std::array<double, 3>, 4> place;  ///< [m], not wrapped round the repeat
    int phase;                                   ///< 0 resin, 1 warp, 2 weft
  };
  std::vector<Node> nodes;
  std::vector<Tetrahedron> tetrahedra;
  double area = 0.0;    ///< of the repeat [m^2]
  double volume = 0.0;  ///< [m^3]
  double height = 0.0;  ///< [m]
};

/// Along the tow that fills a place (phase 1 warp, 2 weft), not of unit length; {1, 0, 0} in resin.
/// @param place  {x, y, z} [m]
std::array<double, 3> fibre_direction(const mesoscale::UnitCell& cell, int phase,
                                      const std::array<double, 3>& place);

/// @param per_tow    columns over a tow; gaps take a fifth of it
/// @param over_tow   layers of a tow at its crown
TetCell tet_cell(const mesoscale::UnitCell& cell, double thickness, int per_tow, int over_tow);

}  // namespace heddle::test
