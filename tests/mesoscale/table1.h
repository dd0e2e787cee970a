#pragma once

#include <numbers>
#include <variant>

#include "mesoscale/cell.h"
#include "mesoscale/forming.h"

namespace heddle::test {

/// The plain weave of Table 1, which the defaults of CellSpec describe.
inline mesoscale::FabricGeometry table1() {
  return mesoscale::fabric_geometry(mesoscale::WeaveSpec{}, mesoscale::CellState::as_woven);
}

/// The section of a crossing whose tows are lenses.
inline mesoscale::LensSection lens_of(const mesoscale::CrossingGeometry& crossing) {
  return std::get<mesoscale::LensSection>(crossing.tow[0].section.upper);
}

/// Elliptic tows on sine paths: the geometry that does interpenetrate.
inline mesoscale::UnitCell ellipse_on_sine() {
  const mesoscale::FabricGeometry fabric = table1();
  const mesoscale::TowGeometry& t = fabric.crossing.tow[0];
  const mesoscale::UnitCell::Tow tow{
      t.spacing, mesoscale::PowerEllipseSection{width(t.section), thickness(t.section), 1.0},
      mesoscale::SinePath{t.spacing, t.path.height}};
  return {fabric.weave, {tow, tow}, 0.0};
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
