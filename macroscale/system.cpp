#include "macroscale/system.h"

#include <algorithm>
#include <cmath>

#include "macroscale/parallel.h"
#include "macroscale/self_contact.h"
#include "macroscale/tool_drive.h"

namespace heddle::macroscale {

namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Eigen::VectorXd;

// Resistance to twist of the sheet, as a share of the mean bending stiffness. Tow bending alone leaves the
// saddle w = x y without energy; the share is small, and reports print how much energy it took.
constexpr double twist_share = 0.1;

Vector3d second_difference(const VectorXd& x, const TowTriple& t) {
  return node_of(x, t.before) - 2.0 * node_of(x, t.middle) + node_of(x, t.after);
}

Vector3d second_difference(const VectorXd& x, const MirroredTriple& t) {
  Vector3d difference = 2.0 * (node_of(x, t.beside) - node_of(x, t.middle));
  difference[t.axis] = 0.0;
  return difference;
}

// Held over the step, as the temperatures of `heat` are.
double temperature_before(const Scene& scene, const StepData& step) {
  return scene.cooling_rate == 0.0 ? scene.blank_temperature : scene.blank_temperature_at(step.start->time);
}

Vector3d twist_of(const VectorXd& x, const std::array<int, 4>& q) {
  return node_of(x, q[0]) - node_of(x, q[1]) + node_of(x, q[2]) - node_of(x, q[3]);
}

}  // namespace

System::System(const Scene& scene)
    : scene_(scene),
      size_(scene.unknowns()),
      points_(macroscale::contact_points(scene.blank, scene.contact_sites)),
      ply_points_(macroscale::ply_points(scene.blank)),
      between_plies_(ply_points_.size()) {
  if (scene.self_contact) {
    const std::vector<PlyPoint> own = macroscale::self_points(scene.blank);
    ply_points_.insert(ply_points_.end(), own.begin(), own.end());
  }
  compaction_ = scene.fabric->compaction.curves().front();
  mass_.assign(size_, 0.0);
  const double density = scene.fabric->areal_density * scene.mass_scaling;
  for (int i = 0; i < scene.blank.nodes(); ++i)
    for (int c = 0; c < 3; ++c) mass_[3 * i + c] = density * scene.blank.node_area[i];
  int next = 3 * scene.blank.nodes();
  for (const Tool& tool : scene.tools) {
    body_.push_back(has_unknown(tool) ? next : -1);
    for (int u = 0; u < unknowns_of(tool); ++u) mass_[next++] = tool.mass;
  }
  build_pattern();
  assemble_constant();
}

double System::bending_stiffness(const TowTriple& t) const {
  const Blank& blank = scene_.blank;
  const double h = blank.ply(blank.ply_of_node(t.middle)).spacing[t.direction];
  return scene_.fabric->bending[t.direction](scene_.blank_temperature) * t.width / (h * h * h);
}

double System::bending_stiffness(const MirroredTriple& t) const {
  return bending_stiffness(TowTriple{t.beside, t.middle, t.beside, t.width, t.direction});
}

double System::twist_stiffness(int quad) const {
  const double mean = 0.5 * (scene_.fabric->bending[0](scene_.blank_temperature) +
                             scene_.fabric->bending[1](scene_.blank_temperature));
  const auto& spacing = scene_.blank.ply(scene_.blank.ply_of_quad(quad)).spacing;
  return scene_.blank.share[quad] * (twist_share * mean / (spacing[0] * spacing[1]));
}

Pose System::pose_of(const VectorXd& x, int k, double tool_z) const {
  const Tool& tool = scene_.tools[k];
  Pose pose{tool.motion == Motion::sprung ? tool_z + x[body_[k]] : tool_z};
  if (unknowns_of(tool) == 3) pose.lift = {x[body_[k] + 1], x[body_[k] + 2]};
  return pose;
}

Pose System::pose(const StepData& step, const VectorXd& x, int k) const {
  return pose_of(x, k, scene_.tools[k].motion == Motion::loaded ? x[body_[k]] : step.tool_z[k]);
}

