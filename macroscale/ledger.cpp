#include "macroscale/ledger.h"

#include <numeric>

#include "macroscale/tool_drive.h"

namespace heddle::macroscale {

namespace {

using Eigen::Vector3d;

struct Increment {
  double stored = 0.0;  ///< change of energy
  double work =
      0.0;  ///< end-of-step force times increment; the excess over `stored` is numerical dissipation
};

struct CornerIncrements {
  Increment tow, shear;
  double rate = 0.0, tow_rate = 0.0;
  double hysteresis = 0.0;
};

CornerIncrements corner_increments(const System& system, const StepData& step, const State& end) {
  const Blank& blank = system.scene().blank;
  const State& start = *step.start;
  const std::vector<CornerLaw> laws = system.corner_laws(step);
  CornerIncrements sum;
  for (std::size_t q = 0; q < blank.quads.size(); ++q) {
    const auto corners = corners_of(blank.quads[q]);
    CornerLaw here = trimmed(laws[blank.ply_of_quad(static_cast<int>(q))], blank.share[q]);
    here.rate_consistency *= system.rate_factor(step, q);
    here.shear_factor = system.shear_factor(step, q);
    for (std::size_t k = 0; k < 4; ++k) {
      const Corner& c = corners[k];
      const double before = start.corner_angle[4 * q + k];
      here.memory = shear_memory(start, 4 * q + k);
      if (here.tow_viscosity > 0.0) here.strain_before = system.strain_before(step, c, here);
      const Vector3d a0 = start.node(c.along_warp) - start.node(c.node),
                     b0 = start.node(c.along_weft) - start.node(c.node);
      const Vector3d a = end.node(c.along_warp) - end.node(c.node),
                     b = end.node(c.along_weft) - end.node(c.node);
      const CornerEnergy e0 = corner_energy(here, a0, b0, before), e = corner_energy(here, a, b, before);
      const CornerGradient g = corner_gradient(here, a, b, before);
      sum.tow.stored += e.tension - e0.tension;
      // The shear energy of a step holds what its tows rubbed away.
      const double rubbed = here.memory ? here.area * here.shear_factor *
                                              dissipated_by_tows(here.friction, here.fabric->shear_stress,
                                                                 *here.memory, end.shear_memory[4 * q + k])
                                        : 0.0;
      sum.hysteresis += rubbed;
      sum.shear.stored += e.shear - e0.shear - rubbed;
      sum.tow.work += g.tension_a.dot(a - a0) + g.tension_b.dot(b - b0);
      sum.shear.work += g.shear_a.dot(a - a0) + g.shear_b.dot(b - b0);
      sum.rate += g.rate_a.dot(a - a0) + g.rate_b.dot(b - b0);
      sum.tow_rate += g.tow_rate_a.dot(a - a0) + g.tow_rate_b.dot(b - b0);
    }
  }
  return sum;
}

// 1/2 k (|d1|^2 - |d0|^2) and k d1.(d1 - d0).
Increment quadratic(double stiffness, const Vector3d& before, const Vector3d& after) {
  return {0.5 * stiffness * (after.squaredNorm() - before.squaredNorm()),
          stiffness * after.dot(after - before)};
}

void add(Increment& sum, const Increment& part) {
  sum.stored += part.stored;
  sum.work += part.work;
}

Increment bending_increment(const System& system, const State& start, const State& end) {
  Increment sum;
  for (const TowTriple& t : system.scene().blank.triples) {
    const auto difference = [&](const State& s) -> Vector3d {
      return s.node(t.before) - 2.0 * s.node(t.middle) + s.node(t.after);
    };
    add(sum, quadratic(system.bending_stiffness(t), difference(start), difference(end)));
  }
  for (const MirroredTriple& t : system.scene().blank.mirrored) {
    const auto difference = [&](const State& s) {
      Vector3d apart = 2.0 * (s.node(t.beside) - s.node(t.middle));
      apart[t.axis] = 0.0;
      return apart;
    };
    add(sum, quadratic(system.bending_stiffness(t), difference(start), difference(end)));
  }
  return sum;
}

Increment twist_increment(const System& system, const State& start, const State& end) {
  Increment sum;
  const auto& quads = system.scene().blank.quads;
  for (int quad = 0; quad < static_cast<int>(quads.size()); ++quad) {
    const auto& q = quads[quad];
    const auto twist = [&](const State& s) -> Vector3d {
      return s.node(q[0]) - s.node(q[1]) + s.node(q[2]) - s.node(q[3]);
    };
    add(sum, quadratic(system.twist_stiffness(quad), twist(start), twist(end)));
  }
  return sum;
}

Vector3d unknowns(const Pose& pose) {
  return {pose.z, pose.lift[0], pose.lift[1]};
}

// Work on a tool with an unknown of its own, and what its spring took.
void add_drive(const System& system, const State& start, const State& end, int k, StepLedger& ledger) {
  const Tool& tool = system.scene().tools[k];
  const double u0 = start.x[system.unknown_of(k)], u1 = end.x[system.unknown_of(k)];
  const Drive before = drive_at(tool, u0), after = drive_at(tool, u1);
  const double stored = after.spring_energy - before.spring_energy;
  ledger.press += stored;
  ledger.numerical += after.spring_force * (u1 - u0) - stored;
  for (int u = 1; u < unknowns_of(tool); ++u) {
    const double l0 = start.x[system.unknown_of(k) + u], l1 = end.x[system.unknown_of(k) + u];
    const double stored_by_lift = tilt_drive_at(tool, l1).energy - tilt_drive_at(tool, l0).energy;
    ledger.press += stored_by_lift;
    ledger.numerical += tilt_drive_at(tool, l1).force * (l1 - l0) - stored_by_lift;
  }
  if (tool.motion == Motion::sprung) {
    ledger.work_driven -= after.spring_force * (end.tool_z[k] - start.tool_z[k]);
  } else {
    ledger.work_loaded -= tool.force * (u1 - u0);
    ledger.work_dead -= tool.weight * (u1 - u0);
  }
}

// What is stored between plies follows from positions alone: from where they meet at the start, and where
// they meet at the end. Forces of the step know the first only; the difference stands with the numerical
// dissipation.
void account_plies(const System& system, const StepData& step, const State& end, StepLedger& ledger) {
  // A sheet that had no other part within reach at the start does not touch one at the end (passage_of).
  if (step.pairs.empty()) return;
  const Scene& scene = system.scene();
  const State& start = *step.start;
  const int row = static_cast<int>(scene.tools.size());
  const FrictionSettings settings = system.friction_settings(row);
  Increment held;
  double rubbed = 0.0, met = 0.0;
  for (std::size_t k = 0; k < step.pairs.size(); ++k) {
    const PlyPair& pair = step.pairs[k];
    if (pair.quad < 0) continue;
    const NormalContact c0 = system.contact_of_plies(pair, start.x), c = system.contact_of_plies(pair, end.x);
    held.stored += pair.area * (c.energy - c0.energy);
    held.work -= pair.area * c.pressure * (gap(pair, end.x) - gap(pair, start.x));
    met -= pair.area * c.energy;
    if (!system.rubs(step, row) || step.friction[row][k].load == 0.0) continue;
    const FrictionPoint& point = step.friction[row][k];
    const Vector3d v = system.velocity_in_row(step, end.x, row, static_cast<int>(k));
    const double work = friction_force(settings, point, v).dot(v) * step.dt;
    rubbed += work;
    friction::Context context = point.context;
    context.slip_speed = slip_velocity(point, v).norm();
    if (!settings.model->box.contains(context, law_at(settings, point, context.slip_speed).hersey))
      ledger.friction_outside += work;
  }
  for (const PlyPair& pair : system.pairs_at(end.x))
    met += pair.area * system.contact_of_plies(pair, end.x).energy;
  ledger.friction.push_back(rubbed);
  ledger.compaction_plies = held.stored + met;
  ledger.pairing = -met;
  ledger.numerical += held.work - ledger.compaction_plies;
}

}  // namespace

double StepLedger::dissipated() const {
  return std::accumulate(friction.begin(), friction.end(), 0.0) + shear_rate + shear_hysteresis + tow_rate +
         artefact + numerical;
}

StepAccount account(const System& system, const StepData& step, const State& end) {
  const Scene& scene = system.scene();
  const Blank& blank = scene.blank;
  const State& start = *step.start;
  StepAccount result;
  StepLedger& ledger = result.ledger;

  const CornerIncrements corner = corner_increments(system, step, end);
  const Increment bending = bending_increment(system, start, end),
                  twist = twist_increment(system, start, end);
  ledger.tow = corner.tow.stored;
  ledger.shear = corner.shear.stored;
  ledger.shear_rate = corner.rate;
  ledger.shear_hysteresis = corner.hysteresis;
  ledger.tow_rate = corner.tow_rate;
  ledger.bending = bending.stored;
  ledger.twist = twist.stored;
  ledger.numerical += corner.tow.work - corner.tow.stored + corner.shear.work - corner.shear.stored;
  ledger.numerical -= corner.hysteresis;
  ledger.numerical += bending.work - bending.stored + twist.work - twist.stored;

  Vector3d momentum_rate = Vector3d::Zero();
  for (int k = 0; k < scene.unknowns(); ++k) {
    const double v0 = start.v[k], v1 = end.v[k], m = system.mass(k);
    ledger.kinetic += 0.5 * m * (v1 * v1 - v0 * v0);
    ledger.numerical += 0.5 * m * (v1 - v0) * (v1 - v0);
    if (k < 3 * blank.nodes()) momentum_rate[k % 3] += m * (v1 - v0) / step.dt;
  }

  Vector3d on_blank = Vector3d::Zero();
  Increment compaction;
  // Compaction holds the trellis angle of the start; what is stored in the end is of the angle reached. The
  // difference is work that shear does or takes and that no force of the step knows: it stands with the
  // numerical dissipation.
  StepData reached;
  if (!step.contact_shear.empty())
    reached.contact_shear = contact_shear_angle(blank, scene.contact_sites, end.corner_angle);
  const auto added_by_shear = [&](const Vector3d& x, int k, int i, double held) {
    if (reached.contact_shear.empty()) return 0.0;
    return system.contact_area(reached, i) *
               system.contact_at(reached, x, k, i, system.pose(end, k)).normal.energy -
           held;
  };
  const bool rubs = scene.friction && !step.frictionless;
  for (int k = 0; k < static_cast<int>(scene.tools.size()); ++k) {
    Vector3d on_tool = Vector3d::Zero();
    double rubbed = 0.0;
    const FrictionSettings settings = system.friction_settings(k);
    const Tool& tool = scene.tools[k];
    const Pose before = system.pose(start, k), after = system.pose(end, k);
    for (int i = 0; i < system.contacts(); ++i) {
      const double area = system.contact_area(step, i);
      const ContactPoint& at = system.contact_points()[i];
      const Vector3d x0 = at_point(at, start.x), x1 = at_point(at, end.x);
      const Vector3d step_of_point = x1 - x0 - carried(tool, before, after, x0);
      const NormalContact c0 = system.contact_at(step, x0, k, i, before).normal;
      const auto [d, c] = system.contact_at(step, x1, k, i, after);
      Vector3d gradient = -area * c.pressure * d.normal;
      compaction.stored += area * (c.energy - c0.energy) + added_by_shear(x1, k, i, area * c.energy);
      compaction.work +=
          tool.tilt
              ? gradient.dot(x1 - x0) -
                    area * c.pressure *
                        slopes_at(*tool.tilt, after, x1, d.normal).dot(unknowns(after) - unknowns(before))
              : gradient.dot(step_of_point);
      if (rubs && step.friction[k][i].load > 0.0) {
        const FrictionPoint& point = step.friction[k][i];
        const Vector3d v = step_of_point / step.dt;
        const Vector3d drag = friction_force(settings, point, v);
        const double work = drag.dot(step_of_point);
        rubbed += work;
        const double hersey = law_at(settings, point, slip_velocity(point, v).norm()).hersey;
        friction::Context context = point.context;
        context.slip_speed = slip_velocity(point, v).norm();
        if (!settings.model->box.contains(context, hersey)) ledger.friction_outside += work;
        gradient += drag;
      }
      on_tool += gradient;
    }
    ledger.friction.push_back(rubbed);
    result.forces.on_tool.push_back(on_tool);
    on_blank -= on_tool;
    if (tool.motion == Motion::driven) ledger.work_driven -= on_tool.z() * (after.z - before.z);
    if (has_unknown(tool)) add_drive(system, start, end, k, ledger);
  }
  ledger.compaction = compaction.stored;
  ledger.numerical += compaction.work - compaction.stored;
  account_plies(system, step, end, ledger);

  if (scene.stabilisation > 0.0)
    for (int i = 0; i < blank.nodes(); ++i) {
      const Vector3d moved = end.node(i) - start.node(i);
      const Vector3d drag = scene.stabilisation * blank.node_area[i] / step.dt * moved;
      ledger.artefact += drag.dot(moved);
      on_blank -= drag;
    }
  for (std::size_t k = 0; k < scene.load.size(); ++k) {
    const Eigen::Index n = static_cast<Eigen::Index>(k);
    ledger.work_dead += scene.load[k] * (end.x[n] - start.x[n]);
    on_blank[n % 3] += scene.load[k];
  }
  if (!scene.held.empty()) {
    const Eigen::VectorXd support = system.full_gradient(step, end.x);
    for (std::size_t k = 0; k < scene.held.size(); ++k) {
      if (!scene.held[k]) continue;
      const Eigen::Index n = static_cast<Eigen::Index>(k);
      ledger.work_held += support[n] * (end.x[n] - start.x[n]);
      result.forces.by_supports[n % 3] += support[n];
    }
    on_blank += result.forces.by_supports;
  }
  result.forces.imbalance = (on_blank - momentum_rate).norm();
  return result;
}

}  // namespace heddle::macroscale
