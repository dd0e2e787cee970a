#include "pipeline/stages.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "friction/hersey.h"
#include "friction/test_design.h"
#include "macroscale/tool_set.h"
#include "mesoscale/state.h"

namespace heddle::pipeline {

namespace {

std::string in_words(const friction::FittedParameter& p) {
  const std::string unit = p.unit.empty() ? "" : " " + p.unit;
  if (!p.fitted) return fmt::format("{} = {:.4g}{} (held)", p.key, p.value, unit);
  if (p.standard_error)
    return fmt::format("{} = {:.4g} +- {:.2g}{} (fitted)", p.key, p.value, *p.standard_error, unit);
  return fmt::format("{} = {:.4g}{} (fitted, no degree of freedom left)", p.key, p.value, unit);
}

void add_calibration_notes(FrictionStage& stage, const FrictionSpec& spec) {
  const friction::Calibration& c = stage.calibration->assumed;
  std::string fitted = fmt::format(
      "The friction law was fitted to {} pulls (RMS error {:.2f} %, {} degrees of freedom): ", c.rows.size(),
      100.0 * c.rms_error, c.degrees_of_freedom);
  for (std::size_t k = 0; k < c.parameters.size(); ++k) fitted += (k ? "; " : "") + in_words(c.parameters[k]);
  stage.notes.push_back(fitted + ".");
  stage.notes.push_back(
      fmt::format("The plate area of the friction rig is assumed ({:g} m^2, band {:g} to {:g} m^2): the "
                  "paper does not give it. At the ends of the "
                  "band the fit has RMS errors of {:.2f} and {:.2f} %.",
                  spec.rig.plate_area, spec.rig.plate_area_band[0], spec.rig.plate_area_band[1],
                  100.0 * stage.calibration->low.rms_error, 100.0 * stage.calibration->high.rms_error));
}

// Mean log slope of the weave's contact area between the lowest and the highest pressure of the rows.
double exponent_between(const friction::AreaFunction& area,
                        const std::vector<friction::FrictionTestResult>& rows) {
  double low = 1e300, high = 0.0;
  for (const auto& row : rows) {
    low = std::min(low, row.context.pressure);
    high = std::max(high, row.context.pressure);
  }
  return std::log(area(high).first / area(low).first) / std::log(high / low);
}

// The contact area of the fabric that was pulled: that of this case if both are the same weave.
mesoscale::FabricProperties pulled_fabric(const Case& a_case, const mesoscale::FabricProperties* fabric) {
  mesoscale::CellSpec cell = *a_case.cell;
  const bool compacted = cell.state == mesoscale::CellState::compacted;
  if (fabric && !compacted && cell.weave == a_case.friction->calibration_weave) return *fabric;
  cell.weave = a_case.friction->calibration_weave;
  cell.film.reset();  // the area alone is asked for
  cell.facing = mesoscale::Facing::flat;
  // Somebody's thickness or pressure is not that of the fabric in the rig.
  if (compacted) cell.state = mesoscale::CellState::as_woven;
  return mesoscale::analyse(cell).fabric;
}

void calibrate_law(FrictionStage& stage, const FrictionSpec& spec, const friction::AreaFunction& area,
                   const friction::AreaFunction& weave_area) {
  const auto rows = friction::read_friction_table(spec.calibration_data.string());
  const friction::CalibrationOptions options{.hold_tool_temperature_slope = !spec.fit_temperature_slope,
                                             .search = {}};
  stage.calibration = friction::calibrate_band(spec.model, rows, spec.rig, area, options);
  stage.model = stage.calibration->assumed.model;
  add_calibration_notes(stage, spec);
  // One parameter more than the law's own: only where the pulls leave a degree of freedom for it.
  const bool room = stage.calibration->assumed.degrees_of_freedom > 0;
  if (!room || !std::holds_alternative<friction::HerseyPower>(spec.model.law)) return;
  stage.area_exponent =
      friction::area_exponent_that_fits(spec.model.film, spec.model.effects, rows, spec.rig);
  std::string note =
      fmt::format("A contact area phi ~ p^a with a = {:.2f} would meet the calibration pulls best",
                  stage.area_exponent->value);
  if (weave_area) {
    stage.area_exponent_of_weave = exponent_between(weave_area, stage.calibration->assumed.rows);
    note += fmt::format("; the weave's compaction (a prior, not fitted) gives a = {:.2f} between their loads",
                        *stage.area_exponent_of_weave);
  }
  stage.notes.push_back(note + ".");
}

FrictionTestRow file_row(const friction::FrictionTestRow& row, const friction::FrictionTestResult& result) {
  FrictionTestRow r;
  r.name = row.name;
  r.velocity = row.velocity;
  r.normal_force = row.normal_force;
  r.tool_temperature = row.tool_temperature;
  r.fabric_temperature = row.fabric_temperature;
  r.orientation = row.orientation;
  r.friction_coefficient = result.mu;
  r.pull_force = result.pull_force;
  r.measured_force = row.measured_force;
  r.paper_force = row.paper_model_force;
  return r;
}

// The campaign's own pulls, one factor at a time, and the range of mu over every combination of its levels.
void add_design(FrictionStage& stage, const FrictionSpec& spec, const friction::AreaFunction& area,
                const std::string& path) {
  const friction::TestDesign design = friction::read_test_design(path);
  const auto rows = friction::one_at_a_time(design);
  const auto results = friction::run_friction_tests(stage.model, rows, spec.rig, area);
  for (std::size_t k = 0; k < rows.size(); ++k) stage.test.push_back(file_row(rows[k], results[k]));
  double low = 1e300, high = 0.0;
  const auto all = friction::all_combinations(design);
  for (const auto& result : friction::run_friction_tests(stage.model, all, spec.rig, area)) {
    low = std::min(low, result.mu);
    high = std::max(high, result.mu);
  }
  stage.notes.push_back(fmt::format(
      "Over all {} combinations of the campaign's levels{} mu lies between {:.3f} and {:.3f}.", all.size(),
      friction::is_on(stage.model.effects.orientation) ? ", at the first orientation," : "", low, high));
}

// mu against speed at the first test's temperatures, for three loads across the rig's range.
std::vector<FrictionCurveRow> curve_of(const FrictionStage& stage, const FrictionSpec& spec,
                                       const friction::AreaFunction& area) {
  std::vector<FrictionCurveRow> curve;
  friction::FrictionTestRow row;
  for (double pressure : {5e3, 5e4, 5e5}) {
    row.normal_force = pressure * spec.rig.plate_area;
    for (int k = 0; k <= 48; ++k) {
      row.velocity = 1e-4 * std::pow(10.0, k / 12.0);
      const auto context = friction::contact_of(row, spec.rig, area);
      const auto law = friction::evaluate(stage.model, context,
                                          friction::state_after_pull(stage.model, context, spec.rig));
      curve.push_back({row.tool_temperature, row.fabric_temperature, context.pressure, row.velocity,
                       law.film_viscosity, law.hersey, law.mu});
    }
  }
  return curve;
}

}  // namespace

friction::AreaFunction area_function(const FrictionSpec& spec, const mesoscale::FabricProperties* fabric) {
  if (spec.contact_pressure == macroscale::ContactPressure::nominal || !fabric) return {};
  return [contact = fabric->contact](double pressure) {
    const auto floored = friction::floored(pressure);
    const auto area = contact.evaluate(floored.value, 0.0);
    return std::pair{area.fraction, area.slope * floored.slope};
  };
}

friction::AreaFunction area_of_pulled_fabric(const Case& a_case) {
  const FrictionSpec& spec = *a_case.friction;
  if (spec.contact_pressure == macroscale::ContactPressure::nominal || !a_case.cell ||
      !friction::reads_hersey_number(spec.model.law))
    return {};
  const mesoscale::FabricProperties pulled = pulled_fabric(a_case, nullptr);
  return area_function(spec, &pulled);
}

friction::Model model_of_run(const FrictionSpec& spec, const friction::AreaFunction& area) {
  if (!spec.calibrated()) return spec.model;
  const auto rows = friction::read_friction_table(spec.calibration_data.string());
  return friction::calibrate(spec.model, rows, spec.rig, area,
                             {.hold_tool_temperature_slope = !spec.fit_temperature_slope, .search = {}})
      .model;
}

FrictionStage run_friction_stage(const Case& a_case, const mesoscale::FabricProperties* fabric) {
  const FrictionSpec& spec = *a_case.friction;
  if (spec.contact_pressure == macroscale::ContactPressure::real && !fabric)
    throw InputError({{"friction.contact_pressure.weave"_rule, "friction.contact_pressure", "real",
                       "needs a weave: the contact area comes from it",
                       "Add `weave:`, or write `contact_pressure: nominal`."}});
  const friction::AreaFunction area = area_function(spec, fabric);
  FrictionStage stage;
  stage.model = spec.model;
  if (spec.calibrated()) {
    // With nominal pressure and no weave there is no area to compare with.
    const auto pulled = a_case.cell ? std::optional(pulled_fabric(a_case, fabric)) : std::nullopt;
    FrictionSpec real = spec;
    real.contact_pressure = macroscale::ContactPressure::real;
    calibrate_law(stage, spec, area_function(spec, pulled ? &*pulled : nullptr),
                  area_function(real, pulled ? &*pulled : nullptr));
  }
  if (a_case.friction_test) {
    const auto rows = friction::read_friction_table(a_case.friction_test->data.string());
    const auto results = friction::run_friction_tests(stage.model, rows, spec.rig, area);
    for (std::size_t k = 0; k < rows.size(); ++k) stage.test.push_back(file_row(rows[k], results[k]));
    if (!a_case.friction_test->design.empty())
      add_design(stage, spec, area, a_case.friction_test->design.string());
  } else if (stage.calibration) {
    const auto rows = friction::read_friction_table(spec.calibration_data.string());
    for (std::size_t k = 0; k < rows.size(); ++k)
      stage.test.push_back(file_row(rows[k], stage.calibration->assumed.rows[k]));
  }
  stage.curve = curve_of(stage, spec, area);
  return stage;
}

WeavePictures weave_pictures(const mesoscale::CellSpec& spec) {
  const auto cell = mesoscale::unit_cell(mesoscale::fabric_geometry(spec), 0.0);
  WeavePictures pictures;
  // Large repeats take what a repeat of eight does, so that no picture outgrows a screen.
  const int tows = std::max(cell.weave.warps, cell.weave.wefts);
  pictures.height = mesoscale::height_field(cell, tows <= 2 ? 96 : std::min(32 * tows, 256));
  pictures.section = mesoscale::warp_cut(cell);
  pictures.bodies = mesoscale::tow_bodies(cell);
  return pictures;
}

CellBodies cell_bodies(const mesoscale::CellSpec& spec) {
  const auto cell = mesoscale::unit_cell(mesoscale::fabric_geometry(spec), 0.0);
  const int tows = std::max(cell.weave.warps, cell.weave.wefts);
  return {cell.weave.warps, mesoscale::tow_surfaces(cell, tows <= 8 ? 24 : 192 / tows),
          mesoscale::solid::cell_voxels(cell, tows <= 8 ? 32 : 256 / tows, 32)};
}

std::string blank_in_words(const macroscale::BlankSpec& blank) {
  switch (blank.shape) {
    case macroscale::BlankShape::rectangle:
      return fmt::format("{:g} x {:g} mm", 1e3 * blank.size[0], 1e3 * blank.size[1]);
    case macroscale::BlankShape::circle:
      return fmt::format("round {:g} mm", 2e3 * blank.radius);
    case macroscale::BlankShape::polygon:
      return fmt::format("{}-cornered {:.4g} cm2", blank.polygon.outer.size(),
                         1e4 * macroscale::area(macroscale::outline_of(blank)));
  }
  return "";
}

double mean_binder_pressure(const macroscale::StampingSpec& spec) {
  return spec.process.applied_binder_force() / macroscale::binder_face(spec).area;
}

}  // namespace heddle::pipeline
