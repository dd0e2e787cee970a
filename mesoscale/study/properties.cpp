#include "mesoscale/study/properties.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "mesoscale/contact.h"
#include "mesoscale/forming.h"

namespace heddle::mesoscale::study {

namespace {

constexpr double degree = std::numbers::pi / 180.0;
constexpr double none = std::numeric_limits<double>::quiet_NaN();

// A row of values that is filled by name, so that no order has to be kept twice.
class Row {
 public:
  Row() : values_(properties().size(), none) {}
  void set(const std::string& key, double value) { values_[index_of(key)] = value; }
  std::vector<double> take() { return std::move(values_); }

 private:
  std::vector<double> values_;
};

void set_geometry(Row& row, const FormingModels& models, double angle) {
  const FabricGeometry& fabric = models.fabric;
  const CrossingGeometry at_angle = sheared(fabric.crossing, angle);
  row.set("areal_density_kg_m2", fabric.mass.areal_density / std::cos(angle));
  row.set("crimp_warp", fabric.interlacing[0] * at_angle.tow[0].path.crimp());
  row.set("crimp_weft", fabric.interlacing[1] * at_angle.tow[1].path.crimp());
  row.set("gap_closure_angle_deg", gap_closure_angle(fabric.crossing));
  row.set("tow_fibre_fraction", std::max(at_angle.tow[0].fibre_fraction, at_angle.tow[1].fibre_fraction));
  row.set("consolidated_thickness_mm", fabric.mass.consolidated_thickness() / std::cos(angle));
}

void set_contact(Row& row, const FormingModels& models, double angle) {
  const PlateContact plate = plate_contact(models.fabric, models.compaction, angle);
  const double depth = plate.depth_at(pressed_at);
  row.set("contact_fraction_50um", plate.touched_fraction(contact_depth));
  row.set("contact_fraction_10kPa", plate.touched_fraction(depth));
  row.set("thickness_10kPa_mm", models.fabric.thickness - 2.0 * depth);
}

// What no angle changes, once a weave.
struct AtRest {
  double locking = none;
  std::array<double, 2> tension{}, bending{};
  double shear_20 = 0.0, shear_40 = 0.0, shear_rate = 0.0;
};

AtRest at_rest(const CellSpec& cell, const FormingModels& models) {
  AtRest rest;
  try {
    rest.locking = locking_angle(tabulate(models.shear, sine_grid(models.fabric)));
  } catch (const NumericalError&) {  // a loose weave that does not lock: it has no such angle
    rest.locking = none;
  }
  rest.tension = models.tension.relax({stretched_by, stretched_by}).tension;
  rest.bending = {models.bending[0].value, models.bending[1].value};
  rest.shear_20 = models.shear.flow(20.0 * degree).total();
  rest.shear_40 = models.shear.flow(40.0 * degree).total();
  rest.shear_rate = shear_rate(models.fabric, cell.resin, cell.forming.in_tow_shear_share).consistency;
  return rest;
}

void set_forming(Row& row, const FormingModels& models, const AtRest& rest, double angle) {
  row.set("locking_angle_deg", rest.locking);
  row.set("tension_warp_N_per_mm", rest.tension[0]);
  row.set("tension_weft_N_per_mm", rest.tension[1]);
  row.set("shear_flow_N_per_mm", models.shear.flow(std::abs(angle)).total());
  row.set("shear_flow_20deg_N_per_mm", rest.shear_20);
  row.set("shear_flow_40deg_N_per_mm", rest.shear_40);
  row.set("viscous_shear_N_sn_per_m", rest.shear_rate);
  row.set("bending_warp_N_mm", rest.bending[0]);
  row.set("bending_weft_N_mm", rest.bending[1]);
}

void set_solid(Row& row, const CellSpec& cell, const solid::SolidSpec& spec, double angle) {
  const auto [thickness, stiffness] = solid::ply(cell.weave, angle, spec);
  if (!stiffness.solver.converged)
    throw NumericalError("solid part: the load cases did not converge: " + stiffness.solver.reason);
  const solid::Matrix6& ply = stiffness.all;
  row.set("solid_A11_GPa", ply(0, 0) / thickness);
  row.set("solid_A22_GPa", ply(1, 1) / thickness);
  row.set("solid_A12_GPa", ply(0, 1) / thickness);
  row.set("solid_A66_GPa", ply(2, 2) / thickness);
  row.set("solid_D11_N_mm", ply(3, 3));
  row.set("solid_D22_N_mm", ply(4, 4));
  row.set("solid_D66_N_mm", ply(5, 5));
}

}  // namespace

const std::vector<Property>& properties() {
  constexpr double to_degrees = 1.0 / degree;
  static const std::vector<Property> all{
      {"areal_density_kg_m2", "mass per area", "kg/m²", 1.0, true, false},
      {"crimp_warp", "crimp, warp", "%", 100.0, true, false},
      {"crimp_weft", "crimp, weft", "%", 100.0, true, false},
      {"gap_closure_angle_deg", "gap closure", "°", to_degrees, false, false},
      {"locking_angle_deg", "locking", "°", to_degrees, false, false},
      {"tow_fibre_fraction", "glass in the tow", "%", 100.0, true, false},
      {"thickness_10kPa_mm", "thickness at 10 kPa", "mm", 1e3, true, false},
      {"contact_fraction_50um", "contact 0.05 mm deep", "%", 100.0, true, false},
      {"contact_fraction_10kPa", "contact at 10 kPa", "%", 100.0, true, false},
      {"tension_warp_N_per_mm", "tension at 0.5 %, warp", "N/mm", 1e-3, false, false},
      {"tension_weft_N_per_mm", "tension at 0.5 %, weft", "N/mm", 1e-3, false, false},
      {"shear_flow_N_per_mm", "shear flow", "N/mm", 1e-3, true, false},
      {"shear_flow_20deg_N_per_mm", "shear flow at 20°", "N/mm", 1e-3, false, false},
      {"shear_flow_40deg_N_per_mm", "shear flow at 40°", "N/mm", 1e-3, false, false},
      {"viscous_shear_N_sn_per_m", "viscous shear", "N sⁿ/m", 1.0, false, false},
      {"bending_warp_N_mm", "bending, warp", "N mm", 1e3, false, false},
      {"bending_weft_N_mm", "bending, weft", "N mm", 1e3, false, false},
      {"consolidated_thickness_mm", "consolidated thickness", "mm", 1e3, true, false},
      {"solid_A11_GPa", "solid A11/H", "GPa", 1e-9, true, true},
      {"solid_A22_GPa", "solid A22/H", "GPa", 1e-9, true, true},
      {"solid_A12_GPa", "solid A12/H", "GPa", 1e-9, true, true},
      {"solid_A66_GPa", "solid A66/H", "GPa", 1e-9, true, true},
      {"solid_D11_N_mm", "solid D11", "N mm", 1e3, true, true},
      {"solid_D22_N_mm", "solid D22", "N mm", 1e3, true, true},
      {"solid_D66_N_mm", "solid D66", "N mm", 1e3, true, true},
  };
  return all;
}

std::size_t index_of(const std::string& key) {
  const auto& all = properties();
  const auto found = std::find_if(all.begin(), all.end(), [&](const Property& p) { return p.key == key; });
  if (found == all.end()) throw std::logic_error("no property " + key);
  return static_cast<std::size_t>(found - all.begin());
}

CellProperties cell_properties(const CellSpec& cell, const std::optional<solid::SolidSpec>& solid,
                               std::span<const double> angles) {
  if (Problems problems = check(cell); !problems.empty()) throw InputError(std::move(problems));
  const FormingModels models = forming_models(cell);
  const AtRest rest = at_rest(cell, models);
  std::vector<Row> rows(angles.size());
  for (std::size_t k = 0; k < angles.size(); ++k) {
    set_geometry(rows[k], models, angles[k]);
    set_contact(rows[k], models, angles[k]);
    set_forming(rows[k], models, rest, angles[k]);
    if (solid) set_solid(rows[k], cell, *solid, angles[k]);
  }
  CellProperties result;
  for (Row& row : rows) result.at.push_back(row.take());
  return result;
}

}  // namespace heddle::mesoscale::study