Pose System::pose(const State& state, int k) const {
  return pose_of(state.x, k, state.tool_z[k]);
}

ToolContact System::contact_at(const Vector3d& x, int k, const Pose& pose) const {
  ToolContact contact;
  contact.surface = distance(scene_.tools[k], pose, x);
  contact.normal = normal_contact(compaction_, contact.surface.distance, 0.5 * scene_.fabric->thickness);
  return contact;
}

ToolContact System::contact_at(const StepData& step, const Vector3d& x, int k, int i,
                               const Pose& pose) const {
  if (step.contact_shear.empty()) return contact_at(x, k, pose);
  ToolContact contact;
  contact.surface = distance(scene_.tools[k], pose, x);
  contact.normal = normal_contact(scene_.fabric->compaction, step.contact_shear[i], contact.surface.distance,
                                  0.5 * scene_.fabric->thickness);
  return contact;
}

double System::contact_area(const StepData& step, int i) const {
  return step.contact_shear.empty() ? points_[i].area : points_[i].area * std::cos(step.contact_shear[i]);
}

ToolContact System::tool_contact(const StepData& step, const VectorXd& x, int k, int i) const {
  return contact_at(step, at_point(points_[i], x), k, i, pose(step, x, k));
}

Vector3d System::relative_velocity(const StepData& step, const VectorXd& x, int k, int i) const {
  const Vector3d before = at_point(points_[i], step.start->x);
  return (at_point(points_[i], x) - before -
          carried(scene_.tools[k], pose(*step.start, k), pose(step, x, k), before)) /
         step.dt;
}

CornerLaw System::corner_law(const StepData& step, int ply) const {
  CornerLaw law;
  const Ply& grid = scene_.blank.ply(ply);
  law.fabric = scene_.fabric;
  law.area = grid.corner_area();
  law.length_warp = grid.spacing[0];
  law.length_weft = grid.spacing[1];
  if (scene_.shear_rate > 0.0)
    law.rate_consistency =
        scene_.shear_rate * scene_.fabric->shear_rate.consistency_at(temperature_before(scene_, step));
  law.rate_index = scene_.fabric->shear_rate.index;
  law.time_step = step.dt;
  law.friction = scene_.shear_friction;
  law.locking = scene_.effects.shear_locking;
  law.coupling = scene_.coupling.empty() ? nullptr : &scene_.coupling;
  law.tow_viscosity = scene_.effects.tow_viscosity;
  return law;
}

double System::shear_factor(const StepData& step, std::size_t quad) const {
  const ShearSoftening& softening = scene_.effects.softening;
  if (!softening.on()) return 1.0;
  if (!step.start->heat.empty()) return step.start->heat.shear_factor[quad];
  return softening.factor_at(temperature_before(scene_, step));
}

std::array<double, 2> System::strain_before(const StepData& step, const Corner& corner,
                                            const CornerLaw& law) const {
  const VectorXd& x = step.start->x;
  const Vector3d origin = node_of(x, corner.node);
  return {(node_of(x, corner.along_warp) - origin).norm() / law.length_warp - 1.0,
          (node_of(x, corner.along_weft) - origin).norm() / law.length_weft - 1.0};
}

std::vector<CornerLaw> System::corner_laws(const StepData& step) const {
  std::vector<CornerLaw> laws;
  for (int k = 0; k < scene_.blank.plies(); ++k) laws.push_back(corner_law(step, k));
  return laws;
}

