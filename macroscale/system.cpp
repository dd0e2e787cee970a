#include "macroscale/system.h"

#include <algorithm>
#include <functional>
#include <set>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>

namespace heddle::macroscale {

namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Eigen::VectorXd;

// Resistance to twist of the sheet, as a share of the mean bending stiffness. Tow bending alone leaves the
// saddle w = x y without energy; the share is small, and reports print how much energy it took.
constexpr double twist_share = 0.1;

// Fixed pieces and a fixed order of summation: the same bytes on one thread or many.
template <class Term>
double ordered_sum(int n, const Term& term) {
  return tbb::parallel_deterministic_reduce(
      tbb::blocked_range<int>(0, n, 512), 0.0,
      [&](const tbb::blocked_range<int>& range, double sum) {
        for (int i = range.begin(); i != range.end(); ++i) sum += term(i);
        return sum;
      },
      std::plus<>());
}

template <class Body>
void for_each(int n, const Body& body) {
  tbb::parallel_for(tbb::blocked_range<int>(0, n, 256), [&](const tbb::blocked_range<int>& range) {
    for (int i = range.begin(); i != range.end(); ++i) body(i);
  });
}

Vector3d node_of(const VectorXd& x, int i) {
  return x.segment<3>(3 * i);
}

Vector3d second_difference(const VectorXd& x, const TowTriple& t) {
  return node_of(x, t.before) - 2.0 * node_of(x, t.middle) + node_of(x, t.after);
}

Vector3d twist_of(const VectorXd& x, const std::array<int, 4>& q) {
  return node_of(x, q[0]) - node_of(x, q[1]) + node_of(x, q[2]) - node_of(x, q[3]);
}

}  // namespace

System::System(const Scene& scene) : scene_(scene), size_(scene.unknowns()) {
  compaction_ = scene.fabric->compaction.curves().front();
  mass_.assign(size_, 0.0);
  const double density = scene.fabric->areal_density * scene.mass_scaling;
  for (int i = 0; i < scene.blank.nodes(); ++i)
    for (int c = 0; c < 3; ++c) mass_[3 * i + c] = density * scene.blank.node_area[i];
  int next = 3 * scene.blank.nodes();
  for (const Tool& tool : scene.tools) {
    body_.push_back(tool.motion == Motion::loaded ? next : -1);
    if (tool.motion == Motion::loaded) mass_[next++] = tool.mass;
  }
  build_pattern();
  assemble_constant();
}

double System::bending_stiffness(const TowTriple& t) const {
  const double h = scene_.blank.spacing[t.direction];
  return scene_.fabric->bending[t.direction](scene_.blank_temperature) * t.width / (h * h * h);
}

double System::twist_stiffness(int quad) const {
  const double mean = 0.5 * (scene_.fabric->bending[0](scene_.blank_temperature) +
                             scene_.fabric->bending[1](scene_.blank_temperature));
  return scene_.blank.share[quad] *
         (twist_share * mean / (scene_.blank.spacing[0] * scene_.blank.spacing[1]));
}

double System::tool_position(const StepData& step, const VectorXd& x, int k) const {
  return body_[k] >= 0 ? x[body_[k]] : step.tool_z[k];
}

ToolContact System::contact_at(const Vector3d& x, int k, double z) const {
  ToolContact contact;
  contact.surface = distance(scene_.tools[k].shape, x - Vector3d(0, 0, z));
  contact.normal = normal_contact(compaction_, contact.surface.distance, 0.5 * scene_.fabric->thickness);
  return contact;
}

ToolContact System::tool_contact(const StepData& step, const VectorXd& x, int k, int i) const {
  return contact_at(node_of(x, i), k, tool_position(step, x, k));
}

Vector3d System::relative_velocity(const StepData& step, const VectorXd& x, int k, int i) const {
  const double tool_motion = tool_position(step, x, k) - step.start->tool_z[k];
  return (node_of(x, i) - step.start->node(i) - Vector3d(0, 0, tool_motion)) / step.dt;
}

