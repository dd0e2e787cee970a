#include "macroscale/stamping_scene.h"

#include <algorithm>

#include "macroscale/contact.h"
#include "macroscale/punch_profile.h"
#include "macroscale/tool_set.h"

namespace heddle::macroscale {

// Die and binder stand where they have closed on a flat blank, so that its midplane is at z = 0 and the punch
// touches it at t = 0 whatever the binder force.
Scene stamping_scene(const StampingSpec& spec, const mesoscale::FabricProperties& fabric,
                     const friction::Model& friction) {
  Scene scene;
  scene.blank = make_blank(outline_of(spec.blank), spec.blank.spacing, spec.blank.orientation);
  scene.fabric = &fabric;
  scene.friction = &friction;
  const double half = 0.5 * fabric.thickness;
  const TouchingTools tools = touching_tools(spec);
  const double pressure = spec.process.binder_force / binder_area(spec);
  const double closed = half - approach_at(fabric.compaction.curves().front(), pressure);
  scene.tools = {{Role::punch, raised(tools.punch, half), Motion::driven, 0.0, 0.0},
                 {Role::die, raised(tools.die, -closed), Motion::fixed, 0.0, 0.0},
                 {Role::binder, raised(tools.binder, closed), Motion::loaded, spec.process.binder_force,
                  spec.binder.mass}};
  scene.blank_temperature = spec.process.blank_temperature;
  scene.tool_temperature = spec.process.tool_temperature;
  // Smoothing follows the punch speed, so a rate-free law stays rate-free; creep while sticking is below
  // 2e-4 of the stroke.
  scene.slip_smoothing = std::max(2e-4 * mean_speed(spec.process), 1e-6);
  scene.mass_scaling = spec.artefact.mass_scaling;
  scene.stabilisation = spec.artefact.stabilisation;
  scene.shear_rate = spec.shear_rate;
  scene.shear_friction = spec.shear_friction;
  scene.contact_pressure = spec.contact_pressure;
  scene.contact_sites = spec.contact_sites;
  scene.compaction_follows_shear = spec.compaction_follows_shear;
  if (spec.thermal) scene.heat = heat_model(*spec.thermal, fabric.areal_density, scene.blank_temperature);
  return scene;
}

}  // namespace heddle::macroscale