void System::evaluate(const StepData& step, const VectorXd& x, Position& at) const {
  const Blank& blank = scene_.blank;
  at.x = x;
  at.corners.resize(4 * blank.quads.size());
  const std::vector<CornerLaw> laws = corner_laws(step);
  for_each(static_cast<int>(blank.quads.size()), [&](int q) {
    const auto corners = corners_of(blank.quads[q]);
    CornerLaw here = laws[blank.ply_of_quad(q)];
    here.rate_consistency *= rate_factor(step, q);
    here.shear_factor = shear_factor(step, q);
    for (int k = 0; k < 4; ++k) {
      const Corner& c = corners[k];
      const Vector3d origin = node_of(x, c.node);
      here.memory = shear_memory(*step.start, 4 * q + k);
      at.corners[4 * q + k] =
          corner_point(here, node_of(x, c.along_warp) - origin, node_of(x, c.along_weft) - origin,
                       step.start->corner_angle[4 * q + k]);
    }
  });
  const int tools = static_cast<int>(scene_.tools.size());
  const bool rubs = scene_.friction && !step.frictionless;
  at.contacts.resize(tools);
  at.friction.resize(rubs ? friction_rows(step) : 0);
  for (int k = 0; k < tools; ++k) {
    at.contacts[k].resize(contacts());
    if (rubs) at.friction[k].resize(contacts());
    const FrictionSettings settings = friction_settings(k);
    for_each(contacts(), [&, k](int i) {
      const ToolContact contact = tool_contact(step, x, k, i);
      at.contacts[k][i] = {contact.surface.distance, contact.surface.normal, contact.normal};
      if (rubs && step.friction[k][i].load > 0.0)
        at.friction[k][i] =
            friction_response(settings, step.friction[k][i], relative_velocity(step, x, k, i));
    });
  }
  evaluate_plies(step, at);
}

PotentialTerms System::potential(const StepData& step, const Position& at) const {
  const Blank& blank = scene_.blank;
  const VectorXd& x = at.x;
  PotentialTerms e;
  const double dt2 = step.dt * step.dt;
  e.inertia = ordered_sum(size_, [&](int k) {
    const double d = x[k] - step.target[k];
    return 0.5 * mass_[k] * d * d / dt2;
  });

  const std::vector<CornerLaw> laws = corner_laws(step);
  const int quads = static_cast<int>(blank.quads.size());
  struct Sums {
    double tow = 0.0, shear = 0.0, rate = 0.0, tow_rate = 0.0;
  };
  const Sums sums = tbb::parallel_deterministic_reduce(
      tbb::blocked_range<int>(0, quads, 256), Sums{},
      [&](const tbb::blocked_range<int>& range, Sums s) {
        for (int q = range.begin(); q != range.end(); ++q) {
          CornerLaw here = trimmed(laws[blank.ply_of_quad(q)], blank.share[q]);
          const auto corners = corners_of(blank.quads[q]);
          for (int k = 0; k < 4; ++k) {
            if (here.tow_viscosity > 0.0) here.strain_before = strain_before(step, corners[k], here);
            const CornerEnergy w = corner_energy(here, at.corners[4 * q + k]);
            s.tow += w.tension;
            s.shear += w.shear;
            s.rate += w.rate;
            s.tow_rate += w.tow_rate;
          }
        }
        return s;
      },
      [](Sums a, const Sums& b) {
        a.tow += b.tow;
        a.shear += b.shear;
        a.rate += b.rate;
        a.tow_rate += b.tow_rate;
        return a;
      });
  e.tow = sums.tow;
  e.shear = sums.shear;
  e.rate = sums.rate;
  e.tow_rate = sums.tow_rate;

  e.bending = ordered_sum(static_cast<int>(blank.triples.size()), [&](int t) {
    return 0.5 * bending_stiffness(blank.triples[t]) * second_difference(x, blank.triples[t]).squaredNorm();
  });
  for (const MirroredTriple& t : blank.mirrored)
    e.bending += 0.5 * bending_stiffness(t) * second_difference(x, t).squaredNorm();
  e.twist = ordered_sum(
      quads, [&](int q) { return 0.5 * twist_stiffness(q) * twist_of(x, blank.quads[q]).squaredNorm(); });

  const int tools = static_cast<int>(scene_.tools.size());
  for (int k = 0; k < tools; ++k) {
    e.compaction += ordered_sum(
        contacts(), [&](int i) { return contact_area(step, i) * at.contacts[k][i].normal.energy; });
    if (body_[k] < 0) continue;
    e.loads += drive_at(scene_.tools[k], x[body_[k]]).energy;
    for (int u = 1; u < unknowns_of(scene_.tools[k]); ++u)
      e.loads += tilt_drive_at(scene_.tools[k], x[body_[k] + u]).energy;
  }
  e.compaction_plies = ordered_sum(static_cast<int>(step.pairs.size()),
                                   [&](int i) { return step.pairs[i].area * at.ply_contacts[i].energy; });
  for (std::size_t k = 0; k < scene_.load.size(); ++k)
    e.loads -= scene_.load[k] * x[static_cast<Eigen::Index>(k)];
  if (scene_.stabilisation > 0.0)
    e.stabilisation = ordered_sum(blank.nodes(), [&](int i) {
      return 0.5 * scene_.stabilisation * blank.node_area[i] / step.dt *
             (node_of(x, i) - step.start->node(i)).squaredNorm();
    });
  return e;
}

