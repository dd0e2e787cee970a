#include "macroscale/scene.h"

#include <cmath>

#include "macroscale/contact_points.h"

namespace heddle::macroscale {

double Scene::blank_temperature_at(double time) const {
  if (cooling_rate == 0.0) return blank_temperature;
  return tool_temperature + (blank_temperature - tool_temperature) * std::exp(-cooling_rate * time);
}

State initial_state(const Scene& scene) {
  State state;
  const int nodes = scene.blank.nodes();
  state.x = Eigen::VectorXd::Zero(scene.unknowns());
  state.v = Eigen::VectorXd::Zero(scene.unknowns());
  for (int i = 0; i < nodes; ++i) state.x.segment<3>(3 * i) = scene.blank.reference[i];
  state.tool_z.assign(scene.tools.size(), 0.0);
  state.corner_angle.assign(4 * scene.blank.quads.size(), 0.0);
  if (scene.shear_friction.on()) state.shear_memory.resize(state.corner_angle.size());
  state.memory.assign(scene.tools.size(),
                      std::vector<friction::ContactState>(contact_count(scene.blank, scene.contact_sites)));
  if (scene.blank.plies() > 1) state.memory.emplace_back(ply_points(scene.blank).size());
  state.heat = initial_heat(scene);
  return state;
}

std::vector<double> nodal_shear_angle(const Blank& blank, const std::vector<double>& corner_angle) {
  std::vector<double> sum(blank.nodes(), 0.0), weight(blank.nodes(), 0.0);
  for (std::size_t q = 0; q < blank.quads.size(); ++q) {
    const auto corners = corners_of(blank.quads[q]);
    for (std::size_t k = 0; k < 4; ++k) {
      sum[corners[k].node] += blank.share[q] * (corners[k].sign * corner_angle[4 * q + k]);
      weight[corners[k].node] += blank.share[q];
    }
  }
  for (std::size_t i = 0; i < sum.size(); ++i)
    if (weight[i] > 0.0) sum[i] /= weight[i];
  // Trellis angles turn their sign in a mirror, so those on either side of a plane cancel.
  if (blank.symmetry != Symmetry::none)
    for (int i = 0; i < blank.nodes(); ++i)
      if (on_plane(blank, i, 0) || on_plane(blank, i, 1)) sum[i] = 0.0;
  return sum;
}

}  // namespace heddle::macroscale
