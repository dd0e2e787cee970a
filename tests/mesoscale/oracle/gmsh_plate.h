#pragma once

#include <array>
#include <vector>

#include "mesoscale/solid/stiffness.h"
#include "tet_cell.h"

namespace heddle::test {

/// One repeat of a weave filled with tetrahedra by gmsh. The faces of tows, gaps, floor, roof and sides are
/// the triangles of a TetCell, which gmsh keeps: conformal where tows touch, periodic in the plane. What lies
/// between them is gmsh's own, and nodes on the middles of the edges make the elements quadratic.
struct GmshCell {
  struct Tetrahedron {
    std::array<int, 10> node;                    ///< corners, then edges 01 02 03 12 13 23
    std::array<std::array<double, 3>, 4> place;  ///< of the corners [m], not wrapped round the repeat
    int phase;                                   ///< 0 resin, 1 warp, 2 weft
    std::array<double, 3> fibre;
  };
  std::vector<Tetrahedron> tetrahedra;
  int nodes = 0;  ///< of a repeat: periodic images are one
  int regions = 0;
  double area = 0.0;               ///< of the repeat [m^2]
  std::array<double, 3> volume{};  ///< of each phase [m^3]
  double worst = 0.0;  ///< quality of an element: 12 (3 V)^(2/3) over the sum of its squared edges
};

/// @throws std::runtime_error  with gmsh's words, or of a tetrahedron without volume: seen at 18 columns and
/// 30 deg
GmshCell gmsh_cell(const mesoscale::UnitCell& cell, const TetCell& faces);

/// [A B; B D] by quadratic tetrahedra with periodic sides and free faces, and one factorisation by CHOLMOD.
/// @param phases  stiffness of resin, warp and weft, axis 1 along the fibres [Pa]
mesoscale::solid::Matrix6 plate_of(const GmshCell& cell,
                                   const std::array<mesoscale::solid::Matrix6, 3>& phases);

}  // namespace heddle::test
