// The Hessian of the incremental potential: its pattern, found once, and its values.
#include <algorithm>
#include <array>
#include <set>

#include "macroscale/parallel.h"
#include "macroscale/system.h"
#include "macroscale/tool_drive.h"

namespace heddle::macroscale {

using Eigen::Matrix3d;

int System::block(int row_node, int column_node) const {
  const auto begin = block_row_.begin() + block_start_[column_node],
             end = block_row_.begin() + block_start_[column_node + 1];
  return static_cast<int>(std::lower_bound(begin, end, row_node) - block_row_.begin());
}

void System::build_pattern() {
  const Blank& blank = scene_.blank;
  const int nodes = blank.nodes();
  block_start_.clear();
  block_row_.clear();
  block_place_.clear();
  corner_slots_.clear();
  cell_slots_.clear();
  for (auto& colour : colours_) colour.clear();
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
  for (std::size_t k = 0; k < coupling_.quad.size(); ++k)
    for (const int near : coupled_nodes(blank, coupling_, k))
      for (const int own : blank.quads[ply_points_[k].quad]) couple(own, near);
  block_start_.push_back(0);
  for (const auto& column : rows) {
    block_row_.insert(block_row_.end(), column.begin(), column.end());
    block_start_.push_back(static_cast<int>(block_row_.size()));
  }
  body_row_.assign(scene_.unknowns_of_tools(), std::vector<double>(3 * nodes, 0.0));
  body_column_.clear();
  for (const Tool& tool : scene_.tools)
    for (int left = unknowns_of(tool); left > 0; --left) body_column_.emplace_back(left, 0.0);

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
  if (scene_.contact_sites == ContactSites::gauss)
    for (const auto& quad : blank.quads) {
      auto slot = cell_slots_.emplace_back().begin();
      for (std::size_t a = 0; a < 4; ++a)
        for (std::size_t b = 0; b <= a; ++b)
          *slot++ = block(std::max(quad[a], quad[b]), std::min(quad[a], quad[b]));
    }
  for (int q = 0; q < static_cast<int>(blank.quads.size()); ++q) {
    const auto [i, j] = blank.grid[blank.quads[q][0]];
    colours_[2 * (i % 2) + j % 2].push_back(q);
  }

  SymmetricPattern pattern;
  pattern.size = size_;
  pattern.column_start.push_back(0);
  const int bodies = scene_.unknowns_of_tools();
  for (int j = 0; j < nodes; ++j)
    for (int c = 0; c < 3; ++c) {
      for (int k = block_start_[j]; k < block_start_[j + 1]; ++k)
        for (int r = (k == block_start_[j] ? c : 0); r < 3; ++r) pattern.row.push_back(3 * block_row_[k] + r);
      for (int b = 0; b < bodies; ++b) pattern.row.push_back(3 * nodes + b);
      pattern.column_start.push_back(static_cast<int>(pattern.row.size()));
    }
  for (int b = 0; b < bodies; ++b) {
    for (std::size_t r = 0; r < body_column_[b].size(); ++r)
      pattern.row.push_back(3 * nodes + b + static_cast<int>(r));
    pattern.column_start.push_back(static_cast<int>(pattern.row.size()));
  }
  solver_ = std::make_unique<SparseSolver>(std::move(pattern));
  values_ = solver_->values();
  const auto& start = solver_->pattern().column_start;
  for (int j = 0; j < nodes; ++j)
    for (int k = block_start_[j]; k < block_start_[j + 1]; ++k)
      block_place_.push_back(
          {start[3 * j] + 3 * (k - block_start_[j]), start[3 * j + 1] - start[3 * j], k == block_start_[j]});
}

// Columns of a node begin at their diagonals: the second has one value less than the first, the third two. So
// row r of column c of a block stands r behind {0, length - 1, 2 length - 3}.
std::array<double*, 3> System::columns_of(const BlockPlace& place) const {
  double* first = &values_[place.first];
  return {first, first + place.column_length - 1, first + 2 * place.column_length - 3};
}

void System::add_block(int block, const Matrix3d& part) {
  const BlockPlace& place = block_place_[block];
  const std::array<double*, 3> column = columns_of(place);
  if (!place.diagonal) {
    for (int c = 0; c < 3; ++c) Eigen::Map<Eigen::Vector3d>(column[c]) += part.col(c);
    return;
  }
  for (int c = 0; c < 3; ++c)
    for (int r = c; r < 3; ++r) column[c][r] += part(r, c);
}

void System::assemble_constant() {
  constant_.assign(block_row_.size(), 0.0);
  const auto add = [&](int a, int b, double value) {
    constant_[block(std::max(a, b), std::min(a, b))] += value;
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

// Nothing bends across a plane of symmetry: the only terms here that differ from one direction to another.
void System::add_mirrored() {
  for (const MirroredTriple& t : scene_.blank.mirrored) {
    Eigen::Vector3d in_plane = Eigen::Vector3d::Ones();
    in_plane[t.axis] = 0.0;
    const Matrix3d part = (4.0 * bending_stiffness(t) * in_plane).asDiagonal();
    add_block(block(t.middle, t.middle), part);
    add_block(block(t.beside, t.beside), part);
    add_block(block(std::max(t.middle, t.beside), std::min(t.middle, t.beside)), -part);
  }
}

void System::add_corners(const StepData& step, const Position& at, Filter filter) {
  const std::vector<CornerLaw> laws = corner_laws(step);
  for (const auto& colour : colours_)
    for_each(static_cast<int>(colour.size()), [&](int index) {
      const int q = colour[index];
      CornerLaw here = trimmed(laws[scene_.blank.ply_of_quad(q)], scene_.blank.share[q]);
      const auto corners = corners_of(scene_.blank.quads[q]);
      for (int k = 0; k < 4; ++k) {
        if (here.tow_viscosity > 0.0) here.strain_before = strain_before(step, corners[k], here);
        const CornerHessian h = corner_hessian(here, at.corners[4 * q + k], filter);
        const std::array<Matrix3d, 6> part = {h.aa + h.ab + h.ab.transpose() + h.bb,
                                              h.aa,
                                              h.bb,
                                              -(h.aa + h.ab),
                                              -(h.ab.transpose() + h.bb),
                                              h.ab};
        const CornerSlots& slots = corner_slots_[4 * q + k];
        for (std::size_t p = 0; p < part.size(); ++p) {
          if (slots.flipped[p])
            add_block(slots.slot[p], part[p].transpose());
          else
            add_block(slots.slot[p], part[p]);
        }
      }
    });
}

Matrix3d System::contact_stiffness(const StepData& step, const Position& at, int k, int i,
                                   Filter filter) const {
  const auto& [distance, direction, contact] = at.contacts[k][i];
  const double area = contact_area(step, i);
  Matrix3d stiffness = area * contact.stiffness * direction * direction.transpose();
  // Pressing against a convex tool, the point would rather slide off: negative, so dropped when filtering.
  if (filter == Filter::none && contact.pressure > 0.0)
    stiffness -= area * contact.pressure * tool_contact(step, at.x, k, i).surface.curvature;
  if (!at.friction.empty() && step.friction[k][i].load > 0.0)
    stiffness += friction_stiffness(step, at, k, i, filter);
  return stiffness;
}

Matrix3d System::friction_stiffness(const StepData& step, const Position& at, int k, int i,
                                    Filter filter) const {
  const FrictionTangent tangent = filter == Filter::none       ? FrictionTangent::exact
                                  : filter == Filter::positive ? FrictionTangent::convex
                                                               : FrictionTangent::secant;
  return friction_tangent(friction_settings(k), step.friction[k][i], at.friction[k][i], tangent) / step.dt;
}

void System::add_contact(const StepData& step, const Position& at, Filter filter) {
  if (scene_.contact_sites == ContactSites::gauss) return add_contact_in_cells(step, at, filter);
  const Blank& blank = scene_.blank;
  for (int k = 0; k < static_cast<int>(scene_.tools.size()); ++k) {
    const bool loaded = body_[k] >= 0;
    std::vector<double>* row = loaded ? &body_row_[body_[k] - 3 * blank.nodes()] : nullptr;
    for_each(blank.nodes(), [&, k](int i) {
      const Matrix3d stiffness = contact_stiffness(step, at, k, i, filter);
      add_block(block_start_[i], stiffness);
      if (loaded)
        for (int c = 0; c < 3; ++c) (*row)[3 * i + c] = -stiffness(2, c);
    });
    close_tool(step, at, k, filter);
  }
}

// A point inside a cell stiffens all pairs of its corners by the product of their weights: symmetric blocks,
// so which node has the larger number does not matter. Cells of one colour share no node.
void System::add_contact_in_cells(const StepData& step, const Position& at, Filter filter) {
  for (int k = 0; k < static_cast<int>(scene_.tools.size()); ++k) {
    const bool loaded = body_[k] >= 0;
    const int body = body_[k] - 3 * scene_.blank.nodes();
    if (loaded) std::fill(body_row_[body].begin(), body_row_[body].end(), 0.0);
    for (const auto& colour : colours_)
      for_each(static_cast<int>(colour.size()), [&, k](int index) {
        const int q = colour[index];
        for (int i = 4 * q; i < 4 * q + 4; ++i) {
          if (at.contacts[k][i].normal.approach <= 0.0 &&
              (at.friction.empty() || step.friction[k][i].load == 0.0))
            continue;
          const ContactPoint& point = points_[i];
          const Matrix3d stiffness = contact_stiffness(step, at, k, i, filter);
          auto slot = cell_slots_[q].begin();
          for (std::size_t a = 0; a < 4; ++a) {
            for (std::size_t b = 0; b <= a; ++b)
              add_block(*slot++, point.weight[a] * point.weight[b] * stiffness);
            if (loaded)
              for (int c = 0; c < 3; ++c)
                body_row_[body][3 * point.node[a] + c] -= point.weight[a] * stiffness(2, c);
          }
        }
      });
    close_tool(step, at, k, filter);
  }
}

// A loaded tool feels what all its contacts feel along z, its own mass and its spring.
void System::close_tool(const StepData& step, const Position& at, int k, Filter filter) {
  if (body_[k] < 0) return;
  const Tool& tool = scene_.tools[k];
  const int body = body_[k] - 3 * scene_.blank.nodes();
  double diagonal = tool.mass / (step.dt * step.dt) + drive_at(tool, at.x[body_[k]]).stiffness;
  if (tool.tilt) return close_tilting(step, at, k, filter, diagonal);
  for (int i = 0; i < scene_.blank.nodes(); ++i) diagonal -= body_row_[body][3 * i + 2];
  body_column_[body][0] = diagonal;
}

// With ways w_j of the tool's points for each of its unknowns q_j, a point's friction knows x - sum w_j q_j,
// its contact the distance of x and q.
void System::close_tilting(const StepData& step, const Position& at, int k, Filter filter,
                           double stiffness_along_z) {
  const Tool& tool = scene_.tools[k];
  const int body = body_[k] - 3 * scene_.blank.nodes();
  const Pose pose = this->pose(step, at.x, k);
  for (int u = 0; u < 3; ++u) std::fill(body_row_[body + u].begin(), body_row_[body + u].end(), 0.0);
  Matrix3d own = Matrix3d::Zero();
  for (int u = 0; u < 3; ++u)
    own(u, u) = u == 0 ? stiffness_along_z
                       : tool.mass / (step.dt * step.dt) + tilt_drive_at(tool, at.x[body_[k] + u]).stiffness;
  for (int i = 0; i < contacts(); ++i) {
    const auto& [d, direction, contact] = at.contacts[k][i];
    const bool rubs = !at.friction.empty() && step.friction[k][i].load > 0.0;
    if (contact.approach <= 0.0 && !rubs) continue;
    const double area = contact_area(step, i);
    const Eigen::Vector3d slope = slopes_at(*tool.tilt, pose, at_point(points_[i], at.x), direction);
    Matrix3d with_point = area * contact.stiffness * direction * slope.transpose();
    own += area * contact.stiffness * slope * slope.transpose();
    if (filter == Filter::none && contact.pressure > 0.0) {
      const TiltCurvature bent =
          curvature_at(*tool.tilt, pose, at_point(points_[i], at.x), tool_contact(step, at.x, k, i).surface);
      with_point -= area * contact.pressure * bent.with_point;
      own -= area * contact.pressure * bent.own;
    }
    if (rubs) {
      const Matrix3d drag = friction_stiffness(step, at, k, i, filter);
      Matrix3d way;
      const auto ways = ways_at(*tool.tilt, at_point(points_[i], step.start->x));
      for (int u = 0; u < 3; ++u) way.col(u) = ways[u];
      with_point -= drag * way;
      own += way.transpose() * drag * way;
    }
    const ContactPoint& point = points_[i];
    for (int a = 0; a < point.nodes; ++a)
      for (int u = 0; u < 3; ++u)
        for (int c = 0; c < 3; ++c)
          body_row_[body + u][3 * point.node[a] + c] += point.weight[a] * with_point(c, u);
  }
  for (int u = 0; u < 3; ++u)
    for (int r = u; r < 3; ++r) body_column_[body + u][r - u] = own(r, u);
}

// Inertia, stabilisation, bending and twist: multiples of the unit matrix in each block.
void System::begin_matrix(const StepData& step) {
  const double inverse_dt2 = 1.0 / (step.dt * step.dt);
  const auto& start = solver_->pattern().column_start;
  for_each(scene_.blank.nodes(), [&](int j) {
    std::fill(values_.begin() + start[3 * j], values_.begin() + start[3 * j + 3], 0.0);
    const double diagonal =
        mass_[3 * j] * inverse_dt2 + scene_.stabilisation * scene_.blank.node_area[j] / step.dt;
    for (int k = block_start_[j]; k < block_start_[j + 1]; ++k) {
      const std::array<double*, 3> column = columns_of(block_place_[k]);
      const double alike = block_place_[k].diagonal ? constant_[k] + diagonal : constant_[k];
      for (int c = 0; c < 3; ++c) column[c][c] = alike;
    }
  });
}

// The rows of loaded tools at the foot of each column, the shift, identity rows and columns of held unknowns.
void System::finish_matrix(double shift) {
  const int nodes = scene_.blank.nodes(), bodies = scene_.unknowns_of_tools();
  const auto& start = solver_->pattern().column_start;
  const auto& row = solver_->pattern().row;
  const bool some_held = !scene_.held.empty();
  for_each(3 * nodes, [&](int j) {
    for (int b = 0; b < bodies; ++b) values_[start[j + 1] - bodies + b] = body_row_[b][j];
    values_[start[j]] += shift;
    if (!some_held) return;
    for (int k = start[j]; k < start[j + 1]; ++k)
      if (scene_.held[j] || (row[k] < 3 * nodes && scene_.held[row[k]]))
        values_[k] = k == start[j] ? 1.0 : 0.0;
  });
  for (int b = 0; b < bodies; ++b) {
    std::copy(body_column_[b].begin(), body_column_[b].end(), values_.begin() + start[3 * nodes + b]);
    values_[start[3 * nodes + b]] += shift;
  }
}

void System::assemble(const StepData& step, const Position& at, Filter filter, double shift) {
  begin_matrix(step);
  add_mirrored();
  add_corners(step, at, filter);
  add_contact(step, at, filter);
  add_contact_of_plies(step, at, filter);
  finish_matrix(shift);
}

double System::largest_diagonal() const {
  const auto& pattern = solver_->pattern();
  double largest = 0.0;
  for (int j = 0; j < pattern.size; ++j) largest = std::max(largest, values_[pattern.column_start[j]]);
  return largest;
}

}  // namespace heddle::macroscale
