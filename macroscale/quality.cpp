#include "macroscale/quality.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "macroscale/outline_cut.h"
#include "macroscale/stack.h"

namespace heddle::macroscale {

std::vector<std::array<double, 2>> nodal_tow_strain(const Blank& blank, const State& state) {
  std::vector<std::array<double, 2>> strain(blank.nodes(), {0.0, 0.0});
  std::vector<std::array<int, 2>> count(blank.nodes(), {0, 0});
  for (const TowSegment& segment : blank.segments) {
    const auto direction = static_cast<std::size_t>(segment.direction);
    const double length = (state.node(segment.to) - state.node(segment.from)).norm();
    const double e = length / blank.ply(blank.ply_of_node(segment.from)).spacing[direction] - 1.0;
    for (int n : {segment.from, segment.to}) {
      strain[n][direction] += e;
      ++count[n][direction];
    }
  }
  for (std::size_t n = 0; n < strain.size(); ++n)
    for (std::size_t d = 0; d < 2; ++d)
      if (count[n][d] > 0) strain[n][d] /= count[n][d];
  return strain;
}

namespace {

using Eigen::Vector3d;

Vector3d position_of(const Blank& blank, const State& state, const MaterialPoint& point) {
  Vector3d x = Vector3d::Zero();
  for (std::size_t k = 0; k < 4; ++k) x += point.weight[k] * state.node(blank.quads[point.quad][k]);
  return x;
}

double draw_in_at(const Blank& blank, const State& state, const MaterialPoint& point,
                  const Eigen::Vector2d& inward) {
  Eigen::Vector2d moved = Eigen::Vector2d::Zero();
  for (std::size_t k = 0; k < 4; ++k) {
    const int node = blank.quads[point.quad][k];
    moved += point.weight[k] * (state.node(node) - blank.reference[node]).head<2>();
  }
  return inward.dot(moved);
}

std::vector<double> draw_in(const Blank& blank, const State& state) {
  std::vector<double> inward;
  for (int k = 0; k < blank.plies(); ++k)
    for (const EdgePoint& edge : blank.ply(k).edge)
      inward.push_back(draw_in_at(blank, state, edge.point, edge.inward));
  return inward;
}

// Whether the trimmed grid maps onto itself under the mirrors of its tow axes and the swap of warp and weft,
// about the punch axis.
bool has_square_symmetry(const Blank& blank) {
  constexpr double alike = 1e-9;  // of a cell: shares and centres agree to rounding
  const int n = blank.nu;
  if (blank.plies() > 1) return false;  // of single plies; turned ones have only some of these
  if (blank.nv != n || std::abs(blank.spacing[0] / blank.spacing[1] - 1.0) > alike) return false;
  if (std::hypot(blank.centre[0], blank.centre[1]) > alike * blank.spacing[0]) return false;
  const auto share = [&](int i, int j) { return blank.quad(i, j) < 0 ? 0.0 : blank.share[blank.quad(i, j)]; };
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      for (const double image : {share(n - 1 - i, j), share(i, n - 1 - j), share(j, i)})
        if (std::abs(image - share(i, j)) > alike) return false;
  return true;
}

// Largest difference of a nodal field and its images under those symmetries, over the field's largest size.
// Shear changes sign in a mirror.
double shear_symmetry_gap(const Blank& blank, const std::vector<double>& shear) {
  double gap = 0.0, size = 0.0;
  const int n = blank.nu;
  for (int node = 0; node < blank.nodes(); ++node) {
    const auto [i, j] = blank.grid[node];
    const double value = shear[node];
    size = std::max(size, std::abs(value));
    gap =
        std::max({gap, std::abs(value + shear[blank.node(n - i, j)]),
                  std::abs(value + shear[blank.node(i, n - j)]), std::abs(value - shear[blank.node(j, i)])});
  }
  return size > 0.0 ? gap / size : 0.0;
}

// The same of the draw-in along the edge.
double draw_in_symmetry_gap(const Blank& blank, const State& state) {
  Eigen::Matrix2d to_tows;
  to_tows << blank.warp[0], blank.warp[1], -blank.warp[1], blank.warp[0];
  std::array<Eigen::Matrix2d, 3> images;
  images[0] << -1, 0, 0, 1;
  images[1] << 1, 0, 0, -1;
  images[2] << 0, 1, 1, 0;
  double gap = 0.0, size = 0.0;
  for (const EdgePoint& edge : blank.edge) {
    const double value = draw_in_at(blank, state, edge.point, edge.inward);
    size = std::max(size, std::abs(value));
    for (const Eigen::Matrix2d& image : images) {
      const Eigen::Matrix2d map = to_tows.transpose() * image * to_tows;
      const double other = draw_in_at(blank, state, blank.locate(map * edge.reference), map * edge.inward);
      gap = std::max(gap, std::abs(value - other));
    }
  }
  return size > 0.0 ? gap / size : 0.0;
}

// The strongest contact of each node over the tools.
void add_contacts_at_nodes(const System& system, const State& state, const StepData& step,
                           BlankState& blank) {
  const Scene& scene = system.scene();
  for (int i = 0; i < scene.blank.nodes(); ++i)
    for (int k = 0; k < static_cast<int>(scene.tools.size()); ++k) {
      const FrictionPoint& point = step.friction[k][i];
      if (point.context.pressure <= blank.pressure[i] || point.load == 0.0) continue;
      const double speed = slip_velocity(point, system.relative_velocity(step, state.x, k, i)).norm();
      const auto law = law_at(system.friction_settings(k), point, speed);
      blank.pressure[i] = point.context.pressure;
      blank.slip_speed[i] = speed;
      blank.friction_coefficient[i] = law.mu;
      blank.hersey[i] = law.hersey;
    }
}

// The same of contact inside cells: a node's pressure is the force that reaches it over its area, and what
// goes with it the mean over that force.
void add_contacts_in_cells(const System& system, const State& state, const StepData& step,
                           BlankState& blank) {
  struct Sum {
    double area = 0.0, load = 0.0, slip_speed = 0.0, mu = 0.0, hersey = 0.0;
  };
  for (int k = 0; k < static_cast<int>(system.scene().tools.size()); ++k) {
    std::vector<Sum> sums(system.scene().blank.nodes());
    for (int i = 0; i < system.contacts(); ++i) {
      const ContactPoint& at = system.contact_points()[i];
      const FrictionPoint& point = step.friction[k][i];
      const double area = system.contact_area(step, i);
      for (std::size_t a = 0; a < 4; ++a) sums[at.node[a]].area += at.weight[a] * area;
      if (point.load == 0.0) continue;
      const double speed = slip_velocity(point, system.relative_velocity(step, state.x, k, i)).norm();
      const auto law = law_at(system.friction_settings(k), point, speed);
      for (std::size_t a = 0; a < 4; ++a) {
        Sum& sum = sums[at.node[a]];
        const double load = at.weight[a] * point.load;
        sum.load += load;
        sum.slip_speed += load * speed;
        sum.mu += load * law.mu;
        sum.hersey += load * law.hersey;
      }
    }
    for (std::size_t n = 0; n < sums.size(); ++n) {
      const Sum& sum = sums[n];
      if (sum.load == 0.0 || sum.load / sum.area <= blank.pressure[n]) continue;
      blank.pressure[n] = sum.load / sum.area;
      blank.slip_speed[n] = sum.slip_speed / sum.load;
      blank.friction_coefficient[n] = sum.mu / sum.load;
      blank.hersey[n] = sum.hersey / sum.load;
    }
  }
}

void add_contact_fields(const System& system, const State& state, const StepData& step, BlankState& blank) {
  if (system.scene().contact_sites == ContactSites::nodes)
    add_contacts_at_nodes(system, state, step, blank);
  else
    add_contacts_in_cells(system, state, step, blank);
}

}  // namespace

BlankState blank_state(const System& system, const State& state, const StepData* step) {
  const Scene& scene = system.scene();
  const Blank& blank = scene.blank;
  BlankState s;
  s.nu = blank.nu;
  s.nv = blank.nv;
  s.symmetry = blank.symmetry;
  s.grid = blank.grid;
  s.quads = blank.quads;
  s.pieces = blank.pieces;
  s.outline = blank.outline;
  for (int k = 0; k < blank.plies(); ++k) {
    const Ply& ply = blank.ply(k);
    const int first_edge = static_cast<int>(s.edge.size());
    for (const EdgePoint& edge : ply.edge) {
      const Vector3d x = position_of(blank, state, edge.point);
      s.edge.push_back({{edge.reference.x(), edge.reference.y()},
                        {x.x(), x.y(), x.z()},
                        draw_in_at(blank, state, edge.point, edge.inward)});
    }
    if (blank.plies() > 1)
      s.plies.push_back({ply.nu, ply.nv, ply.first_node, ply.end_node, ply.first_quad, ply.end_quad,
                         first_edge, static_cast<int>(s.edge.size())});
  }
  s.time = state.time;
  s.tow_strain = nodal_tow_strain(blank, state);
  s.shear_angle = nodal_shear_angle(blank, state.corner_angle);
  for (int i = 0; i < blank.nodes(); ++i) {
    const Vector3d x = state.node(i), v = state.v.segment<3>(3 * i);
    s.reference.push_back({blank.reference[i].x(), blank.reference[i].y()});
    s.position.push_back({x.x(), x.y(), x.z()});
    s.velocity.push_back({v.x(), v.y(), v.z()});
  }
  for (auto* field : {&s.pressure, &s.slip_speed, &s.friction_coefficient, &s.hersey})
    field->assign(blank.nodes(), 0.0);
  if (step && scene.friction && !step->frictionless) add_contact_fields(system, state, *step, s);
  if (blank.plies() > 1) add_ply_fields(system, state, step, s);
  s.heat = heat_fields(scene, state.heat);
  for (std::size_t k = 0; k < scene.tools.size(); ++k) {
    if (scene.tools[k].role == Role::punch) s.punch_displacement = -state.tool_z[k];
    if (scene.tools[k].role == Role::binder) s.binder_position = state.tool_z[k];
  }
  return s;
}

double largest_draw_in(const Blank& blank, const State& state) {
  const auto inward = draw_in(blank, state);
  return *std::max_element(inward.begin(), inward.end());
}

double ledger_residual(const HistoryRow& r) {
  const double work = r.work_punch + r.work_binder + r.work_gravity;
  const double stored = r.energy_tow + r.energy_shear + r.energy_bending + r.energy_twist +
                        r.energy_compaction + r.energy_kinetic + r.energy_press;
  const double dissipated = r.friction_punch + r.friction_die + r.friction_binder + r.dissipation_shear_rate +
                            r.dissipation_shear_hysteresis + r.dissipation_artefact +
                            r.dissipation_numerical + r.friction_plies + r.dissipation_tow_rate;
  return work - stored - dissipated;
}

double energy_residual_max(const std::vector<HistoryRow>& history) {
  double largest = 0.0;
  const double floor = history.empty() ? 0.0 : 0.01 * std::abs(history.back().work_punch);
  for (const HistoryRow& row : history)
    largest = std::max(largest, std::abs(ledger_residual(row)) / std::max(row.work_punch, floor));
  return largest;
}

bool on_falling_branch(const System& system, const StepData& step, const State& end) {
  const Scene& scene = system.scene();
  if (!scene.friction || step.frictionless) return false;
  for (int k = 0; k < static_cast<int>(scene.tools.size()); ++k)
    for (int i = 0; i < system.contacts(); ++i) {
      const FrictionPoint& point = step.friction[k][i];
      if (point.load == 0.0) continue;
      const double speed = slip_velocity(point, system.relative_velocity(step, end.x, k, i)).norm();
      if (speed > scene.slip_smoothing && !law_at(system.friction_settings(k), point, speed).convex)
        return true;
    }
  return false;
}

double largest_pressure(const System& system, const StepData& step, const State& end) {
  double largest = 0.0;
  for (int k = 0; k < static_cast<int>(system.scene().tools.size()); ++k)
    for (int i = 0; i < system.contacts(); ++i)
      largest = std::max(largest, system.tool_contact(step, end.x, k, i).normal.pressure);
  return largest;
}

namespace {

std::optional<HeatSummary> heat_summary(const std::vector<HistoryRow>& history,
                                        const std::vector<HeatRow>& hold) {
  std::vector<HeatRow> rows;
  for (const HistoryRow& row : history)
    if (row.heat) rows.push_back(*row.heat);
  if (rows.empty()) return {};
  const double stroke_ends = rows.back().time;
  rows.insert(rows.end(), hold.begin(), hold.end());
  HeatSummary s;
  s.last = rows.back();
  s.held = s.last.time - stroke_ends;
  constexpr double all = 1.0 - 1e-12;  // a share is a sum of areas
  double residual = 0.0;
  for (const HeatRow& row : rows) {
    if (!s.first_face && row.frozen_faces > 0.0) s.first_face = row.time;
    if (!s.solid && row.frozen_through >= all) s.solid = row.time;
    residual = std::max(residual, std::abs(row.residual));
  }
  const double through = std::abs(s.last.through_bottom) + std::abs(s.last.through_top);
  if (through > 0.0) s.residual_share = residual / through;
  return s;
}

}  // namespace

void summarise(StampingResult& result, const Blank& blank, const State& state, double peak_force_balance) {
  StampingSummary& s = result.summary;
  s.steps = static_cast<int>(result.history.size());
  s.energy_residual_max = energy_residual_max(result.history);
  s.heat = heat_summary(result.history, result.hold);
  if (result.history.empty()) return;
  const HistoryRow& last = result.history.back();
  const double work_floor = 0.01 * std::abs(last.work_punch);
  double largest_force = 0.0;
  for (const HistoryRow& row : result.history) {
    s.peak_punch_force = std::max(s.peak_punch_force, row.punch_force);
    largest_force = std::max(largest_force, std::abs(row.punch_force));
    s.shear_angle_max = std::max(s.shear_angle_max, row.shear_angle_max);
    s.draw_in_max = std::max(s.draw_in_max, row.draw_in_max);
    if (s.self_crossings == 0 && row.self_crossings > 0) s.first_crossing = row.punch_displacement;
    s.self_crossings = std::max(s.self_crossings, row.self_crossings);
    const double stored =
        row.energy_tow + row.energy_shear + row.energy_bending + row.energy_twist + row.energy_compaction;
    if (row.work_punch > work_floor && stored > 0.0)
      s.twist_share = std::max(s.twist_share, row.energy_twist / stored);
  }
  if (largest_force > 0.0) s.force_balance_residual_max = peak_force_balance / largest_force;
  if (last.work_punch > 0.0) s.numerical_dissipation_share = last.dissipation_numerical / last.work_punch;
  const double rubbed = last.friction_punch + last.friction_die + last.friction_binder + last.friction_plies;
  s.friction_work_outside = rubbed > 0.0 ? last.friction_work_outside / rubbed : 0.0;
  s.symmetry_gap_shear = s.symmetry_gap_draw_in = -1.0;
  if (has_square_symmetry(blank)) {
    s.symmetry_gap_shear = shear_symmetry_gap(blank, nodal_shear_angle(blank, state.corner_angle));
    s.symmetry_gap_draw_in = draw_in_symmetry_gap(blank, state);
  }
  for (std::size_t k = 0; k < 8; ++k) {
    const double angle = 0.25 * std::numbers::pi * static_cast<double>(k);
    Eigen::Vector2d ray(std::cos(angle), std::sin(angle));
    if (mirrored_across(blank.symmetry, 0)) ray.x() = std::abs(ray.x());
    if (mirrored_across(blank.symmetry, 1)) ray.y() = std::abs(ray.y());
    const Eigen::Vector2d x = ray_length(blank.outline, {ray.x(), ray.y()}) * ray;
    s.draw_in_rays[k] = draw_in_at(blank, state, blank.locate(x), -ray);
  }
}

}  // namespace heddle::macroscale
