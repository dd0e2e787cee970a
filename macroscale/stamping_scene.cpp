#include "macroscale/stamping_scene.h"

#include <algorithm>

#include "macroscale/contact.h"
#include "macroscale/punch_profile.h"
#include "macroscale/tool_set.h"

namespace heddle::macroscale {

namespace {

// Of one face, by the binder's pressure on its flat part [m].
double approach_under_binder(const StampingSpec& spec, const mesoscale::FabricProperties& fabric) {
  const double pressure = spec.process.binder_force / binder_area(spec);
  return approach_at(fabric.compaction.curves().front(), pressure);
}

}  // namespace

Blank stamping_blank(const StampingSpec& spec, const mesoscale::FabricProperties& fabric) {
  const BlankSpec& blank = spec.blank;
  if (blank.plies == 1) return make_blank(outline_of(blank), blank.spacing, blank.orientation);
  const double apart = fabric.thickness - blank.nesting - 2.0 * approach_under_binder(spec, fabric);
  std::vector<Blank> plies;
  for (int k = 0; k < blank.plies; ++k) {
    const double turned = blank.layup.empty() ? 0.0 : blank.layup[static_cast<std::size_t>(k)];
    plies.push_back(make_blank(outline_of(blank), blank.spacing, blank.orientation + turned,
                               (k - 0.5 * (blank.plies - 1)) * apart));
  }
  return stacked(std::move(plies));
}

// Die and binder stand where they have closed on a flat blank, so that its middle is at z = 0 and the punch
// touches it at t = 0 whatever the binder force. In the opening nothing presses the plies: there the stack
// rises to its rest.
Scene stamping_scene(const StampingSpec& spec, const mesoscale::FabricProperties& fabric,
                     const friction::Model& friction) {
  Scene scene;
  scene.blank = stamping_blank(spec, fabric);
  scene.nesting = spec.blank.nesting;
  scene.fabric = &fabric;
  scene.friction = &friction;
  const double half = 0.5 * fabric.thickness;
  const TouchingTools tools = touching_tools(spec);
  const double approach = approach_under_binder(spec, fabric);
  const double outer = 0.5 * (spec.blank.plies - 1);  // from the stack's middle to that of its outer plies
  const double closed = half - approach + outer * (scene.ply_rest() - 2.0 * approach);
  const double at_rest = half + outer * scene.ply_rest();
  scene.tools = {{Role::punch, raised(tools.punch, at_rest), Motion::driven, 0.0, 0.0},
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
  scene.contact_pressure = spec.contact_pressure;
  scene.contact_sites = spec.contact_sites;
  scene.compaction_follows_shear = spec.compaction_follows_shear;
  if (spec.thermal) scene.heat = heat_model(*spec.thermal, fabric.areal_density, scene.blank_temperature);
  return scene;
}

}  // namespace heddle::macroscale