double System::friction_difference(const StepData& step, const Position& from, const Position& to) const {
  if (from.friction.empty()) return 0.0;
  double sum = 0.0;
  for (int k = 0; k < friction_rows(step); ++k) {
    const FrictionSettings settings = friction_settings(k);
    sum += ordered_sum(points_in_row(step, k), [&](int i) {
      const FrictionPoint& point = step.friction[k][i];
      if (point.load == 0.0) return 0.0;
      return friction_power_difference(settings, point, from.friction[k][i], to.friction[k][i]);
    });
  }
  return step.dt * sum;
}

Vector3d System::contact_force(const StepData& step, const Position& at, int k, int i) const {
  const KeptContact& contact = at.contacts[k][i];
  Vector3d force = -contact_area(step, i) * contact.normal.pressure * contact.direction;
  if (!at.friction.empty() && step.friction[k][i].load > 0.0)
    force += friction_force(step.friction[k][i], at.friction[k][i]);
  return force;
}

// Slopes of contact, friction and springs to what a tilting tool's unknowns are.
Vector3d System::force_on_tilting(const StepData& step, const Position& at, int k) const {
  const Tool& tool = scene_.tools[k];
  const Pose pose = this->pose(step, at.x, k);
  Vector3d force = Vector3d::Zero();
  for (int u = 1; u < 3; ++u) force[u] = tilt_drive_at(tool, at.x[body_[k] + u]).force;
  for (int i = 0; i < contacts(); ++i) {
    const KeptContact& contact = at.contacts[k][i];
    if (contact.normal.pressure > 0.0)
      force -= contact_area(step, i) * contact.normal.pressure *
               slopes_at(*tool.tilt, pose, at_point(points_[i], at.x), contact.direction);
    if (at.friction.empty() || step.friction[k][i].load == 0.0) continue;
    const Vector3d drag = friction_force(step.friction[k][i], at.friction[k][i]);
    const std::array<Vector3d, 3> way = ways_at(*tool.tilt, at_point(points_[i], step.start->x));
    for (int u = 0; u < 3; ++u) force[u] -= drag.dot(way[u]);
  }
  return force;
}

