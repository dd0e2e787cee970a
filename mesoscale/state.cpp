#include "mesoscale/state.h"

#include <fmt/format.h>

#include "mesoscale/contact.h"
#include "mesoscale/forming.h"

namespace heddle::mesoscale {

namespace {

PlateContact as_woven_contact(const CellSpec& spec) {
  return plate_contact(fabric_geometry(spec.weave, CellState::as_woven), compaction_law(spec.forming), 0.0);
}

Problems check_thickness(const CellSpec& spec, double least) {
  const double thickness = *spec.compacted_thickness, most = spec.weave.fabric_thickness;
  if (thickness >= least && thickness <= most) return {};
  return {
      {"cell.thickness.room"_rule,
       "cell.thickness",
       fmt::format("{:.6g} mm", 1e3 * thickness),
       fmt::format("must lie between the sheet without voids, {:.6g} mm, and the fabric as woven, {:.6g} mm",
                   1e3 * least, 1e3 * most),
       thickness < least ? "Glass and resin alone take that room; write state: consolidated for it."
                         : "Write state: as_woven for that.",
       "",
       0,
       {"weave.fabric_thickness"}}};
}

Problems check_pressure(const CellSpec& spec, double least) {
  const double pressure = *spec.compacted_pressure;
  if (!(pressure > 0.0 && pressure <= 1e9))
    return {{"*.range"_family.of("cell.pressure"), "cell.pressure",
             fmt::format("{:.6g} kPa", 1e-3 * pressure), "must satisfy 0 < pressure <= 1000000 kPa",
             "Write state: as_woven for no pressure."}};
  const double most = as_woven_contact(spec).pressure(0.5 * (spec.weave.fabric_thickness - least));
  if (pressure <= most) return {};
  return {
      {"cell.pressure.room"_rule,
       "cell.pressure",
       fmt::format("{:.6g} kPa", 1e-3 * pressure),
       fmt::format("must be at most {:.6g} kPa, at which the sheet is {:.6g} mm thick and has no voids left",
                   1e-3 * most, 1e3 * least),
       "Write state: consolidated for the sheet without voids.",
       "",
       0,
       {"weave.fabric_thickness"}}};
}

}  // namespace

double thickness_under(const CellSpec& spec, double pressure) {
  return spec.weave.fabric_thickness - 2.0 * as_woven_contact(spec).depth_at(pressure);
}

FabricGeometry fabric_geometry(const CellSpec& spec) {
  if (spec.state != CellState::compacted) return fabric_geometry(spec.weave, spec.state);
  return compacted_geometry(spec.weave, spec.compacted_thickness
                                            ? *spec.compacted_thickness
                                            : thickness_under(spec, spec.compacted_pressure.value()));
}

SheetShares sheet_shares(const FabricGeometry& fabric) {
  SheetShares shares;
  for (std::size_t i = 0; i < 2; ++i) {
    const TowGeometry& tow = fabric.crossing.tow[i];
    const double length_per_area = (1.0 + fabric.as_woven_crimp[i]) / tow.spacing;
    shares.glass += fabric.mass.glass_area[i] * length_per_area / fabric.thickness;
    shares.resin += fabric.mass.resin_area[i] * length_per_area / fabric.thickness;
    shares.tows += area(tow.section) / tow.spacing / fabric.thickness;
  }
  shares.voids = 1.0 - shares.glass - shares.resin;
  return shares;
}

Problems check_state(const CellSpec& spec) {
  if (spec.state != CellState::compacted) return {};
  if (spec.compacted_thickness.has_value() == spec.compacted_pressure.has_value())
    return {{"cell.state.compacted"_rule,
             "cell.state",
             "compacted",
             "needs one of cell.thickness and cell.pressure, and not both",
             "Write thickness: 1 mm, or pressure: 10 kPa.",
             "",
             0,
             {"cell.thickness", "cell.pressure"}}};
  const double least = fabric_geometry(spec.weave, CellState::as_woven).mass.consolidated_thickness();
  return spec.compacted_thickness ? check_thickness(spec, least) : check_pressure(spec, least);
}

}  // namespace heddle::mesoscale