CornerLaw System::corner_law(const StepData& step) const {
  CornerLaw law;
  law.fabric = scene_.fabric;
  law.area = scene_.blank.corner_area();
  law.length_warp = scene_.blank.spacing[0];
  law.length_weft = scene_.blank.spacing[1];
  if (scene_.shear_rate > 0.0)
    law.rate_consistency =
        scene_.shear_rate * scene_.fabric->shear_rate.consistency_at(scene_.blank_temperature);
  law.rate_index = scene_.fabric->shear_rate.index;
  law.time_step = step.dt;
  return law;
}

PotentialTerms System::potential(const StepData& step, const VectorXd& x) const {
  const Blank& blank = scene_.blank;
  PotentialTerms e;
  const double dt2 = step.dt * step.dt;
  e.inertia = ordered_sum(size_, [&](int k) {
    const double d = x[k] - step.target[k];
    return 0.5 * mass_[k] * d * d / dt2;
  });

  const CornerLaw law = corner_law(step);
  const int quads = static_cast<int>(blank.quads.size());
  struct Sums {
    double tow = 0.0, shear = 0.0, rate = 0.0;
  };
  const Sums sums = tbb::parallel_deterministic_reduce(
      tbb::blocked_range<int>(0, quads, 256), Sums{},
      [&](const tbb::blocked_range<int>& range, Sums s) {
        for (int q = range.begin(); q != range.end(); ++q) {
          const auto corners = corners_of(blank.quads[q]);
          const CornerLaw here = trimmed(law, blank.share[q]);
          for (int k = 0; k < 4; ++k) {
            const Corner& c = corners[k];
            const Vector3d origin = node_of(x, c.node);
            const CornerEnergy w =
                corner_energy(here, node_of(x, c.along_warp) - origin, node_of(x, c.along_weft) - origin,
                              step.start->corner_angle[4 * q + k]);
            s.tow += w.tension;
            s.shear += w.shear;
            s.rate += w.rate;
          }
        }
        return s;
      },
      [](Sums a, const Sums& b) {
        a.tow += b.tow;
        a.shear += b.shear;
        a.rate += b.rate;
        return a;
      });
  e.tow = sums.tow;
  e.shear = sums.shear;
  e.rate = sums.rate;

  e.bending = ordered_sum(static_cast<int>(blank.triples.size()), [&](int t) {
    return 0.5 * bending_stiffness(blank.triples[t]) * second_difference(x, blank.triples[t]).squaredNorm();
  });
  e.twist = ordered_sum(
      quads, [&](int q) { return 0.5 * twist_stiffness(q) * twist_of(x, blank.quads[q]).squaredNorm(); });

  const int tools = static_cast<int>(scene_.tools.size());
  for (int k = 0; k < tools; ++k) {
    e.compaction += ordered_sum(
        blank.nodes(), [&](int i) { return blank.node_area[i] * tool_contact(step, x, k, i).normal.energy; });
    if (body_[k] >= 0) e.loads += scene_.tools[k].force * x[body_[k]];
  }
  for (std::size_t k = 0; k < scene_.load.size(); ++k)
    e.loads -= scene_.load[k] * x[static_cast<Eigen::Index>(k)];
  if (scene_.stabilisation > 0.0)
    e.stabilisation = ordered_sum(blank.nodes(), [&](int i) {
      return 0.5 * scene_.stabilisation * blank.node_area[i] / step.dt *
             (node_of(x, i) - step.start->node(i)).squaredNorm();
    });
  return e;
}

double System::friction_difference(const StepData& step, const VectorXd& from, const VectorXd& to) const {
  if (step.frictionless || !scene_.friction) return 0.0;
  const FrictionSettings settings = friction_settings();
  double sum = 0.0;
  for (int k = 0; k < static_cast<int>(scene_.tools.size()); ++k)
    sum += ordered_sum(scene_.blank.nodes(), [&](int i) {
      const FrictionPoint& point = step.friction[k][i];
      if (point.load == 0.0) return 0.0;
      return friction_power_difference(settings, point,
                                       slip_velocity(point, relative_velocity(step, from, k, i)).norm(),
                                       slip_velocity(point, relative_velocity(step, to, k, i)).norm());
    });
  return step.dt * sum;
}

