#include "macroscale/stack.h"

#include <algorithm>
#include <cmath>

namespace heddle::macroscale {

void add_ply_fields(const System& system, const State& state, const StepData* step, BlankState& blank) {
  blank.ply_slip.assign(blank.position.size(), 0.0);
  blank.ply_pressure.assign(blank.position.size(), 0.0);
  const auto& points = system.ply_points();
  // Faces of cells are among them once the sheet has met itself.
  const auto& memory = state.memory.back();
  for (std::size_t k = 0; k < memory.size(); ++k) {
    const bool paired = step && k < step->pairs.size();
    const double slip = memory[k].slip,
                 pressure = paired ? system.contact_of_plies(step->pairs[k], state.x).pressure : 0.0;
    for (const int node : blank.quads[static_cast<std::size_t>(points[k].quad)]) {
      const auto n = static_cast<std::size_t>(node);
      blank.ply_slip[n] = std::max(blank.ply_slip[n], slip);
      blank.ply_pressure[n] = std::max(blank.ply_pressure[n], pressure);
    }
  }
}

double pairing_share(const StampingCheckpoint& at) {
  const bool driven = !at.history.empty() && at.history.back().work_punch > 0.0;
  return driven ? at.pairing / at.history.back().work_punch : 0.0;
}

StackSummary stack_summary(const Blank& blank, const StampingCheckpoint& at) {
  StackSummary s;
  s.patterns = at.patterns;
  s.pairing_share = pairing_share(at);
  for (int k = 0; k < blank.plies(); ++k) {
    PlySummary& ply = s.plies.emplace_back();
    ply.orientation = std::atan2(blank.ply(k).warp[1], blank.ply(k).warp[0]);
    const PlyRange& range = at.blank.plies.at(static_cast<std::size_t>(k));
    for (int n = range.first_node; n < range.end_node; ++n)
      ply.shear_angle_max = std::max(ply.shear_angle_max, std::abs(at.blank.shear_angle[n]));
    for (int e = range.first_edge; e < range.end_edge; ++e)
      ply.draw_in_max = std::max(ply.draw_in_max, at.blank.edge[e].draw_in);
  }
  s.interfaces.resize(s.plies.size() - 1);
  std::vector<double> area(s.interfaces.size(), 0.0);
  const std::vector<PlyPoint> points = ply_points(blank);
  for (std::size_t k = 0; k < points.size(); ++k) {
    const auto lower = static_cast<std::size_t>(interface_of(points[k]));
    const double slip = at.state.memory.back().at(k).slip;
    const double weight =
        blank.share[points[k].quad] * blank.ply(blank.ply_of_quad(points[k].quad)).corner_area();
    InterfaceSummary& between = s.interfaces[lower];
    between.slip_max = std::max(between.slip_max, slip);
    between.slip_mean += weight * slip;
    area[lower] += weight;
  }
  for (std::size_t k = 0; k < area.size(); ++k) s.interfaces[k].slip_mean /= area[k];
  return s;
}

}  // namespace heddle::macroscale
