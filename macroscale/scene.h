#pragma once

#include <array>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "friction/model.h"
#include "macroscale/blank.h"
#include "macroscale/contact.h"
#include "macroscale/fabric_effects.h"
#include "macroscale/ply_contact.h"
#include "macroscale/shear_friction.h"
#include "macroscale/stamping.h"
#include "macroscale/thermal/blank_heat.h"
#include "macroscale/tools.h"
#include "mesoscale/fabric_properties.h"

namespace heddle::macroscale {

/// Distance of the middles of two plies that do not press each other [m].
inline double ply_rest(const mesoscale::FabricProperties& fabric, double nesting) {
  return fabric.facing.empty() ? fabric.thickness - nesting : fabric.facing.rest;
}
/// What each of two faces of plies that press each other gives way.
inline const Curve& ply_compaction(const mesoscale::FabricProperties& fabric) {
  return fabric.facing.empty() ? fabric.compaction.curves().front() : fabric.facing.compaction;
}

/// Everything that does not change while the clock runs: blank, tools, laws, supports and loads.
struct Scene {
  Blank blank;
  const mesoscale::FabricProperties* fabric = nullptr;
  /// Of all tools without a law of their own, between plies and of a sheet that touches itself; null =
  /// frictionless everywhere.
  const friction::Model* friction = nullptr;
  bool plies_rub = true;      ///< whether the same law acts between plies
  bool self_contact = false;  ///< whether a ply that folds touches itself
  double nesting = 0.0;       ///< how much nearer than a thickness two plies lie unpressed [m]
  std::vector<Tool> tools;

  std::vector<char> held;    ///< per unknown 3 i + c: 1 = its position is prescribed; empty = all free
  std::vector<double> load;  ///< dead force per unknown [N]; empty = none

  double blank_temperature = 453.15;  ///< [K]
  double tool_temperature = 358.15;   ///< [K]
  double cooling_rate = 0.0;          ///< of the blank towards its tools [1/s]; 0 = one temperature a run
  double slip_smoothing = 1e-5;       ///< eps_v [m/s]
  double mass_scaling = 1.0;          ///< artefact; 1 = true mass
  double stabilisation = 0.0;         ///< artefact [N s/m^3]
  double shear_rate = 1.0;            ///< factor on the rate-dependent shear resistance; 0 is off
  ShearFriction shear_friction;       ///< between tows; off by default
  FabricEffects effects;              ///< of what the fabric's numbers alone do not hold; off by default
  Surface coupling;                   ///< coupling_of(effects.tension_coupling, ...); empty: off
  ContactPressure contact_pressure = ContactPressure::real;
  ContactSites contact_sites = ContactSites::nodes;
  bool compaction_follows_shear = false;  ///< else the table of gamma = 0 on initial areas
  std::optional<HeatModel> heat;          ///< absent: one temperature a run

  int unknowns_of_tools() const {
    int n = 0;
    for (const Tool& tool : tools) n += unknowns_of(tool);
    return n;
  }
  /// Distance of the middles of two plies that do not press each other [m].
  double ply_rest() const { return macroscale::ply_rest(*fabric, nesting); }
  int unknowns() const { return 3 * blank.nodes() + unknowns_of_tools(); }
  /// Temperature of a blank without `heat`, a time after the punch has touched [K]:
  /// T_tool + (T_blank - T_tool) exp(-rate t).
  double blank_temperature_at(double time) const;
};

/// Where everything is at one instant. Unknowns: 3 a node (x, y, z), then those of each tool: z of a loaded
/// one (and its lifts where it tilts), how far a sprung one stays behind.
struct State {
  double time = 0.0;           ///< [s]
  Eigen::VectorXd x;           ///< positions [m]
  Eigen::VectorXd v;           ///< velocities [m/s]
  std::vector<double> tool_z;  ///< displacement of each tool along z; of a sprung tool that of its drive [m]
  std::vector<double> corner_angle;       ///< gamma of each corner, 4 a quad [rad]
  std::vector<ShearMemory> shear_memory;  ///< of each corner; empty: no friction between tows
  /// Per tool, per contact point; behind the tools, in a blank of several plies or one that has met itself,
  /// per ply point: those between plies, and the faces of all cells once one has met another part.
  std::vector<std::vector<friction::ContactState>> memory;
  PlyCoupling coupling;  ///< pattern of the matrix between plies, which a run that is resumed must share
  BlankHeat heat;        ///< empty: one temperature a run

  Eigen::Vector3d node(int i) const { return x.segment<3>(3 * i); }
};

/// What a corner remembers of its shear, or null where tows do not rub.
inline const ShearMemory* shear_memory(const State& state, std::size_t corner) {
  return state.shear_memory.empty() ? nullptr : &state.shear_memory[corner];
}

/// The blank at rest in its reference position, tools where their shapes say.
State initial_state(const Scene& scene);

/// Trellis angle averaged at the nodes by the area of the corners that meet there, signed in tow axes [rad].
std::vector<double> nodal_shear_angle(const Blank& blank, const std::vector<double>& corner_angle);

}  // namespace heddle::macroscale
