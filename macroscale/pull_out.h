#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "friction/model.h"
#include "friction/rig/curved_plates.h"
#include "macroscale/stamping.h"
#include "mesoscale/fabric_properties.h"

namespace heddle::macroscale {

/// The paper's friction test (Figure 1) through the finite elements: a sample lies between a fixed plate and
/// a plate under a held load, and its leading edge is drawn out at constant speed.
struct PullOutSpec {
  std::array<double, 2> size{0.1, 0.1};       ///< between the plates, along the pull and across [m]
  double spacing = 10e-3;                     ///< upper bound of the node spacing [m]
  double orientation = 0.0;                   ///< warp against the pull [rad]
  std::optional<friction::SCurve> bend = {};  ///< of the plates, in the middle of the sample; absent: flat
  double normal_force = 1500.0;               ///< N [N]
  double speed = 16.67e-3;                    ///< U [m/s]
  double travel = 2e-3;                       ///< pulled before the force is read [m]
  int steps = 20;
  double plate_mass = 5.0;             ///< of the loaded plate [kg]
  double tool_temperature = 358.15;    ///< [K]
  double fabric_temperature = 453.15;  ///< [K]
  ContactPressure contact_pressure = ContactPressure::real;
  ContactSites contact_sites = ContactSites::nodes;
  friction::ContactState memory{};  ///< of every contact when the pull begins
};

struct PullOutResult {
  bool completed = false;
  std::string failure;
  std::vector<double> travel;    ///< [m]
  std::vector<double> force;     ///< on the leading edge, along the pull [N]
  double steady_force = 0.0;     ///< of the last step [N]
  double pressure_spread = 0.0;  ///< largest relative deviation of nodal pressure from N / area [-]
  double shear_angle_max = 0.0;  ///< in the sample at the end [rad]
  /// The last step, node by node, row by row along the pull; of a sample along its tows these rows are grid
  /// lines.
  int nu = 0, nv = 0;                                  ///< cells along and across
  std::vector<double> lower_pressure, upper_pressure;  ///< [Pa]
};

PullOutResult run_pull_out(const PullOutSpec& spec, const mesoscale::FabricProperties& fabric,
                           const friction::Model& friction);

}  // namespace heddle::macroscale
