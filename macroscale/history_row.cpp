#include "macroscale/history_row.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "macroscale/folds.h"
#include "macroscale/quality.h"
#include "macroscale/whole_blank.h"

namespace heddle::macroscale {

namespace {

constexpr int punch = 0;  // the first tool of a stamping

}  // namespace

void add_to_history(HistoryRow& row, const StepAccount& account, const Scene& scene) {
  const StepLedger& l = account.ledger;
  const double all = images(scene.blank.symmetry);  // rows are of the whole part
  std::array<double, 3> friction{}, force{};        // of punch, die, binder, as Role counts them
  for (std::size_t k = 0; k < scene.tools.size(); ++k) {
    const auto role = static_cast<std::size_t>(scene.tools[k].role);
    friction[role] += all * l.friction[k];
    force[role] += all * account.forces.on_tool[k].z();
  }
  row.work_punch += all * l.work_driven;
  row.work_binder += all * l.work_loaded;
  row.work_gravity += all * l.work_dead;
  row.energy_tow += all * l.tow;
  row.energy_shear += all * l.shear;
  row.energy_bending += all * l.bending;
  row.energy_twist += all * l.twist;
  row.energy_compaction += all * (l.compaction + l.compaction_plies);
  row.energy_kinetic += all * l.kinetic;
  row.energy_press += all * l.press;
  row.friction_punch += friction[0];
  row.friction_die += friction[1];
  row.friction_binder += friction[2];
  if (l.friction.size() > scene.tools.size()) row.friction_plies += all * l.friction.back();
  row.dissipation_shear_rate += all * l.shear_rate;
  row.dissipation_shear_hysteresis += all * l.shear_hysteresis;
  row.dissipation_tow_rate += all * l.tow_rate;
  row.dissipation_artefact += all * l.artefact;
  row.dissipation_numerical += all * l.numerical;
  row.ledger_residual = ledger_residual(row);
  row.friction_work_outside += all * l.friction_outside;
  row.punch_force = force[0];
  row.die_force = force[1];
  row.binder_force = force[2];
  row.force_balance = std::max(row.force_balance, all * account.forces.imbalance);
}

void finish_row(HistoryRow& row, const BlankState& blank, const State& state, const System& system) {
  const Scene& scene = system.scene();
  row.punch_displacement = -state.tool_z[punch];
  row.punch_deflection = system.pose(state, punch).z - state.tool_z[punch];
  row.binder_tilt = 0.0;
  for (std::size_t k = 0; k < scene.tools.size(); ++k)
    row.binder_tilt =
        std::max(row.binder_tilt, angle_of(scene.tools[k], system.pose(state, static_cast<int>(k))));
  measure_blank(row, blank, state, scene);
  if (scene.heat) row.heat = heat_row(scene, state.heat, state.time);
}

void measure_blank(HistoryRow& row, const BlankState& blank, const State& state, const Scene& scene) {
  row.time = state.time;
  row.draw_in_max = largest_draw_in(scene.blank, state);
  row.shear_angle_max = 0.0;
  for (double angle : blank.shear_angle) row.shear_angle_max = std::max(row.shear_angle_max, std::abs(angle));
  row.tow_strain_max = 0.0;
  for (const auto& strain : blank.tow_strain)
    row.tow_strain_max = std::max({row.tow_strain_max, strain[0], strain[1]});
  const double thickness = scene.fabric->thickness;
  const Folds folds = blank.symmetry == Symmetry::none ? find_folds(blank, thickness)
                                                       : find_folds(whole_of(blank).state, thickness);
  row.folded_nodes = folds.folded;
  row.near_nodes = folds.near;
  row.self_crossings = folds.crossings;
}

}  // namespace heddle::macroscale
