#include "macroscale/stamping_scene.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <Eigen/Geometry>

#include "macroscale/closing.h"
#include "macroscale/contact.h"
#include "macroscale/punch_profile.h"
#include "macroscale/symmetric_piece.h"
#include "macroscale/tool_set.h"

namespace heddle::macroscale {

namespace {

using Eigen::Vector3d;

// A press that yields at a force without giving way below it: as stiff as a frame can be told from rigid.
constexpr double rigid_compliance = 1e-9;  // [m/N]

Tool punch_of(const PressSpec& press, const Shape& shape) {
  if (press.compliance == 0.0 && press.force_limit == 0.0)
    return {Role::punch, shape, Motion::driven, 0.0, 0.0};
  Tool punch{Role::punch, shape, Motion::sprung, 0.0, 0.0};
  punch.stiffness = 1.0 / std::max(press.compliance, press.force_limit > 0.0 ? rigid_compliance : 0.0);
  punch.yield = press.force_limit;
  return punch;
}

// About the punch's axis, at the height of the binder's face.
std::optional<Turn> tilt_of(const PressSpec& press, double face) {
  if (press.binder_tilt == 0.0) return {};
  const Vector3d axis(std::cos(press.binder_tilt_axis), std::sin(press.binder_tilt_axis), 0.0);
  return Turn{Eigen::AngleAxisd(press.binder_tilt, axis).toRotationMatrix(), Vector3d(0.0, 0.0, face)};
}

// Equal sectors, the first one about the x axis: the symmetries of the square stay those of four and eight.
Shape sector(const StampingSpec& spec, int k, double face) {
  const double width = 2.0 * std::numbers::pi / spec.binder.sectors;
  return SectorShape{face, spec.binder.inner_radius, spec.binder.edge_fillet, (k - 0.5) * width,
                     (k + 0.5) * width};
}

std::vector<Tool> binders_of(const StampingSpec& spec, const Shape& whole, double face, double weight) {
  const BinderSpec& binder = spec.binder;
  const double share = 1.0 / binder.sectors;
  std::vector<Tool> tools;
  for (int k = 0; k < binder.sectors; ++k) {
    Tool tool{Role::binder,        binder.sectors > 1 ? sector(spec, k, face) : raised(whole, face),
              Motion::loaded,      share * spec.process.applied_binder_force(),
              share * binder.mass, share * weight};
    if (binder.control == BinderControl::gap) tool = {Role::binder, tool.shape, Motion::fixed};
    if (tool.motion == Motion::loaded) tool.stiffness = share * binder.stiffness;
    tool.turn = tilt_of(spec.process.press, face);
    if (binder.free_tilt && tool.motion == Motion::loaded)
      tool.tilt = Tilt{Vector3d(0.0, 0.0, face), binder_face(spec).arm};
    tools.push_back(tool);
  }
  return tools;
}

// How far the closed binder presses each face of each ply [m]: those at the tools, and those of plies at each
// other.
struct ClosedApproach {
  double tools = 0.0, plies = 0.0;
};

// The stack fills the gap, or carries the force.
ClosedApproach closed_approach(const StampingSpec& spec, const mesoscale::FabricProperties& fabric,
                               double weight) {
  const Curve &at_tools = fabric.compaction.curves().front(), &between = ply_compaction(fabric);
  const auto under = [&](double pressure) -> ClosedApproach {
    return {approach_at(at_tools, pressure), approach_at(between, pressure)};
  };
  if (spec.binder.control != BinderControl::gap)
    return under((spec.process.applied_binder_force() + weight) / binder_face(spec).area);
  if (fabric.facing.empty()) {  // all faces alike
    const double each =
        (stack_thickness(spec.blank, fabric.thickness) - spec.binder.gap) / (2.0 * spec.blank.plies);
    return {each, each};
  }
  // The pressure under which all faces together give way by so much. What no pressure of the tables gives, a
  // gap wider than the stack or narrower than all tables, falls on all faces alike.
  const int interfaces = spec.blank.plies - 1;
  const double closing =
      fabric.thickness + interfaces * ply_rest(fabric, spec.blank.nesting) - spec.binder.gap;
  const auto given = [&](const ClosedApproach& approach) {
    return 2.0 * (approach.tools + interfaces * approach.plies);
  };
  constexpr double beyond_any_table = 1e9;  // [Pa]
  double low = 0.0, high = beyond_any_table;
  for (int k = 0; k < 100; ++k) {
    const double middle = 0.5 * (low + high);
    (given(under(middle)) < closing ? low : high) = middle;
  }
  const ClosedApproach found = under(low);
  const double rest = (closing - given(found)) / (2.0 * spec.blank.plies);
  return {found.tools + rest, found.plies + rest};
}

std::optional<double> friction_coefficient_of(const StampingSpec& spec, Role role) {
  switch (role) {
    case Role::punch:
      return spec.punch.friction_coefficient;
    case Role::die:
      return spec.die.friction_coefficient;
    case Role::binder:
      return spec.binder.friction_coefficient;
  }
  return {};
}

double binder_weight(const StampingSpec& spec) {
  return spec.process.press.gravity ? standard_gravity * spec.binder.mass : 0.0;
}

}  // namespace

Blank stamping_blank(const StampingSpec& spec, const mesoscale::FabricProperties& fabric) {
  const BlankSpec& blank = spec.blank;
  if (blank.plies == 1)
    return turned(make_blank(outline_of(blank), blank.spacing, blank.orientation, 0.0, blank.symmetry),
                  blank.turned);
  const double apart =
      ply_rest(fabric, blank.nesting) - 2.0 * closed_approach(spec, fabric, binder_weight(spec)).plies;
  std::vector<Blank> plies;
  for (int k = 0; k < blank.plies; ++k) {
    const double of_ply = blank.layup.empty() ? 0.0 : blank.layup[static_cast<std::size_t>(k)];
    plies.push_back(make_blank(outline_of(blank), blank.spacing, blank.orientation + of_ply,
                               (k - 0.5 * (blank.plies - 1)) * apart));
  }
  return turned(stacked(std::move(plies)), blank.turned);
}

// Die and binder stand where they have closed on a flat blank, so that its middle is at z = 0 and the punch
// touches it at t = 0 whatever the binder force. In the opening nothing presses the plies: there the stack
// rises to its rest.
Scene stamping_scene(const StampingSpec& spec, const mesoscale::FabricProperties& fabric,
                     const friction::Model& friction) {
  Scene scene;
  scene.blank = stamping_blank(spec, fabric);
  scene.nesting = spec.blank.nesting;
  scene.self_contact = spec.self_contact;
  scene.fabric = &fabric;
  scene.friction = &friction;
  const PressSpec& press = spec.process.press;
  const double half = 0.5 * fabric.thickness;
  const TouchingTools tools = touching_tools(spec);
  const double weight = binder_weight(spec);
  const ClosedApproach approach = closed_approach(spec, fabric, weight);
  const double outer = 0.5 * (spec.blank.plies - 1);  // from the stack's middle to that of its outer plies
  const double closed = half - approach.tools + outer * (scene.ply_rest() - 2.0 * approach.plies);
  const double at_rest = half + outer * scene.ply_rest();
  scene.tools = {punch_of(press, raised(tools.punch, at_rest)),
                 {Role::die, raised(tools.die, -closed), Motion::fixed, 0.0, 0.0}};
  if (spec.die.bottom == DieBottom::flat)
    scene.tools.push_back(
        {Role::die, PlaneShape{Vector3d(0.0, 0.0, -closed - spec.die.depth)}, Motion::fixed, 0.0, 0.0});
  for (Tool& binder : binders_of(spec, tools.binder, closed, weight))
    scene.tools.push_back(std::move(binder));
  for (Tool& tool : scene.tools)
    if (const auto coefficient = friction_coefficient_of(spec, tool.role)) {
      tool.friction.emplace();
      tool.friction->law = friction::Coulomb{*coefficient};
    }
  take_share(scene.tools, spec.blank.symmetry);
  scene.held = held_by_planes(scene.blank);
  if (press.gravity) scene.load = weight_of_fabric(scene);
  scene.blank_temperature = spec.process.blank_temperature;
  scene.tool_temperature = spec.process.tool_temperature;
  scene.cooling_rate = spec.process.cooling_rate;
  // Smoothing follows the punch speed, so a rate-free law stays rate-free; creep while sticking is below
  // 2e-4 of the stroke.
  scene.slip_smoothing = std::max(2e-4 * mean_speed(spec.process), 1e-6);
  scene.mass_scaling = spec.artefact.mass_scaling;
  scene.stabilisation = spec.artefact.stabilisation;
  scene.shear_rate = spec.shear_rate;
  scene.shear_friction = spec.shear_friction;
  scene.effects = spec.effects;
  scene.coupling = coupling_of(spec.effects.tension_coupling, fabric.tension_energy);
  scene.contact_pressure = spec.contact_pressure;
  scene.contact_sites = spec.contact_sites;
  scene.compaction_follows_shear = spec.compaction_follows_shear;
  if (spec.thermal) scene.heat = heat_model(*spec.thermal, fabric.areal_density, scene.blank_temperature);
  return scene;
}

StateSizes state_sizes(const StampingSpec& spec) {
  const PressSpec& press = spec.process.press;
  const bool sprung = press.compliance > 0.0 || press.force_limit > 0.0;
  const bool loaded = spec.binder.control == BinderControl::force;
  const int of_binder = loaded ? spec.binder.sectors + (spec.binder.free_tilt ? 2 : 0) : 0;
  const int dies = spec.die.bottom == DieBottom::flat ? 2 : 1;
  return {1 + dies + spec.binder.sectors, (sprung ? 1 : 0) + of_binder, spec.self_contact};
}

}  // namespace heddle::macroscale
