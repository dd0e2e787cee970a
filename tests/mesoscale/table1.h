#pragma once

#include <numbers>

#include "mesoscale/cell.h"
#include "mesoscale/forming.h"

namespace heddle::test {

/// The plain weave of Table 1, which the defaults of CellSpec describe.
inline mesoscale::FabricGeometry table1() {
  return mesoscale::fabric_geometry(mesoscale::WeaveSpec{}, mesoscale::CellState::as_woven);
}

inline const mesoscale::FormingModels& table1_models() {
  static const mesoscale::FormingModels models = mesoscale::forming_models(mesoscale::CellSpec{});
  return models;
}

inline double degrees(double radians) {
  return radians * 180.0 / std::numbers::pi;
}
inline double radians(double degrees) {
  return degrees * std::numbers::pi / 180.0;
}

}  // namespace heddle::test