VectorXd System::full_gradient(const StepData& step, const VectorXd& x) const {
  const Blank& blank = scene_.blank;
  VectorXd g(size_);
  const double dt2 = step.dt * step.dt;
  for_each(size_, [&](int k) { g[k] = mass_[k] * (x[k] - step.target[k]) / dt2; });

  const CornerLaw law = corner_law(step);
  for (const auto& colour : colours_)
    for_each(static_cast<int>(colour.size()), [&](int index) {
      const int q = colour[index];
      const auto corners = corners_of(blank.quads[q]);
      const CornerLaw here = trimmed(law, blank.share[q]);
      for (int k = 0; k < 4; ++k) {
        const Corner& c = corners[k];
        const Vector3d origin = node_of(x, c.node);
        const CornerGradient w =
            corner_gradient(here, node_of(x, c.along_warp) - origin, node_of(x, c.along_weft) - origin,
                            step.start->corner_angle[4 * q + k]);
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
  for (int quad = 0; quad < static_cast<int>(blank.quads.size()); ++quad) {
    const auto& q = blank.quads[quad];
    const Vector3d force = twist_stiffness(quad) * twist_of(x, q);
    g.segment<3>(3 * q[0]) += force;
    g.segment<3>(3 * q[1]) -= force;
    g.segment<3>(3 * q[2]) += force;
    g.segment<3>(3 * q[3]) -= force;
  }

  const FrictionSettings settings = friction_settings();
  const bool rubs = scene_.friction && !step.frictionless;
  std::vector<double> vertical(blank.nodes());
  for (int k = 0; k < static_cast<int>(scene_.tools.size()); ++k) {
    for_each(blank.nodes(), [&](int i) {
      const auto [d, contact] = tool_contact(step, x, k, i);
      Vector3d force = -blank.node_area[i] * contact.pressure * d.normal;
      if (rubs && step.friction[k][i].load > 0.0)
        force += friction_force(settings, step.friction[k][i], relative_velocity(step, x, k, i));
      g.segment<3>(3 * i) += force;
      vertical[i] = force.z();
    });
    if (body_[k] >= 0) {
      g[body_[k]] += scene_.tools[k].force;
      for (double f : vertical) g[body_[k]] -= f;
    }
  }
  for (std::size_t k = 0; k < scene_.load.size(); ++k) g[static_cast<Eigen::Index>(k)] -= scene_.load[k];
  if (scene_.stabilisation > 0.0)
    for (int i = 0; i < blank.nodes(); ++i)
      g.segment<3>(3 * i) +=
          scene_.stabilisation * blank.node_area[i] / step.dt * (node_of(x, i) - step.start->node(i));
  return g;
}

VectorXd System::gradient(const StepData& step, const VectorXd& x) const {
  VectorXd g = full_gradient(step, x);
  for (std::size_t k = 0; k < scene_.held.size(); ++k)
    if (scene_.held[k]) g[static_cast<Eigen::Index>(k)] = 0.0;
  return g;
}

int System::block(int row_node, int column_node) const {
  const auto begin = block_row_.begin() + block_start_[column_node],
             end = block_row_.begin() + block_start_[column_node + 1];
  return static_cast<int>(std::lower_bound(begin, end, row_node) - block_row_.begin());
}

void System::build_pattern() {
  const Blank& blank = scene_.blank;
  const int nodes = blank.nodes();
  std::vector<std::set<int>> rows(nodes);
  const auto couple = [&](int a, int b) { rows[std::min(a, b)].insert(std::max(a, b)); };
  for (int i = 0; i < nodes; ++i) couple(i, i);
  for (const auto& quad : blank.quads)
    for (int a : quad)
      for (int b : quad) couple(a, b);
  for (const TowTriple& t : blank.triples) {
    couple(t.before, t.middle);
    couple(t.middle, t.after);
    couple(t.before, t.after);
  }
  block_start_.push_back(0);
  for (const auto& column : rows) {
    block_row_.insert(block_row_.end(), column.begin(), column.end());
    block_start_.push_back(static_cast<int>(block_row_.size()));
  }
  blocks_.assign(9 * block_row_.size(), 0.0);
  body_row_.assign(scene_.loaded_tools(), std::vector<double>(3 * nodes, 0.0));
  body_diagonal_.assign(scene_.loaded_tools(), 0.0);

  for (const auto& quad : blank.quads)
    for (const Corner& c : corners_of(quad)) {
      const std::array<std::array<int, 2>, 6> pairs = {{{c.node, c.node},
                                                        {c.along_warp, c.along_warp},
                                                        {c.along_weft, c.along_weft},
                                                        {c.along_warp, c.node},
                                                        {c.along_weft, c.node},
                                                        {c.along_warp, c.along_weft}}};
      CornerSlots slots{};
      for (std::size_t k = 0; k < pairs.size(); ++k) {
        slots.flipped[k] = pairs[k][0] < pairs[k][1];
        slots.slot[k] = block(std::max(pairs[k][0], pairs[k][1]), std::min(pairs[k][0], pairs[k][1]));
      }
      corner_slots_.push_back(slots);
    }
  for (int q = 0; q < static_cast<int>(blank.quads.size()); ++q) {
    const auto [i, j] = blank.grid[blank.quads[q][0]];
    colours_[2 * (i % 2) + j % 2].push_back(q);
  }

  SymmetricPattern pattern;
  pattern.size = size_;
  pattern.column_start.push_back(0);
  const int bodies = scene_.loaded_tools();
  for (int j = 0; j < nodes; ++j)
    for (int c = 0; c < 3; ++c) {
      for (int k = block_start_[j]; k < block_start_[j + 1]; ++k)
        for (int r = (k == block_start_[j] ? c : 0); r < 3; ++r) pattern.row.push_back(3 * block_row_[k] + r);
      for (int b = 0; b < bodies; ++b) pattern.row.push_back(3 * nodes + b);
      pattern.column_start.push_back(static_cast<int>(pattern.row.size()));
    }
  for (int b = 0; b < bodies; ++b) {
    pattern.row.push_back(3 * nodes + b);
    pattern.column_start.push_back(static_cast<int>(pattern.row.size()));
  }
  solver_ = std::make_unique<SparseSolver>(std::move(pattern));
}

void System::assemble_constant() {
  constant_.assign(blocks_.size(), 0.0);
  const auto add = [&](int a, int b, double value) {
    double* target = &constant_[9 * block(std::max(a, b), std::min(a, b))];
    for (int c = 0; c < 3; ++c) target[4 * c] += value;
  };
  for (const TowTriple& t : scene_.blank.triples) {
    const double k = bending_stiffness(t);
    add(t.before, t.before, k);
    add(t.middle, t.middle, 4.0 * k);
    add(t.after, t.after, k);
    add(t.before, t.middle, -2.0 * k);
    add(t.middle, t.after, -2.0 * k);
    add(t.before, t.after, k);
  }
  constexpr std::array<double, 4> sign = {1.0, -1.0, 1.0, -1.0};
  for (int quad = 0; quad < static_cast<int>(scene_.blank.quads.size()); ++quad) {
    const auto& q = scene_.blank.quads[quad];
    const double twist = twist_stiffness(quad);
    for (int a = 0; a < 4; ++a)
      for (int b = 0; b <= a; ++b) add(q[a], q[b], twist * sign[a] * sign[b]);
  }
}

void System::add_corners(const StepData& step, const VectorXd& x, Filter filter) {
  const CornerLaw law = corner_law(step);
  for (const auto& colour : colours_)
    for_each(static_cast<int>(colour.size()), [&](int index) {
      const int q = colour[index];
      const auto corners = corners_of(scene_.blank.quads[q]);
      const CornerLaw here = trimmed(law, scene_.blank.share[q]);
      for (int k = 0; k < 4; ++k) {
        const Corner& c = corners[k];
        const Vector3d origin = node_of(x, c.node);
        const CornerHessian h =
            corner_hessian(here, node_of(x, c.along_warp) - origin, node_of(x, c.along_weft) - origin,
                           step.start->corner_angle[4 * q + k], filter);
        const std::array<Matrix3d, 6> part = {h.aa + h.ab + h.ab.transpose() + h.bb,
                                              h.aa,
                                              h.bb,
                                              -(h.aa + h.ab),
                                              -(h.ab.transpose() + h.bb),
                                              h.ab};
        const CornerSlots& slots = corner_slots_[4 * q + k];
        for (std::size_t p = 0; p < part.size(); ++p) {
          Eigen::Map<Matrix3d> target(&blocks_[9 * slots.slot[p]]);
          if (slots.flipped[p])
            target += part[p].transpose();
          else
            target += part[p];
        }
      }
    });
}

void System::add_contact(const StepData& step, const VectorXd& x, Filter filter) {
  const Blank& blank = scene_.blank;
  const FrictionSettings settings = friction_settings();
  const bool rubs = scene_.friction && !step.frictionless;
  const FrictionTangent tangent = filter == Filter::none       ? FrictionTangent::exact
                                  : filter == Filter::positive ? FrictionTangent::convex
                                                               : FrictionTangent::secant;
  for (int k = 0, body = 0; k < static_cast<int>(scene_.tools.size()); ++k) {
    const bool loaded = body_[k] >= 0;
    std::vector<double>* row = loaded ? &body_row_[body] : nullptr;
    for_each(blank.nodes(), [&](int i) {
      const auto [d, contact] = tool_contact(step, x, k, i);
      Matrix3d stiffness = blank.node_area[i] * contact.stiffness * d.normal * d.normal.transpose();
      // Pressing against a convex tool, the node would rather slide off: negative, so dropped when filtering.
      if (filter == Filter::none) stiffness -= blank.node_area[i] * contact.pressure * d.curvature;
      if (rubs && step.friction[k][i].load > 0.0)
        stiffness +=
            friction_tangent(settings, step.friction[k][i], relative_velocity(step, x, k, i), tangent) /
            step.dt;
      Eigen::Map<Matrix3d>(&blocks_[9 * block_start_[i]]) += stiffness;
      if (loaded)
        for (int c = 0; c < 3; ++c) (*row)[3 * i + c] = -stiffness(2, c);
    });
    if (loaded) {
      double diagonal = scene_.tools[k].mass / (step.dt * step.dt);
      for (int i = 0; i < blank.nodes(); ++i) diagonal -= (*row)[3 * i + 2];
      body_diagonal_[body++] = diagonal;
    }
  }
}

void System::assemble(const StepData& step, const VectorXd& x, Filter filter, double shift) {
  blocks_ = constant_;
  const double inverse_dt2 = 1.0 / (step.dt * step.dt);
  for_each(scene_.blank.nodes(), [&](int i) {
    const double diagonal =
        mass_[3 * i] * inverse_dt2 + scene_.stabilisation * scene_.blank.node_area[i] / step.dt;
    for (int c = 0; c < 3; ++c) blocks_[9 * block_start_[i] + 4 * c] += diagonal;
  });
  add_corners(step, x, filter);
  add_contact(step, x, filter);
  write_matrix(shift);
}

void System::write_matrix(double shift) {
  const int nodes = scene_.blank.nodes(), bodies = scene_.loaded_tools();
  auto values = solver_->values();
  const auto& start = solver_->pattern().column_start;
  const bool some_held = !scene_.held.empty();
  const auto held = [&](int unknown) { return some_held && scene_.held[unknown]; };
  for_each(nodes, [&](int j) {
    for (int c = 0; c < 3; ++c) {
      int target = start[3 * j + c];
      const bool column_held = held(3 * j + c);
      for (int k = block_start_[j]; k < block_start_[j + 1]; ++k) {
        const double* source = &blocks_[9 * k + 3 * c];
        const bool diagonal_block = k == block_start_[j];
        for (int r = diagonal_block ? c : 0; r < 3; ++r, ++target) {
          const bool on_diagonal = diagonal_block && r == c;
          if (column_held || held(3 * block_row_[k] + r))
            values[target] = on_diagonal ? 1.0 : 0.0;
          else
            values[target] = source[r] + (on_diagonal ? shift : 0.0);
        }
      }
      for (int b = 0; b < bodies; ++b, ++target) values[target] = column_held ? 0.0 : body_row_[b][3 * j + c];
    }
  });
  for (int b = 0; b < bodies; ++b) values[start[3 * nodes + b]] = body_diagonal_[b] + shift;
}

double System::largest_diagonal() const {
  const auto& pattern = solver_->pattern();
  const auto values = solver_->values();
  double largest = 0.0;
  for (int j = 0; j < pattern.size; ++j) largest = std::max(largest, values[pattern.column_start[j]]);
  return largest;
}

}  // namespace heddle::macroscale