VectorXd System::full_gradient(const StepData& step, const Position& at) const {
  const Blank& blank = scene_.blank;
  const VectorXd& x = at.x;
  VectorXd g(size_);
  const double dt2 = step.dt * step.dt;
  for_each(size_, [&](int k) { g[k] = mass_[k] * (x[k] - step.target[k]) / dt2; });

  const std::vector<CornerLaw> laws = corner_laws(step);
  for (const auto& colour : colours_)
    for_each(static_cast<int>(colour.size()), [&](int index) {
      const int q = colour[index];
      const auto corners = corners_of(blank.quads[q]);
      CornerLaw here = trimmed(laws[blank.ply_of_quad(q)], blank.share[q]);
      for (int k = 0; k < 4; ++k) {
        const Corner& c = corners[k];
        if (here.tow_viscosity > 0.0) here.strain_before = strain_before(step, c, here);
        const CornerGradient w = corner_gradient(here, at.corners[4 * q + k]);
        const Vector3d a = w.a(), b = w.b();
        g.segment<3>(3 * c.along_warp) += a;
        g.segment<3>(3 * c.along_weft) += b;
        g.segment<3>(3 * c.node) -= a + b;
      }
    });

  for (const TowTriple& t : blank.triples) {
    const Vector3d force = bending_stiffness(t) * second_difference(x, t);
    g.segment<3>(3 * t.before) += force;
    g.segment<3>(3 * t.middle) -= 2.0 * force;
    g.segment<3>(3 * t.after) += force;
  }
  for (const MirroredTriple& t : blank.mirrored) {
    const Vector3d force = 2.0 * bending_stiffness(t) * second_difference(x, t);
    g.segment<3>(3 * t.beside) += force;
    g.segment<3>(3 * t.middle) -= force;
  }
  for (int quad = 0; quad < static_cast<int>(blank.quads.size()); ++quad) {
    const auto& q = blank.quads[quad];
    const Vector3d force = twist_stiffness(quad) * twist_of(x, q);
    g.segment<3>(3 * q[0]) += force;
    g.segment<3>(3 * q[1]) -= force;
    g.segment<3>(3 * q[2]) += force;
    g.segment<3>(3 * q[3]) -= force;
  }

  std::vector<Vector3d> force(points_.size());
  for (int k = 0; k < static_cast<int>(scene_.tools.size()); ++k) {
    for_each(contacts(), [&, k](int i) { force[i] = contact_force(step, at, k, i); });
    if (scene_.contact_sites == ContactSites::nodes) {
      for_each(contacts(), [&](int i) { g.segment<3>(3 * i) += force[i]; });
    } else {
      for (std::size_t i = 0; i < points_.size(); ++i)
        for (std::size_t a = 0; a < 4; ++a)
          g.segment<3>(3 * points_[i].node[a]) += points_[i].weight[a] * force[i];
    }
    if (body_[k] < 0) continue;
    g[body_[k]] += drive_at(scene_.tools[k], x[body_[k]]).force;
    if (scene_.tools[k].tilt)
      g.segment<3>(body_[k]) += force_on_tilting(step, at, k);
    else
      for (const Vector3d& f : force) g[body_[k]] -= f.z();
  }
  add_forces_of_plies(step, at, g);
  for (std::size_t k = 0; k < scene_.load.size(); ++k) g[static_cast<Eigen::Index>(k)] -= scene_.load[k];
  if (scene_.stabilisation > 0.0)
    for (int i = 0; i < blank.nodes(); ++i)
      g.segment<3>(3 * i) +=
          scene_.stabilisation * blank.node_area[i] / step.dt * (node_of(x, i) - step.start->node(i));
  return g;
}

VectorXd System::gradient(const StepData& step, const Position& at) const {
  VectorXd g = full_gradient(step, at);
  for (std::size_t k = 0; k < scene_.held.size(); ++k)
    if (scene_.held[k]) g[static_cast<Eigen::Index>(k)] = 0.0;
  return g;
}

PotentialTerms System::potential(const StepData& step, const VectorXd& x) const {
  Position at;
  evaluate(step, x, at);
  return potential(step, at);
}

double System::friction_difference(const StepData& step, const VectorXd& from, const VectorXd& to) const {
  Position before, after;
  evaluate(step, from, before);
  evaluate(step, to, after);
  return friction_difference(step, before, after);
}

VectorXd System::full_gradient(const StepData& step, const VectorXd& x) const {
  Position at;
  evaluate(step, x, at);
  return full_gradient(step, at);
}

VectorXd System::gradient(const StepData& step, const VectorXd& x) const {
  Position at;
  evaluate(step, x, at);
  return gradient(step, at);
}

void System::assemble(const StepData& step, const VectorXd& x, Filter filter, double shift) {
  Position at;
  evaluate(step, x, at);
  assemble(step, at, filter, shift);
}

}  // namespace heddle::macroscale
